// What the kernels of the walk and walk.c agree on.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_BSP_WALK_PARTS_H
#define PORTCULLIS_BSP_WALK_PARTS_H

#include "walk.h"

typedef struct walk_cut { uint32_t volume, which; } walk_cut; // planes of it that cut the node's box

enum { STEP_ITEMS = 1, STEP_INSIDE = 2 }; // of step.how: the node's own items alone; all of it lies inside some volume
typedef struct walk_step {
    uint32_t node, how;
    uint32_t first, count; // volumes, in cuts: what is left of the parent's
} walk_step;

// The scratch. cuts: what is left of a node's volumes stands behind what is left of its parent's, so popping a node forgets what
// came after.
typedef struct walk_memory {
    bsp_volume volumes[WALK_VOLUMES];
    clip_room room;
    walk_cut *cuts;
    walk_step *steps;
    uint8_t *wanted; // by place, where there are more volumes than one pass takes
} walk_memory;

walk_memory *walk_memory_of(const walk_request *q);

#endif
