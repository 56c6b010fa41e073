// The tree that method=hiz walks: boxes sixteen to a vector, sixteen children a node, all leaves full but the last (a complete tree, as
// heaps have): a node is its number, and its children's boxes are one block.
// SPDX-License-Identifier: MIT
//
// Invariant: entry i of level 0 is slot i; entry i of level k covers entries 16 i .. 16 i + 15 of level k - 1, whose boxes are
// block i of that level.
#ifndef OCCLUSION_HIZ_TREE_H
#define OCCLUSION_HIZ_TREE_H

#include <portcullis/box.h>

enum { HIZ_WIDTH = 16, HIZ_LEVELS_MOST = 8, HIZ_BLOCK_FLOATS = 6 * HIZ_WIDTH }; // 16^8 = 2^32

typedef struct hiz_tree {
    float *blocks[HIZ_LEVELS_MOST]; // of each level: 16 each of min x, y, z, max x, y, z; what is not there is FLT_MAX .. -FLT_MAX
    uint32_t counts[HIZ_LEVELS_MOST]; // entries of each level
    uint32_t level_count;
    uint32_t *items; // by slot: the zone's item
    uint32_t *slots; // back
    float *memory;
    size_t float_count;
    uint32_t item_count;
} hiz_tree;

// [build] On failure nothing is left behind.
cull_result hiz_tree_make(const cull_host *host, const cull_zone *zone, hiz_tree *out);
void hiz_tree_free(const cull_host *host, hiz_tree *tree);
size_t hiz_tree_bytes(const hiz_tree *tree);

static inline uint32_t hiz_block_count(uint32_t entries)
{
    return (entries + HIZ_WIDTH - 1) / HIZ_WIDTH;
}

#endif
