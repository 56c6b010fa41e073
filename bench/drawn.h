// What a frame truly put on the screen: the draws of a view once more, as owners of pixels, through the strategy's own
// layout, beside the picture of the set D drawn by global id. Where they differ, more, less or other was drawn than said.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_BENCH_DRAWN_H
#define PORTCULLIS_BENCH_DRAWN_H

#include "strategy.h"

typedef struct drawn_picture { // width_px * height_px each, bottom row first
    uint32_t *owners;          // global triangle + 1, 0: nothing
    float *depths;             // reversed: nearer is larger
    size_t pixels;
} drawn_picture;

result drawn_picture_open(const strategy *s, report *r, drawn_picture *out);
void drawn_picture_free(const strategy *s, drawn_picture *p); // zeroed is fine

// [main] All below: after a view of RECORD_DRAWS and before the next, movers standing where the view had them.
// The view's draws again, cut as they were.
result drawn_again(strategy *s, uint32_t view, report *r, drawn_picture *out);
// Pixels of the view that do not show what D shows. Of two surfaces at one depth either may show, if it is in D.
result drawn_compare(strategy *s, const truth *t, uint32_t view, report *r, uint64_t *out_pixels);

#endif
