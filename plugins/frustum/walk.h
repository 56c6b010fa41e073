// Queries of an index, compiled once for each instruction set; all give the same runs.
// SPDX-License-Identifier: MIT
#ifndef FRUSTUM_WALK_H
#define FRUSTUM_WALK_H

#include "index.h"

enum {
    WALK_SPARE_RUNS = 8,     // runs behind the last one that a query may scribble on: a vector is stored whole
    WALK_SMALL_LEVELS = 3,   // of an index that is small: up to 4,096 items
    WALK_SMALL_VOLUMES = 16, // that a walk of a small index takes at once
};

typedef struct small_query { // volume_count <= WALK_SMALL_VOLUMES; eye: as in cull_view
    const cull_volume *volumes;
    const float *eye;
    uint32_t volume_count;
} small_query;

typedef struct walk_kernel {
    const char *isa;
    // Writes the runs of items whose boxes touch the volume, ascending; returns how many, at most (item_count + 1) / 2.
    // *nodes_visited is added to.
    uint32_t (*volume)(const frustum_index *index, const cull_volume *volume, cull_run *runs, uint32_t *nodes_visited);
    // Writes the parts of `in` whose walls may show their front to the eye; index->faces must be there. `in` and `out` differ.
    uint32_t (*facing)(const frustum_index *index, const float eye[4], const cull_run *in, uint32_t in_count, cull_run *out);
    // Of an index of at most WALK_SMALL_LEVELS: the runs of items that touch one of the volumes and, where index->faces are there, may
    // show their front. As volume and facing would find them one after the other, in one pass.
    uint32_t (*small)(const frustum_index *index, const small_query *q, cull_run *runs, uint32_t *nodes_visited);
} walk_kernel;

// [main] "auto" takes the widest that this CPU has; NULL: no such name, or this CPU lacks it.
const walk_kernel *walk_kernel_of(const char *isa);

extern const walk_kernel walk_plain;
#if defined(__x86_64__)
extern const walk_kernel walk_avx2, walk_avx512;
#endif

#endif
