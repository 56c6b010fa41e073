// A binary tree over boxes: which of them touch a box.
// SPDX-License-Identifier: MIT
// Invariant: split by count, so its depth is at most 32 whatever the boxes are.
#ifndef PORTCULLIS_HOST_BOX_TREE_H
#define PORTCULLIS_HOST_BOX_TREE_H

#include "memory.h"
#include "report.h"

typedef struct tree_box { double min[3], max[3]; } tree_box;
typedef struct box_tree_node {
    tree_box box;
    uint32_t first, count; // of `order`; count 0: the children are the next node and `first`
} box_tree_node;
typedef struct box_tree {
    box_tree_node *nodes;
    uint32_t *order;
    tree_box *sorted;      // boxes[order[i]]: a leaf's lie side by side
    const tree_box *boxes; // as given
    uint32_t count, node_capacity;
} box_tree;

result box_tree_open(const tree_box *boxes, uint32_t count, const allocator *memory, box_tree *out); // boxes are borrowed
void box_tree_close(box_tree *t, const allocator *memory);

typedef struct box_walk {
    const box_tree *tree;
    tree_box box;
    uint32_t stack[40], depth, at, end;
} box_walk;
void box_walk_start(box_walk *w, const box_tree *t, const tree_box *box);
// The next box that touches, borders included; each once. 0: no more.
int box_walk_next(box_walk *w, uint32_t *out);

#endif
