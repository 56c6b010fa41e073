// Growing arrays: see vector.h.
// SPDX-License-Identifier: MIT
#include "vector.h"

#include <string.h>

enum { ALIGN = 64, CAPACITY_LEAST = 64, CAPACITY_MOST = 0x7fffffff };

void *vector_push(const cull_host *host, bsp_vector *v, uint32_t count)
{
    if (count > CAPACITY_MOST - v->count) return NULL;
    if (v->count + count > v->capacity || !v->items) {
        uint32_t capacity = v->capacity < CAPACITY_MOST / 2 ? v->capacity * 2 : CAPACITY_MOST;
        if (capacity < v->count + count) capacity = v->count + count;
        if (capacity < CAPACITY_LEAST) capacity = CAPACITY_LEAST;
        void *items = host->alloc(host, (size_t)capacity * v->item_size, ALIGN);
        if (!items) return NULL;
        if (v->count) memcpy(items, v->items, (size_t)v->count * v->item_size);
        if (v->items) host->free(host, v->items, (size_t)v->capacity * v->item_size);
        v->items = items;
        v->capacity = capacity;
    }
    char *at = (char *)v->items + (size_t)v->count * v->item_size;
    v->count += count;
    return at;
}

void vector_free(const cull_host *host, bsp_vector *v)
{
    if (v->items) host->free(host, v->items, (size_t)v->capacity * v->item_size);
    v->items = NULL;
    v->count = v->capacity = 0;
}

void *vector_copy(const cull_host *host, const bsp_vector *v, int *failed)
{
    void *out = array_alloc(host, v->count, v->item_size, failed);
    if (out) memcpy(out, v->items, (size_t)v->count * v->item_size);
    return out;
}

void *array_alloc(const cull_host *host, size_t count, size_t item_size, int *failed)
{
    if (count == 0) return NULL;
    void *items = count <= SIZE_MAX / item_size ? host->alloc(host, count * item_size, ALIGN) : NULL;
    if (!items) *failed = 1;
    return items;
}

void array_free(const cull_host *host, void *items, size_t count, size_t item_size)
{
    if (items) host->free(host, items, count * item_size);
}
