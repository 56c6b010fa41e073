// Popping: what changes between two frames of a strategy and not in full geometry. A steady error goes with the surface that it is on, and is not seen
// to change; one that comes, goes or jumps is. So the error of the frame before is carried along, as Lai et al., "Learning Blind Video Temporal
// Consistency" (ECCV 2018) do with pictures and a mask of what was hidden, and FLIP tells what is shown from full geometry with that error.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_BENCH_POPPING_H
#define PORTCULLIS_BENCH_POPPING_H

#include "../host/core/view.h"

#define POPPING_NEW UINT32_MAX

typedef struct popping_view { // full geometry
    const camera *camera;
    const float *depths; // as renderer_read_depths gives them: bottom row first, 0: nothing
    const float *movers; // of movers alone, that go elsewhere between frames; NULL: there are none
} popping_view;
typedef struct popping_views { popping_view before, now; uint32_t width_px, height_px; } popping_views;
// By pixel, top row first: the pixel of the view before, top row first too, where the same place of what stands still was nearest; POPPING_NEW: it was
// hidden, out of the picture, or is a mover's.
void popping_trace(const popping_views *q, uint32_t *from);

typedef struct popping_pictures { // top row first, 4 bytes a pixel
    const uint8_t *truth_before, *shown_before, *truth, *shown;
    const uint32_t *from;
    size_t pixels;
} popping_pictures;
// What would be shown had no error changed: full geometry with the error of the frame before; where that is not known, what is shown.
void popping_expect(const popping_pictures *q, uint8_t *expected);

#endif
