// Clipped items: cut where their planes are, whole again where the parts meet, at a seam with a picture too.
// SPDX-License-Identifier: MIT
#include "picture_fixture.h"

#include <string.h>

static const cull_run all = {0, QUADS};

typedef struct clips {
    const cull_clipped *clipped;
    uint32_t count;
    const cull_capture *capture;
    const cull_run *after;
} clips;

static void draw_clips(bed *b, void *what)
{
    const clips *c = what;
    if (c->capture) renderer_capture(b->g, b->l, 0, c->capture);
    for (uint32_t i = 0; i < c->count; ++i) renderer_draw_clipped(b->g, b->l, 0, &c->clipped[i]);
    if (c->after) bed_draw(b, b->l, c->after, 1);
    if (c->capture) renderer_show(b->g, b->l, 0, &(cull_picture){.slot = c->capture->slot, .runs = c->capture->runs, .run_count = c->capture->run_count});
}

static uint8_t *clips_frame(bed *b, const frame_request *q, clips c)
{
    return frame_of(b, q, draw_clips, &c);
}

static void each_plane_cuts_what_lies_outside_it(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    const frame_request q = request(&c);
    const quad quads[] = {quad_at(-8, -8, -8, 8, 8)};
    const cull_run one = {0, 1};
    scene_with_slots(b, quads, 1);
    for (uint32_t count = 0; count <= 4; ++count) { // x > -4, x < 4, y > -4, y < 4
        cull_clipped part = {.runs = &one, .run_count = 1, .plane_count = count};
        part.planes[0] = plane_in_zone(b, 1, 0, 0, 4);
        part.planes[1] = plane_in_zone(b, -1, 0, 0, 4);
        part.planes[2] = plane_in_zone(b, 0, 1, 0, 4);
        part.planes[3] = plane_in_zone(b, 0, -1, 0, 4);
        uint8_t *cut = clips_frame(b, &q, (clips){&part, 1, NULL, NULL});
        const uint32_t low = SIDE / 4, high = SIDE - SIDE / 4;
        for (uint32_t i = 0; i < SIDE * SIDE; ++i) {
            const uint32_t x = i % SIDE, y = SIDE - 1 - i / SIDE; // rows come from the top
            const int on_edge = x + 1 == low || x == low || x + 1 == high || x == high || y + 1 == low || y == low || y + 1 == high || y == high;
            const int is_in = (count < 1 || x >= low) && (count < 2 || x < high) && (count < 3 || y >= low) && (count < 4 || y < high);
            if (!on_edge) assert_int_equal(cut[4 * i] + cut[4 * i + 1] + cut[4 * i + 2] != 0, is_in);
        }
        drop_pixels(cut);
    }
}

static void parts_that_meet_are_the_whole_and_what_comes_after_is_not_cut(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0.5, 0.25, 0);
    const frame_request q = request(&c);
    const cull_run half = {0, QUADS / 2}, rest = {QUADS / 2, QUADS - QUADS / 2};
    random_scene(b, 3);
    uint8_t *plain = bed_frame(b, &q, b->l, &all, 1);
    cull_clipped parts[4];
    for (int i = 0; i < 4; ++i) {
        parts[i] = (cull_clipped){.runs = &half, .run_count = 1, .plane_count = 2};
        parts[i].planes[0] = plane_in_zone(b, i & 1 ? 1 : -1, 0, 0, 0.01); // they overlap by 2 cm
        parts[i].planes[1] = plane_in_zone(b, 0, 0, i & 2 ? 1 : -1, i & 2 ? 10.01 : -9.99);
    }
    uint8_t *shown = clips_frame(b, &q, (clips){parts, 4, NULL, &rest});
    assert_in_range(pixels_that_differ(plain, shown), 0, SIDE / 2); // a triangle cut in two may round an edge otherwise
    drop_pixels(plain);
    drop_pixels(shown);
}

// Half as geometry, half as a picture, by the same plane moved outward on both sides: no pixel is left open.
static void a_seam_of_geometry_and_picture_has_no_crack(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0.5, 0.25, 0);
    const frame_request q = request(&c);
    for (uint32_t keep = 0; keep < 2; ++keep) {
        random_scene(b, 5 + keep);
        uint8_t *plain = bed_frame(b, &q, b->l, &all, 1);
        cull_clipped near = {.runs = &all, .run_count = 1, .plane_count = 1, .planes = {plane_in_zone(b, 1, 0, 0, 0.2)}};
        cull_capture far = whole_picture(b, &c, 10, &all, 1);
        far.clip_plane_count = 1;
        far.clip_planes[0] = plane_in_zone(b, -1, 0, 0, 0.2);
        far.keep_depth = keep;
        uint8_t *shown = clips_frame(b, &q, (clips){&near, 1, &far, NULL});
        for (uint32_t i = 0; i < SIDE * SIDE; ++i)
            assert_int_equal(plain[4 * i] + plain[4 * i + 1] + plain[4 * i + 2] == 0, shown[4 * i] + shown[4 * i + 1] + shown[4 * i + 2] == 0);
        if (keep) assert_in_range(pixels_that_differ(plain, shown), 0, SIDE * SIDE / 200);
        drop_pixels(plain);
        drop_pixels(shown);
    }
}

static void a_translucent_item_in_many_parts_and_pictures_is_drawn_once(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    const frame_request q = request(&c);
    quad quads[] = {quad_at(-10, -20, -20, 20, 20), quad_at(-5, -2, -2, 2, 2)};
    quads[1].material = "*water";
    quads[1].material_flags = MATERIAL_TRANSLUCENT;
    const cull_run both = {0, 2};
    scene_with_slots(b, quads, 2);
    uint8_t *plain = bed_frame(b, &q, b->l, &both, 1);
    cull_clipped parts[8];
    for (int i = 0; i < 8; ++i)
        parts[i] = (cull_clipped){.runs = &both, .run_count = 1, .plane_count = 1, .planes = {plane_in_zone(b, i & 1 ? 1 : -1, 0, 0, 0)}};
    const cull_capture capture = whole_picture(b, &c, 10, &both, 1);
    uint8_t *shown = clips_frame(b, &q, (clips){parts, 8, &capture, NULL});
    assert_int_equal(pixels_that_differ(plain, shown), 0);
    drop_pixels(plain);
    drop_pixels(shown);
}

int main(void)
{
#define T(f) cmocka_unit_test_setup_teardown(f, bed_setup, bed_teardown)
    const struct CMUnitTest clipped[] = {
        T(each_plane_cuts_what_lies_outside_it),
        T(parts_that_meet_are_the_whole_and_what_comes_after_is_not_cut),
        T(a_seam_of_geometry_and_picture_has_no_crack),
        T(a_translucent_item_in_many_parts_and_pictures_is_drawn_once),
    };
    return RUN_WITH_GL(clipped);
}
