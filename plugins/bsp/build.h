// The tree while it is made: nodes, leaves, and what is filed in them.
// SPDX-License-Identifier: MIT
// Invariant: nodes and leaves stand in the order of a walk from the root, front before back; every item is filed at least once.
#ifndef PORTCULLIS_BSP_BUILD_H
#define PORTCULLIS_BSP_BUILD_H

#include "choose.h"

// Deeper sets become leaves, convex or not: only sets of more planes than this, each with nothing but itself on one side, get there.
#define BSP_DEPTH_MOST 512u

typedef struct tree_filing { uint32_t owner, item, piece; } tree_filing; // owner: a node, or a leaf with BSP_LEAF; piece BSP_NONE: by its box

typedef struct tree_task { uint32_t first, count, parent, side, depth; } tree_task; // a set of pieces, the last of `lists`, and the child it becomes

typedef struct tree_maker {
    const cull_host *host;
    const cull_zone *zone;
    bsp_wish wish;
    plane_table table;
    piece_set set;
    chooser chooser;
    bsp_vector nodes, leaves; // bsp_node, bsp_leaf without entries
    bsp_vector filings;       // tree_filing: pieces in the order of the walk, then boxes
    bsp_vector tasks, lists;  // tree_task; uint32_t: pieces
    bsp_vector aside[2];      // uint32_t: pieces in front, behind, of the set at hand
    uint32_t depth_most, pieces_most;
    uint32_t depth, splits, bent_leaves, piece_filings; // piece_filings: filings of pieces, the first ones
} tree_maker;

void tree_maker_free(tree_maker *m);
// Divides the pieces of m->set into nodes and leaves. m->depth_most 0: one leaf.
cull_result tree_divide(tree_maker *m);
// Files each item that has no piece in all leaves that its box reaches (file_items.c). CULL_ERR_ZONE: that would be too many
// for any use, and the tree is to be one leaf.
cull_result tree_file_boxes(tree_maker *m);
// Makes the arrays of a tree of what was filed: order, entries, points (order.c); `out` has the counts and arrays so far.
cull_result tree_lay_out(tree_maker *m, bsp_tree *out);
// The boxes of leaves and nodes, from entries and order (boxes.c).
void tree_measure_boxes(const cull_zone *zone, bsp_tree *tree);

#endif
