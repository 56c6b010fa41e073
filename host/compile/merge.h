// Merge of coplanar convex polygons of one material, equal texture rows and one role, where the union is convex.
// SPDX-License-Identifier: MIT
// Invariant: the surface stays the same point for point; the order of merging follows lengths, areas and places that turn with
// the map. Corners in a straight line go: what else meets there comes back with the T-junctions.
#ifndef PORTCULLIS_HOST_MERGE_H
#define PORTCULLIS_HOST_MERGE_H

#include "csg.h"

typedef struct merge_input {
    const compile_input *in;
    const map_field *field;
    const uint32_t *class_of; // of faces, see face_classes_make
    const polygon_soup *soup; // corners numbered by vertex_weld
    const compile_vertex *vertices;
} merge_input;

result merge_polygons(const merge_input *m, const allocator *memory, polygon_soup *out);

#endif
