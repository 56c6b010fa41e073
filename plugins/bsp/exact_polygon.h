// Convex polygons that are nothing but planes: one that holds them and one through each edge, so that cutting makes no number
// that decides (Bernstein and Fussell, Fast, Exact, Linear Booleans, 2009).
// SPDX-License-Identifier: MIT
//
// Invariant: strictly convex, counterclockwise from the front of the plane that holds them; every edge has a length, so corner i is the
// one point where the holding plane and edge planes i - 1 and i meet; positions are cull_meet_position's and decide only where sure.
#ifndef PORTCULLIS_BSP_EXACT_POLYGON_H
#define PORTCULLIS_BSP_EXACT_POLYGON_H

#include "vector.h"

#include <portcullis/exact.h>

typedef struct exact_plane {
    cull_wide_plane plane;
    cull_row row;
    uint32_t same;   // the first plane of the array that has the same points, this one among them
    uint32_t turned; // 1: it looks the other way than that one
} exact_plane;

typedef struct exact_edge {
    double start[3]; // grid steps, of the corner where the edge begins
    uint32_t plane;  // through the edge; looks anywhere
} exact_edge;

typedef struct exact_polygon { uint32_t plane, first, count; } exact_polygon; // a run of edges in exact_pool.edges

typedef struct exact_pool {
    const exact_plane *planes;
    bsp_vector edges; // exact_edge
    bsp_vector signs; // int8_t, of the polygon that was last placed
} exact_pool;

typedef enum exact_place { // of a polygon against a plane
    EXACT_ON = 0,
    EXACT_FRONT = 1,  // in front or on it
    EXACT_BEHIND = 2, // behind or on it
    EXACT_ACROSS = 3,
} exact_place;

exact_pool exact_pool_make(const cull_host *host, const exact_plane *planes);
void exact_pool_free(exact_pool *pool);

static inline const exact_edge *exact_edges(const exact_pool *pool, const exact_polygon *p)
{
    return (const exact_edge *)pool->edges.items + p->first;
}

// Sets `same` of planes[0 .. count) by their points. scratch: 2 * count rounded up to a power of two, or more, and that many words.
void exact_planes_match(exact_plane *planes, uint32_t count, uint32_t *scratch, uint32_t scratch_count);

// All of the plane that lies in a box, and more of it: bounded by the four of the box's planes (pairs: low and high of x, y, z) on the
// axes that its normal is not longest in. To be cut by the two others. 0: out of memory.
int exact_polygon_whole(exact_pool *pool, const uint32_t box[6], uint32_t plane, exact_polygon *out);

// Keeps the corners' sides for exact_polygon_cut. 0: out of memory.
int exact_polygon_place(exact_pool *pool, const exact_polygon *p, uint32_t by, exact_place *out);
// The parts of a polygon that was just placed ACROSS `by`, appended to the pool. 0: out of memory.
int exact_polygon_cut(exact_pool *pool, const exact_polygon *p, uint32_t by, exact_polygon *front, exact_polygon *behind);

#endif
