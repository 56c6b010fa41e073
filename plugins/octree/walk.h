// Queries of an index, compiled once for each instruction set; all give the same runs.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_OCTREE_WALK_H
#define PORTCULLIS_OCTREE_WALK_H

#include "index.h"

enum {
    WALK_SPARE_RUNS = 8, // runs behind the last one that a query may scribble on: a vector is stored whole
    WALK_VOLUMES = 16,   // that one walk takes at once
    ALL_ITEMS = 0xffff,  // bits of a leaf's
    WALK_NEAR_BYTES = 1 << 20, // an index of at most so many stays in a core's second cache: asking for memory ahead for several volumes only costs
};

typedef enum walk_order { WALK_NEAR_FIRST, WALK_ASCENDING } walk_order; // ascending: as items stand, runs never touch

typedef struct walk_query {
    const octree_index *index;
    const cull_volume *volumes;
    const float *eye;      // as in cull_view
    uint32_t volume_count; // 1 .. WALK_VOLUMES
    walk_order order;
} walk_query;

typedef struct walk_kernel {
    const char *isa;
    // Writes the runs of items whose boxes touch one of the volumes and, where index->faces are there, may show their front to the eye.
    // Returns how many, at most walk_runs_most(index). *nodes_visited is added to.
    uint32_t (*walk)(const walk_query *q, cull_run *runs, uint32_t *nodes_visited);
} walk_kernel;

// Runs of one bottom node never touch, and one that spans several nodes counts for each of them: half of each node's items, rounded up.
static inline uint32_t walk_runs_most(const octree_index *index)
{
    return index->item_count / 2 + index->bottom_count + WALK_SPARE_RUNS;
}

// [main] "auto" takes the widest that this CPU has; NULL: no such name, or this CPU lacks it.
const walk_kernel *walk_kernel_of(const char *isa);

extern const walk_kernel walk_plain;
#if defined(__x86_64__)
extern const walk_kernel walk_avx2, walk_avx512;
#endif

#endif
