// Strategies: runs the world of one over one view and keeps what it drew.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "strategy_parts.h"

#include "../host/render/costs.h"

#include <math.h>
#include <string.h>
#include <time.h>

static double process_cpu_ns(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec * 1e9 + (double)t.tv_nsec;
}

// ---- Opening ----

static int open_arrays(strategy *s)
{
    const allocator *memory = s->q->services->memory;
    const scene *sc = s->q->scene;
    s->words = (sc->item_count + sc->mover_count + 31) / 32;
    s->drawn_bits = memory_alloc_zeroed(memory, s->words, sizeof(uint32_t));
    s->picture_bits = memory_alloc_zeroed(memory, s->words, sizeof(uint32_t));
    s->clipped_bits = memory_alloc_zeroed(memory, s->words, sizeof(uint32_t));
    if (!s->drawn_bits || !s->picture_bits || !s->clipped_bits || !blame_open(s)) return 0;
    if (s->q->ids == BENCH_IDS) {
        s->ids = memory_alloc_zeroed(memory, (size_t)sc->item_count + RUNS_OVERWRITE, sizeof(uint32_t));
        if (!s->ids) return 0;
    }
    return motion_open(sc, s->q->doors, memory, &s->motion) == RESULT_OK;
}

static void set_doors(strategy *s)
{
    for (uint32_t d = 0; d < s->q->scene->door_count; ++d)
        if (world_door(s->world, d) != motion_door(&s->motion, d)) world_set_door(s->world, d, motion_door(&s->motion, d));
}

result strategy_open(const bench_request *q, const bench_strategy_request *chains, renderer *g, report *r, strategy *out)
{
    *out = (strategy){.q = q, .chains = chains, .kernel = runs_kernel_best()};
    out->draws = buffer_make(q->services->memory, sizeof(strategy_draw));
    out->draw_runs = buffer_make(q->services->memory, sizeof(cull_run));
    result done = chains_open(out, r);
    if (done == RESULT_OK && !open_arrays(out)) done = report_no_memory(r, q->scene->path);
    if (done == RESULT_OK) {
        set_doors(out);
        done = world_view_open(out->world, VIEWER_CHECK_BOUNDS, r, &out->view);
    }
    if (done == RESULT_OK && g) done = strategy_attach(out, g, r);
    if (done != RESULT_OK) strategy_close(out);
    return done;
}

// What cullers weigh pictures by; measured once a renderer and scene.
static result tell_costs(const strategy *s, report *r)
{
    cull_costs costs = s->q->services->costs;
    result done = s->q->costs == BENCH_COSTS_FIXED ? RESULT_OK : renderer_costs(s->g, r, &costs);
    costs.frame_ns = s->q->frame_ms * 1e6;
    if (done == RESULT_OK) done = render_layout_levels(s->layout, r, &costs);
    if (done == RESULT_OK) host_costs_set(s->q->services, &costs);
    return done;
}

result strategy_attach(strategy *s, renderer *g, report *r)
{
    const allocator *memory = s->q->services->memory;
    const uint32_t zone_count = s->q->scene->zone_count;
    render_layout_zone *zones = memory_alloc(memory, zone_count, sizeof *zones);
    if (!zones) return report_no_memory(r, s->q->scene->path);
    for (uint32_t z = 0; z < zone_count; ++z) zones[z] = (render_layout_zone){s->order + s->zones[z].first, s->zones[z].item_count};
    result done = render_layout_open(g, zones, zone_count, r, &s->layout);
    memory_free(memory, zones, zone_count, sizeof *zones);
    if (done != RESULT_OK) return done;
    s->g = g;
    done = chains_tell_pieces(s, r);
    if (done == RESULT_OK) done = chains_tell_slots(s, r);
    return done == RESULT_OK && s->has_pictures ? tell_costs(s, r) : done;
}

result strategy_restart(strategy *s, report *r)
{
    world_view_close(s->view);
    s->view = NULL;
    if (s->g) {
        renderer_forget_tests(s->g);
        renderer_forget_pictures(s->g);
    }
    return world_view_open(s->world, VIEWER_CHECK_BOUNDS, r, &s->view);
}

result strategy_ask_figures(strategy *s, report *r)
{
    const result done = strategy_restart(s, r);
    if (done == RESULT_OK) chains_figures(s);
    return done;
}

void strategy_close(strategy *s)
{
    if (!s->q) return;
    const allocator *memory = s->q->services->memory;
    render_layout_close(s->layout);
    world_view_close(s->view);
    chains_close(s);
    motion_close(&s->motion);
    scissor_close(&s->scissor);
    blame_close(s);
    buffer_free(&s->draws);
    buffer_free(&s->draw_runs);
    memory_free(memory, s->drawn_bits, s->words, sizeof(uint32_t));
    memory_free(memory, s->picture_bits, s->words, sizeof(uint32_t));
    memory_free(memory, s->clipped_bits, s->words, sizeof(uint32_t));
    memory_free(memory, s->ids, (size_t)s->q->scene->item_count + RUNS_OVERWRITE, sizeof(uint32_t));
    *s = (strategy){0};
}

// ---- One view ----

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

frame_input strategy_input(strategy *s, uint32_t view)
{
    const bench_request *q = s->q;
    return (frame_input){.camera = &q->path->cameras[view],
                         .frame = {.width_px = q->width_px, .height_px = q->height_px, .frame = view + 1, .flags = view_flags(q->path, view),
                                   .purpose = CULL_VIEW_MAIN},
                         .driver = s->between.driver ? s->between.driver(s->between.user, driver_of(s)) : driver_of(s)};
}

static void move_movers(strategy *s, uint32_t view)
{
    if (s->q->scene->mover_count == 0) return;
    const uint64_t before = movers_counts(world_movers(s->world)).moves;
    const double start = thread_cpu_ns();
    world_set_time(s->world, motion_time_s(view));
    const double ns = thread_cpu_ns() - start - world_view_clock_overhead_ns(s->view);
    s->times.mover_ns += ns > 0 ? ns : 0;
    s->times.movers += movers_counts(world_movers(s->world)).moves - before;
    if (s->g) motion_show(&s->motion, view, s->g);
}

static result prepare_view(strategy *s, const strategy_request *w, report *r)
{
    result done = chains_turn(s, w->view, r);
    const int opens_scissor = done == RESULT_OK && w->scissor == SCISSOR_ZONES && !s->scissor.scene;
    if (opens_scissor && scissor_open(s->q->scene, s->q->services->memory, &s->scissor) != RESULT_OK)
        done = report_no_memory(r, s->q->scene->path);
    if (done != RESULT_OK) return done;
    move_movers(s, w->view);
    if (w->marks == MARK_DRAWN) memset(s->drawn_bits, 0, s->words * sizeof(uint32_t));
    if (w->marks == MARK_DRAWN && s->has_pictures) {
        memset(s->picture_bits, 0, s->words * sizeof(uint32_t));
        memset(s->clipped_bits, 0, s->words * sizeof(uint32_t));
    }
    s->again_polygons = s->again_triangles = 0;
    s->marks = w->marks;
    s->records = w->records;
    s->draws.count = s->draw_runs.count = 0;
    s->cut = w->scissor;
    s->cut_is_told = s->repeats = s->picture_faults = s->id_faults = s->record_failed = 0;
    return RESULT_OK;
}

result strategy_run_view(strategy *s, const strategy_request *w, report *r, strategy_view *out)
{
    const frame_input input = strategy_input(s, w->view);
    const result ready = prepare_view(s, w, r);
    if (ready != RESULT_OK) return ready;
    *out = (strategy_view){0};
    double start = 0;
    if (s->g) {
        const frame_request frame = {.camera = input.camera, .width_px = s->q->width_px, .height_px = s->q->height_px, .mode = w->mode,
                                     .scissor = w->scissor};
        renderer_forget_state(s->g); // what was drawn before it is no part of what a view costs
        start = process_cpu_ns();
        const result begun = renderer_begin(s->g, &frame, r);
        if (begun != RESULT_OK) return begun;
    }
    world_cull(s->view, &input, &out->set, &out->stats);
    if (s->g) {
        renderer_end(s->g);
        const double ms = (process_cpu_ns() - start - out->stats.cull_ns) * 1e-6;
        out->gl_ms = ms > 0 ? ms : 0;
        out->draw_calls = renderer_draw_calls(s->g);
        out->state_changes = renderer_state_changes(s->g);
        out->picture_bytes = s->has_pictures ? render_layout_picture_counts(s->layout).bytes_peak : 0;
    }
    if (s->ids) {
        const double ns = set_write_ids(s, &out->set) - world_view_clock_overhead_ns(s->view);
        if (ns > 0) out->stats.cull_ns += ns;
    }
    if (w->marks == MARK_DRAWN) set_mark(s, &out->set);
    out->faults = out->stats.faults + s->repeats + s->picture_faults + s->id_faults;
    return s->record_failed ? report_no_memory(r, s->q->scene->path) : RESULT_OK;
}
