// Convex cells of the air: leaves of a binary space partition by the planes of walls and portals (Fuchs, Kedem, Naylor, 1980),
// and the faces between them. What automatic rooms are merged from.
// SPDX-License-Identifier: MIT
// Invariant: every place decision is exact; sizes are doubles, for orders and scores alone. Two cells of air touch along
// faces of the list and nowhere else but in edges and corners.
#ifndef PORTCULLIS_HOST_ROOMS_CELLS_H
#define PORTCULLIS_HOST_ROOMS_CELLS_H

#include "compile.h"
#include "plane_polygon.h"

#define CELL_SOLID UINT32_MAX // of faces: rock, or the void

// A polygon of what bounds the air, or of a portal.
typedef struct cell_wall {
    plane_polygon shape; // in cell_input.edges
    uint32_t region;     // in front
    uint32_t behind;     // of a portal the region behind, else CELL_SOLID
} cell_wall;

typedef struct cell_face {
    plane_polygon shape; // in cell_set.edges
    uint32_t cells[2];   // in front, behind; CELL_SOLID
    double area;         // square steps
} cell_face;

typedef struct cell {
    uint32_t region;
    uint32_t walls; // that touch it from within
    double volume;  // cubic steps
} cell;

typedef struct cell_set {
    buffer cells; // cell
    buffer faces; // cell_face: between two cells of air; a portal's faces are not among them
    buffer edges; // polygon_edge
    uint32_t nodes, depth; // of the partition
} cell_set;

typedef struct cell_input {
    plane_table *planes;
    const cell_wall *walls; // in an order that does not depend on how the map is turned; the first are tried first as splitters
    const polygon_edge *edges;
    uint32_t wall_count, edge_count;
} cell_input;

// RESULT_NO_MEMORY or fine. To be freed also after a failure.
result cell_set_make(const cell_input *from, const allocator *memory, cell_set *out);
void cell_set_free(cell_set *c);

#endif
