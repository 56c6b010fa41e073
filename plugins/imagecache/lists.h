// What each node of the quadtree over the cells stands for: its items as runs, its box, and how many polygons it has; for pictures of nodes.
// SPDX-License-Identifier: MIT
//
// Invariant: a node lists exactly the items that its cells list, each once, in runs that ascend and never touch; its box holds their parts in
// its cells' columns. A node without items has no runs, and a box with min above max.
#ifndef PORTCULLIS_IMAGECACHE_LISTS_H
#define PORTCULLIS_IMAGECACHE_LISTS_H

#include "cells.h"
#include "nodes.h"

typedef struct lists_node {
    cull_box box;
    uint32_t first_run, run_count; // in lists.runs
    uint32_t item_count, polygon_count;
    float polygon_share; // of a cell: an item's polygons shared evenly by the cells that list it, so that cells in view add up to what is drawn; 0 of others
} lists_node;

typedef struct lists {
    lists_node *nodes; // nodes_count of them, numbered as nodes.h does
    cull_run *runs;
    uint32_t node_count, run_count;
    size_t node_bytes, run_bytes; // allocated
} lists;

// [build] On failure nothing is left behind; lists_free of zeros is fine. O(listings) a level.
cull_result lists_build(const cull_host *host, const cull_zone *zone, const cells *c, lists *out);
void lists_free(const cull_host *host, lists *l);

#endif
