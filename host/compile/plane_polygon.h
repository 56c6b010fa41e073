// Convex polygons that are nothing but planes: one that holds them and one through each edge. Cutting makes no number that decides.
// SPDX-License-Identifier: MIT
// Invariant: strictly convex, counterclockwise from the front of the polygon's plane; edge planes have the inside behind them;
// every edge has a length, so corner i is the one point where the polygon's plane and edge planes i - 1 and i meet.
#ifndef PORTCULLIS_HOST_PLANE_POLYGON_H
#define PORTCULLIS_HOST_PLANE_POLYGON_H

#include "plane_table.h"

typedef struct polygon_edge {
    double start[3]; // by plane_table_position, of the corner where the edge begins
    plane_ref plane; // front: outside the polygon
    uint32_t vertex; // number of that corner after the weld
} polygon_edge;

// A run of edges in a buffer of polygon_edge, which may grow and move.
typedef struct plane_polygon {
    plane_ref plane;
    uint32_t first, count;
} plane_polygon;

typedef enum polygon_place { // of a polygon against a plane
    POLYGON_ON = 0,
    POLYGON_FRONT = 1,  // in front or on it
    POLYGON_BEHIND = 2, // behind or on it
    POLYGON_ACROSS = 3,
} polygon_place;

// Corner by corner: signs[i] 1 in front, 0 on the plane, -1 behind.
polygon_place polygon_signs(const plane_table *t, plane_ref polygon, const polygon_edge *edges, uint32_t count, plane_ref by, int8_t *signs);
// The planes that meet in corner `i`.
static inline void polygon_corner(plane_ref polygon, const polygon_edge *edges, uint32_t count, uint32_t i, plane_ref meet[3])
{
    meet[0] = polygon;
    meet[1] = edges[i ? i - 1 : count - 1].plane;
    meet[2] = edges[i].plane;
}

// Cuts a polygon that lies across `by`: the parts are appended to `edges` (which holds `p` itself). NULL: not wanted.
typedef struct polygon_parts { plane_polygon *behind, *front; } polygon_parts;
int polygon_cut(const plane_table *t, const plane_polygon *p, const int8_t *signs, plane_ref by, buffer *edges, polygon_parts out); // 0: out of memory

double polygon_area(const polygon_edge *edges, uint32_t count); // square steps, rounded: for orders, never for decisions

#endif
