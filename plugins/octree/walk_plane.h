// What the walk and the kernels of each instruction set agree on.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_OCTREE_WALK_PLANE_H
#define PORTCULLIS_OCTREE_WALK_PLANE_H

#include "walk.h"

// A plane made ready for blocks: where in a block the corners stand that lie farthest inside and farthest outside.
typedef struct walk_plane {
    float x, y, z;
    float limit; // -offset: comparing a sum with it has the sign of the sum with the offset added, exactly
    uint32_t inner_x, inner_y, inner_z, outer_x, outer_y, outer_z; // floats from the block's start
} walk_plane;

// A node's children, bit by bit.
typedef struct walk_split {
    uint32_t touching; // no plane has the child outside
    uint32_t cut;      // some plane has a part of it outside
    _Alignas(64) uint32_t planes[INDEX_WIDTH]; // of each child: the planes that cut it; elsewhere undefined
} walk_split;

#endif
