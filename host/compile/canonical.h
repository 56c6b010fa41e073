// Orders that don't depend on how a map was written or turned: who keeps a shared area, which cut or merge comes first.
// SPDX-License-Identifier: MIT
// Invariant: sizes and places are rounded far coarser than doubles err, so that a rotated, mirrored, moved or reordered map gives
// the same order; what still ties is symmetric and ordered by coordinates. No geometry is decided here: any order is right.
#ifndef PORTCULLIS_HOST_CANONICAL_H
#define PORTCULLIS_HOST_CANONICAL_H

#include "brush_polygons.h"

// A scalar field that moves with the map: squared distances to three centres of its brushes, weighed in three ways.
typedef struct map_field {
    double centres[3][3];
    double step; // square steps that count as one: 2^-38 of the map's extent, squared
} map_field;

map_field map_field_of(const brush_bodies *bodies);
int64_t map_field_at(const map_field *f, const double p[3]);

// Where a brush stands in the CSG. Only a change between adding and subtracting binds brushes to the order of the file; in a
// phase of one kind, and by size, the larger body comes first, then the place in the map, then what covers it.
typedef struct brush_rank {
    uint32_t phase; // counts those changes
    uint32_t rank;  // by phase, then size; the first keeps what two share of a plane
    uint32_t size;  // by size alone
} brush_rank;
result brush_ranks_make(const compile_input *in, const brush_bodies *bodies, const map_field *field, const allocator *memory, brush_rank **rank);

// Faces of one material and equal texture rows have one class.
result face_classes_make(const compile_input *in, const allocator *memory, uint32_t **class_of);

#endif
