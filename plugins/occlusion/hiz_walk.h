// The walk of method=hiz: tree and pyramid together, nearest first.
// SPDX-License-Identifier: MIT
#ifndef OCCLUSION_HIZ_WALK_H
#define OCCLUSION_HIZ_WALK_H

#include "hiz_queue.h"
#include "hiz_shapes.h"
#include "hiz_tree.h"

typedef struct hiz_index { // of a zone, built once
    hiz_tree tree;
    hiz_shapes shapes;
} hiz_index;

typedef struct hiz_walk {
    const hiz_index *index;
    const hiz_view *view;
    const cull_volume *volumes;
    const uint64_t *active[HIZ_LEVELS_MOST]; // by level, a bit an entry; [0] NULL: all are to be looked at
    hiz_buffer *buffer;
    hiz_queue queue;
    uint32_t *seen; // slots, nearest first; room for all
    uint32_t volume_count, seen_count, nodes_visited, polygon_count, cover_count, test_count;
} hiz_walk;

typedef struct hiz_kernel {
    const char *isa;
    void (*walk)(hiz_walk *w);
    // Which of 16 boxes may leave a pixel behind what is drawn.
    uint32_t (*boxes_seen)(const hiz_view *v, hiz_buffer *b, const float *block, uint32_t lanes);
    void (*polygon_cover)(hiz_buffer *b, const hiz_polygon *p);
    int (*rectangle_hidden)(hiz_buffer *b, const hiz_rectangle *q, hiz_place *open); // open: where to begin; where it is not hidden
} hiz_kernel;

// [main] "auto" takes the widest that this CPU has; NULL: no such name, or this CPU lacks it.
const hiz_kernel *hiz_kernel_of(const char *isa);

extern const hiz_kernel hiz_kernel_plain;
#if defined(__x86_64__)
extern const hiz_kernel hiz_kernel_avx2, hiz_kernel_avx512;
#endif

#endif
