// Parting at a median (Hoare, Find, 1961), the pivot by a fixed generator: O(n) whatever the boxes are, for both trees of occlusion's own.
// SPDX-License-Identifier: MIT
#ifndef OCCLUSION_MEDIAN_H
#define OCCLUSION_MEDIAN_H

#include <portcullis/box.h>
#include <portcullis/culler.h>

typedef struct sort_key { float value; uint32_t item; } sort_key;

static inline int key_less(sort_key a, sort_key b)
{
    return a.value < b.value || (a.value == b.value && a.item < b.item);
}

static inline uint32_t seed_below(uint32_t *seed, uint32_t count)
{
    *seed = *seed * 1664525u + 1013904223u;
    return (uint32_t)((uint64_t)*seed * count >> 32);
}

// Keys below place `middle` become the least. No two keys are equal: the item settles it.
static inline void keys_part(sort_key *keys, uint32_t count, uint32_t middle, uint32_t *seed)
{
    uint32_t low = 0, high = count - 1;
    while (low < high) {
        const sort_key pivot = keys[low + seed_below(seed, high - low + 1)];
        uint32_t i = low, j = high;
        for (;;) {
            while (key_less(keys[i], pivot)) i++;
            while (key_less(pivot, keys[j])) j--;
            if (i >= j) break;
            const sort_key swapped = keys[i];
            keys[i++] = keys[j];
            keys[j--] = swapped;
        }
        if (middle < i) high = i - 1; // all before i are less than all from i on
        else low = i > low ? i : low + 1;
    }
}

static inline float centre_of(const cull_zone *zone, uint32_t item, int axis)
{
    const cull_box b = cull_box_at(&zone->boxes, item);
    const float low[3] = {b.min.x, b.min.y, b.min.z}, high[3] = {b.max.x, b.max.y, b.max.z};
    const float centre = low[axis] * 0.5f + high[axis] * 0.5f;
    return centre == centre ? centre : 0;
}

#endif
