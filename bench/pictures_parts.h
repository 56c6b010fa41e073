// What the files of the pass over pictures share among themselves.
// SPDX-License-Identifier: MIT
// Invariant: full geometry and what is shown stand in rings; a place is written again only when the jobs that read it are done.
#ifndef PORTCULLIS_BENCH_PICTURES_PARTS_H
#define PORTCULLIS_BENCH_PICTURES_PARTS_H

#include "cracks.h"
#include "pictures.h"
#include "similarity.h"
#include "worker.h"

enum { PICTURES_TRUTHS = 3, PICTURES_JOBS = 2 }; // the view drawn, the one compared, and the one before that

typedef struct picture { // top row first; depths: bottom row first
    uint8_t *rgba;
    float *depths;
} picture;

typedef struct truth_picture {
    picture all;
    float *fronts; // depths of what shows its front; NULL: no strategy is judged by that
    float *movers; // depths of movers alone; NULL: there are none
    const camera *camera;
    uint64_t job; // the last that reads it
} truth_picture;

typedef struct worst_view { // copies, where images are wanted: history can't be drawn again
    uint8_t *truth, *shown, *heat;
} worst_view;

typedef struct picture_sums { // of one strategy; before NULL: it is not wanted
    worst_view worst;
    double flip_max; // of the worst
    uint32_t views, flip_view;
    uint8_t *before; // what it showed in the view before
} picture_sums;

typedef struct picture_job { // one view of one strategy
    picture shown;
    const truth_picture *now, *before; // before NULL: the view starts anew
    uint32_t view, strategy;
} picture_job;

typedef struct pictures {
    const pictures_request *q;
    report *r;
    const allocator *memory;
    size_t pixels;
    render_layout *layout; // all items, in the scene's order
    uint32_t *items;
    worker *worker;
    truth_picture truths[PICTURES_TRUTHS]; // by view
    picture_job jobs[PICTURES_JOBS];       // by number
    uint64_t given;
    picture_sums *sums; // by strategy
    // The worker's alone, until it is waited for:
    flip *flip;
    similarity *similarity; // NULL: too small a picture for a window
    float *map;
    uint8_t *marks, *expected;
    uint32_t *from;      // see popping.h
    uint32_t from_view;  // that it is of, + 1; 0: none
} pictures;

void pictures_compare(void *context, uint64_t job); // for worker_request.run; context: pictures

#endif
