// What a viewer holds: shared by viewer.c, which sizes it once, frame.c, which uses it, and batch_check.c.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_VIEWER_H
#define PORTCULLIS_HOST_VIEWER_H

#include "frame.h"
#include "list.h"
#include "runs.h"

typedef struct viewer_stage {
    cull_query *query;
    list runs; // cull_run, max_runs (+ mover_capacity for who takes movers)
    uint32_t run_capacity;
} viewer_stage;

struct viewer {
    const chain *chain;
    const allocator *memory;
    report *log;
    const runs_kernel *kernel;
    viewer_checks checks;
    viewer_stage stages[CHAIN_STAGES_MOST];
    uint32_t last;                 // the stage that may step: the last select or filter
    uint32_t first;                // the stage that starts: 0, or a filter that walks the hierarchy
    list tests, captures, pictures; // of the stepping stage
    list drawn;                    // cull_run: the host's own copy of what a stepping stage had drawn; none for one of one step
    list select_captures, select_pictures, keep_captures, keep_pictures; // of a select behind which a filter stands
    list early_tests, early_captures, early_pictures; // room for what a stage before the last may not give, so that it harms nobody
    list answers, movers, mover_runs;
    list seen;                     // one bit an item and mover, for VIEWER_CHECK_ALL
    uint8_t *slots;
    list slot_marks;               // one byte a slot, of meaning only while a batch or a filter's choice is looked at
    uint32_t slot_count, answer_capacity;
    void *scratch;
    size_t scratch_size;
    cull_run whole; // all items of the zone
    double clock_overhead_ns;
    uint32_t told_fault;
};

// One stage's frame as checked so far: what stands in earlier steps is not looked at again.
typedef struct batch_check {
    uint32_t stage;
    cull_batch lent;                     // the batch before the first call: its lists are the host's and stay
    uint32_t runs, pictures, mover_runs; // of earlier steps
    uint64_t items;                      // in those runs
} batch_check;

// NULL when what the culler wrote in this step may be used, and is then counted into the check; else what is wrong.
const char *batch_fault(viewer *v, const cull_batch *batch, batch_check *check);

#endif
