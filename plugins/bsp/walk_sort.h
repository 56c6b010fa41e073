// Items that no plane of the tree parts, halved by their places in space: mesh clusters, many walls in one leaf.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_BSP_WALK_SORT_H
#define PORTCULLIS_BSP_WALK_SORT_H

#include <portcullis/culler.h>

typedef struct walk_range {
    const cull_zone *zone;
    const uint32_t *order; // order[place] = item of the zone
    uint32_t *places;      // count of them, put in another order
    uint32_t count;
} walk_range;

// The halves: the first `front` places lie in front of plane (normal, offset), the others behind; a multiple of `width`. 0: all lie on
// one spot. Within a half the order is no matter.
uint32_t walk_halve(const walk_range *range, uint32_t width, float plane[4]);
void walk_sort(uint32_t *places, uint32_t count); // ascending

#endif
