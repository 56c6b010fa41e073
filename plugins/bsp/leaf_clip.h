// One item against one volume: a wall by its polygon, anything else by its box.
// SPDX-License-Identifier: MIT
// Invariant: the answer depends on the item and the volume only, not on where in the tree it is asked: `which` may lack planes
// that have no part of a box around the item outside, and then it is the same. That makes the set select finds that of a loop
// over the items.
//
// Why nothing is lost: the volume's planes stand outward by 4 u of |normal|_1 * radius (u = 2^-24, plane.h), of which a plane's own
// rounding takes u; 3 u of the radius are left at least. A loop whose vertices lie within d of some plane, cut as if it were flat, errs by
// d, and what is drawn may lie beside it by t: shapes.c takes loops of d + t <= 3 u of the radius only. A triangle is flat. Cutting in
// double costs 2^-28 of that.
#ifndef PORTCULLIS_BSP_LEAF_CLIP_H
#define PORTCULLIS_BSP_LEAF_CLIP_H

#include "shapes.h"
#include "volume.h"

#include <portcullis/clip.h>

typedef struct clip_room { // two polygons
    cull_point *points[2];
    uint32_t capacity; // of each
} clip_room;

// Points of each polygon that no wall of the zone outgrows: twice, because rounding may bend a loop.
static inline uint32_t clip_capacity(uint32_t most_vertices)
{
    return 2 * (most_vertices + CULL_MAX_PLANES);
}

typedef struct clip_request {
    const bsp_volume *volume;
    uint32_t which; // of its planes
    clip_room room;
} clip_request;

typedef enum clip_fate {
    CLIP_KEPT,      // some of it is inside
    CLIP_BEYOND,    // one plane has all of it outside: *out_plane
    CLIP_NOTHING,   // the planes together leave nothing; *out_plane took the last of it
} clip_fate;
clip_fate clip_shape(const clip_request *q, const bsp_shape *shape, uint32_t *out_plane);

#endif
