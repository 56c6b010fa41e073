// Coarser triangles over the same vertices, with a proved bound on how far any point of the surface moves: half-edge collapses bounded by successive
// mappings (Cohen, Manocha, Olano, "Simplifying polygonal models using successive mappings", 1997).
// SPDX-License-Identifier: MIT
//
// THE BOUND. A collapse of u into its neighbour v changes the triangles round u only. Seen along one direction all of them, before and after, are
// turned the same way, so both cover the same polygon once, and each point goes to the one behind it along that direction. The distance is linear in
// every part of the overlay, so it is largest at u or where an old edge from u crosses a new one from v. Where u stands on a border (of a group, or where
// its vertices differ: a crease) it first slides straight to the line between its neighbours there, and every point goes less far than u. Distances of one
// collapse after another add up: each triangle keeps the sum.
// Invariant: each group's surface goes onto the same group's, no point farther than the bound; an open edge of the mesh stays as it is.
#ifndef PORTCULLIS_RENDER_SIMPLIFY_H
#define PORTCULLIS_RENDER_SIMPLIFY_H

#include "../core/memory.h"
#include "../core/report.h"

#define SIMPLIFY_GONE UINT32_MAX // in the place of a triangle's first corner
#define SIMPLIFY_KEPT UINT32_MAX // in the place of a group: the triangle stays as it is

typedef struct simplify_input {
    const float *positions;  // 3 a vertex, finite; equal ones are one point, of different looks
    const uint32_t *normals; // 3 x snorm8 in the low bytes; 0: such a vertex stays
    const uint32_t *groups;  // a triangle
    uint32_t position_count, triangle_count;
} simplify_input;

typedef struct simplify simplify;
// corners: 3 a triangle, the caller's, rewritten by simplify_to; all of the input is lent until simplify_close.
result simplify_open(const simplify_input *in, uint32_t *corners, const allocator *memory, simplify **out); // RESULT_NO_MEMORY, unreported
// Goes on from where the last call came to. Afterwards no point is farther than bound_m from its place in the input. Returns the triangles that are left.
uint32_t simplify_to(simplify *s, double bound_m);
void simplify_close(simplify *s); // NULL is fine

#endif
