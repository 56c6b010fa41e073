// method=hiz: a hierarchical z-buffer of the items' own surfaces, drawn by the CPU while the tree is walked nearest first. No test is
// asked of the host and nothing is kept from frame to frame.
// SPDX-License-Identifier: MIT
#ifndef OCCLUSION_HIZ_H
#define OCCLUSION_HIZ_H

#include "hiz_counters.h"
#include "hiz_walk.h"

enum { HIZ_THREADS_MOST = 8 };

typedef struct hiz_options {
    const hiz_kernel *kernel;
    uint32_t threads; // the picture is parted into so many bands, each a task of the host's parallel_for
    uint32_t pixels;  // to a depth: 1, 2 (of two rows), 4, or 0: as it suits zone and picture
    uint32_t prunes;  // 1: tiles that the polygon does not touch are passed over
} hiz_options;

typedef struct hiz { // of a zone, constant once built
    const cull_host *host;
    hiz_options options;
    hiz_index index;
} hiz;

// [build] values of prune, threads, isa, pixels, in this order. Logs what is wrong.
cull_result hiz_options_read(const cull_host *host, const char *const *values, hiz_options *out);

// [build] On failure nothing is left behind.
cull_result hiz_make(const cull_host *host, const cull_zone *zone, const hiz_options *options, hiz *out);
void hiz_free(hiz *h);
size_t hiz_bytes(const hiz *h);
size_t hiz_scratch_bytes(const hiz *h);

// [step] The whole answer of a frame. numbers: what the host is told, by the zone's item; NULL: that item. counters are added to.
cull_progress hiz_step(const hiz *h, const uint32_t *numbers, const cull_visit *visit, cull_batch *batch, hiz_counters *counters);
// [step] What becomes of the item in the same visit, for a person: all is done again. The last two of items that it drops, if for no other reason.
typedef enum hiz_sight { HIZ_SEEN, HIZ_UNTESTED, HIZ_HIDDEN, HIZ_NO_PIXEL } hiz_sight;
hiz_sight hiz_look(const hiz *h, const cull_visit *visit, uint32_t item);

#endif
