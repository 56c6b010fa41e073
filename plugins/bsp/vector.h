// A growing array in the host's memory, for the time of a build.
// SPDX-License-Identifier: MIT
// Invariant: count <= capacity < 2^31, so no index and no sum of two wraps.
#ifndef PORTCULLIS_BSP_VECTOR_H
#define PORTCULLIS_BSP_VECTOR_H

#include <portcullis/culler.h>

typedef struct bsp_vector {
    void *items;
    uint32_t count, capacity, item_size;
} bsp_vector;

static inline bsp_vector vector_make(uint32_t item_size)
{
    const bsp_vector v = {0, 0, 0, item_size};
    return v;
}
// Room for `count` more, of undefined content; NULL without memory, and the vector is as before. May move what it holds.
void *vector_push(const cull_host *host, bsp_vector *v, uint32_t count);
void vector_free(const cull_host *host, bsp_vector *v);
// An array of exactly what the vector holds, NULL when that is nothing; *failed is set where there is no memory.
void *vector_copy(const cull_host *host, const bsp_vector *v, int *failed);

// count things of a size; NULL for none and for no memory, and then *failed is set.
void *array_alloc(const cull_host *host, size_t count, size_t item_size, int *failed);
void array_free(const cull_host *host, void *items, size_t count, size_t item_size);

#endif
