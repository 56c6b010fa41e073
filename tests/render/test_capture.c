// Captures and pictures: what was taken through a parallelogram looks the same shown at its place.
// SPDX-License-Identifier: MIT
#include "picture_fixture.h"

static void a_picture_shown_from_where_it_was_taken_is_the_geometry(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0.5, 0.25, 0);
    const frame_request q = request(&c);
    const cull_run all = {0, QUADS};
    random_scene(b, 3);
    uint8_t *plain = bed_frame(b, &q, b->l, &all, 1);
    for (uint32_t keep = 0; keep < 2; ++keep)
        for (int distance = 5; distance <= 20; distance += 15) { // before and behind what it shows
            cull_capture capture = whole_picture(b, &c, distance, &all, 1);
            capture.keep_depth = keep;
            uint8_t *shown = frame_with(b, &q, &capture, &(cull_picture){.slot = 7, .runs = &all, .run_count = 1}, NULL);
            assert_in_range(pixels_that_differ(plain, shown), 0, SIDE * SIDE / 200);
            drop_pixels(shown);
        }
    drop_pixels(plain);
}

static void turning_the_eye_costs_little_error(void **state)
{
    bed *b = *state;
    camera c = camera_at(0, 0, 0);
    const cull_run all = {0, QUADS};
    random_scene(b, 4);
    const cull_capture capture = whole_picture(b, &c, 10, &all, 1);
    frame_request q = request(&c);
    uint8_t *taken = frame_with(b, &q, &capture, NULL, NULL);
    c.forward[0] = 0.2;
    c.fovy_deg = 50; // still inside what was captured
    q = request(&c);
    uint8_t *plain = bed_frame(b, &q, b->l, &all, 1);
    uint8_t *shown = frame_with(b, &q, NULL, &(cull_picture){.slot = 7, .runs = &all, .run_count = 1}, NULL);
    assert_in_range(pixels_that_differ(plain, shown), 0, SIDE * SIDE / 10); // edges, resampled
    drop_pixels(taken);
    drop_pixels(plain);
    drop_pixels(shown);
}

static void a_kept_depth_sorts_geometry_against_the_picture(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    const frame_request q = request(&c);
    // captured: near on the left, far on the right; then a wall in between. The parallelogram stands nearest of all.
    const quad quads[] = {quad_at(-6, -20, -20, 0, 20), quad_at(-12, 0, -20, 20, 20), quad_at(-9, -20, -20, 20, 20)};
    const cull_run captured = {0, 2}, wall = {2, 1}, all = {0, 3};
    scene_with_slots(b, quads, 3);
    uint8_t *plain = bed_frame(b, &q, b->l, &all, 1);
    cull_capture capture = whole_picture(b, &c, 4, &captured, 1);
    const cull_picture picture = {.slot = 7, .runs = &captured, .run_count = 1};
    uint8_t *flat = frame_with(b, &q, &capture, &picture, &wall);
    capture.keep_depth = 1;
    uint8_t *deep = frame_with(b, &q, &capture, &picture, &wall);
    assert_in_range(pixels_that_differ(plain, deep), 0, SIDE); // a column at the seam
    assert_true(pixels_that_differ(plain, flat) > SIDE * SIDE / 3);
    drop_pixels(plain);
    drop_pixels(flat);
    drop_pixels(deep);
}

static void a_picture_has_holes_where_nothing_was(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    const frame_request q = request(&c);
    const quad quads[] = {quad_at(-8, -8, -8, 0, 8), quad_at(-20, -40, -40, 40, 40)};
    const cull_run front = {0, 1}, back = {1, 1}, all = {0, 2};
    scene_with_slots(b, quads, 2);
    uint8_t *plain = bed_frame(b, &q, b->l, &all, 1);
    cull_capture capture = whole_picture(b, &c, 8, &front, 1);
    capture.keep_depth = 1;
    uint8_t *shown = frame_with(b, &q, &capture, &(cull_picture){.slot = 7, .runs = &front, .run_count = 1}, &back);
    assert_in_range(pixels_that_differ(plain, shown), 0, SIDE);
    drop_pixels(plain);
    drop_pixels(shown);
}

static void clip_planes_cut_what_is_captured(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    const frame_request q = request(&c);
    const quad quads[] = {quad_at(-8, -8, -8, 8, 8)};
    const cull_run all = {0, 1};
    scene_with_slots(b, quads, 1);
    cull_capture capture = whole_picture(b, &c, 8, &all, 1);
    capture.clip_plane_count = 2; // x > 0 and y > 0
    const float at[2] = {(float)b->s->whole.origin[0], (float)b->s->whole.origin[1]};
    capture.clip_planes[0] = (cull_plane){{1, 0, 0}, at[0]};
    capture.clip_planes[1] = (cull_plane){{0, 1, 0}, at[1]};
    uint8_t *shown = frame_with(b, &q, &capture, &(cull_picture){.slot = 7, .runs = &all, .run_count = 1}, NULL);
    for (uint32_t y = 0; y < SIDE; ++y) // rows from the top
        for (uint32_t x = 0; x < SIDE; ++x) {
            if (x == SIDE / 2 || x == SIDE / 2 - 1 || y == SIDE / 2 || y == SIDE / 2 - 1) continue;
            assert_int_equal(shown[4 * (y * SIDE + x)] != 0, x > SIDE / 2 && y < SIDE / 2);
        }
    drop_pixels(shown);
}

static void a_picture_can_be_made_of_pictures(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    const frame_request q = request(&c);
    const cull_run first = {0, QUADS / 2}, second = {QUADS / 2, QUADS - QUADS / 2}, all = {0, QUADS};
    const uint32_t part = SLOTS - 1;
    uint8_t *rgba = memory_alloc(allocator_heap(), (size_t)SIDE * SIDE, 4);
    random_scene(b, 6);
    uint8_t *plain = bed_frame(b, &q, b->l, &all, 1);
    cull_capture child = whole_picture(b, &c, 10, &first, 1), parent = whole_picture(b, &c, 7, &second, 1);
    child.slot = part;
    child.keep_depth = parent.keep_depth = 1;
    parent.slots = &part;
    parent.slot_count = 1;
    assert_int_equal(renderer_begin(b->g, &q, &b->r), RESULT_OK);
    renderer_capture(b->g, b->l, 0, &child);
    renderer_capture(b->g, b->l, 0, &parent);
    renderer_show(b->g, b->l, 0, &(cull_picture){.slot = 7, .runs = &all, .run_count = 1});
    renderer_end(b->g);
    assert_int_equal(renderer_read(b->g, rgba, &b->r), RESULT_OK);
    assert_in_range(pixels_that_differ(plain, rgba), 0, SIDE * SIDE / 100);
    drop_pixels(plain);
    drop_pixels(rgba);
}

static void a_capture_that_cannot_be_taken_shows_the_geometry(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    const frame_request q = request(&c);
    const cull_run all = {0, QUADS};
    const cull_picture picture = {.slot = 7, .runs = &all, .run_count = 1};
    random_scene(b, 5);
    uint8_t *plain = bed_frame(b, &q, b->l, &all, 1);
    cull_capture bad[3];
    for (int i = 0; i < 3; ++i) bad[i] = whole_picture(b, &c, 8, &all, 1);
    bad[0].corner = in_zone(b, -1, 0, -1); // the eye lies in the parallelogram's plane
    bad[0].right = (cull_vec3){2, 0, 0};
    bad[0].up = (cull_vec3){0, 0, 1};
    bad[1].width_px = 0;
    bad[2].height_px = 1u << 30;
    for (int i = 0; i < 3; ++i) {
        uint8_t *shown = frame_with(b, &q, &bad[i], &picture, NULL);
        assert_memory_equal(plain, shown, SIDE * SIDE * 4);
        drop_pixels(shown);
    }
    const cull_capture good = whole_picture(b, &c, 8, &all, 1);
    uint8_t *shown = frame_with(b, &q, &good, &picture, NULL);
    renderer_forget_pictures(b->g);
    uint8_t *forgotten = frame_with(b, &q, NULL, &picture, &all);
    assert_memory_equal(plain, forgotten, SIDE * SIDE * 4);
    drop_pixels(shown);
    drop_pixels(forgotten);
    drop_pixels(plain);
}

static void a_capture_in_a_frame_leaves_the_frame_as_it_was(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    const frame_request q = request(&c);
    const cull_run half = {0, QUADS / 2}, rest = {QUADS / 2, QUADS - QUADS / 2}, all = {0, QUADS};
    uint8_t *rgba = memory_alloc(allocator_heap(), (size_t)SIDE * SIDE, 4);
    random_scene(b, 8);
    uint8_t *plain = bed_frame(b, &q, b->l, &all, 1);
    cull_capture capture = whole_picture(b, &c, 10, &half, 1);
    capture.width_px = 33; // a viewport of its own
    capture.height_px = 9;
    assert_int_equal(renderer_begin(b->g, &q, &b->r), RESULT_OK);
    bed_draw(b, b->l, &half, 1);
    renderer_capture(b->g, b->l, 0, &capture);
    bed_draw(b, b->l, &rest, 1);
    renderer_end(b->g);
    assert_int_equal(renderer_read(b->g, rgba, &b->r), RESULT_OK);
    assert_memory_equal(plain, rgba, SIDE * SIDE * 4);
    drop_pixels(plain);
    drop_pixels(rgba);
}

static void translucent_items_of_a_picture_are_drawn_live(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    const frame_request q = request(&c);
    quad quads[] = {quad_at(-10, -20, -20, 20, 20), quad_at(-5, -2, -2, 2, 2)};
    quads[1].material = "*water";
    quads[1].material_flags = MATERIAL_TRANSLUCENT;
    const cull_run all = {0, 2};
    scene_with_slots(b, quads, 2);
    uint8_t *plain = bed_frame(b, &q, b->l, &all, 1);
    cull_capture capture = whole_picture(b, &c, 9, &all, 1);
    capture.keep_depth = 1;
    uint8_t *shown = frame_with(b, &q, &capture, &(cull_picture){.slot = 7, .runs = &all, .run_count = 1}, NULL);
    assert_int_equal(pixels_that_differ(plain, shown), 0);
    drop_pixels(plain);
    drop_pixels(shown);
}

int main(void)
{
#define T(f) cmocka_unit_test_setup_teardown(f, bed_setup, bed_teardown)
    const struct CMUnitTest capture[] = {
        T(a_picture_shown_from_where_it_was_taken_is_the_geometry),
        T(turning_the_eye_costs_little_error),
        T(a_kept_depth_sorts_geometry_against_the_picture),
        T(a_picture_has_holes_where_nothing_was),
        T(clip_planes_cut_what_is_captured),
        T(a_picture_can_be_made_of_pictures),
        T(a_capture_that_cannot_be_taken_shows_the_geometry),
        T(a_capture_in_a_frame_leaves_the_frame_as_it_was),
        T(translucent_items_of_a_picture_are_drawn_live),
    };
    return RUN_WITH_GL(capture);
}
