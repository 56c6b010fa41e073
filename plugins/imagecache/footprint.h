// The footprint of a volume: what of the ground lies under (or over) it, a convex polygon in 24.8 fixed point, and its edges as integers.
// Planes are projected by Fourier and Motzkin's elimination of y (1827, 1936); hull: Andrew's monotone chain, 1979; edges: Pineda, 1988.
// SPDX-License-Identifier: MIT
//
// Invariant: no cell is lost. Each closed cell whose column, between the ground's low and high, holds a point of the volume is kept by
// footprint_keeps. It is exact but for rounding: nothing is kept that lies further than 1/128 of a cell, along either axis, from the volume.
//
// Why no hull of the apex and four far corners: the volume between two heights is what is projected, so that pitch, roll, up or down in view, a
// volume narrowed by portals and a viewer infinitely far off are all one case, and none of them is the whole disc.
#ifndef PORTCULLIS_IMAGECACHE_FOOTPRINT_H
#define PORTCULLIS_IMAGECACHE_FOOTPRINT_H

#include "ground.h"

enum {
    FOOTPRINT_UNITS = 256,    // a cell: 24.8 fixed point
    FOOTPRINT_POINTS = 32,    // of the polygon; a cut that would need more is left out, and the footprint is larger
};

typedef struct footprint_point { int32_t x, z; } footprint_point; // units from the ground's corner

// a * i + b * j + c >= 0: the edge leaves something of cell (i, j) inside.
typedef struct footprint_edge { int64_t a, b, c; } footprint_edge;

typedef struct footprint {
    footprint_point points[FOOTPRINT_POINTS]; // counterclockwise by (x, z), convex, none between two others; 0: nothing of the ground
    footprint_edge edges[FOOTPRINT_POINTS];   // those along no axis: the cells' own box stands for these
    uint32_t point_count, edge_count;
    ground_range columns, rows;
} footprint;

void footprint_of(const ground *g, const cull_volume *volume, footprint *out);

// The test of one cell of the ground, which rings.h solves for whole intervals of cells.
static inline int footprint_keeps(const footprint *f, ground_cell c)
{
    if (f->point_count == 0 || c.i < f->columns.first || c.i > f->columns.last || c.j < f->rows.first || c.j > f->rows.last) return 0;
    for (uint32_t e = 0; e < f->edge_count; e++)
        if (f->edges[e].a * c.i + f->edges[e].b * c.j + f->edges[e].c < 0) return 0;
    return 1;
}

#endif
