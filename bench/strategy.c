// Strategies: runs one chain over one view and keeps what it drew.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "strategy.h"

#include <math.h>
#include <string.h>
#include <time.h>

static double cpu_ns(clockid_t clock)
{
    struct timespec t;
    clock_gettime(clock, &t);
    return (double)t.tv_sec * 1e9 + (double)t.tv_nsec;
}

// ---- Driver: the renderer behind the frame ----

static void drive_draw(void *user, const cull_run *runs, uint32_t count)
{
    strategy *s = user;
    renderer_draw(s->g, s->layout, runs, count);
}

// The global id at a place of the chain's order; movers stand behind the items in both.
static uint32_t item_at(const strategy *s, uint32_t place)
{
    return place < s->q->scene->item_count && s->order ? s->order[place] : place;
}

static void mark_run_in(const strategy *s, cull_run run, uint32_t *bits)
{
    for (uint32_t p = run.first; p < run.first + run.count; ++p) {
        const uint32_t item = item_at(s, p);
        bits[item / 32] |= 1u << (item % 32);
    }
}

// What a picture holds is what was captured into it, not what the culler says later.
static void note_capture(strategy *s, const cull_capture *c)
{
    uint32_t *bits = s->slot_bits + (size_t)c->slot * s->words;
    memset(bits, 0, s->words * sizeof *bits);
    for (uint32_t i = 0; i < c->run_count; ++i) mark_run_in(s, c->runs[i], bits);
    for (uint32_t i = 0; i < c->slot_count; ++i)
        for (uint32_t w = 0; w < s->words; ++w) bits[w] |= s->slot_bits[(size_t)c->slots[i] * s->words + w];
}

static void note_picture(strategy *s, const cull_picture *p)
{
    const uint32_t *held = s->slot_bits + (size_t)p->slot * s->words;
    uint32_t missing = 0;
    for (uint32_t k = 0; k < p->run_count; ++k)
        for (uint32_t at = p->runs[k].first; at < p->runs[k].first + p->runs[k].count; ++at) {
            const uint32_t item = item_at(s, at), bit = held[item / 32] & 1u << (item % 32);
            s->drawn_bits[item / 32] |= bit; // in D, though only in a picture
            missing |= bit == 0;
        }
    s->picture_faults += missing;
}

static void drive_capture(void *user, const cull_capture *captures, uint32_t count)
{
    strategy *s = user;
    for (uint32_t i = 0; i < count; ++i) {
        renderer_capture(s->g, s->layout, &captures[i]);
        note_capture(s, &captures[i]);
    }
}

static void drive_show(void *user, const cull_picture *pictures, uint32_t count)
{
    strategy *s = user;
    for (uint32_t i = 0; i < count; ++i) {
        renderer_show(s->g, &pictures[i]);
        if (s->marks == MARK_DRAWN) note_picture(s, &pictures[i]);
    }
}

static void drive_test(void *user, const cull_test *tests, uint32_t count, uint32_t frame)
{
    strategy *s = user;
    renderer_test(s->g, tests, count, frame);
}

static uint32_t drive_collect(void *user, collect_how how, uint32_t frame, cull_answer *answers, uint32_t capacity, uint32_t *stalled)
{
    strategy *s = user;
    return renderer_collect(s->g, how == COLLECT_EVERYTHING ? COLLECT_ALL : COLLECT_READY, frame, answers, capacity, stalled);
}

static frame_driver driver_of(strategy *s)
{
    if (!s->g) return (frame_driver){0};
    return (frame_driver){s, drive_draw, drive_capture, drive_show, drive_test, drive_collect};
}

// ---- Opening ----

static int open_arrays(strategy *s)
{
    const allocator *memory = s->q->services->memory;
    const scene *sc = s->q->scene;
    const size_t samples = (size_t)s->q->repeat * s->q->path->count;
    s->words = (sc->item_count + sc->mover_count + 31) / 32;
    s->drawn_bits = memory_alloc_zeroed(memory, s->words, sizeof(uint32_t));
    s->cull_ns = memory_alloc_zeroed(memory, samples, sizeof(double));
    s->gl_ms = memory_alloc_zeroed(memory, samples, sizeof(double));
    s->missed = memory_alloc_zeroed(memory, s->q->path->count, sizeof(uint64_t));
    if (!s->drawn_bits || !s->cull_ns || !s->gl_ms || !s->missed) return 0;
    for (uint32_t i = 0; i < s->chain->stage_count; ++i)
        if (s->chain->stages[i].built.slot_count > s->slot_count) s->slot_count = s->chain->stages[i].built.slot_count;
    if (s->slot_count) {
        s->slot_bits = memory_alloc_zeroed(memory, (size_t)s->slot_count * s->words, sizeof(uint32_t));
        if (!s->slot_bits) return 0;
    }
    if (s->chain->order) {
        s->order_count = sc->item_count + RUNS_OVERWRITE;
        s->order = memory_alloc_zeroed(memory, s->order_count, sizeof(uint32_t));
        if (!s->order) return 0;
        memcpy(s->order, s->chain->order, sc->item_count * sizeof(uint32_t));
    }
    if (s->q->ids == BENCH_IDS) {
        s->ids = memory_alloc_zeroed(memory, (size_t)sc->item_count + RUNS_OVERWRITE, sizeof(uint32_t));
        if (!s->ids) return 0;
    }
    return 1;
}

result strategy_open(const bench_request *q, const chain_spec *spec, renderer *g, report *r, strategy *out)
{
    *out = (strategy){.q = q, .g = g, .kernel = runs_kernel_best()};
    const chain_request build = {spec, q->scene, q->plugins, q->services};
    result done = chain_build(&build, r, &out->chain);
    if (done == RESULT_OK) out->walls = walls_of_chain(out->chain, spec);
    if (done == RESULT_OK) done = viewer_open(out->chain, q->services, VIEWER_CHECK_BOUNDS, r, &out->viewer);
    if (done == RESULT_OK && !open_arrays(out)) done = report_no_memory(r, q->scene->path);
    if (done == RESULT_OK && g) done = render_layout_open(g, out->chain->order, r, &out->layout);
    if (done != RESULT_OK) strategy_close(out);
    return done;
}

result strategy_restart(strategy *s, report *r)
{
    viewer_close(s->viewer);
    s->viewer = NULL;
    if (s->g) {
        renderer_forget_tests(s->g);
        renderer_forget_pictures(s->g);
    }
    return viewer_open(s->chain, s->q->services, VIEWER_CHECK_BOUNDS, r, &s->viewer);
}

void strategy_close(strategy *s)
{
    if (!s->q) return;
    const allocator *memory = s->q->services->memory;
    const size_t samples = (size_t)s->q->repeat * s->q->path->count;
    render_layout_close(s->layout);
    viewer_close(s->viewer);
    chain_close(s->chain);
    memory_free(memory, s->drawn_bits, s->words, sizeof(uint32_t));
    memory_free(memory, s->slot_bits, (size_t)s->slot_count * s->words, sizeof(uint32_t));
    memory_free(memory, s->order, s->order_count, sizeof(uint32_t));
    memory_free(memory, s->ids, (size_t)s->q->scene->item_count + RUNS_OVERWRITE, sizeof(uint32_t));
    memory_free(memory, s->cull_ns, samples, sizeof(double));
    memory_free(memory, s->gl_ms, samples, sizeof(double));
    memory_free(memory, s->missed, s->q->path->count, sizeof(uint64_t));
    *s = (strategy){0};
}

// ---- One view ----

static void write_ids(strategy *s, strategy_view *v)
{
    const double start = cpu_ns(CLOCK_THREAD_CPUTIME_ID);
    s->kernel->expand(v->set.runs, v->set.run_count, s->order, s->ids);
    const double ns = cpu_ns(CLOCK_THREAD_CPUTIME_ID) - start - frame_clock_overhead_ns(s->viewer);
    if (ns > 0) v->stats.cull_ns += ns;
}

// A hint for cullers that keep history: ten steps of a smooth path, or an eighth of a turn, between two frames is a jump.
static const double JUMP_M = 3, JUMP_COSINE = 0.7071;

static uint32_t view_flags(const camera_path *path, uint32_t view)
{
    if (view == 0) return CULL_VIEW_CUT;
    const camera *a = &path->cameras[view - 1], *b = &path->cameras[view];
    double moved = 0, along = 0, length_a = 0, length_b = 0;
    for (int k = 0; k < 3; ++k) {
        moved += (b->eye[k] - a->eye[k]) * (b->eye[k] - a->eye[k]);
        along += a->forward[k] * b->forward[k];
        length_a += a->forward[k] * a->forward[k];
        length_b += b->forward[k] * b->forward[k];
    }
    return moved > JUMP_M * JUMP_M || along < JUMP_COSINE * sqrt(length_a) * sqrt(length_b) ? CULL_VIEW_CUT : 0;
}

static void mark_set(strategy *s, const visible_set *set)
{
    for (uint32_t i = 0; i < set->run_count; ++i) mark_run_in(s, set->runs[i], s->drawn_bits);
    for (uint32_t i = 0; i < set->mover_run_count; ++i) mark_run_in(s, set->mover_runs[i], s->drawn_bits);
}

result strategy_run_view(strategy *s, const strategy_request *w, report *r, strategy_view *out)
{
    const bench_request *q = s->q;
    const frame_input input = {.camera = &q->path->cameras[w->view],
                               .frame = {.width_px = q->width_px, .height_px = q->height_px, .frame = w->view + 1, .flags = view_flags(q->path, w->view), .purpose = CULL_VIEW_MAIN},
                               .driver = driver_of(s)};
    if (w->marks == MARK_DRAWN) memset(s->drawn_bits, 0, s->words * sizeof(uint32_t));
    *out = (strategy_view){0};
    s->marks = w->marks;
    s->picture_faults = 0;
    double start = 0;
    if (s->g) {
        const frame_request frame = {.camera = input.camera, .width_px = q->width_px, .height_px = q->height_px, .mode = w->mode};
        start = cpu_ns(CLOCK_PROCESS_CPUTIME_ID);
        const result begun = renderer_begin(s->g, &frame, r);
        if (begun != RESULT_OK) return begun;
    }
    frame_run(s->viewer, &input, &out->set, &out->stats);
    if (s->g) {
        renderer_end(s->g);
        const double ms = (cpu_ns(CLOCK_PROCESS_CPUTIME_ID) - start - out->stats.cull_ns) * 1e-6;
        out->gl_ms = ms > 0 ? ms : 0;
        out->draw_calls = renderer_draw_calls(s->g);
        out->state_changes = renderer_state_changes(s->g);
    }
    if (s->ids) write_ids(s, out);
    if (w->marks == MARK_DRAWN) mark_set(s, &out->set);
    out->faults = out->stats.faults + s->picture_faults;
    return RESULT_OK;
}

view_counts strategy_count(const strategy *s, const visible_set *set)
{
    const scene *sc = s->q->scene;
    view_counts c = {.runs = (uint64_t)set->run_count + set->mover_run_count};
    for (uint32_t w = 0; w < s->words; ++w)
        for (uint32_t bits = s->drawn_bits[w]; bits; bits &= bits - 1) {
            const uint32_t id = w * 32 + (uint32_t)__builtin_ctz(bits);
            c.triangles += sc->items[id].index_count / 3;
            if (id >= sc->item_count) c.mover_polygons += sc->items[id].polygon_count;
            else {
                c.items++;
                c.polygons += sc->items[id].polygon_count;
            }
        }
    return c;
}

view_misses strategy_misses(const strategy *s, const truth *t, uint32_t view)
{
    const truth_view *v = (const truth_view *)t->views.items + view;
    view_misses m = {0};
    if (!v->count) return m; // of a whole path that sees nothing there is no list
    const truth_item *items = (const truth_item *)t->items.items + v->first;
    for (uint32_t i = 0; i < v->count; ++i) {
        if (s->drawn_bits[items[i].item / 32] >> (items[i].item % 32) & 1) continue;
        m.items++;
        m.pixels += items[i].pixels;
    }
    return m;
}
