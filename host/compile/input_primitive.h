// Primitives of solid geometry on the grid: each becomes planes with whole numbers that close it exactly.
// SPDX-License-Identifier: MIT
// Invariant: what is flat stays flat and what is parallel parallel, however the body is turned: opposite sides of a box, a
// cylinder's sides and its axis; all sides of a cone meet in its apex, a grid point. Only points are rounded, once each.
#ifndef PORTCULLIS_HOST_INPUT_PRIMITIVE_H
#define PORTCULLIS_HOST_INPUT_PRIMITIVE_H

#include "../core/memory.h"
#include "../core/scene.h"

#include <portcullis/exact.h>

enum { SEGMENTS_LEAST = 3, SEGMENTS_MOST = 128, HULL_POINTS_LEAST = 4, HULL_POINTS_MOST = 64 };

typedef enum primitive_fault {
    PRIMITIVE_SOUND,
    PRIMITIVE_BEYOND, // the grid
    PRIMITIVE_FLAT,   // no volume is left on the grid
    PRIMITIVE_NO_MEMORY,
} primitive_fault;

typedef struct primitive {
    builder_transform place;   // of what is written, to metres of the scene
    double steps_per_metre;
    buffer planes;             // cull_wide_plane: fronts outside, each once
    double low[3], high[3];    // steps: holds all points that it was made of, as written
    double moved;              // steps: the farthest that rounding took one of them
} primitive;

primitive primitive_make(const allocator *memory, double steps_per_metre, const builder_transform *place);
void primitive_free(primitive *p);

typedef struct round_body { // its first corner lies towards the coordinate axis (x before y before z) that the body's own is farthest from
    double base[3], top[3]; // middle of the base; of the top, or the apex
    double radius;          // of the corners
    uint32_t segments;
} round_body;

// Metres, before `place`. A body's planes are added to those there: half spaces one by one make a convex body.
primitive_fault primitive_box(primitive *p, const double min[3], const double max[3]);
primitive_fault primitive_cylinder(primitive *p, const round_body *b);
primitive_fault primitive_cone(primitive *p, const round_body *b);
primitive_fault primitive_half_space(primitive *p, const double point[3], const double normal[3]); // behind the plane
primitive_fault primitive_half_space_of(primitive *p, const double (*points)[3]);                  // three, counterclockwise from outside
primitive_fault primitive_hull(primitive *p, const double (*points)[3], uint32_t count);
// Six more planes round it, whole steps.
primitive_fault primitive_bound(primitive *p, const double low[3], const double high[3]);

#endif
