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
    uint32_t door;       // whose portal it is part of, in cell_input.doors; CELL_NO_DOOR
    double area;         // square steps
} cell_face;
#define CELL_NO_DOOR UINT32_MAX

// What a door's portal parts, in one plane. It may be given up; portals that may not are none of these.
typedef struct cell_door {
    uint32_t plane;      // without its side
    uint32_t regions[2]; // ascending
    uint32_t group;      // doors that stand and fall together
} cell_door;

// The partition once more, for lines of sight. child: a node, CELL_LEAF | cell, or CELL_NO_AIR; 0 in front.
typedef struct cell_node { double plane[4]; uint32_t child[2]; } cell_node;
#define CELL_LEAF 0x80000000u
#define CELL_NO_AIR 0xfffffffeu

typedef struct cell_patch { // what of a wall bounds one cell
    plane_polygon shape;    // in cell_set.edges
    uint32_t cell, wall;
    double area, plane[4];  // unit normal, in front the air
} cell_patch;

typedef struct cell {
    uint32_t region;
    uint32_t walls; // that touch it from within
    double volume;  // cubic steps
} cell;

typedef struct cell_set {
    buffer cells;   // cell
    buffer faces;   // cell_face: between two cells of air; of portals' faces, those of doors alone
    buffer patches; // cell_patch
    buffer tree;    // cell_node
    buffer edges; // polygon_edge
    uint32_t nodes, depth; // of the partition
} cell_set;

typedef struct cell_input {
    plane_table *planes;
    const cell_wall *walls; // in an order that does not depend on how the map is turned; the first are tried first as splitters
    const polygon_edge *edges;
    const cell_door *doors;
    uint32_t wall_count, edge_count, door_count;
} cell_input;

// RESULT_NO_MEMORY or fine. To be freed also after a failure.
result cell_set_make(const cell_input *from, const allocator *memory, cell_set *out);
void cell_set_free(cell_set *c);

#endif
