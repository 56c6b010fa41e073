// The bench: passes over the path, strategies interleaved pass by pass, truth first.
// SPDX-License-Identifier: MIT
// A pass walks the whole path with one strategy, so that a culler's history sees consecutive frames. A shard walks the views before its own for that
// too, and keeps nothing of them.
#include "bench.h"
#include "drawn.h"
#include "images.h"
#include "part.h"
#include "pictures.h"
#include "progress.h"
#include "resume.h"
#include "shard.h"
#include "strategy.h"
#include "trace.h"

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
    view_range range; // of this process
    resume resume;    // of a shard that was stopped
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

static result find_view(run *b, uint32_t k, uint32_t v, truth *t)
{
    progress_tell(&b->bar, "truth");
    motion_show(&b->motion, v, b->g);
    result done = strategy_judge(&b->strategies[k], v, b->r, t);
    if (done == RESULT_OK) done = truth_add_view(t, b->g, &b->q->path->cameras[v], b->r);
    return done == RESULT_OK ? resume_keep_truth(&b->resume, k, t, b->r) : done;
}

static result find_truth(run *b, uint32_t k)
{
    truth *t = truth_of(b, k);
    const uint32_t samples = b->q->samples ? b->q->samples : 1;
    const truth_request request = {b->q->scene, b->q->width_px * samples, b->q->height_px * samples, b->strategies[k].walls};
    result done = truth_open(&request, b->q->services->memory, b->r, t);
    for (uint32_t v = 0; v < b->range.first && done == RESULT_OK; ++v) done = truth_skip_view(t, b->r);
    if (done == RESULT_OK) done = resume_truth(&b->resume, k, b->r, t);
    for (uint32_t v = (uint32_t)t->views.count; v < b->range.end && done == RESULT_OK; ++v) done = find_view(b, k, v, t);
    return done;
}

static result find_truths(run *b)
{
    result done = RESULT_OK;
    for (uint32_t k = 0; k < b->q->strategy_count && done == RESULT_OK; ++k)
        if (!truth_of(b, k)->scene) done = find_truth(b, k);
    return done;
}

uint32_t bench_warmup_views(const camera_path *path)
{
    static const char walk[] = "auto:walk:", drive[] = "auto:drive:";
    const int is_smooth = strncmp(path->name, walk, sizeof walk - 1) == 0 || strncmp(path->name, drive, sizeof drive - 1) == 0;
    return path->count >= BENCH_WARMUP_WALK && is_smooth ? BENCH_WARMUP_VIEWS : 0;
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
static result judge_view(run *b, uint32_t k, uint32_t view, pass_record *out)
{
    strategy *s = &b->strategies[k];
    const truth *t = truth_of(b, k);
    const view_misses m = strategy_misses(s, t, view);
    out->missed_pixels = m.pixels;
    out->missed_items = m.items;
    out->broken_items = m.broken;
    if (!is_compared(b, k, view)) return RESULT_OK;
    out->compared = 1;
    return drawn_compare(s, t, view, b->r, &out->picture_differs);
}

static void count_view(const strategy *s, const strategy_view *v, counted_record *out)
{
    const view_counts c = strategy_count(s, &v->set);
    *out = (counted_record){.polygons = c.polygons, .triangles = c.triangles, .items = c.items, .runs = c.runs, .mover_polygons = c.mover_polygons,
                            .picture_bytes = v->picture_bytes, .zones = v->stats.zones, .volumes = v->stats.volumes, .crossings = v->stats.crossings,
                            .queries = v->stats.queries, .steps = v->stats.steps, .draw_calls = v->draw_calls, .state_changes = v->state_changes,
                            .captures = v->stats.captures, .portal_merges = v->stats.portal_merges, .limits_hit = v->stats.limits_hit,
                            .stalls = v->stats.stalls};
}

static void count_truth(const truth_view *t, counted_record *out)
{
    out->polygons_visible = t->polygons_visible;
    out->polygons_items = t->polygons_items;
    out->items_visible = t->items_visible;
    out->floor_items = t->floor_items;
    out->mover_polygons_visible = t->mover_polygons_visible;
}

// Without truth a pass of its own counts, and those that are timed mark nothing. is_kept 0: only so that later views have the history that they would have.
static result run_view(run *b, const resume_place *at, int is_kept)
{
    const int has_truth = b->q->truth == BENCH_TRUTH, counts = is_kept && at->pass == records_counting_pass(b->q);
    strategy *s = &b->strategies[at->strategy];
    const strategy_times before = s->times;
    strategy_view view;
    progress_tell(&b->bar, b->out->rows[at->strategy].name);
    const strategy_request request = {.view = at->view, .mode = RENDER_SHADED, .marks = is_kept && (has_truth || counts) ? MARK_DRAWN : MARK_NOTHING,
                                      .records = is_kept && has_truth && is_compared(b, at->strategy, at->view) ? RECORD_DRAWS : RECORD_NOTHING};
    result done = strategy_run_view(s, &request, b->r, &view);
    if (done != RESULT_OK || !is_kept) return done;
    pass_record *out = records_pass(b->out->records, at->strategy, at->pass, at->view);
    *out = (pass_record){.cull_ns = view.stats.cull_ns, .gl_ms = view.gl_ms, .mover_ns = s->times.mover_ns - before.mover_ns,
                         .swap_ns = s->times.swap_ns - before.swap_ns, .movers = s->times.movers - before.movers,
                         .swaps = s->times.swaps - before.swaps, .faults = view.faults};
    if (counts) count_view(s, &view, records_counted(b->out->records, at->strategy, at->view));
    if (counts && has_truth)
        count_truth((const truth_view *)truth_of(b, at->strategy)->views.items + at->view, records_counted(b->out->records, at->strategy, at->view));
    if (has_truth) done = judge_view(b, at->strategy, at->view, out);
    return done == RESULT_OK ? resume_keep_pass(&b->resume, at, b->out->records, b->r) : done;
}

// Of a strategy without history a few views before warm the caches up.
enum { VIEWS_BEFORE = 8 };

static uint32_t first_view_run(const run *b, uint32_t k, uint32_t first)
{
    if (!strategy_is_stateless(&b->strategies[k])) return 0;
    return first > VIEWS_BEFORE ? first - VIEWS_BEFORE : 0;
}

static result run_pass(run *b, uint32_t pass, uint32_t k)
{
    strategy *s = &b->strategies[k];
    const view_range left = resume_left(&b->resume, k, pass);
    result done = pass == records_counting_pass(b->q) ? RESULT_OK : strategy_turn(s, b->q->path->count - 1, b->r);
    if (done == RESULT_OK) done = strategy_restart(s, b->r);
    if (left.first == left.end) return done;
    for (uint32_t v = first_view_run(b, k, left.first); v < left.end && done == RESULT_OK; ++v)
        done = run_view(b, &(resume_place){k, pass, v}, v >= left.first);
    return done;
}

static result run_passes(run *b)
{
    const uint32_t count = b->q->strategy_count;
    for (uint32_t k = 0; k < count && b->q->truth == BENCH_NO_TRUTH; ++k) {
        const result done = run_pass(b, records_counting_pass(b->q), k);
        if (done != RESULT_OK) return done;
    }
    for (uint32_t pass = 0; pass < b->q->repeat; ++pass)
        for (uint32_t i = 0; i < count; ++i) {
            const result done = run_pass(b, pass, (i + pass) % count); // another one starts each pass
            if (done != RESULT_OK) return done;
        }
    return RESULT_OK;
}

// ---- Results ----

result bench_result_open(const bench_request *q, bench_result *out)
{
    const allocator *memory = q->services->memory;
    const uint32_t views = q->path->count - bench_warmup_views(q->path);
    *out = (bench_result){.memory = memory, .row_count = q->strategy_count, .views = q->path->count, .least_count = views};
    out->rows = memory_alloc_zeroed(memory, q->strategy_count, sizeof *out->rows);
    out->least = memory_alloc_zeroed(memory, (size_t)q->strategy_count * views * 2, sizeof *out->least);
    out->records = memory_alloc_zeroed(memory, 1, sizeof *out->records);
    if (!out->rows || !out->least || !out->records) {
        bench_result_free(out);
        return RESULT_NO_MEMORY;
    }
    for (uint32_t k = 0; k < q->strategy_count; ++k) {
        out->rows[k].name = q->strategies[k].name;
        out->rows[k].least_cull_ns = out->least + (size_t)k * views * 2;
        out->rows[k].least_total_ns = out->rows[k].least_cull_ns + views;
    }
    return RESULT_OK;
}

void bench_result_free(bench_result *b)
{
    if (b->records) records_close(b->records);
    memory_free(b->memory, b->records, 1, sizeof *b->records);
    memory_free(b->memory, b->least, (size_t)b->row_count * b->least_count * 2, sizeof *b->least);
    memory_free(b->memory, b->rows, b->row_count, sizeof *b->rows);
    b->rows = NULL;
    b->least = NULL;
    b->records = NULL;
}

static result open_result(run *b)
{
    const bench_request *q = b->q;
    const scene *s = q->scene;
    bench_result *out = b->out;
    if (bench_result_open(q, out) != RESULT_OK) return report_no_memory(b->r, NULL);
    out->zones = s->zone_count;
    out->portals = s->portal_count;
    out->pixels = (uint64_t)q->width_px * q->height_px * (q->samples ? q->samples * q->samples : 1);
    out->items_total = s->item_count;
    for (uint32_t i = 0; i < s->item_count; ++i) out->polygons_total += s->items[i].polygon_count;
    return records_open(q, b->range.first, b->range.end - b->range.first, out->records) == RESULT_OK ? RESULT_OK : report_no_memory(b->r, NULL);
}

// What is no sum over views.
static void fill_facts(const strategy *s, bench_row *row)
{
    row->front_walls_only = s->walls != WALLS_BOTH_SIDES;
    row->build_ms = s->build_ms;
    row->index_bytes = s->index_bytes;
    row->figures = s->figures;
    row->indices_built = s->indices_built;
}

// What pictures take, for those who look at several strategies' together.
static void find_picture_bytes(run *b, uint32_t k)
{
    for (uint32_t v = b->range.first; v < b->range.end; ++v) {
        const uint64_t bytes = records_counted(b->out->records, k, v)->picture_bytes;
        if (bytes > b->out->rows[k].picture_bytes) b->out->rows[k].picture_bytes = bytes;
    }
}

// Whether a strategy that swaps shows pictures it knows only when it has had the chains that do, which a shard's views may not come to.
static result have_all_chains(run *b, uint32_t k)
{
    const bench_strategy_request *s = &b->q->strategies[k];
    const uint64_t every = s->swap_views, views = b->q->path->count;
    result done = RESULT_OK;
    for (uint64_t turn = 0; b->q->shard.count && every && turn < s->set_count && turn * every < views && done == RESULT_OK; ++turn)
        done = strategy_turn(&b->strategies[k], (uint32_t)(turn * every), b->r);
    return done;
}

static result look_at_pictures(run *b)
{
    result done = RESULT_OK;
    for (uint32_t k = 0; k < b->q->strategy_count; ++k) find_picture_bytes(b, k);
    for (uint32_t k = 0; k < b->q->strategy_count && done == RESULT_OK; ++k) done = have_all_chains(b, k);
    if (done != RESULT_OK) return done;
    return pictures_run(&(pictures_request){b->q, b->strategies, b->out->rows, b->out->records, &b->motion, b->g}, &b->bar, b->r);
}

static result finish(run *b)
{
    result done = RESULT_OK;
    for (uint32_t k = 0; k < b->q->strategy_count && done == RESULT_OK; ++k) {
        done = strategy_ask_figures(&b->strategies[k], b->r);
        fill_facts(&b->strategies[k], &b->out->rows[k]);
    }
    b->out->plugins_opened = loader_libraries_open(b->q->plugins);
    if (done == RESULT_OK && b->q->shard.count) return part_write(b->q, b->out, b->r);
    if (done == RESULT_OK && records_fill(b->out->records, b->q, b->out) != RESULT_OK) return report_no_memory(b->r, NULL);
    for (uint32_t k = 0; k < b->q->strategy_count && done == RESULT_OK && b->q->images; ++k)
        done = bench_images(&b->strategies[k], truth_of(b, k), &b->out->rows[k], b->r);
    return done;
}

static result run_all(run *b)
{
    result done = motion_open(b->q->scene, b->q->doors, b->q->services->memory, &b->motion);
    done = done == RESULT_OK ? open_strategies(b) : report_no_memory(b->r, NULL);
    if (done == RESULT_OK && needs_renderer(b)) done = open_renderer(b);
    if (done == RESULT_OK) done = resume_open(b->q, b->out, b->range, b->r, &b->resume);
    const int pictures = done == RESULT_OK && wants_pictures(b);
    b->bar = progress_start((uint64_t)(b->range.end - b->range.first) * truths_needed(b) +
                            b->range.end * ((uint64_t)records_passes(b->q) * b->q->strategy_count + (uint64_t)pictures));
    if (done == RESULT_OK && b->q->truth == BENCH_TRUTH) done = find_truths(b);
    if (done == RESULT_OK) done = run_passes(b);
    if (done == RESULT_OK && pictures) done = look_at_pictures(b);
    for (uint32_t k = 0; k < b->q->strategy_count && done == RESULT_OK && b->q->trace; ++k) done = trace_strategy(b->q->trace, &b->strategies[k], b->r);
    if (done == RESULT_OK && b->g && renderer_errors(b->g))
        done = report_error(b->r, NULL, 0, "%u OpenGL errors; the figures are not to be trusted", renderer_errors(b->g));
    if (done == RESULT_OK) done = finish(b);
    progress_end(&b->bar);
    resume_close(&b->resume, done);
    return done;
}

result bench_run(const bench_request *q, report *r, bench_result *out)
{
    const allocator *memory = q->services->memory;
    run b = {.q = q, .r = r, .out = out, .range = shard_range(&q->shard, q->path->count)};
    *out = (bench_result){.memory = memory};
    result done = open_result(&b);
    b.strategies = memory_alloc_zeroed(memory, q->strategy_count, sizeof *b.strategies);
    b.mixed = memory_alloc_zeroed(memory, q->strategy_count, sizeof *b.mixed);
    if (done == RESULT_OK) done = b.strategies && b.mixed ? run_all(&b) : report_no_memory(r, NULL);
    for (uint32_t k = 0; b.strategies && k < q->strategy_count; ++k) strategy_close(&b.strategies[k]);
    for (uint32_t k = 0; b.mixed && k < q->strategy_count; ++k) truth_close(&b.mixed[k]);
    for (walls w = 0; w < WALLS_MIXED; ++w) truth_close(&b.truths[w]);
    motion_close(&b.motion);
    renderer_close(b.g);
    memory_free(memory, b.strategies, q->strategy_count, sizeof *b.strategies);
    memory_free(memory, b.mixed, q->strategy_count, sizeof *b.mixed);
    if (done != RESULT_OK) bench_result_free(out);
    return done;
}

uint32_t bench_check_failed(const bench_row *row)
{
    return row->picture_differs || row->broken_items;
}
