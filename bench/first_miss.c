// The first wrong pixel: see first_miss.h. One walk finds it; walks from ever farther back find the shortest that shows it again.
// SPDX-License-Identifier: MIT
// Invariant: what is explained and pictured is the very frame that missed, with the history that it had.
#include "first_miss.h"
#include "first_miss_picture.h"
#include "progress.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct hunt {
    const bench_request *q;
    report *r;
    renderer *g;
    strategy s;
    truth t;
    uint8_t *drawn, *whole, *missed; // drawn: of the view at hand
    first_miss *out;
    progress bar;
} hunt;

static size_t pixels_of(const bench_request *q)
{
    return (size_t)q->width_px * q->height_px;
}

static result open_hunt(hunt *h)
{
    const bench_request *q = h->q;
    const allocator *memory = q->services->memory;
    const renderer_options of_gl = {.target = RENDERER_HEADLESS, .width_px = q->width_px, .height_px = q->height_px};
    h->drawn = memory_alloc_zeroed(memory, pixels_of(q), 4);
    h->whole = memory_alloc_zeroed(memory, pixels_of(q), 4);
    h->missed = memory_alloc_zeroed(memory, pixels_of(q), 1);
    if (!h->drawn || !h->whole || !h->missed) return report_no_memory(h->r, NULL);
    result done = strategy_open(q, q->strategies, NULL, h->r, &h->s);
    if (done == RESULT_OK) done = renderer_open(&of_gl, memory, h->r, &h->g);
    if (done == RESULT_OK) done = renderer_upload(h->g, q->scene, h->r);
    if (done == RESULT_OK) done = strategy_attach(&h->s, h->g, h->r);
    if (done != RESULT_OK) return done;
    renderer_query_latency(h->g, q->query_latency);
    done = renderer_reserve(h->g, strategy_tests(&h->s), h->r);
    const truth_request of_truth = {q->scene, q->width_px, q->height_px, h->s.walls};
    return done == RESULT_OK ? truth_open(&of_truth, memory, h->r, &h->t) : done;
}

static void close_hunt(hunt *h)
{
    const allocator *memory = h->q->services->memory;
    truth_close(&h->t);
    strategy_close(&h->s);
    renderer_close(h->g);
    memory_free(memory, h->drawn, pixels_of(h->q), 4);
    memory_free(memory, h->whole, pixels_of(h->q), 4);
    memory_free(memory, h->missed, pixels_of(h->q), 1);
}

// ---- One view ----

static int is_drawn(const hunt *h, uint32_t item)
{
    return h->s.drawn_bits[item / 32] >> (item % 32) & 1;
}

static result run_view(hunt *h, uint32_t view)
{
    strategy_view out;
    const strategy_request request = {.view = view, .mode = RENDER_SHADED, .marks = MARK_DRAWN};
    return strategy_run_view(&h->s, &request, h->r, &out);
}

// The truth of that view alone, into h->t; its picture stays there.
static result find_truth(hunt *h, uint32_t view)
{
    h->t.items.count = h->t.views.count = 0;
    const result done = strategy_judge(&h->s, view, h->r, &h->t);
    return done == RESULT_OK ? truth_add_view(&h->t, h->g, &h->q->path->cameras[view], h->r) : done;
}

static uint32_t owner_at(const hunt *h, size_t i)
{
    const uint32_t triangle = h->t.picture.triangles[i];
    return triangle && triangle <= h->t.triangle_count ? h->t.polygon_item[h->t.triangle_polygon[triangle - 1]] : SCENE_NONE;
}

// In reading order. Marks all, keeps the first.
static void find_pixel(hunt *h)
{
    const uint32_t width = h->q->width_px, height = h->q->height_px;
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            const uint32_t item = owner_at(h, (size_t)(height - 1 - y) * width + x); // bottom row first
            const int is_missed = item != SCENE_NONE && !is_drawn(h, item);
            h->missed[(size_t)y * width + x] = (uint8_t)is_missed;
            if (!is_missed || h->out->kind == MISS_PIXEL) continue;
            h->out->kind = MISS_PIXEL;
            h->out->item = item;
            h->out->x_px = x;
            h->out->y_px = y;
        }
}

static uint32_t pixel_of(double clip, double w, uint32_t size)
{
    const double at = (clip / w * 0.5 + 0.5) * size;
    return at > 0 ? at < size ? (uint32_t)at : size - 1 : 0;
}

// Where the middle of the item's box is seen; the picture's middle where it lies behind the eye.
static void place_box(hunt *h, uint32_t view)
{
    const scene *s = h->q->scene;
    const camera *c = &h->q->path->cameras[view];
    const uint32_t i = h->out->item;
    const double middle[3] = {((double)s->boxes.min_x[i] + (double)s->boxes.max_x[i]) / 2, ((double)s->boxes.min_y[i] + (double)s->boxes.max_y[i]) / 2,
                              ((double)s->boxes.min_z[i] + (double)s->boxes.max_z[i]) / 2};
    double m[16], clip[4];
    camera_clip_from_eye(c, m);
    for (int row = 0; row < 4; ++row) {
        clip[row] = m[12 + row];
        for (int k = 0; k < 3; ++k) clip[row] += m[4 * k + row] * (middle[k] + s->whole.origin[k] - c->eye[k]);
    }
    const int is_before = clip[3] > 0;
    h->out->x_px = is_before ? pixel_of(clip[0], clip[3], h->q->width_px) : h->q->width_px / 2;
    h->out->y_px = is_before ? pixel_of(-clip[1], clip[3], h->q->height_px) : h->q->height_px / 2;
}

static void find_spot(hunt *h, uint32_t view)
{
    const truth_view *v = h->t.views.items;
    const truth_item *items = (const truth_item *)h->t.items.items + v->first;
    find_pixel(h);
    for (uint32_t i = 0; i < v->count && h->out->kind == MISS_NONE; ++i)
        if (!is_drawn(h, items[i].item)) {
            h->out->kind = MISS_NO_PIXEL;
            h->out->item = items[i].item;
            place_box(h, view);
        }
    for (uint32_t i = 0; i < v->count; ++i)
        if (items[i].item == h->out->item) h->out->item_pixels = items[i].pixels;
}

static result explain_miss(hunt *h, uint32_t view)
{
    const frame_input input = strategy_input(&h->s, view);
    const explain_request request = {&input, h->out->item};
    h->out->why_size = world_explain(h->s.view, &request, NULL, 0) + 1;
    h->out->why = memory_alloc_zeroed(h->q->services->memory, h->out->why_size, 1);
    if (!h->out->why) return report_no_memory(h->r, NULL);
    world_explain(h->s.view, &request, h->out->why, h->out->why_size);
    return RESULT_OK;
}

// ---- The picture ----

// Movers stand where the view had them.
static result draw_whole(hunt *h, uint32_t view)
{
    const bench_request *q = h->q;
    const allocator *memory = q->services->memory;
    const uint32_t count = q->scene->item_count;
    const frame_request frame = {.camera = &q->path->cameras[view], .width_px = q->width_px, .height_px = q->height_px, .mode = RENDER_SHADED};
    const cull_run all = {0, count};
    render_layout *layout = NULL;
    uint32_t *items = memory_alloc(memory, count, sizeof *items);
    if (!items) return report_no_memory(h->r, NULL);
    for (uint32_t i = 0; i < count; ++i) items[i] = i;
    result done = render_layout_open(h->g, &(render_layout_zone){items, count}, 1, h->r, &layout);
    if (done == RESULT_OK) done = renderer_begin(h->g, &frame, h->r);
    if (done == RESULT_OK) {
        if (count) renderer_draw(h->g, layout, 0, &all, 1);
        for (uint32_t m = 0; m < q->scene->mover_count; ++m) renderer_draw_movers(h->g, layout, &m, 1);
        renderer_end(h->g);
        done = renderer_read(h->g, h->whole, h->r);
    }
    render_layout_close(layout);
    memory_free(memory, items, count, sizeof *items);
    return done;
}

static result draw_picture(hunt *h, uint32_t view)
{
    const result done = draw_whole(h, view);
    if (done != RESULT_OK) return done;
    h->out->rgba = memory_alloc(h->q->services->memory, pixels_of(h->q), 4);
    if (!h->out->rgba) return report_no_memory(h->r, NULL);
    const miss_picture picture = {h->q->width_px, h->q->height_px, h->out->x_px, h->out->y_px, h->drawn, h->whole, h->missed};
    miss_picture_draw(&picture, h->out->rgba);
    return RESULT_OK;
}

// ---- The walks ----

static result note_miss(hunt *h, uint32_t view)
{
    const view_misses m = strategy_misses(&h->s, &h->t, 0);
    const truth_view *v = h->t.views.items;
    h->out->views_looked_at++;
    h->out->views_blind += v->count == 0;
    if (!m.items) return RESULT_OK;
    h->out->view = view;
    h->out->pixels = m.pixels;
    h->out->items = m.items;
    h->out->broken = m.broken;
    find_spot(h, view);
    const result done = explain_miss(h, view);
    return done == RESULT_OK ? draw_picture(h, view) : done;
}

static result walk(hunt *h, uint32_t from)
{
    result done = strategy_restart(&h->s, h->r);
    for (uint32_t v = from; v < h->q->path->count && done == RESULT_OK && h->out->kind == MISS_NONE; ++v) {
        progress_tell(&h->bar, "views");
        done = run_view(h, v);
        if (done == RESULT_OK) done = renderer_read(h->g, h->drawn, h->r); // before the truth is drawn over it
        if (done == RESULT_OK) done = find_truth(h, v);
        if (done == RESULT_OK) done = note_miss(h, v);
    }
    return done;
}

static result walk_again(hunt *h, uint32_t from, int *out_missed)
{
    result done = strategy_restart(&h->s, h->r);
    for (uint32_t v = from; v <= h->out->view && done == RESULT_OK; ++v) done = run_view(h, v);
    *out_missed = done == RESULT_OK && !is_drawn(h, h->out->item);
    return done;
}

// Twice as far back each time: no history, one view, three, seven ... all of it.
static result shorten(hunt *h, uint32_t first)
{
    int is_missed = 0;
    for (uint64_t back = 0;; back = 2 * back + 1) {
        const uint32_t view = h->out->view, from = view - first > back ? view - (uint32_t)back : first;
        const result done = walk_again(h, from, &is_missed);
        if (done != RESULT_OK) return done;
        h->out->from = from;
        if (is_missed || from == first) break;
    }
    h->out->repeats = is_missed ? MISS_REPEATS : MISS_REPEATS_NOT;
    return RESULT_OK;
}

result first_miss_find(const bench_request *q, uint32_t from, report *r, first_miss *out)
{
    *out = (first_miss){0};
    hunt h = {.q = q, .r = r, .out = out, .bar = progress_start(q->path->count - from)};
    result done = open_hunt(&h);
    if (done == RESULT_OK) done = walk(&h, from);
    progress_end(&h.bar);
    if (done == RESULT_OK && out->kind != MISS_NONE) done = shorten(&h, from);
    if (done == RESULT_OK && renderer_errors(h.g)) {
        report_error(r, NULL, 0, "%u OpenGL errors, told above; what was drawn is not to be trusted: try another driver", renderer_errors(h.g));
        done = RESULT_NO_GL;
    }
    close_hunt(&h);
    if (done != RESULT_OK) first_miss_free(q, out);
    return done;
}

void first_miss_free(const bench_request *q, first_miss *m)
{
    memory_free(q->services->memory, m->why, m->why_size, 1);
    memory_free(q->services->memory, m->rgba, pixels_of(q), 4);
    *m = (first_miss){0};
}
