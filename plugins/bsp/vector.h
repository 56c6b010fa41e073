// A growing array in the host's memory, for the time of a build. No step uses it.
// SPDX-License-Identifier: MIT
// Invariant: count <= capacity < 2^31, so no index and no sum of two wraps; items moves when it grows, so references are places, not pointers.
#ifndef PORTCULLIS_BSP_VECTOR_H
#define PORTCULLIS_BSP_VECTOR_H

#include <portcullis/culler.h>

#include <string.h>

typedef struct bsp_vector {
    const cull_host *host;
    void *items;
    size_t item_size; // bytes
    uint32_t count, capacity;
} bsp_vector;

static inline bsp_vector vector_make(const cull_host *host, size_t item_size)
{
    const bsp_vector v = {host, 0, item_size, 0, 0};
    return v;
}

// Moves the items to where `more` fit behind them. 0 without memory, and the vector is as before.
int vector_grow(bsp_vector *v, uint32_t more);
void vector_free(bsp_vector *v); // it can be filled again
// An array of exactly what the vector holds, NULL when that is nothing; *failed is set where there is no memory.
void *vector_copy(const bsp_vector *v, int *failed);
// The same to *out_items, a pointer to whatever the items are, and the vector is empty then. 0 without memory, and nothing is changed.
int vector_take(bsp_vector *v, void *out_items, uint32_t *out_count);

// Room for `more` behind the last, of undefined content and not counted yet; NULL without memory, and the vector is as before.
static inline void *vector_reserve(bsp_vector *v, uint32_t more)
{
    if ((more > v->capacity - v->count || !v->items) && !vector_grow(v, more)) return 0;
    return (char *)v->items + v->item_size * v->count;
}

// The same, counted.
static inline void *vector_push(bsp_vector *v, uint32_t more)
{
    void *to = vector_reserve(v, more);
    if (to) v->count += more;
    return to;
}

static inline int vector_add(bsp_vector *v, const void *item) // none of its own: they move
{
    void *to = vector_push(v, 1);
    if (to) memcpy(to, item, v->item_size);
    return to != 0;
}

// count things of a size; NULL for none and for no memory, and then *failed is set.
void *array_alloc(const cull_host *host, size_t count, size_t item_size, int *failed);
void array_free(const cull_host *host, void *items, size_t count, size_t item_size);

#endif
