// Triangles of one polygon: quads on the better diagonal, larger ones by ear clipping in the polygon's own plane.
// SPDX-License-Identifier: MIT
// Invariant: every triangle has area; a simple polygon's triangles cover it exactly and keep its orientation.
#ifndef PORTCULLIS_IMPORT_MESH_TRIANGULATE_H
#define PORTCULLIS_IMPORT_MESH_TRIANGULATE_H

#include "../core/memory.h"
#include "../core/report.h"

typedef struct triangulator { // scratch, kept from polygon to polygon
    buffer points;    // 2 doubles: in the plane
    buffer vertices;  // the ring
    buffer queue;     // uint32_t: ears to come
    buffer obstacles; // by x
} triangulator;

triangulator triangulator_make(const allocator *memory);
void triangulator_free(triangulator *t);

// Appends corner numbers (0 .. count - 1), three a triangle, to `triangles` (uint32_t); at most count - 2 triangles, none
// for a polygon without area. A triangle lower than flat_m over its longest edge has no area.
result polygon_triangulate(triangulator *t, const double (*points)[3], uint32_t count, double flat_m, buffer *triangles);

#endif
