// Frames: a viewer of a built chain asks it, view by view, what to draw.
// SPDX-License-Identifier: MIT
// Invariant: whatever a culler writes, the frame ends, allocates nothing, and draws at least what was truly answered;
// nonsense draws the whole zone and is counted.
#ifndef PORTCULLIS_HOST_FRAME_H
#define PORTCULLIS_HOST_FRAME_H

#include "chain.h"
#include "view.h"

typedef enum collect_how { COLLECT_WHAT_IS_READY, COLLECT_EVERYTHING } collect_how;

// What carries out batches. Functions may be NULL; without `test` every test counts as seen, without `capture` no slot
// is ever filled. Called between steps, on the stepping thread; their time is not the cullers'.
typedef struct frame_driver {
    void *user;
    void (*draw)(void *user, const cull_run *runs, uint32_t run_count); // places in the chain's order, movers behind
    void (*capture)(void *user, const cull_capture *captures, uint32_t count);
    void (*show)(void *user, const cull_picture *pictures, uint32_t count);
    void (*test)(void *user, const cull_test *tests, uint32_t count, uint32_t frame);
    uint32_t (*collect)(void *user, collect_how how, uint32_t frame, cull_answer *answers, uint32_t capacity, uint32_t *stalled);
} frame_driver;

typedef struct frame_input {
    const camera *camera;
    view_frame frame;
    frame_driver driver;
} frame_input;

typedef struct frame_stats {
    double cull_ns; // CPU time of host flow and plugin steps, without the driver's
    uint32_t steps, queries, captures, pictures, stalls, limits_hit, faults, portal_merges;
    uint32_t movers_tested, movers_drawn;
    uint64_t nodes_visited, items_drawn; // items of the runs, movers not counted
} frame_stats;

typedef struct visible_set {
    const cull_run *runs; // of the zone's items, in the chain's order; valid until the viewer's next frame
    const cull_run *mover_runs; // (item_count + slot, count)
    uint32_t run_count, mover_run_count;
} visible_set;

typedef enum viewer_checks {
    VIEWER_CHECK_BOUNDS, // O(runs): bounds and totals
    VIEWER_CHECK_ALL,    // O(items drawn): also each item once. Debug builds always
} viewer_checks;

typedef struct viewer viewer; // one view's memory of one chain

// [main] The chain is borrowed. Sizes everything that a frame needs.
result viewer_open(const chain *c, const host_services *services, viewer_checks checks, report *r, viewer **out);
void viewer_close(viewer *v); // NULL is fine
// [any thread, one at a time per viewer] Never fails and allocates nothing. out_set may be NULL.
void frame_run(viewer *v, const frame_input *q, visible_set *out_set, frame_stats *out_stats);
// For the bench: overhead of the two clock readings of a frame, already taken off cull_ns.
double frame_clock_overhead_ns(const viewer *v);

#endif
