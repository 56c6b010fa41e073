// Brushes as bodies: the polygons of their faces and their corners, from the planes alone.
// SPDX-License-Identifier: MIT
// Invariant: faces that bound nothing make no polygon; what is left closes the brush exactly.
#ifndef PORTCULLIS_HOST_BRUSH_POLYGONS_H
#define PORTCULLIS_HOST_BRUSH_POLYGONS_H

#include "compile.h"
#include "plane_polygon.h"

typedef struct body_polygon {
    plane_polygon shape; // in brush_bodies.edges
    uint32_t brush, face;
} body_polygon;

typedef struct body_corner {
    plane_ref meet[3]; // ascending
    double position[3];
} body_corner;

typedef struct brush_body { // polygon_count 0: makes nothing
    uint32_t first_polygon, polygon_count, first_corner, corner_count;
    double min[3], max[3]; // hold the exact body with room to spare
} brush_body;

typedef struct brush_bodies {
    brush_body *of;  // brush_count
    buffer polygons; // body_polygon, by brush
    buffer edges;    // polygon_edge
    buffer corners;  // body_corner, by brush
    uint32_t brush_count;
} brush_bodies;

// Of the brushes whose role is in `roles` (bits 1 << BRUSH_*) and of which some face has a material. Open or flat ones: an error.
result brush_bodies_make(const compile_input *in, unsigned roles, report *r, const allocator *memory, brush_bodies *out);
void brush_bodies_free(brush_bodies *b); // of zeros is fine

#endif
