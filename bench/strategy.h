// A strategy in the bench: its chain, viewer, layout, samples of time, and the set drawn in the current view.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_BENCH_STRATEGY_H
#define PORTCULLIS_BENCH_STRATEGY_H

#include "../host/core/runs.h"
#include "bench.h"

typedef struct view_counts { // of one view: the set D
    uint64_t polygons, triangles, items, runs, mover_polygons;
} view_counts;

typedef struct view_misses { uint64_t pixels, items; } view_misses;

typedef struct strategy {
    const bench_request *q;
    chain *chain;
    viewer *viewer;
    renderer *g;           // NULL: no GL
    render_layout *layout; // with a renderer
    uint32_t *drawn_bits;  // D by global id, movers too; also what stands only in a picture
    uint32_t *order;       // chain's order, padded for runs_kernel.expand; NULL: none
    uint32_t *ids;         // for BENCH_IDS
    const runs_kernel *kernel;
    walls walls; // which truth judges it
    uint32_t *slot_bits; // by slot: the items that its picture truly holds; NULL without slots
    uint32_t slot_count, marks, picture_faults; // picture_faults: of the current view, pictures said to hold what they don't
    double *cull_ns, *gl_ms; // repeat * views samples
    uint64_t *missed;        // pixels a view, the worst pass
    uint32_t words, order_count;
} strategy;

result strategy_open(const bench_request *q, const chain_spec *spec, renderer *g, report *r, strategy *out);
void strategy_close(strategy *s);

// A new viewer without history, pictures or tests: what each pass over the path starts with.
result strategy_restart(strategy *s, report *r);
// One view: culls, draws where there is a renderer. gl_ms: 0 without. Leaves D in drawn_bits, unless it is not wanted:
// marking reads as much memory as culling, and would push the culler's out of the caches before the next view.
typedef enum strategy_marks { MARK_DRAWN, MARK_NOTHING } strategy_marks;
typedef struct strategy_request {
    uint32_t view;
    render_mode mode;
    strategy_marks marks;
} strategy_request;
typedef struct strategy_view {
    frame_stats stats;
    visible_set set;
    double gl_ms;
    uint32_t draw_calls, state_changes, faults; // faults: of the frame, and what only the bench can see
} strategy_view;
result strategy_run_view(strategy *s, const strategy_request *w, report *r, strategy_view *out);

view_counts strategy_count(const strategy *s, const visible_set *set);
view_misses strategy_misses(const strategy *s, const truth *t, uint32_t view);

#endif
