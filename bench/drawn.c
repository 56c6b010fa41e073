// What a frame truly drew: see drawn.h.
// SPDX-License-Identifier: MIT
// Invariant: what is drawn again is what the frame's driver was told, not the visible set that it gave.
#include "drawn.h"

result drawn_picture_open(const strategy *s, report *r, drawn_picture *out)
{
    const allocator *memory = s->q->services->memory;
    *out = (drawn_picture){.pixels = (size_t)s->q->width_px * s->q->height_px};
    out->owners = memory_alloc(memory, out->pixels, sizeof *out->owners);
    out->depths = memory_alloc(memory, out->pixels, sizeof *out->depths);
    if (out->owners && out->depths) return RESULT_OK;
    drawn_picture_free(s, out);
    return report_no_memory(r, NULL);
}

void drawn_picture_free(const strategy *s, drawn_picture *p)
{
    memory_free(s->q->services->memory, p->owners, p->pixels, sizeof *p->owners);
    memory_free(s->q->services->memory, p->depths, p->pixels, sizeof *p->depths);
    *p = (drawn_picture){0};
}

static void repeat_draws(strategy *s)
{
    const strategy_draw *draws = s->draws.items;
    const cull_run *runs = s->draw_runs.items;
    if (s->cut == SCISSOR_ZONES) scissor_tell(&s->scissor, world_view_flow(s->view), s->g);
    for (size_t i = 0; i < s->draws.count; ++i)
        if (draws[i].zone != SCENE_NONE) renderer_draw(s->g, s->layout, draws[i].zone, runs + draws[i].first, draws[i].count);
        else
            for (uint32_t k = 0; k < draws[i].count; ++k) renderer_draw_movers(s->g, s->layout, &runs[draws[i].first + k].first, 1);
}

result drawn_again(strategy *s, uint32_t view, report *r, drawn_picture *out)
{
    const frame_request frame = {.camera = &s->q->path->cameras[view], .width_px = s->q->width_px, .height_px = s->q->height_px,
                                 .mode = RENDER_IDS, .scissor = s->cut};
    const result begun = renderer_begin(s->g, &frame, r);
    if (begun != RESULT_OK) return begun;
    repeat_draws(s);
    renderer_end(s->g);
    return renderer_read_ids(s->g, out->owners, out->depths, r);
}

static result draw_alone(strategy *s, uint32_t view, report *r, id_picture *picture, float *depths)
{
    const id_request only = {.camera = &s->q->path->cameras[view], .item_bits = s->drawn_bits};
    const result done = renderer_id_picture(s->g, &only, r, picture);
    return done == RESULT_OK ? renderer_read_ids(s->g, NULL, depths, r) : done;
}

static int is_said(const strategy *s, const truth *t, uint32_t owner)
{
    if (owner == 0 || owner > t->triangle_count) return owner == 0;
    const uint32_t item = t->polygon_item[t->triangle_polygon[owner - 1]];
    return s->drawn_bits[item / 32] >> (item % 32) & 1;
}

result drawn_compare(strategy *s, const truth *t, uint32_t view, report *r, uint64_t *out_pixels)
{
    const allocator *memory = s->q->services->memory;
    id_picture alone = {0};
    drawn_picture drawn;
    *out_pixels = 0;
    result done = drawn_picture_open(s, r, &drawn);
    if (done != RESULT_OK) return done;
    float *depths = memory_alloc(memory, drawn.pixels, sizeof *depths);
    if (!depths || id_picture_open(s->q->scene, s->q->width_px, s->q->height_px, memory, &alone) != RESULT_OK) done = report_no_memory(r, NULL);
    if (done == RESULT_OK) done = drawn_again(s, view, r, &drawn);
    if (done == RESULT_OK) done = draw_alone(s, view, r, &alone, depths);
    for (size_t i = 0; i < drawn.pixels && done == RESULT_OK; ++i) {
        if (drawn.owners[i] == alone.triangles[i] && drawn.depths[i] == depths[i]) continue;
        *out_pixels += drawn.depths[i] != depths[i] || !is_said(s, t, drawn.owners[i]);
    }
    if (alone.triangles) id_picture_free(&alone, memory);
    memory_free(memory, depths, drawn.pixels, sizeof *depths);
    drawn_picture_free(s, &drawn);
    return done;
}
