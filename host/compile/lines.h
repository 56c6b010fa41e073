// All edges of a surface by the exact line that they lie on, the vertices of a line in order, so that partial edges,
// T-junctions and edges shared by many polygons are all the same case: elementary segments between neighbours on a line.
// SPDX-License-Identifier: MIT
// Invariant: a line is the meeting of two planes; doubles only choose where to look and what is far apart, by stated bounds.
#ifndef PORTCULLIS_HOST_LINES_H
#define PORTCULLIS_HOST_LINES_H

#include "surface.h"

typedef struct line_direction {
    cull_wide_vector exact; // without a common divisor, first component that is not zero positive
    double unit[3];
} line_direction;

typedef struct surface_line {
    plane_ref a, b;     // that meet in it
    uint32_t direction; // in line_set.directions
    uint32_t first_vertex, vertex_count; // in line_set.vertices, along the direction
    uint32_t first_edge, edge_count;     // in line_set.edges
} surface_line;

typedef struct line_edge {
    uint32_t polygon, corner; // corner: in surface.corners
    uint32_t line;
    uint32_t from, to;        // ranks of its start and its end among the line's vertices
} line_edge;

typedef struct line_set {
    const surface *s;
    const allocator *memory;
    buffer directions; // line_direction
    buffer lines;      // surface_line
    buffer edges;      // line_edge, by line
    buffer vertices;   // uint32_t, by line
    uint32_t *edge_of; // of each corner of a polygon in use: its place in edges
    size_t corner_count;
} line_set;

// The surface must not change while the lines are in use.
result line_set_make(const surface *s, const allocator *memory, line_set *out);
void line_set_free(line_set *l); // zeroed is fine
// Until then a line has only the vertices where edges of its own end, which is enough to join faces round it: now those that
// touch it too. Places in line_set.vertices and ranks change.
result line_set_add_touches(line_set *l);
// Along the line: sign of (place of vertex a - place of vertex b).
int line_order(const line_set *l, const surface_line *line, uint32_t a, uint32_t b);

// In lines_touch.c: (line, vertex) of vertices that lie inside an edge.
typedef struct line_touch { uint32_t line, vertex; } line_touch;
result line_touches(const line_set *l, buffer *out);

#endif
