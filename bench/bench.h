// The bench: every strategy over the same path of one scene; what it draws, what that costs, what it gets wrong.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_BENCH_BENCH_H
#define PORTCULLIS_BENCH_BENCH_H

#include "../host/core/world.h"
#include "../host/import/views.h"
#include "../host/render/render.h"
#include "figures.h"
#include "truth.h"

typedef enum bench_truth { BENCH_TRUTH, BENCH_NO_TRUTH } bench_truth;
// Pictures beside full geometry (pictures.h): of strategies that show pictures of their own, with BENCH_TRUTH; of all; of none.
typedef enum bench_pictures { BENCH_PICTURES_SHOWN, BENCH_PICTURES_ALL, BENCH_PICTURES_NONE } bench_pictures;
typedef enum bench_costs { BENCH_COSTS_MEASURED, BENCH_COSTS_FIXED } bench_costs; // that cullers weigh by, see CULL_EXT_COSTS; FIXED: those that the services have
typedef enum bench_times { BENCH_TIMES_TOLD, BENCH_TIMES_OF_VIEWS } bench_times; // OF_VIEWS: the JSON has each view's least time, for --against
typedef enum bench_ids { BENCH_RUNS, BENCH_IDS } bench_ids; // IDS: writing every drawn id belongs to cull_ns

// Which chain each zone has. A set names them by zone (scene.zone_count, NULL entries: `chain`). With swap_views the zones
// go on to the next set every so many views, zone i being i sets ahead, so that chains are mixed.
typedef struct bench_strategy_request {
    const char *name;                    // as it stands in the results
    const chain_spec *chain;             // of zones that no set names
    const chain_spec *const *const *sets; // set_count; may be NULL when that is 0
    uint32_t set_count, swap_views;      // swap_views 0: the first set stays
} bench_strategy_request;

// A part of the path's views, of a bench that several processes share: their parts are merged (merge.h). Nothing of bench_result's rows is filled but what
// stands in the part too.
typedef struct bench_shard {
    uint32_t index, count; // 1 to count; count 0: the whole path, here
    const char *part;      // the file that this shard's records go to, all at once; part.journal beside it keeps them until then
    const char *identity;  // what all parts must agree on: see shard_identity
} bench_shard;

typedef struct bench_request {
    const scene *scene;
    const camera_path *path;
    const bench_strategy_request *strategies;
    const door_state *doors; // how all doors stand; NULL: as the scene has them at rest
    loader *plugins;
    const host_services *services;
    uint32_t strategy_count, width_px, height_px, repeat, query_latency;
    uint32_t samples; // the truth is a picture this many times as wide and high; 1 to BENCH_SAMPLES_MOST; 0 as 1. images only with 1
    bench_truth truth;
    bench_ids ids;
    bench_costs costs;
    bench_pictures pictures;
    bench_times times;
    double frame_ms; // what a frame may take, as cullers are told (cull_costs.frame_ns); 0: nobody says
    const char *images; // folder for pictures, NULL: none
    bench_shard shard;
    struct trace *trace; // spans of a pass of its own go there, see trace.h; NULL: none
} bench_request;

enum { BENCH_SAMPLES_MOST = 8 };
enum { BENCH_HARD_POLYGONS = 40 }; // visible in a view: from there on it is a hard one, beside walls that fill the picture

// One strategy's counters: as the JSON names them. Means are per view, sums over the path.
typedef struct bench_row {
    const char *name;
    double cull_ns, cull_ns_mean, cull_ns_p95, cull_ns_p99, gl_ms, total_ms; // over views of each view's median
    double polygons_drawn, polygons_visible, polygons_items, triangles_drawn, items_drawn, items_visible, runs, floor;
    double movers_drawn, movers_visible, queries, steps, draw_calls, state_changes;
    double excess, excess_items, build_ms;
    double total_ms_mean, total_ms_p95, total_ms_p99; // over views, as total_ms
    double refreshes;                  // captures a view
    uint64_t picture_bytes;            // of all slots that hold a picture, the most of any view
    uint32_t pictures_measured, has_ssim; // views beside full geometry; 0: the next lines mean nothing. has_ssim 0: too small for it
    double psnr;                       // dB, of the mean squared error over all those views; at most PSNR_MOST_DB
    double ssim, flip, flip_p99, flip_max; // means of the views' means; the views' means' 99th percentile and largest
    double popping, popping_p99, popping_max; // the same of what changes from view to view and not in full geometry: see popping.h
    uint32_t popping_view, popping_views;     // the worst; how many follow another without a cut. 0: the line before means nothing
    uint64_t crack_pixels, crack_inner, crack_spills, crack_pixels_max; // over all views: see cracks.h
    uint64_t mover_pixels, mover_pixels_wrong, mover_pixels_wrong_far; // over all views: see mover_order in cracks.h
    uint32_t flip_view, crack_view;    // the worst of each
    double hard_excess, hard_drawn, hard_visible; // of the views that see at least BENCH_HARD_POLYGONS; the last two are sums over them
    uint64_t missed_pixels, missed_items, missed_pixels_max;
    double zones, volumes, crossings; // zones reached, volumes they are seen through, portals tried
    double mover_update_ns;           // CPU time to move one mover on its path; 0 where none moves
    double swap_ms;                   // CPU time to give one zone another chain; 0 without swaps
    uint64_t swaps;                   // zones given another chain, over all passes
    uint64_t portal_merges, limits_hit, stalls, faults, index_bytes;
    uint32_t indices_built;    // zones whose chain was built
    uint32_t front_walls_only; // judged by walls that face the eye only: excess does not compare with rows that are not
    uint64_t broken_items;     // of missed_items: those that a chain of a zone listing them had promised
    uint64_t picture_differs;  // pixels, over all views looked at, where what was drawn is not what D shows: see drawn.h
    uint32_t pictures_compared; // views looked at
    uint32_t worst_view, hard_views;
    double *least_cull_ns, *least_total_ns; // by view, warm-up left out: the least of all passes; the result's memory
    bench_figures figures;
} bench_row;

typedef struct bench_result {
    bench_row *rows; // strategy_count
    uint32_t row_count, views, zones, portals, plugins_opened, gl_used;
    uint64_t pixels, polygons_total, items_total;
    char gl_name[256];
    double *least;           // behind the rows' lists
    struct records *records; // of each view: see records.h
    uint32_t least_count;    // of each list
    uint32_t shards;         // parts that it was merged from; 0: one process's
    const allocator *memory;
} bench_result;

// [main] Reports progress on a terminal. Free with bench_result_free.
result bench_run(const bench_request *q, report *r, bench_result *out);
// Rows with room for their lists; strategies by name. What bench_run and a merge begin with. RESULT_NO_MEMORY leaves nothing.
result bench_result_open(const bench_request *q, bench_result *out);
void bench_result_free(bench_result *b);
// 1 when a chain missed an item although it promises not to, or a strategy drew what it did not say.
uint32_t bench_check_failed(const bench_row *row);
// The first views of a long walk or drive (auto:walk:200, auto:drive:200 or more), until a strategy with history has one: they are drawn and checked, and
// left out of times and of means over pictures. 0 for all other paths.
enum { BENCH_WARMUP_VIEWS = 60, BENCH_WARMUP_WALK = 200 };
uint32_t bench_warmup_views(const camera_path *path);

typedef struct bench_labels { const char *scene, *path; } bench_labels; // for names and context

typedef struct bench_text { // free with memory_free(q->services->memory, bytes, size + 1, 1)
    char *bytes; // with a closing zero
    size_t size;
} bench_text;

// The table for people. `-` stands where nothing was visible to divide by.
result bench_table(const bench_result *b, const bench_request *q, const bench_labels *labels, bench_text *out);
// Google Benchmark's JSON. What was not measured is null, and so is an excess where nothing was visible.
result bench_json(const bench_result *b, const bench_request *q, const bench_labels *labels, bench_text *out);
// As JSON's counters, a line a strategy; the first line names them. What was not measured is empty. Figures of plugins are left out.
result bench_csv(const bench_result *b, const bench_request *q, const bench_labels *labels, bench_text *out);
// CSV too, a line a strategy and view: from the result's records.
result bench_frames(const bench_result *b, const bench_request *q, const bench_labels *labels, bench_text *out);

#endif
