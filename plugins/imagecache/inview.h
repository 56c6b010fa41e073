// The cells of a zone that are in view: listed once, by rings about the eye, with the volumes that see them. What stands between view culling
// (footprint.h, rings.h) and what shows a cell, as geometry or otherwise.
// SPDX-License-Identifier: MIT
//
// Invariant: a cell that lists something and whose closed column holds a point of a volume is listed, no cell twice; except by the report's
// border (walk=bresenham), which loses cells.
#ifndef PORTCULLIS_IMAGECACHE_INVIEW_H
#define PORTCULLIS_IMAGECACHE_INVIEW_H

#include "cells.h"
#include "forms.h"
#include "rings.h"

enum { INVIEW_VOLUMES = 32 }; // at a time: bits of a mask

typedef enum inview_walk { INVIEW_RINGS, INVIEW_BRESENHAM, INVIEW_TREE } inview_walk; // tree: by tree.h, not gathered here
typedef enum inview_order { INVIEW_BY_RINGS, INVIEW_BY_SLOPE } inview_order;

typedef struct inview_ways {
    inview_walk walk;
    inview_order order;
} inview_ways;

// A query's memory of it; `volumes` are those of the last gathering.
typedef struct inview {
    const cells *cells;
    uint32_t *list;  // cells, near first
    uint32_t *masks; // by cell: bit v, seen through volumes[v]; 0 for cells not listed
    uint32_t count;
    uint32_t volume_count;
    const cull_volume *volumes;
    uint32_t rings_walked;
    struct inview_room *room;
    size_t bytes; // of all memory at `list`
} inview;

int inview_open(const cull_host *host, const cells *c, inview *out); // 0: no memory
void inview_close(const cull_host *host, inview *v);

ground_cell inview_eye(const ground *g, const cull_view *view);

// The volumes of the visit from `first` on, at most INVIEW_VOLUMES; returns how many were taken.
uint32_t inview_gather(inview *v, const cull_visit *visit, uint32_t first, inview_ways ways);

#endif
