// The partition while cells are made of it: shared by rooms_cells.c, which builds it, and rooms_faces.c, which finds its cells' faces.
// SPDX-License-Identifier: MIT
// Invariant: a child is a node, PART_LEAF | cell, or PART_SOLID; child 0 lies in front of the plane, child 1 behind.
#ifndef PORTCULLIS_HOST_ROOMS_PARTITION_H
#define PORTCULLIS_HOST_ROOMS_PARTITION_H

#include "rooms_cells.h"

#define PART_LEAF 0x80000000u
#define PART_SOLID 0xfffffffeu
#define PART_NONE 0xffffffffu

typedef struct part_node {
    plane_ref plane;
    uint32_t child[2], parent, side; // side of the parent that it is on
    uint32_t regions[2];             // of the splitter: in front, behind
} part_node;

typedef struct partition {
    plane_table *planes;
    cell_set *out;
    buffer nodes; // part_node; parents first
    buffer edges; // polygon_edge
    buffer signs; // int8_t: of the last place found
} partition;

static inline part_node *partition_node(const partition *p, uint32_t node)
{
    return (part_node *)p->nodes.items + node;
}
static inline int partition_is_node(uint32_t child)
{
    return !(child & PART_LEAF);
}

void partition_plane(const partition *p, plane_ref plane, double out[4]); // unit normal
result partition_build(partition *p, const cell_input *from, const allocator *memory);
result partition_faces(partition *p, const cell_input *from, const allocator *memory);
// The place of a polygon of p->edges that does not lie in the plane; its signs are for partition_cut, right after.
result partition_place(partition *p, const plane_polygon *shape, plane_ref by, polygon_place *out);
result partition_cut(partition *p, const plane_polygon *shape, plane_ref by, plane_polygon *front, plane_polygon *behind);

#endif
