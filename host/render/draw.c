// Draws of a frame: ranges of many zones gathered, one multi-draw for all until something needs the picture or the cut differs.
// SPDX-License-Identifier: MIT
// Invariant: nothing here allocates but frame_reserve; what waits is drawn before anyone looks at the depth.
#include "levels.h"

#include <assert.h>
#include <math.h>
#include <string.h>

static result reserve_cuts(renderer *g, uint32_t zones)
{
    frame_state *f = &g->frame;
    if (zones <= f->cut_capacity) return RESULT_OK;
    zone_cut *cuts = memory_alloc_zeroed(g->memory, zones, sizeof *cuts);
    if (!cuts) return RESULT_NO_MEMORY;
    if (f->cut_capacity) memcpy(cuts, f->cuts, f->cut_capacity * sizeof *cuts);
    memory_free(g->memory, f->cuts, f->cut_capacity, sizeof *cuts);
    f->cuts = cuts;
    f->cut_capacity = zones;
    return RESULT_OK;
}

static result reserve_translucent(renderer *g, uint32_t count)
{
    frame_state *f = &g->frame;
    if (count <= f->translucent_capacity) return RESULT_OK;
    translucent_item *items = memory_alloc(g->memory, count, sizeof *items);
    if (!items) return RESULT_NO_MEMORY;
    if (f->translucent_count) memcpy(items, f->translucent, f->translucent_count * sizeof *items);
    memory_free(g->memory, f->translucent, f->translucent_capacity, sizeof *items);
    f->translucent = items;
    f->translucent_capacity = count;
    return RESULT_OK;
}

result frame_reserve(renderer *g, uint32_t zones, uint32_t places, uint32_t translucent)
{
    enum { LONG_RANGES = 8 }; // that are too long for one draw and take two places
    frame_flush(g);
    const uint32_t noted = translucent < UINT32_MAX / 2 ? 2 * translucent : UINT32_MAX; // where some come often, half of a full list at least goes
    if (reserve_cuts(g, zones) != RESULT_OK || reserve_translucent(g, noted) != RESULT_OK) return RESULT_NO_MEMORY;
    return places < UINT32_MAX - LONG_RANGES ? ranges_reserve(&g->scene.ranges, places + LONG_RANGES, g->memory) : RESULT_OK;
}

void frame_release(renderer *g)
{
    frame_state *f = &g->frame;
    memory_free(g->memory, f->translucent, f->translucent_capacity, sizeof *f->translucent);
    memory_free(g->memory, f->cuts, f->cut_capacity, sizeof *f->cuts);
    f->translucent = NULL;
    f->cuts = NULL;
    f->pending = NULL;
    f->translucent_capacity = f->translucent_count = f->cut_capacity = 0;
}

// ---- Where a zone may draw ----

static pixel_box whole_picture(const renderer *g)
{
    return (pixel_box){0, 0, (GLsizei)g->frame.request.width_px, (GLsizei)g->frame.request.height_px};
}

static int same_box(const pixel_box *a, const pixel_box *b)
{
    return a->x == b->x && a->y == b->y && a->width == b->width && a->height == b->height;
}

pixel_box frame_cut(const renderer *g, uint32_t zone)
{
    const frame_state *f = &g->frame;
    if (f->request.scissor == SCISSOR_NONE || zone >= f->cut_capacity || f->cuts[zone].frame != f->number) return whole_picture(g);
    return f->cuts[zone].box;
}

void cut_begin(renderer *g, const pixel_box *cut)
{
    const pixel_box whole = whole_picture(g);
    if (same_box(cut, &whole)) return;
    glEnable(GL_SCISSOR_TEST);
    glScissor(cut->x, cut->y, cut->width, cut->height);
    g->frame.state_changes++;
}

void cut_end(renderer *g, const pixel_box *cut)
{
    const pixel_box whole = whole_picture(g);
    if (same_box(cut, &whole)) return;
    glDisable(GL_SCISSOR_TEST); // it would cut clears and copies too
    g->frame.state_changes++;
}

// One side of a rectangle in pixels, moved outward by a pixel: rectangles are rounded, and so are the corners drawn.
static GLint side_px(double at, uint32_t size_px, double outward)
{
    const double pixels = (at + 1) / 2 * size_px;
    const double moved = (outward < 0 ? floor(pixels) : ceil(pixels)) + outward;
    return (GLint)fmin(fmax(moved, 0), size_px);
}

void renderer_zone_rectangle(renderer *g, uint32_t zone, const float rectangle[4])
{
    frame_state *f = &g->frame;
    const frame_request *q = &f->request;
    if (!f->open || q->scissor == SCISSOR_NONE || zone >= f->cut_capacity) return;
    for (int i = 0; i < 4; ++i)
        if (isnan(rectangle[i])) return; // nothing is known: it stays whole
    const GLint x0 = side_px((double)rectangle[0], q->width_px, -1), y0 = side_px((double)rectangle[1], q->height_px, -1);
    const GLint x1 = side_px((double)rectangle[2], q->width_px, 1), y1 = side_px((double)rectangle[3], q->height_px, 1);
    const pixel_box box = {x0, y0, x1 > x0 ? x1 - x0 : 0, y1 > y0 ? y1 - y0 : 0};
    f->cuts[zone] = (zone_cut){box, f->number};
}

// ---- Runs to ranges ----

static void draw_pending(renderer *g)
{
    frame_state *f = &g->frame;
    ranges *a = &g->scene.ranges;
    const render_layout *l = f->pending;
    if (!l || a->count == 0) return;
    frame_bind(g);
    if (frame_pass(g, &(draw_pass){.view = &f->view}, 0)) {
        state_vertices(g, l->vertices);
        frame_state_pass(g, BLEND_NONE, DEPTH_ON);
        cut_begin(g, &f->pending_cut);
        ranges_draw(g, a);
        cut_end(g, &f->pending_cut);
        gl_check(g, NULL, "drawing");
    }
    a->count = 0;
}

void frame_flush(renderer *g)
{
    draw_pending(g); // of draws and tests only one kind ever waits
    g->frame.pending = NULL;
    tests_submit(g);
}

static void range_of(const layout_runs *r, const uint32_t *first_index, uint32_t i, uint32_t *out_first, uint32_t *out_count)
{
    const render_layout *l = r->layout;
    const cull_run run = r->runs[i];
    const uint32_t count = r->zone == LAYOUT_MOVERS ? l->total - l->place_count : l->zones[r->zone].count;
    const uint32_t place = layout_first_place(l, r->zone) + run.first;
    assert(run.count >= 1 && run.count <= count && run.first <= count - run.count);
    (void)count;
    *out_first = first_index[place];
    *out_count = first_index[place + run.count] - *out_first;
}

void frame_draw_runs(renderer *g, const draw_pass *p, const layout_runs *r)
{
    ranges *a = &g->scene.ranges;
    const uint32_t *first_index = p->level ? p->level->first_index : r->layout->first_index;
    if (!frame_pass(g, p, 0)) return;
    state_vertices(g, p->level ? p->level->vertices : r->layout->vertices);
    frame_state_pass(g, BLEND_NONE, DEPTH_ON);
    for (uint32_t i = 0; i < r->count; ++i) {
        uint32_t first, count;
        range_of(r, first_index, i, &first, &count);
        if (ranges_add(a, first, count)) continue;
        ranges_draw(g, a); // more runs than items: someone repeats himself
        ranges_add(a, first, count);
    }
    ranges_draw(g, a);
}

static void gather(renderer *g, const layout_runs *r)
{
    frame_state *f = &g->frame;
    ranges *a = &g->scene.ranges;
    const pixel_box cut = frame_cut(g, r->zone);
    tests_submit(g);
    if (f->pending != r->layout || !same_box(&f->pending_cut, &cut)) draw_pending(g);
    f->pending = r->layout;
    f->pending_cut = cut;
    for (uint32_t i = 0; i < r->count; ++i) {
        uint32_t first, count;
        range_of(r, r->layout->first_index, i, &first, &count);
        if (ranges_add(a, first, count)) continue;
        draw_pending(g);
        ranges_add(a, first, count);
    }
    translucent_note(g, r);
}

void renderer_draw(renderer *g, const render_layout *l, uint32_t zone, const cull_run *runs, uint32_t run_count)
{
    assert(g->frame.open && zone < l->zone_count);
    if (run_count) gather(g, &(layout_runs){l, zone, runs, run_count});
}

void renderer_draw_movers(renderer *g, const render_layout *l, const uint32_t *movers, uint32_t count)
{
    assert(g->frame.open);
    for (uint32_t i = 0; i < count; ++i) {
        const cull_run run = {movers[i], 1};
        if (movers[i] < l->total - l->place_count) gather(g, &(layout_runs){l, LAYOUT_MOVERS, &run, 1});
    }
}
