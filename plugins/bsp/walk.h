// The tree as select walks it: nodes of one cache line, each with the box of what is under it, and the items' boxes and faces side by side.
// SPDX-License-Identifier: MIT
//
// Invariant: each item stands at one node, which holds the first of the tree's preorder that lists it, and its whole box lies inside the boxes of all
// nodes on the way there. So it is met exactly once, and the set is that of asking clip_shape about every item, whatever the tree. Nodes
// and their items stand in preorder: the front child is the next node.
#ifndef PORTCULLIS_BSP_WALK_H
#define PORTCULLIS_BSP_WALK_H

#include "leaf_clip.h"
#include "tree.h"

enum {
    WALK_LEAF_ITEMS = 48, // subtrees of at most as many items are one leaf: a box costs as much as some items side by side
    WALK_VOLUMES = 8,     // of one pass
};
#define WALK_ONE_CHILD 0u
#define WALK_NO_CHILD UINT32_MAX

typedef struct bsp_walk_node {
    _Alignas(64) float min[3], max[3];
    float plane[4];               // normal, offset: which child is near. A guess, no more
    uint32_t end;                 // of its subtree: the node after it in preorder
    uint32_t back;                // the second child; WALK_ONE_CHILD, WALK_NO_CHILD
    uint32_t first, count;        // the node's own items: from block `first` on
} bsp_walk_node;

// Eight items side by side. A node's own items start a block; where fewer end it, the rest is never looked at.
enum { WALK_WIDTH = LANES_MOST };
typedef struct walk_block {
    _Alignas(64) float min[3][WALK_WIDTH], max[3][WALK_WIDTH];
    float normal[3][WALK_WIDTH], offset[WALK_WIDTH], doubt[WALK_WIDTH]; // of faces
    uint32_t place[WALK_WIDTH], unit[WALK_WIDTH];                       // unit: of its shape
    uint32_t joined; // bit i: the next item's place is the next place
} walk_block;

typedef struct bsp_walk {
    bsp_walk_node *nodes;
    walk_block *blocks;
    uint32_t node_count, block_count, depth;
} bsp_walk;

// [build] node_count 0 where the zone has no items. On failure nothing is left behind; walk_free of zeros is fine.
cull_result walk_build(const cull_host *host, const cull_zone *zone, const bsp_tree *tree, const bsp_shapes *shapes, bsp_walk *out);
void walk_free(const cull_host *host, bsp_walk *walk);
size_t walk_bytes(const bsp_walk *walk);

typedef struct walk_request {
    const bsp_walk *walk;
    const bsp_shapes *shapes;
    const cull_visit *visit;
    uint32_t backface; // 1: walls that show only their back are left out
    uint8_t *wanted;   // by place: items of 0 are left out; written over. NULL: all are wanted
    void *scratch;     // walk_scratch bytes, 64-byte aligned
    cull_run *runs;    // room for item_count
} walk_request;
size_t walk_scratch(const bsp_walk *walk, const bsp_shapes *shapes);

// [step] Returns the runs written, roughly front to back; adds to *nodes_visited. All kernels find the same.
typedef uint32_t (*walk_kernel)(const walk_request *q, uint32_t *nodes_visited);
uint32_t walk_plain(const walk_request *q, uint32_t *nodes_visited);
uint32_t walk_avx2(const walk_request *q, uint32_t *nodes_visited); // where the CPU has it
walk_kernel walk_kernel_of(const char *isa); // auto, avx2, plain; NULL: none such, or not on this CPU

#endif
