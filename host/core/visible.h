// What a frame of a world's view is given, and what it gives: driver, input, visible set, statistics.
// SPDX-License-Identifier: MIT
// Invariant: whatever a culler writes, a frame ends, allocates nothing, and draws at least what was truly answered;
// nonsense draws the zone whole and is counted.
#ifndef PORTCULLIS_HOST_VISIBLE_H
#define PORTCULLIS_HOST_VISIBLE_H

#include "chain.h"
#include "view.h"

// What begins or has ended in a frame, for who draws up where its time went.
typedef enum frame_mark { FRAME_FLOW_BEGINS, FRAME_FLOW_ENDED, FRAME_STEP_BEGINS, FRAME_STEP_ENDED } frame_mark;

typedef enum collect_how { COLLECT_WHAT_IS_READY, COLLECT_EVERYTHING } collect_how;

// What carries out batches. Functions may be NULL; without `test` every test counts as seen, without `capture` no slot
// is ever filled, and without one of `capture` and `show` a zone that gives pictures is drawn whole, as is one that gives
// clipped items without `draw_clipped`. Called between steps, on the stepping thread; their time is not the cullers'.
typedef struct frame_driver {
    void *user;
    void (*draw)(void *user, uint32_t zone, const cull_run *runs, uint32_t run_count); // places in the order of the zone's chain
    void (*draw_movers)(void *user, const uint32_t *movers, uint32_t count);           // mover numbers
    void (*capture)(void *user, uint32_t zone, const cull_capture *captures, uint32_t count);
    void (*show)(void *user, uint32_t zone, const cull_picture *pictures, uint32_t count);
    void (*test)(void *user, uint32_t zone, const cull_test *tests, uint32_t count, uint32_t frame);
    // Answers to the zone's tests only.
    uint32_t (*collect)(void *user, uint32_t zone, collect_how how, uint32_t frame, cull_answer *answers, uint32_t capacity, uint32_t *stalled);
    void (*draw_clipped)(void *user, uint32_t zone, const cull_clipped *clipped, uint32_t count);
    // Before the zone's first step and after its captures: to 0 which slots hold no picture, or none any more. Its time is the frame's.
    void (*check_slots)(void *user, uint32_t zone, uint8_t *slots, uint32_t count);
    // Its time is the frame's: for no frame that is measured. zone: that steps; of FRAME_FLOW_ENDED: how many zones are reached.
    void (*mark)(void *user, frame_mark mark, uint32_t zone);
} frame_driver;

typedef struct frame_input {
    const camera *camera;
    view_frame frame;
    frame_driver driver;
} frame_input;

typedef struct frame_stats {
    double cull_ns; // CPU time of host flow and plugin steps, without the driver's
    uint32_t zones, volumes, crossings; // reached, seen through, portals tried
    uint32_t steps, queries, captures, pictures, clipped, stalls, limits_hit, faults, portal_merges;
    uint32_t movers_tested, movers_drawn;
    uint64_t nodes_visited, items_drawn; // items of the runs, movers not counted
} frame_stats;

// What a view sees. An item that several zones list stands once, in the first that drew it: near to far in each round.
typedef struct visible_zone {
    uint32_t zone, run_count;
    const cull_run *runs; // of the zone's items, in its chain's order
} visible_zone;
typedef struct visible_set {
    const visible_zone *zones; // near to far; valid until the view's next frame
    const uint32_t *movers;    // numbers, each once
    uint32_t zone_count, mover_count;
} visible_set;

typedef enum viewer_checks {
    VIEWER_CHECK_BOUNDS, // O(runs): bounds and totals
    VIEWER_CHECK_ALL,    // O(items drawn): also each item once. Debug builds always
} viewer_checks;

#endif
