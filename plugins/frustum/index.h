// The built index: item boxes in blocks of 16 in leaf order, and on top of them the boxes of blocks, 16 to a block again.
// SPDX-License-Identifier: MIT
// Invariant: block b of a level holds the boxes of the blocks 16 b .. 16 b + 15 of the level below, so the tree has no
// pointers, and the items below any node are one run.
#ifndef FRUSTUM_INDEX_H
#define FRUSTUM_INDEX_H

#include <portcullis/block.h>

enum {
    INDEX_SHIFT = 4,        // log2 of CULL_BLOCK_WIDTH
    INDEX_MAX_LEVELS = 8,   // 16^8 = 2^32 items
};

typedef struct frustum_index {
    uint32_t item_count, level_count;             // at least one level
    const float *levels[INDEX_MAX_LEVELS];        // [0]: item boxes
    uint32_t entry_counts[INDEX_MAX_LEVELS];      // boxes in a level; the rest of its last block is never visible
    uint32_t *order;                              // order[place] = item
    float *faces;                                 // blocks of CULL_BLOCK_FACE_FLOATS, one a place; NULL: back faces are kept
    float *boxes;                                 // all levels
    size_t order_bytes, face_bytes, box_bytes;
} frustum_index;

typedef enum index_faces { INDEX_NO_FACES, INDEX_FACES } index_faces;

typedef struct index_source {
    const cull_zone *zone;
    const cull_blob *baked; // by index_save; NULL: there is none. The index is the same bit for bit
    index_faces faces;
} index_source;

// [build] On failure nothing is left behind. index_free also after a failed build; a zeroed index is fine.
cull_result index_build(const cull_host *host, const index_source *from, frustum_index *out);
void index_free(const cull_host *host, frustum_index *index);

// Writes a permutation of the items such that every 16^k places that start at a multiple of 16^k lie close together.
cull_result index_order(const cull_host *host, const cull_zone *zone, uint32_t *order);

// ---- Baked: the order alone, all that takes long to find; the boxes are the zone's own (index_bake.c) ----

uint64_t index_save(const frustum_index *index, void *blob, uint64_t size); // as cull_bake.save
// CULL_ERR_BLOB where it isn't, to the last bit, what index_save wrote for as many items.
cull_result index_load_order(const cull_host *host, const cull_blob *baked, uint32_t item_count, uint32_t *order);

#endif
