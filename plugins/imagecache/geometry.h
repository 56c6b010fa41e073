// Cells shown as geometry: the union of their items as runs, near first. The report stamps each item drawn in a frame; here an item is mostly drawn
// with its home, in one run with all others at home there, and stamps settle what is left: items seen where their home is not.
// SPDX-License-Identifier: MIT
//
// Invariant: each item with a point in a volume that sees a cell shown is drawn, once.
#ifndef PORTCULLIS_IMAGECACHE_GEOMETRY_H
#define PORTCULLIS_IMAGECACHE_GEOMETRY_H

#include "cells.h"

typedef enum geometry_draws { GEOMETRY_DRAWN_ONCE, GEOMETRY_DRAWN_OFTEN } geometry_draws; // calls of geometry_draw in a frame

typedef struct geometry { // a query's memory of it
    const cells *cells;
    uint32_t *stamps; // by place: the frame it was drawn in last
    uint32_t *masks;  // by cell shown: bit v, volumes[v] touches its box; 0 for others
    uint32_t *shown;  // cells, near first
    uint8_t *states;  // by cell, 0 for those not shown
    const cull_volume *volumes;
    cull_run *runs;   // where this frame's go
    uint32_t stamp;   // of this frame; 0 in no frame
    uint32_t shown_count, run_count;
    uint32_t settled; // runs that stay as they are: the host has them
    uint32_t tested;  // boxes judged this frame
    uint32_t draws;   // times geometry_draw was called this frame
    geometry_draws promised;
    size_t bytes;
} geometry;

typedef struct geometry_sight { // of a cell: see inview.h
    const cull_volume *volumes; // the same for all cells until geometry_draw
    uint32_t mask;              // bit v: volumes[v] sees it
} geometry_sight;

int geometry_open(const cull_host *host, const cells *c, geometry *out); // 0: no memory
void geometry_close(const cull_host *host, geometry *g);

void geometry_begin(geometry *g, cull_run *runs, geometry_draws draws); // runs: room for one an item
void geometry_show(geometry *g, uint32_t cell, geometry_sight sight); // each cell once until geometry_draw, near first
// A frame in which only what is drawn from now on may add to its runs: those there are, are the host's. All items are drawn by stamps.
void geometry_settle(geometry *g);
void geometry_draw(geometry *g);                                     // all that was shown, then none is

#endif
