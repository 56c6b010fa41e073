// What a view walks: the octree's order packed into wide nodes, whose 16 boxes a vector holds (Wald et al., Getting Rid of Packets, 2008).
// SPDX-License-Identifier: MIT
//
// Invariant: every level of the tree is a division of the order into runs of entries that lie together: leaves are runs of items, a
// node is a run of nodes or leaves of the level below. All ways down are equally long, so a node says where its children start and no more.
#ifndef PORTCULLIS_OCTREE_INDEX_H
#define PORTCULLIS_OCTREE_INDEX_H

#include <portcullis/block.h>

enum {
    INDEX_LEAST = 8,        // in all but a level's only block: a tree at least 8 wide
    INDEX_LEVELS_MOST = 12, // 8^11 > 2^32 items, and one: a root stands over even a single leaf
    INDEX_OCTANTS = 8,
};

typedef struct index_node {
    float boxes[CULL_BLOCK_FLOATS];
    uint32_t firsts[CULL_BLOCK_WIDTH + 1]; // the first item of each child; from child_count on: behind the node's last item
    uint32_t first_child; // in nodes; of level 2, in bottoms; of level 1, in leaves
    uint32_t child_count;
    uint32_t reserved[13]; // eight cache lines
} index_node;

// Of a node over nodes, its children near to far, four bits each, by the octant of its box that the eye is in or beyond.
typedef struct index_order {
    float centre[3], half[3];
    uint64_t children[2][INDEX_OCTANTS]; // [0]: from the octant's middle, [1]: from far off along its diagonal; octant bit 0: on the
                                         // greater side of x, 1: y, 2: z
} index_order;

typedef struct octree_index {
    uint32_t item_count, leaf_count, bottom_count, node_count;
    uint32_t level_count; // of nodes, at least one; the root is the last node, or the only bottom
    const float *leaves;  // blocks of CULL_BLOCK_FLOATS
    const uint32_t *leaf_firsts; // leaf_count + 1
    const index_node *bottoms;   // level 1
    const index_node *nodes;     // level 2 first
    const index_order *orders;   // of the nodes
    const float *faces;          // blocks of CULL_BLOCK_FACE_FLOATS, one a leaf; NULL: back faces are kept
    void *memory;
    size_t bytes;
} octree_index;

typedef enum index_faces { INDEX_NO_FACES, INDEX_FACES } index_faces;

// [build] `order` is the octree's. On failure nothing is left behind; index_free of zeros is fine.
cull_result index_build(const cull_host *host, const cull_zone *zone, const uint32_t *order, index_faces faces, octree_index *out);
void index_free(const cull_host *host, octree_index *index);

// Divides `count` boxes in a row into runs of INDEX_LEAST .. CULL_BLOCK_WIDTH such that the boxes of the runs are small. Writes where each starts
// and, behind, count; returns how many runs. starts: room for count / INDEX_LEAST + 2. 0 where memory is short; count is at least 1.
uint32_t index_pack(const cull_host *host, const cull_box *boxes, uint32_t count, uint32_t *starts);

#endif
