// One brush as a convex polyhedron: for each of its planes the polygon that the others leave of it, exactly.
// SPDX-License-Identifier: MIT
// Invariant: cutting makes no new numbers: a corner is its face's plane and two more; every decision is an exact sign.
#ifndef PORTCULLIS_HOST_BRUSH_SHAPE_H
#define PORTCULLIS_HOST_BRUSH_SHAPE_H

#include "plane_table.h"

typedef struct shape_corner {
    plane_ref planes[3]; // that meet in it, the face's first
    plane_ref edge;      // behind it, counterclockwise seen from outside, lies the edge on this plane
    int32_t side;        // of the plane cut by last
    double position[3];  // grid steps, see plane_table_position
} shape_corner;

typedef struct shape_face {
    uint32_t face; // of the planes given
    uint32_t first_corner, corner_count;
} shape_face;

typedef struct brush_shape {
    buffer corners, faces; // shape_corner, shape_face: of planes that keep an area, in the order given
    buffer loop, other;    // scratch
} brush_shape;

typedef enum shape_fault {
    SHAPE_SOUND,
    SHAPE_OPEN,  // or it reaches beyond the grid
    SHAPE_EMPTY, // nothing is behind all planes
    SHAPE_NO_MEMORY,
} shape_fault;

brush_shape brush_shape_make(const allocator *memory);
void brush_shape_free(brush_shape *s);
// The planes of a cube round the grid, twice as wide, from which faces are cut. 0: out of memory.
int brush_shape_cube(plane_table *t, plane_ref cube[6]);
// The cube's four sides along the plane's steepest axis, in the order in which the square's edges go counterclockwise from its front.
void brush_shape_square(const plane_table *t, const plane_ref cube[6], plane_ref plane, plane_ref edges[4]);
// planes: fronts outside, each at most once. The shape of an earlier call is overwritten.
shape_fault brush_shape_cut(brush_shape *s, const plane_table *t, const plane_ref cube[6], const plane_ref *planes, uint32_t count);
// One face alone, its corners in s->loop. Of equal planes the first has the face; a plane and its opposite leave nothing.
shape_fault brush_shape_face(brush_shape *s, const plane_table *t, const plane_ref cube[6], const plane_ref *planes, uint32_t count, uint32_t face);
// Whole steps, rounded outward, exactly: a corner on a whole step adds nothing.
void brush_shape_bounds(const brush_shape *s, const plane_table *t, int32_t min[3], int32_t max[3]);

#endif
