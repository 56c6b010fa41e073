// Pictures of strategies beside full geometry: see pictures.h.
// SPDX-License-Identifier: MIT
// Invariant: the strategies of a group see the same view before any sees the next, each through its own world, layout and slots.
// What is drawn here a worker compares, one picture behind.
#include "pictures_parts.h"

#include "images.h"

#include <string.h>

int pictures_wanted(const bench_request *q, const strategy *s)
{
    if (q->pictures == BENCH_PICTURES_NONE) return 0;
    return q->pictures == BENCH_PICTURES_ALL || (s->has_pictures && q->truth == BENCH_TRUTH);
}

// ---- Opening ----

static result open_layout(pictures *p)
{
    const scene *s = p->q->bench->scene;
    p->items = memory_alloc(p->memory, s->item_count, sizeof *p->items);
    if (!p->items) return report_no_memory(p->r, NULL);
    for (uint32_t i = 0; i < s->item_count; ++i) p->items[i] = i;
    const render_layout_zone all = {p->items, s->item_count};
    return render_layout_open(p->q->g, &all, 1, p->r, &p->layout);
}

static int open_sums(pictures *p, uint32_t k)
{
    const bench_request *q = p->q->bench;
    picture_sums *s = &p->sums[k];
    if (!pictures_wanted(q, &p->q->strategies[k])) return 1;
    s->before = memory_alloc(p->memory, p->pixels, 4);
    if (!s->before) return 0;
    if (!q->images) return 1;
    s->worst = (worst_view){memory_alloc_zeroed(p->memory, p->pixels, 4), memory_alloc_zeroed(p->memory, p->pixels, 4),
                            memory_alloc_zeroed(p->memory, p->pixels, 4)};
    return s->worst.truth && s->worst.shown && s->worst.heat;
}

static int wants_fronts(const pictures *p)
{
    for (uint32_t k = 0; k < p->q->bench->strategy_count; ++k)
        if (p->sums[k].before && p->q->strategies[k].walls != WALLS_BOTH_SIDES) return 1;
    return 0;
}

static int open_picture(const pictures *p, picture *out)
{
    *out = (picture){memory_alloc(p->memory, p->pixels, 4), memory_alloc(p->memory, p->pixels, sizeof(float))};
    return out->rgba && out->depths;
}

static int open_rings(pictures *p)
{
    const int has_movers = p->q->bench->scene->mover_count > 0, has_fronts = wants_fronts(p);
    for (int i = 0; i < PICTURES_JOBS; ++i)
        if (!open_picture(p, &p->jobs[i].shown)) return 0;
    for (int i = 0; i < PICTURES_TRUTHS; ++i) {
        truth_picture *t = &p->truths[i];
        if (!open_picture(p, &t->all)) return 0;
        if (has_movers) t->movers = memory_alloc(p->memory, p->pixels, sizeof *t->movers);
        if (has_fronts) t->fronts = memory_alloc(p->memory, p->pixels, sizeof *t->fronts);
        if ((has_movers && !t->movers) || (has_fronts && !t->fronts)) return 0;
    }
    return 1;
}

static int open_metrics(pictures *p)
{
    const bench_request *q = p->q->bench;
    const flip_request of_flip = {q->width_px, q->height_px, FLIP_PIXELS_PER_DEGREE};
    const int has_window = q->width_px >= SSIM_WINDOW_PX && q->height_px >= SSIM_WINDOW_PX;
    p->flip = flip_open(&of_flip, p->memory);
    if (has_window) p->similarity = similarity_open(&(similarity_size){q->width_px, q->height_px}, p->memory);
    p->map = memory_alloc(p->memory, p->pixels, sizeof *p->map);
    p->marks = memory_alloc(p->memory, p->pixels, 1);
    p->expected = memory_alloc(p->memory, p->pixels, 4);
    p->from = memory_alloc(p->memory, p->pixels, sizeof *p->from);
    return p->flip && (!has_window || p->similarity) && p->map && p->marks && p->expected && p->from;
}

static int open_pictures(pictures *p)
{
    const bench_request *q = p->q->bench;
    p->sums = memory_alloc_zeroed(p->memory, q->strategy_count, sizeof *p->sums);
    if (!p->sums) return 0;
    for (uint32_t k = 0; k < q->strategy_count; ++k)
        if (!open_sums(p, k)) return 0;
    if (!open_rings(p) || !open_metrics(p)) return 0;
    p->worker = worker_open(&(worker_request){pictures_compare, p}, p->memory);
    return p->worker != NULL;
}

static void close_picture(const pictures *p, picture *s)
{
    memory_free(p->memory, s->rgba, p->pixels, 4);
    memory_free(p->memory, s->depths, p->pixels, sizeof(float));
}

static void close_sums(const pictures *p, picture_sums *s)
{
    memory_free(p->memory, s->before, p->pixels, 4);
    memory_free(p->memory, s->worst.truth, p->pixels, 4);
    memory_free(p->memory, s->worst.shown, p->pixels, 4);
    memory_free(p->memory, s->worst.heat, p->pixels, 4);
}

static void close_all(pictures *p)
{
    const bench_request *q = p->q->bench;
    worker_close(p->worker);
    for (uint32_t k = 0; p->sums && k < q->strategy_count; ++k) close_sums(p, &p->sums[k]);
    memory_free(p->memory, p->sums, q->strategy_count, sizeof *p->sums);
    for (int i = 0; i < PICTURES_JOBS; ++i) close_picture(p, &p->jobs[i].shown);
    for (int i = 0; i < PICTURES_TRUTHS; ++i) {
        close_picture(p, &p->truths[i].all);
        memory_free(p->memory, p->truths[i].fronts, p->pixels, sizeof(float));
        memory_free(p->memory, p->truths[i].movers, p->pixels, sizeof(float));
    }
    memory_free(p->memory, p->map, p->pixels, sizeof *p->map);
    memory_free(p->memory, p->marks, p->pixels, 1);
    memory_free(p->memory, p->expected, p->pixels, 4);
    memory_free(p->memory, p->from, p->pixels, sizeof *p->from);
    flip_close(p->flip);
    similarity_close(p->similarity);
    render_layout_close(p->layout);
    memory_free(p->memory, p->items, q->scene->item_count, sizeof *p->items);
}

// ---- One view ----

typedef enum drawn_parts { DRAW_ALL, DRAW_FRONTS, DRAW_MOVERS } drawn_parts;

static result draw(pictures *p, uint32_t view, drawn_parts parts)
{
    const bench_request *q = p->q->bench;
    const frame_request frame = {.camera = &q->path->cameras[view], .width_px = q->width_px, .height_px = q->height_px,
                                 .faces = parts == DRAW_FRONTS ? FACES_FRONT : FACES_ALL};
    const cull_run all = {0, parts == DRAW_MOVERS ? 0 : q->scene->item_count};
    const result begun = renderer_begin(p->q->g, &frame, p->r);
    if (begun != RESULT_OK) return begun;
    if (all.count) renderer_draw(p->q->g, p->layout, 0, &all, 1);
    for (uint32_t m = 0; m < q->scene->mover_count; ++m) renderer_draw_movers(p->q->g, p->layout, &m, 1);
    renderer_end(p->q->g);
    return RESULT_OK;
}

static result read_picture(pictures *p, picture *out)
{
    const result done = renderer_read(p->q->g, out->rgba, p->r);
    return done == RESULT_OK ? renderer_read_depths(p->q->g, out->depths, p->r) : done;
}

static truth_picture *truth_of(pictures *p, uint32_t view)
{
    return &p->truths[view % PICTURES_TRUTHS];
}

static result draw_truth(pictures *p, uint32_t view)
{
    truth_picture *t = truth_of(p, view);
    result done = RESULT_OK;
    worker_wait(p->worker, t->job);
    t->camera = &p->q->bench->path->cameras[view];
    motion_show(p->q->motion, view, p->q->g);
    if (t->fronts) done = draw(p, view, DRAW_FRONTS);
    if (t->fronts && done == RESULT_OK) done = renderer_read_depths(p->q->g, t->fronts, p->r);
    if (t->movers && done == RESULT_OK) done = draw(p, view, DRAW_MOVERS);
    if (t->movers && done == RESULT_OK) done = renderer_read_depths(p->q->g, t->movers, p->r);
    if (done == RESULT_OK) done = draw(p, view, DRAW_ALL);
    return done == RESULT_OK ? read_picture(p, &t->all) : done;
}

// The worker compares while the next is drawn.
static void give(pictures *p, picture_job *j, uint32_t view, uint32_t k)
{
    truth_picture *now = truth_of(p, view), *before = view > 0 ? truth_of(p, view - 1) : NULL;
    if (strategy_input(&p->q->strategies[k], view).frame.flags & CULL_VIEW_CUT) before = NULL;
    j->now = now;
    j->before = before;
    j->view = view;
    j->strategy = k;
    p->given = worker_give(p->worker);
    now->job = p->given;
    if (before) before->job = p->given;
}

static result run_view(pictures *p, uint32_t view, uint32_t k)
{
    const records *kept = p->q->records;
    const uint64_t swaps = p->q->strategies[k].times.swaps;
    const strategy_request request = {.view = view, .mode = RENDER_SHADED, .marks = MARK_NOTHING};
    strategy_view out;
    const result done = strategy_run_view(&p->q->strategies[k], &request, p->r, &out);
    if (done != RESULT_OK || view < kept->first) return done;
    picture_record *record = records_picture(kept, k, view); // the worker writes other members
    record->faults = out.faults;
    record->swaps = p->q->strategies[k].times.swaps - swaps;
    return RESULT_OK;
}

static result look_at(pictures *p, uint32_t view, uint32_t k)
{
    picture_job *j = &p->jobs[(p->given + 1) % PICTURES_JOBS];
    result done = run_view(p, view, k);
    worker_wait(p->worker, p->given + 1 > PICTURES_JOBS ? p->given + 1 - PICTURES_JOBS : 0);
    if (done == RESULT_OK) done = read_picture(p, &j->shown);
    if (done == RESULT_OK) give(p, j, view, k);
    return done;
}

// Slots of several strategies are filled at once here, as nowhere else: only of so many as one machine has memory for.
static const uint64_t TOGETHER_BYTES = 1u << 30;

static uint32_t group_end(const pictures *p, uint32_t first)
{
    uint64_t bytes = p->q->rows[first].picture_bytes;
    uint32_t end = first + 1;
    for (; end < p->q->bench->strategy_count && bytes + p->q->rows[end].picture_bytes <= TOGETHER_BYTES; ++end) bytes += p->q->rows[end].picture_bytes;
    return end;
}

static int wants_any(const pictures *p, uint32_t first, uint32_t end)
{
    for (uint32_t k = first; k < end; ++k)
        if (p->sums[k].before) return 1;
    return 0;
}

// The view before the records' is looked at for what pops up after it; those before that are only shown.
static result look_at_view(pictures *p, uint32_t view, uint32_t first, uint32_t end)
{
    const int is_compared = view + 1 >= p->q->records->first;
    result done = is_compared ? draw_truth(p, view) : RESULT_OK;
    for (uint32_t k = first; k < end && done == RESULT_OK; ++k)
        if (p->sums[k].before) done = is_compared ? look_at(p, view, k) : run_view(p, view, k);
    return done;
}

static result look_at_group(pictures *p, uint32_t first, uint32_t end, progress *bar)
{
    const records *kept = p->q->records;
    result done = RESULT_OK;
    for (uint32_t k = first; k < end && done == RESULT_OK; ++k) { // a restart forgets the pictures of all
        if (!p->sums[k].before) continue;
        kept->has_pictures[k] = 1;
        done = strategy_turn(&p->q->strategies[k], p->q->bench->path->count - 1, p->r);
        if (done == RESULT_OK) done = strategy_restart(&p->q->strategies[k], p->r);
    }
    for (uint32_t v = 0; v < kept->first + kept->count && done == RESULT_OK; ++v) {
        if (first == 0) progress_tell(bar, "pictures");
        done = look_at_view(p, v, first, end);
    }
    return done;
}

static result look_at_all(pictures *p, progress *bar)
{
    result done = RESULT_OK;
    for (uint32_t first = 0, end; first < p->q->bench->strategy_count && done == RESULT_OK; first = end) {
        end = group_end(p, first);
        if (wants_any(p, first, end)) done = look_at_group(p, first, end, bar);
    }
    worker_wait(p->worker, p->given);
    return done;
}

// ---- Results ----

static result write_worst(const pictures *p, const picture_sums *s, const char *name)
{
    const image_name names[] = {{name, "truth", s->flip_view}, {name, "shown", s->flip_view}, {name, "flip", s->flip_view}};
    const uint8_t *const pictures_of[] = {s->worst.truth, s->worst.shown, s->worst.heat};
    result done = RESULT_OK;
    for (int i = 0; i < 3 && done == RESULT_OK; ++i) done = image_write(p->q->bench, &names[i], pictures_of[i], p->r);
    return done;
}

result pictures_run(const pictures_request *q, progress *bar, report *r)
{
    pictures p = {.q = q, .r = r, .memory = q->bench->services->memory, .pixels = (size_t)q->bench->width_px * q->bench->height_px};
    result done = open_pictures(&p) ? open_layout(&p) : report_no_memory(r, NULL);
    if (done == RESULT_OK) done = look_at_all(&p, bar);
    for (uint32_t k = 0; k < q->bench->strategy_count && done == RESULT_OK; ++k)
        if (p.sums[k].worst.heat && p.sums[k].flip_max > 0) done = write_worst(&p, &p.sums[k], q->rows[k].name);
    close_all(&p);
    return done;
}
