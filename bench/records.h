// What the bench keeps of each view, before anything is added up: the one source of a bench's rows, in one process or merged from shards.
// SPDX-License-Identifier: MIT
// Invariant: rows are a function of the records alone, added up in the path's order; so records of all views give the same bits whoever measured them.
#ifndef PORTCULLIS_BENCH_RECORDS_H
#define PORTCULLIS_BENCH_RECORDS_H

#include "bench.h"

// All without padding: they are written as they stand. See part.h.
typedef struct counted_record { // of a strategy's view: what no pass changes
    uint64_t polygons, triangles, items, runs, mover_polygons, picture_bytes; // picture_bytes: the most so far
    uint64_t polygons_visible, polygons_items, items_visible, floor_items, mover_polygons_visible; // of the truth
    uint32_t zones, volumes, crossings, queries, steps, draw_calls, state_changes, captures, portal_merges, limits_hit, stalls, spare;
} counted_record;

typedef struct pass_record { // of a strategy's view in one pass
    double cull_ns, gl_ms, mover_ns, swap_ns;
    uint64_t missed_pixels, missed_items, broken_items, picture_differs, movers, swaps;
    uint32_t faults, compared;
} pass_record;

typedef struct picture_record { // of a strategy's view beside full geometry
    double squared_error, ssim, flip, popping;
    uint64_t holes, inner, spills, mover_pixels, mover_wrong, mover_wrong_far, swaps;
    uint32_t faults, is_measured, has_ssim, has_popping; // is_measured 0: one of the warm-up, only cracks, movers and faults mean something
} picture_record;

typedef struct records {
    const allocator *memory;
    uint32_t strategies, passes; // passes: records_passes
    uint32_t first, count;       // the views kept
    counted_record *counted;
    pass_record *timed;
    picture_record *pictures;
    uint8_t *has_pictures; // by strategy: were compared
} records;

uint32_t records_passes(const bench_request *q);         // with the one that only counts, when there is no truth
uint32_t records_counting_pass(const bench_request *q);  // that fills counted_record
// Of views first to first + count. RESULT_NO_MEMORY leaves nothing.
result records_open(const bench_request *q, uint32_t first, uint32_t count, records *out);
void records_close(records *r); // zeroed is fine
counted_record *records_counted(const records *r, uint32_t strategy, uint32_t view);
pass_record *records_pass(const records *r, uint32_t strategy, uint32_t pass, uint32_t view);
picture_record *records_picture(const records *r, uint32_t strategy, uint32_t view);

// Rows of records of the whole path; what is no sum over views stays as it is. Of q only the path's count and name, passes, sizes and memory are read.
result records_fill(const records *r, const bench_request *q, bench_result *out);
// What is told of pictures, of one strategy. RESULT_NO_MEMORY: nothing is.
result records_fill_pictures(const records *r, uint32_t strategy, const allocator *memory, bench_row *row);
// Median over the passes that are timed of cull_ns * cull_weight + gl_ms * gl_weight. scratch: repeat.
typedef struct time_weights { double cull, gl; } time_weights;
double records_time(const records *r, const bench_request *q, uint32_t strategy, uint32_t view, time_weights w, double *scratch);

#endif
