// Portals: convex pieces of the mid-planes of doors in their closed place, or of authored portal brushes, clipped by the air.
// SPDX-License-Identifier: MIT
// Invariant: a piece has air on both sides, all over; pieces of one plane don't overlap. Whether a piece separates is for
// the zones to tell.
#ifndef PORTCULLIS_HOST_PORTALS_H
#define PORTCULLIS_HOST_PORTALS_H

#include "surface.h"

typedef struct portal_piece {
    uint32_t polygon;     // of portal_set.s, SURFACE_PORTAL
    uint32_t entity;      // that made it, the first of its group of doors
    uint32_t is_rejected; // by whoever finds out
    uint32_t is_door;     // else authored
} portal_piece;

typedef struct portal_set {
    surface s;     // of the pieces alone
    buffer pieces; // portal_piece
} portal_set;

result portal_set_make(const compile_input *in, portal_choice choice, report *r, const allocator *memory, portal_set *out);
void portal_set_free(portal_set *p); // of a made one

// ---- portal_slab.c: where a portal may lie, before the air is looked at ----
typedef struct portal_slab {
    plane_ref plane;      // the mid-plane of the thin axis
    uint32_t first_side, side_count; // in slab_set.sides: fronts outside; the first four are the box's, round the plane's main axis
    uint32_t entity, is_door;
} portal_slab;
typedef struct slab_set { buffer slabs, sides; } slab_set; // portal_slab, plane_ref
result slab_set_make(const compile_input *in, portal_choice choice, report *r, const allocator *memory, slab_set *out);
void slab_set_free(slab_set *s);

// ---- portal_air.c: clipping ----
// Of the polygon, what has air on both sides: appended to `out` (uint32_t, polygons of s). `brushes`: of structure that may
// touch it, in file order.
result portal_air(surface *s, const compile_input *in, uint32_t polygon, const uint32_t *brushes, uint32_t count, buffer *out);
// Of the polygon, what the coplanar polygon `other` leaves: appended to `out`.
result portal_without(surface *s, uint32_t polygon, uint32_t other, buffer *out);

// ---- portal_cut.c: into the surface that zones are traced on ----
// Appends the pieces that aren't rejected, cuts them by each other, and the surface's polygons that cross them.
// Seals cut like pieces.
result portal_cut(surface *s, const portal_set *p);

// ---- touch_cut.c ----
// Cuts polygons along edges of others that lie inside them.
result touch_cut(surface *s);

#endif
