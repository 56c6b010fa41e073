// The bench: passes over the path, strategies interleaved pass by pass, truth first.
// SPDX-License-Identifier: MIT
// A pass walks the whole path with one strategy, so that a culler's history sees consecutive frames.
#include "bench.h"
#include "drawn.h"
#include "images.h"
#include "pictures.h"
#include "progress.h"
#include "statistics.h"
#include "strategy.h"

#include <stdio.h>
#include <string.h>

typedef struct run {
    const bench_request *q;
    report *r;
    renderer *g;
    truth truths[WALLS_MIXED]; // opened where a strategy is judged by it
    motion motion; // of the truth
    strategy *strategies;
    truth *mixed; // by strategy, for those of WALLS_MIXED: which walls count depends on zones and turns
    bench_result *out;
    progress bar;
    double *scratch; // of views, and of repeats behind them
} run;

static int needs_renderer(const run *b)
{
    for (uint32_t k = 0; k < b->q->strategy_count; ++k)
        if (b->strategies[k].uses_renderer) return 1;
    return b->q->truth == BENCH_TRUTH || b->q->images || b->q->pictures == BENCH_PICTURES_ALL;
}

static int wants_pictures(const run *b)
{
    for (uint32_t k = 0; k < b->q->strategy_count; ++k)
        if (pictures_wanted(b->q, &b->strategies[k])) return 1;
    return 0;
}

static result open_strategies(run *b)
{
    for (uint32_t k = 0; k < b->q->strategy_count; ++k) {
        const result done = strategy_open(b->q, &b->q->strategies[k], NULL, b->r, &b->strategies[k]);
        if (done != RESULT_OK) return done;
    }
    return RESULT_OK;
}

// So that no frame allocates: as many tests a step as the most demanding strategy.
static result reserve(run *b)
{
    uint32_t most = 0;
    for (uint32_t k = 0; k < b->q->strategy_count; ++k) {
        const uint32_t tests = strategy_tests(&b->strategies[k]);
        most = tests > most ? tests : most;
    }
    return renderer_reserve(b->g, most, b->r);
}

// Only now is it known whether anything draws or tests.
static result open_renderer(run *b)
{
    const renderer_options options = {.target = RENDERER_HEADLESS, .width_px = b->q->width_px, .height_px = b->q->height_px};
    result done = renderer_open(&options, b->q->services->memory, b->r, &b->g);
    if (done == RESULT_OK) done = renderer_upload(b->g, b->q->scene, b->r);
    for (uint32_t k = 0; k < b->q->strategy_count && done == RESULT_OK; ++k) done = strategy_attach(&b->strategies[k], b->g, b->r);
    if (done != RESULT_OK) return done;
    renderer_query_latency(b->g, b->q->query_latency);
    done = reserve(b);
    if (done != RESULT_OK) return done;
    b->out->gl_used = 1;
    snprintf(b->out->gl_name, sizeof b->out->gl_name, "%s", renderer_name(b->g));
    return RESULT_OK;
}

static truth *truth_of(run *b, uint32_t k)
{
    const walls w = b->strategies[k].walls;
    return w == WALLS_MIXED ? &b->mixed[k] : &b->truths[w];
}

static uint32_t truths_needed(run *b)
{
    uint32_t has[WALLS_MIXED] = {0}, mixed = 0;
    for (uint32_t k = 0; k < b->q->strategy_count; ++k)
        if (b->strategies[k].walls == WALLS_MIXED) mixed++;
        else has[b->strategies[k].walls] = 1;
    return b->q->truth == BENCH_TRUTH ? has[WALLS_BOTH_SIDES] + has[WALLS_FRONT_ONLY] + mixed : 0;
}

static result find_truth(run *b, uint32_t k)
{
    const strategy *s = &b->strategies[k];
    truth *t = truth_of(b, k);
    const uint32_t samples = b->q->samples ? b->q->samples : 1;
    const truth_request request = {b->q->scene, b->q->width_px * samples, b->q->height_px * samples, s->walls};
    result done = truth_open(&request, b->q->services->memory, b->r, t);
    for (uint32_t v = 0; v < b->q->path->count && done == RESULT_OK; ++v) {
        progress_tell(&b->bar, "truth");
        motion_show(&b->motion, v, b->g);
        done = strategy_judge(s, v, b->r, t);
        if (done == RESULT_OK) done = truth_add_view(t, b->g, &b->q->path->cameras[v], b->r);
    }
    return done;
}

static result find_truths(run *b)
{
    result done = RESULT_OK;
    for (uint32_t k = 0; k < b->q->strategy_count && done == RESULT_OK; ++k)
        if (!truth_of(b, k)->scene) done = find_truth(b, k);
    return done;
}

// ---- Counting ----

static view_counts add_counts(bench_row *row, const strategy *s, const strategy_view *v)
{
    const view_counts c = strategy_count(s, &v->set);
    row->polygons_drawn += (double)c.polygons;
    row->triangles_drawn += (double)c.triangles;
    row->items_drawn += (double)c.items;
    row->runs += (double)c.runs;
    row->movers_drawn += (double)c.mover_polygons;
    row->zones += v->stats.zones;
    row->volumes += v->stats.volumes;
    row->crossings += v->stats.crossings;
    row->queries += v->stats.queries;
    row->steps += v->stats.steps;
    row->draw_calls += v->draw_calls;
    row->state_changes += v->state_changes;
    row->refreshes += v->stats.captures;
    if (v->picture_bytes > row->picture_bytes) row->picture_bytes = v->picture_bytes;
    row->portal_merges += v->stats.portal_merges;
    row->limits_hit += v->stats.limits_hit;
    row->stalls += v->stats.stalls;
    return c;
}

static void add_truth(bench_row *row, const truth_view *t, const view_counts *drawn)
{
    if (t->polygons_visible >= BENCH_HARD_POLYGONS) {
        row->hard_views++;
        row->hard_drawn += (double)drawn->polygons;
        row->hard_visible += (double)t->polygons_visible;
    }
    row->polygons_visible += (double)t->polygons_visible;
    row->polygons_items += (double)t->polygons_items;
    row->items_visible += (double)t->items_visible;
    row->floor += (double)t->floor_items;
    row->movers_visible += (double)t->mover_polygons_visible;
}

// Sums over the path become means; missed counts are the worst pass of each view, faults of the whole path.
static void close_row(run *b, bench_row *row, const strategy *s)
{
    const double views = b->q->path->count;
    row->excess = row->polygons_visible > 0 ? row->polygons_drawn / row->polygons_visible : 0;
    row->excess_items = row->polygons_items > 0 ? row->polygons_drawn / row->polygons_items : 0;
    row->hard_excess = row->hard_visible > 0 ? row->hard_drawn / row->hard_visible : 0;
    double *const means[] = {&row->polygons_drawn, &row->polygons_visible, &row->polygons_items, &row->triangles_drawn, &row->items_drawn,
                             &row->items_visible,  &row->runs, &row->floor, &row->movers_drawn, &row->movers_visible, &row->queries,
                             &row->steps, &row->draw_calls, &row->state_changes, &row->refreshes, &row->zones, &row->volumes, &row->crossings};
    for (size_t i = 0; i < sizeof means / sizeof *means; ++i) *means[i] /= views;
    for (uint32_t v = 0; v < b->q->path->count; ++v) {
        row->missed_pixels += s->missed[v];
        if (s->missed[v] > row->missed_pixels_max) {
            row->missed_pixels_max = s->missed[v];
            row->worst_view = v;
        }
    }
    row->front_walls_only = s->walls != WALLS_BOTH_SIDES;
    row->build_ms = s->build_ms;
    row->index_bytes = s->index_bytes;
    row->figures = s->figures;
    row->indices_built = s->indices_built;
}

uint32_t bench_warmup_views(const camera_path *path)
{
    static const char walk[] = "auto:walk:", drive[] = "auto:drive:";
    const int is_smooth = strncmp(path->name, walk, sizeof walk - 1) == 0 || strncmp(path->name, drive, sizeof drive - 1) == 0;
    return path->count >= BENCH_WARMUP_WALK && is_smooth ? BENCH_WARMUP_VIEWS : 0;
}

// Each view's median over the passes, of cull_ns * cull_weight + gl_ms * gl_weight, into b->scratch; warm-up left out.
static double *medians_of_views(run *b, const strategy *s, double cull_weight, double gl_weight)
{
    const uint32_t views = b->q->path->count, repeat = b->q->repeat, warmup = bench_warmup_views(b->q->path);
    double *of_view = b->scratch, *of_pass = b->scratch + views;
    for (uint32_t v = warmup; v < views; ++v) {
        for (uint32_t p = 0; p < repeat; ++p) {
            const size_t at = (size_t)p * views + v;
            of_pass[p] = s->cull_ns[at] * cull_weight + s->gl_ms[at] * gl_weight;
        }
        of_view[v - warmup] = percentile(of_pass, repeat, 0.5);
    }
    return of_view;
}

static void close_times(run *b, bench_row *row, const strategy *s)
{
    row->mover_update_ns = s->times.movers ? s->times.mover_ns / (double)s->times.movers : 0;
    row->swap_ms = s->times.swaps ? s->times.swap_ns * 1e-6 / (double)s->times.swaps : 0;
    row->swaps = s->times.swaps;
    const uint32_t views = b->q->path->count - bench_warmup_views(b->q->path);
    double *cull_ns = medians_of_views(b, s, 1, 0);
    row->cull_ns_mean = mean(cull_ns, views);
    row->cull_ns_p95 = percentile(cull_ns, views, 0.95);
    row->cull_ns_p99 = percentile(cull_ns, views, 0.99);
    row->cull_ns = percentile(cull_ns, views, 0.5);
    row->gl_ms = percentile(medians_of_views(b, s, 0, 1), views, 0.5);
    double *total_ms = medians_of_views(b, s, 1e-6, 1);
    row->total_ms = percentile(total_ms, views, 0.5);
    row->total_ms_p95 = percentile(total_ms, views, 0.95);
    row->total_ms_p99 = percentile(total_ms, views, 0.99);
}

// ---- Passes ----

// A wrong layout shows after a swap first, so some first views of a turn are compared too: one of so many turns, another
// place among them each time, lest it be the same set always.
enum { TURNS_COMPARED_MOST = 8 };

static int is_compared(const run *b, uint32_t k, uint32_t view)
{
    const uint32_t views = b->q->path->count, every = b->q->strategies[k].swap_views;
    if (view == views / 2) return 1;
    if (!every || view % every) return 0;
    const uint32_t turn = view / every, turns = (views - 1) / every + 1, among = (turns - 1) / TURNS_COMPARED_MOST + 1;
    return turn % among == turn / among % among;
}

// Against the truth: what is missed, and on some views what was truly drawn.
static result judge_view(run *b, uint32_t k, uint32_t view, view_misses *sum)
{
    strategy *s = &b->strategies[k];
    const truth *t = truth_of(b, k);
    const view_misses m = strategy_misses(s, t, view);
    sum->items += m.items;
    sum->broken += m.broken;
    if (m.pixels > s->missed[view]) s->missed[view] = m.pixels;
    if (!is_compared(b, k, view)) return RESULT_OK;
    uint64_t pixels = 0;
    const result done = drawn_compare(s, t, view, b->r, &pixels);
    b->out->rows[k].picture_differs += pixels;
    b->out->rows[k].pictures_compared++;
    return done;
}

// Without truth a pass of its own counts, and those that are timed mark nothing.
static const uint32_t PASS_COUNTS = UINT32_MAX;

static result run_pass(run *b, uint32_t pass, uint32_t k)
{
    const int has_truth = b->q->truth == BENCH_TRUTH, counts = has_truth ? pass == 0 : pass == PASS_COUNTS;
    strategy *s = &b->strategies[k];
    bench_row *row = &b->out->rows[k];
    view_misses missed = {0};
    uint64_t faults = 0;
    const result fresh = strategy_restart(s, b->r);
    if (fresh != RESULT_OK) return fresh;
    for (uint32_t v = 0; v < b->q->path->count; ++v) {
        strategy_view view;
        progress_tell(&b->bar, row->name);
        const strategy_request request = {.view = v, .mode = RENDER_SHADED, .marks = has_truth || counts ? MARK_DRAWN : MARK_NOTHING,
                                          .records = has_truth && is_compared(b, k, v) ? RECORD_DRAWS : RECORD_NOTHING};
        result done = strategy_run_view(s, &request, b->r, &view);
        if (done != RESULT_OK) return done;
        const view_counts drawn = counts ? add_counts(row, s, &view) : (view_counts){0};
        faults += view.faults;
        if (pass != PASS_COUNTS) {
            const size_t at = (size_t)pass * b->q->path->count + v;
            s->cull_ns[at] = view.stats.cull_ns;
            s->gl_ms[at] = view.gl_ms;
        }
        if (!has_truth) continue;
        if (pass == 0) add_truth(row, (const truth_view *)truth_of(b, k)->views.items + v, &drawn);
        done = judge_view(b, k, v, &missed);
        if (done != RESULT_OK) return done;
    }
    if (missed.items > row->missed_items) row->missed_items = missed.items;
    if (missed.broken > row->broken_items) row->broken_items = missed.broken;
    if (faults > row->faults) row->faults = faults;
    return RESULT_OK;
}

static result run_passes(run *b)
{
    const uint32_t count = b->q->strategy_count;
    for (uint32_t k = 0; k < count && b->q->truth == BENCH_NO_TRUTH; ++k) {
        const result done = run_pass(b, PASS_COUNTS, k);
        if (done != RESULT_OK) return done;
    }
    for (uint32_t pass = 0; pass < b->q->repeat; ++pass)
        for (uint32_t i = 0; i < count; ++i) {
            const result done = run_pass(b, pass, (i + pass) % count); // another one starts each pass
            if (done != RESULT_OK) return done;
        }
    return RESULT_OK;
}

static result open_result(const bench_request *q, report *r, bench_result *out)
{
    const scene *s = q->scene;
    *out = (bench_result){.memory = q->services->memory, .row_count = q->strategy_count, .views = q->path->count,
                          .zones = s->zone_count, .portals = s->portal_count,
                          .pixels = (uint64_t)q->width_px * q->height_px * (q->samples ? q->samples * q->samples : 1), .items_total = s->item_count};
    out->rows = memory_alloc_zeroed(out->memory, q->strategy_count, sizeof *out->rows);
    if (!out->rows) return report_no_memory(r, NULL);
    for (uint32_t k = 0; k < q->strategy_count; ++k) out->rows[k].name = q->strategies[k].name;
    for (uint32_t i = 0; i < s->item_count; ++i) out->polygons_total += s->items[i].polygon_count;
    return RESULT_OK;
}

static result run_all(run *b)
{
    result done = motion_open(b->q->scene, b->q->doors, b->q->services->memory, &b->motion);
    done = done == RESULT_OK ? open_strategies(b) : report_no_memory(b->r, NULL);
    if (done == RESULT_OK && needs_renderer(b)) done = open_renderer(b);
    const uint64_t passes = (uint64_t)b->q->repeat + (b->q->truth == BENCH_NO_TRUTH);
    const int pictures = done == RESULT_OK && wants_pictures(b);
    b->bar = progress_start(b->q->path->count * (truths_needed(b) + passes * b->q->strategy_count + (uint64_t)pictures));
    if (done == RESULT_OK && b->q->truth == BENCH_TRUTH) done = find_truths(b);
    if (done == RESULT_OK) done = run_passes(b);
    if (done == RESULT_OK && pictures)
        done = pictures_run(&(pictures_request){b->q, b->strategies, b->out->rows, &b->motion, b->g}, &b->bar, b->r);
    for (uint32_t k = 0; k < b->q->strategy_count && done == RESULT_OK; ++k) {
        done = strategy_ask_figures(&b->strategies[k], b->r);
        close_row(b, &b->out->rows[k], &b->strategies[k]);
        close_times(b, &b->out->rows[k], &b->strategies[k]);
        if (done == RESULT_OK && b->q->images) done = bench_images(&b->strategies[k], truth_of(b, k), &b->out->rows[k], b->r);
    }
    progress_end(&b->bar);
    b->out->plugins_opened = loader_libraries_open(b->q->plugins);
    if (done == RESULT_OK && b->g && renderer_errors(b->g))
        done = report_error(b->r, NULL, 0, "%u OpenGL errors; the figures are not to be trusted", renderer_errors(b->g));
    return done;
}

result bench_run(const bench_request *q, report *r, bench_result *out)
{
    const allocator *memory = q->services->memory;
    result done = open_result(q, r, out);
    if (done != RESULT_OK) return done;
    const size_t scratch = (size_t)q->path->count + q->repeat;
    run b = {.q = q, .r = r, .out = out};
    b.strategies = memory_alloc_zeroed(memory, q->strategy_count, sizeof *b.strategies);
    b.mixed = memory_alloc_zeroed(memory, q->strategy_count, sizeof *b.mixed);
    b.scratch = memory_alloc(memory, scratch, sizeof *b.scratch);
    done = b.strategies && b.mixed && b.scratch ? run_all(&b) : report_no_memory(r, NULL);
    for (uint32_t k = 0; b.strategies && k < q->strategy_count; ++k) strategy_close(&b.strategies[k]);
    for (uint32_t k = 0; b.mixed && k < q->strategy_count; ++k) truth_close(&b.mixed[k]);
    for (walls w = 0; w < WALLS_MIXED; ++w) truth_close(&b.truths[w]);
    motion_close(&b.motion);
    renderer_close(b.g);
    memory_free(memory, b.strategies, q->strategy_count, sizeof *b.strategies);
    memory_free(memory, b.mixed, q->strategy_count, sizeof *b.mixed);
    memory_free(memory, b.scratch, scratch, sizeof *b.scratch);
    if (done != RESULT_OK) bench_result_free(out);
    return done;
}

void bench_result_free(bench_result *b)
{
    memory_free(b->memory, b->rows, b->row_count, sizeof *b->rows);
    b->rows = NULL;
}

uint32_t bench_check_failed(const bench_row *row)
{
    return row->picture_differs || row->broken_items;
}
