// What a viewer's frames came to under method=hiz, and whether it rests.
// SPDX-License-Identifier: MIT
#ifndef OCCLUSION_HIZ_COUNTERS_H
#define OCCLUSION_HIZ_COUNTERS_H

#include "drop.h"

typedef struct hiz_rest { // see hiz_rest.h
    uint32_t serial, on_since, due, level; // of frames; the pause's end, and that of the next: 2^level frames
    uint32_t is_off, has_paused;           // has_paused: this frame, or those since, are tried after a pause
    uint64_t off_items;                    // in the view when it was switched off
    uint64_t spent, gained;                // halves of polygons
} hiz_rest;

typedef struct hiz_counters {
    uint64_t rectangles, items, polygons; // rectangles tested; drawn into the pyramid
    drop_counters drops;
    hiz_rest rest;
} hiz_counters;

#endif
