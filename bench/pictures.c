// Pictures of strategies beside full geometry: see pictures.h.
// SPDX-License-Identifier: MIT
// Invariant: the strategies of a group see the same view before any sees the next, each through its own world, layout and slots.
#include "pictures.h"

#include "cracks.h"
#include "images.h"
#include "similarity.h"
#include "statistics.h"

#include <string.h>

typedef struct picture { // top row first; depths: bottom row first
    uint8_t *rgba;
    float *depths;
} picture;

typedef struct worst_view { // copies, where images are wanted: history can't be drawn again
    uint8_t *truth, *shown, *heat;
} worst_view;

typedef struct sums { // of one strategy
    double squared_error, ssim;
    double *flips; // by view that counts
    uint32_t views;
    crack_counts cracks;
    worst_view worst;
} sums;

typedef struct pictures {
    const pictures_request *q;
    report *r;
    const allocator *memory;
    size_t pixels;
    render_layout *layout; // all items, in the scene's order
    uint32_t *items;
    flip *flip;
    similarity *similarity; // NULL: too small a picture for a window
    picture truth, shown;
    float *fronts; // depths of what shows its front; NULL: no strategy is judged by that
    float *movers; // depths of movers alone; NULL: there are none
    float *map;
    uint8_t *marks;
    sums *sums; // by strategy
} pictures;

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
    sums *s = &p->sums[k];
    if (!pictures_wanted(q, &p->q->strategies[k])) return 1;
    s->flips = memory_alloc_zeroed(p->memory, q->path->count, sizeof *s->flips);
    if (!q->images) return s->flips != NULL;
    s->worst = (worst_view){memory_alloc_zeroed(p->memory, p->pixels, 4), memory_alloc_zeroed(p->memory, p->pixels, 4),
                            memory_alloc_zeroed(p->memory, p->pixels, 4)};
    return s->flips && s->worst.truth && s->worst.shown && s->worst.heat;
}

static int wants_fronts(const pictures *p)
{
    for (uint32_t k = 0; k < p->q->bench->strategy_count; ++k)
        if (p->sums[k].flips && p->q->strategies[k].walls != WALLS_BOTH_SIDES) return 1;
    return 0;
}

static int open_pictures(pictures *p)
{
    const bench_request *q = p->q->bench;
    const flip_request of_flip = {q->width_px, q->height_px, FLIP_PIXELS_PER_DEGREE};
    p->sums = memory_alloc_zeroed(p->memory, q->strategy_count, sizeof *p->sums);
    for (uint32_t k = 0; p->sums && k < q->strategy_count; ++k)
        if (!open_sums(p, k)) return 0;
    p->truth = (picture){memory_alloc(p->memory, p->pixels, 4), memory_alloc(p->memory, p->pixels, sizeof(float))};
    p->shown = (picture){memory_alloc(p->memory, p->pixels, 4), memory_alloc(p->memory, p->pixels, sizeof(float))};
    p->map = memory_alloc(p->memory, p->pixels, sizeof *p->map);
    p->marks = memory_alloc(p->memory, p->pixels, 1);
    p->flip = flip_open(&of_flip, p->memory);
    const int has_window = q->width_px >= SSIM_WINDOW_PX && q->height_px >= SSIM_WINDOW_PX;
    if (has_window) p->similarity = similarity_open(&(similarity_size){q->width_px, q->height_px}, p->memory);
    const int has_pictures = p->truth.rgba && p->truth.depths && p->shown.rgba && p->shown.depths && p->map && p->marks;
    if (!p->sums || !has_pictures || !p->flip || (has_window && !p->similarity)) return 0;
    const int has_movers = q->scene->mover_count > 0, has_fronts = wants_fronts(p);
    if (has_movers) p->movers = memory_alloc(p->memory, p->pixels, sizeof *p->movers);
    if (has_fronts) p->fronts = memory_alloc(p->memory, p->pixels, sizeof *p->fronts);
    return (!has_movers || p->movers) && (!has_fronts || p->fronts);
}

static void close_all(pictures *p)
{
    const bench_request *q = p->q->bench;
    for (uint32_t k = 0; p->sums && k < q->strategy_count; ++k) {
        memory_free(p->memory, p->sums[k].flips, q->path->count, sizeof(double));
        memory_free(p->memory, p->sums[k].worst.truth, p->pixels, 4);
        memory_free(p->memory, p->sums[k].worst.shown, p->pixels, 4);
        memory_free(p->memory, p->sums[k].worst.heat, p->pixels, 4);
    }
    memory_free(p->memory, p->sums, q->strategy_count, sizeof *p->sums);
    memory_free(p->memory, p->truth.rgba, p->pixels, 4);
    memory_free(p->memory, p->truth.depths, p->pixels, sizeof(float));
    memory_free(p->memory, p->shown.rgba, p->pixels, 4);
    memory_free(p->memory, p->shown.depths, p->pixels, sizeof(float));
    memory_free(p->memory, p->fronts, p->pixels, sizeof(float));
    memory_free(p->memory, p->movers, p->pixels, sizeof(float));
    memory_free(p->memory, p->map, p->pixels, sizeof(float));
    memory_free(p->memory, p->marks, p->pixels, 1);
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

static result draw_truth(pictures *p, uint32_t view)
{
    motion_show(p->q->motion, view, p->q->g);
    result done = RESULT_OK;
    if (p->fronts) done = draw(p, view, DRAW_FRONTS);
    if (p->fronts && done == RESULT_OK) done = renderer_read_depths(p->q->g, p->fronts, p->r);
    if (p->movers && done == RESULT_OK) done = draw(p, view, DRAW_MOVERS);
    if (p->movers && done == RESULT_OK) done = renderer_read_depths(p->q->g, p->movers, p->r);
    if (done == RESULT_OK) done = draw(p, view, DRAW_ALL);
    return done == RESULT_OK ? read_picture(p, &p->truth) : done;
}

static void keep_worst(pictures *p, sums *s)
{
    const uint32_t width = p->q->bench->width_px, height = p->q->bench->height_px;
    memcpy(s->worst.truth, p->truth.rgba, p->pixels * 4);
    memcpy(s->worst.shown, p->shown.rgba, p->pixels * 4);
    flip_heat(p->map, p->pixels, s->worst.heat);
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            uint8_t *pixel = s->worst.heat + ((size_t)y * width + x) * 4;
            if (!p->marks[(size_t)(height - 1 - y) * width + x]) continue;
            pixel[0] = 0; // a crack: cyan, which the heat never is
            pixel[1] = pixel[2] = 255;
        }
}

static void count_cracks(pictures *p, uint32_t view, uint32_t k)
{
    const bench_request *q = p->q->bench;
    const float *must = p->q->strategies[k].walls == WALLS_BOTH_SIDES ? p->truth.depths : p->fronts;
    const crack_pictures cracks = {p->truth.depths, must, p->shown.depths, q->width_px, q->height_px};
    const crack_counts c = cracks_count(&cracks, p->marks);
    bench_row *row = &p->q->rows[k];
    if (c.holes + c.spills > row->crack_pixels_max) {
        row->crack_pixels_max = c.holes + c.spills;
        row->crack_view = view;
    }
    p->sums[k].cracks.holes += c.holes;
    p->sums[k].cracks.inner += c.inner;
    p->sums[k].cracks.spills += c.spills;
}

static void count_movers(const pictures *p, bench_row *row)
{
    const mover_order c = movers_count(&(mover_pictures){p->movers, p->truth.depths, p->shown.depths, p->pixels});
    row->mover_pixels += c.pixels;
    row->mover_pixels_wrong += c.wrong;
}

static void compare(pictures *p, uint32_t view, uint32_t k)
{
    const flip_pair pair = {p->truth.rgba, p->shown.rgba};
    sums *s = &p->sums[k];
    bench_row *row = &p->q->rows[k];
    flip_keep_reference(p->flip, (uint64_t)view + 1);
    const double flip = flip_compare(p->flip, &pair, p->map);
    s->squared_error += similarity_squared_error(&pair, p->pixels);
    if (p->similarity) s->ssim += similarity_ssim(p->similarity, &pair);
    if (s->views == 0 || flip > row->flip_max) {
        row->flip_max = flip;
        row->flip_view = view;
        if (s->worst.heat) keep_worst(p, s);
    }
    s->flips[s->views++] = flip;
}

static result look_at(pictures *p, uint32_t view, uint32_t k, uint64_t *faults)
{
    strategy_view out;
    const strategy_request request = {.view = view, .mode = RENDER_SHADED, .marks = MARK_NOTHING};
    result done = strategy_run_view(&p->q->strategies[k], &request, p->r, &out);
    if (done == RESULT_OK) done = read_picture(p, &p->shown);
    if (done != RESULT_OK) return done;
    *faults += out.faults;
    count_cracks(p, view, k);
    if (p->movers) count_movers(p, &p->q->rows[k]);
    if (view >= bench_warmup_views(p->q->bench->path)) compare(p, view, k);
    return RESULT_OK;
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
        if (p->sums[k].flips) return 1;
    return 0;
}

static result look_at_group(pictures *p, uint32_t first, uint32_t end, progress *bar)
{
    result done = RESULT_OK;
    for (uint32_t k = first; k < end && done == RESULT_OK; ++k) // a restart forgets the pictures of all
        if (p->sums[k].flips) done = strategy_restart(&p->q->strategies[k], p->r);
    for (uint32_t v = 0; v < p->q->bench->path->count && done == RESULT_OK; ++v) {
        if (first == 0) progress_tell(bar, "pictures");
        done = draw_truth(p, v);
        for (uint32_t k = first; k < end && done == RESULT_OK; ++k)
            if (p->sums[k].flips) done = look_at(p, v, k, &p->q->rows[k].picture_faults);
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
    return done;
}

// ---- Results ----

static void close_row(const pictures *p, sums *s, bench_row *row)
{
    row->pictures_measured = s->views;
    row->crack_pixels = s->cracks.holes + s->cracks.spills;
    row->crack_inner = s->cracks.inner;
    row->crack_spills = s->cracks.spills;
    row->psnr = similarity_psnr_db(s->squared_error / s->views);
    row->ssim = s->ssim / s->views;
    row->has_ssim = p->similarity != NULL;
    row->flip = mean(s->flips, s->views);
    row->flip_p99 = percentile(s->flips, s->views, 0.99);
    row->faults += row->picture_faults;
}

static result write_worst(const pictures *p, const sums *s, const bench_row *row)
{
    const image_name names[] = {{row->name, "truth", row->flip_view}, {row->name, "shown", row->flip_view}, {row->name, "flip", row->flip_view}};
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
    for (uint32_t k = 0; k < q->bench->strategy_count && done == RESULT_OK; ++k) {
        if (!p.sums[k].flips) continue;
        close_row(&p, &p.sums[k], &q->rows[k]);
        if (p.sums[k].worst.heat && q->rows[k].flip_max > 0) done = write_worst(&p, &p.sums[k], &q->rows[k]);
    }
    close_all(&p);
    return done;
}
