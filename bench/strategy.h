// A strategy in the bench: its world with a chain per zone, one view of it, layout, samples of time, and the set drawn in
// the current view.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_BENCH_STRATEGY_H
#define PORTCULLIS_BENCH_STRATEGY_H

#include "../host/core/runs.h"
#include "bench.h"
#include "motion.h"
#include "scissor.h"

typedef struct view_counts { // of one view: the set D
    uint64_t polygons, triangles, items, runs, mover_polygons;
} view_counts;

typedef struct view_misses { uint64_t pixels, items, broken; } view_misses; // broken: items that a chain had promised

typedef struct strategy_draw { // as the driver was told
    uint32_t zone;         // SCENE_NONE: movers, each as a run
    uint32_t first, count; // in strategy.draw_runs
} strategy_draw;

typedef struct strategy_zone {
    uint32_t first, item_count; // in strategy.order
    uint32_t is_identity;       // a place is a global id
    uint32_t slot_count, words; // words: of one slot
    uint32_t *slot_bits;        // by slot: the places that its picture truly holds; NULL without slots
} strategy_zone;

typedef struct strategy_times { // CPU time of what is no view's culling
    double mover_ns, swap_ns;
    uint64_t movers, swaps; // moved, zones swapped
} strategy_times;

// Who stands between a frame and the renderer; NULL: nobody.
typedef struct strategy_between {
    frame_driver (*driver)(void *user, frame_driver real);
    void *user;
} strategy_between;

typedef struct strategy {
    const bench_request *q;
    const bench_strategy_request *chains;
    world *world;
    world_view *view;
    motion motion;
    renderer *g;            // NULL: no GL
    render_layout *layout;  // with a renderer
    scissor scissor;        // opened by the first view that wants it
    strategy_zone *zones;   // scene.zone_count
    uint32_t *order;        // global id at each place, zone after zone, padded for runs_kernel.expand
    uint32_t *drawn_bits;   // D by global id, movers too; also what stands only in a picture
    uint32_t *picture_bits; // what stands in pictures of the current view, by global id
    uint32_t *clipped_bits; // what was drawn clipped
    uint64_t again_polygons, again_triangles; // of items drawn clipped, more than once
    uint32_t *ids;          // for BENCH_IDS
    const runs_kernel *kernel;
    walls walls;            // which truth judges it
    uint32_t *blame;        // scratch of strategy_misses
    buffer draws, draw_runs; // strategy_draw, cull_run: of the current view, where wanted
    uint32_t uses_renderer, may_step, has_pictures; // may_step: some chain takes several steps
    uint32_t turn;                                  // how often chains have gone on to the next set
    uint32_t marks, records, repeats, picture_faults; // of the current view; picture_faults: pictures said to hold what they don't
    uint32_t id_faults, record_failed;                // id_faults: more ids than items
    render_scissor cut;
    uint32_t cut_is_told;
    strategy_times times;    // since it was opened
    strategy_between between;
    double build_ms;         // of the chains it was opened with
    size_t index_bytes;
    bench_figures figures;  // see strategy_ask_figures
    uint32_t words, order_count, indices_built;
} strategy;

// [main] Builds the chains of all zones. Everything is borrowed. g may be NULL: see strategy_attach.
result strategy_open(const bench_request *q, const bench_strategy_request *chains, renderer *g, report *r, strategy *out);
void strategy_close(strategy *s); // zeroed is fine
// From now on views are drawn: for a strategy that was opened without renderer.
result strategy_attach(strategy *s, renderer *g, report *r);

// A new view without history, pictures or tests: what each pass over the path starts with.
result strategy_restart(strategy *s, report *r);
// Chains as that view has them, as if it had just been run: where a pass that this process left out would have ended.
result strategy_turn(strategy *s, uint32_t view, report *r);
// No view's answer depends on those before: any may be the first.
uint32_t strategy_is_stateless(const strategy *s);
// After the passes: what the chains tell of their indices, and of the views there were, which end for it.
result strategy_ask_figures(strategy *s, report *r);
// One view: moves movers, swaps chains when it is time, culls, draws where there is a renderer. gl_ms: 0 without. Leaves D
// in drawn_bits, unless it is not wanted: marking reads as much memory as culling, and would push the culler's out of the
// caches before the next view. Allocates nothing but in swaps.
typedef enum strategy_marks { MARK_DRAWN, MARK_NOTHING } strategy_marks;
typedef enum strategy_records { RECORD_NOTHING, RECORD_DRAWS } strategy_records; // DRAWS: for drawn.h; takes memory
typedef struct strategy_request {
    uint32_t view;
    render_mode mode;
    strategy_marks marks;
    render_scissor scissor;
    strategy_records records;
} strategy_request;
typedef struct strategy_view {
    frame_stats stats;
    visible_set set;
    double gl_ms;
    uint64_t picture_bytes; // of the slots' pictures, the most so far
    uint32_t draw_calls, state_changes, faults; // faults: of the frame, and what only the bench can see
} strategy_view;
result strategy_run_view(strategy *s, const strategy_request *w, report *r, strategy_view *out);
// What strategy_run_view culls that view with, for explanations of it.
frame_input strategy_input(strategy *s, uint32_t view);
// Box tests that all its zones together may ask in a step: see renderer_reserve.
uint32_t strategy_tests(const strategy *s);

view_counts strategy_count(const strategy *s, const visible_set *set);
// Right after that view was run, against the truth's view of that number.
view_misses strategy_misses(const strategy *s, const truth *t, uint32_t view);
// Which walls are judged by their fronts in that view, to a truth of WALLS_MIXED; before anything is drawn with it.
result strategy_judge(const strategy *s, uint32_t view, report *r, truth *t);

#endif
