// Growing arrays: see vector.h.
// SPDX-License-Identifier: MIT
#include "vector.h"

enum { ALIGN = 64, CAPACITY_LEAST = 64, CAPACITY_MOST = 0x7fffffff };

int vector_grow(bsp_vector *v, uint32_t more)
{
    if (more > CAPACITY_MOST - v->count) return 0;
    uint32_t capacity = v->capacity < CAPACITY_MOST / 2 ? v->capacity * 2 : CAPACITY_MOST;
    if (capacity < v->count + more) capacity = v->count + more;
    if (capacity < CAPACITY_LEAST) capacity = CAPACITY_LEAST;
    void *items = capacity <= SIZE_MAX / v->item_size ? v->host->alloc(v->host, capacity * v->item_size, ALIGN) : NULL;
    if (!items) return 0;
    if (v->count) memcpy(items, v->items, v->count * v->item_size);
    if (v->items) v->host->free(v->host, v->items, v->capacity * v->item_size);
    v->items = items;
    v->capacity = capacity;
    return 1;
}

void vector_free(bsp_vector *v)
{
    if (v->items) v->host->free(v->host, v->items, v->capacity * v->item_size);
    v->items = NULL;
    v->count = v->capacity = 0;
}

void *vector_copy(const bsp_vector *v, int *failed)
{
    void *out = array_alloc(v->host, v->count, v->item_size, failed);
    if (out) memcpy(out, v->items, v->count * v->item_size);
    return out;
}

int vector_take(bsp_vector *v, void *out_items, uint32_t *out_count)
{
    int failed = 0;
    void *items = vector_copy(v, &failed);
    if (failed) return 0;
    memcpy(out_items, &items, sizeof items);
    *out_count = v->count;
    vector_free(v);
    return 1;
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
