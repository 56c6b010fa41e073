// The quadtree of homes: every item once, in the node of the cell that is its home, under boxes of whole items. What a zone is walked by while
// all of it is geometry: then nobody asks which cells an item reaches into. Loose as Ulrich's octree, 2000, with no bound on how loose.
// SPDX-License-Identifier: MIT
//
// Invariant: a node's items are one run of the order, and its box is that of their boxes: what it finds is exactly what a loop over all boxes finds.
#ifndef PORTCULLIS_IMAGECACHE_TREE_H
#define PORTCULLIS_IMAGECACHE_TREE_H

#include "cells.h"
#include "nodes.h"

enum {
    TREE_VOLUMES = 32, // at a time: bits of a mask
    TREE_ITEMS = 8,    // a node of at most as many is not opened
};

typedef struct tree_node {
    cull_box box; // min above max: no items
    uint32_t first, count;
} tree_node;

typedef struct tree {
    tree_node *nodes; // numbered as nodes.h does
    uint32_t node_count;
    size_t bytes;
} tree;

int tree_build(const cull_host *host, const cells *c, tree *out); // 0: no memory
void tree_free(const cull_host *host, tree *t);

typedef struct tree_query {
    const tree *tree;
    const cells *cells;
    const cull_volume *volumes;
    uint32_t volume_count; // at most TREE_VOLUMES
    ground_cell eye;
} tree_query;

// Runs near first by nodes.h's order, each item once; room for one an item. Returns how many; adds the boxes judged.
uint32_t tree_walk(const tree_query *q, cull_run *runs, uint32_t *judged);

#endif
