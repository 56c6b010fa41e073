// Frames: what a chain hands back, drawn from its layout in every mode.
// SPDX-License-Identifier: MIT
#include "fixture.h"

#include <string.h>

enum { SIDE = 64, QUADS = 200 };

static void drop_pixels(uint8_t *rgba)
{
    memory_free(allocator_heap(), rgba, (size_t)SIDE * SIDE, 4);
}

static const uint8_t *pixel(const uint8_t *rgba, uint32_t x, uint32_t y_from_top)
{
    return rgba + 4 * ((size_t)y_from_top * SIDE + x);
}

static frame_request request(const camera *c, render_mode mode)
{
    return (frame_request){.camera = c, .width_px = SIDE, .height_px = SIDE, .mode = mode, .faces = FACES_ALL};
}

static void random_scene(bed *b, uint32_t seed)
{
    static quad quads[QUADS];
    for (int i = 0; i < QUADS; ++i) {
        const double x = 20 * random_unit(&seed) - 10, y = 20 * random_unit(&seed) - 10, z = -20 * random_unit(&seed) - 5;
        quads[i] = quad_at(z, x, y, x + 6 * random_unit(&seed) + 0.1, y + 6 * random_unit(&seed) + 0.1);
        quads[i].is_mover = i % 17 == 0;
        if (i % 11 == 0) {
            quads[i].material = "*water";
            quads[i].material_flags = MATERIAL_TRANSLUCENT;
        }
    }
    bed_scene(b, quads, QUADS, NULL);
}

static const render_mode MODES[] = {RENDER_SHADED, RENDER_ITEMS, RENDER_ZONES, RENDER_DEPTH, RENDER_OVERDRAW};

static void runs_split_at_random_draw_what_one_run_draws(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    random_scene(b, 7);
    for (uint32_t mode = 0; mode < 5; ++mode) {
        const frame_request q = request(&c, MODES[mode]);
        const cull_run all = {0, QUADS};
        cull_run runs[QUADS];
        uint32_t count = 0, seed = 99;
        for (uint32_t at = 0; at < QUADS;) {
            const uint32_t left = QUADS - at, n = 1 + random_next(&seed) % 5;
            runs[count++] = (cull_run){at, n < left ? n : left};
            at += runs[count - 1].count;
        }
        uint8_t *one = bed_frame(b, &q, b->l, &all, 1), *split = bed_frame(b, &q, b->l, runs, count);
        assert_memory_equal(one, split, SIDE * SIDE * 4);
        drop_pixels(one);
        drop_pixels(split);
    }
}

static void the_picture_does_not_depend_on_the_layout(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    const cull_run all = {0, QUADS};
    uint32_t order[QUADS];
    render_layout *turned = NULL;
    random_scene(b, 8);
    for (uint32_t i = 0; i < b->s->item_count; ++i) order[i] = b->s->item_count - 1 - i;
    assert_int_equal(bed_layout(b, order, &turned), RESULT_OK);
    for (uint32_t mode = 0; mode < 5; ++mode) {
        const frame_request q = request(&c, MODES[mode]);
        uint8_t *straight = bed_frame(b, &q, b->l, &all, 1), *other = bed_frame(b, &q, turned, &all, 1);
        assert_memory_equal(straight, other, SIDE * SIDE * 4);
        drop_pixels(straight);
        drop_pixels(other);
    }
    render_layout_close(turned);
}

static void a_run_names_places_of_the_layout_and_movers_behind(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    const frame_request q = request(&c, RENDER_ITEMS);
    quad quads[] = {quad_at(-5, -5, -5, 0, 0), quad_at(-5, 0, -5, 5, 0), quad_at(-5, -5, 0, 0, 5), quad_at(-5, 0, 0, 5, 5)};
    quads[3].is_mover = 1;
    bed_scene(b, quads, 4, NULL);
    const uint32_t order[] = {2, 0, 1};
    render_layout *l = NULL;
    assert_int_equal(bed_layout(b, order, &l), RESULT_OK);
    static const uint32_t quarter_x[] = {16, 16, 48, 48}, quarter_y[] = {16, 48, 48, 16}; // of place 0 to 3, from the top
    for (uint32_t place = 0; place < 4; ++place) {
        const cull_run run = {place, 1};
        uint8_t *rgba = bed_frame(b, &q, l, &run, 1);
        for (uint32_t k = 0; k < 4; ++k) {
            const uint8_t *p = pixel(rgba, quarter_x[k], quarter_y[k]);
            assert_int_equal(p[0] + p[1] + p[2] != 0, k == place);
        }
        drop_pixels(rgba);
    }
    render_layout_close(l);
}

static void items_mode_shows_one_colour_per_owner_of_the_id_picture(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    const frame_request q = request(&c, RENDER_ITEMS);
    const cull_run all = {0, QUADS};
    uint32_t colours[QUADS] = {0};
    random_scene(b, 9);
    for (uint32_t i = 0; i < b->s->material_count; ++i) b->s->materials[i].flags = 0;
    for (uint32_t i = 0; i < QUADS; ++i) b->s->items[i].flags &= ~(uint32_t)CULL_ITEM_SEE_THROUGH; // all opaque
    render_layout_close(b->l);
    assert_int_equal(renderer_upload(b->g, b->s, &b->r), RESULT_OK);
    assert_int_equal(bed_layout(b, NULL, &b->l), RESULT_OK);
    id_picture p = bed_ids(b, &(id_request){.camera = &c}, SIDE, SIDE);
    uint8_t *rgba = bed_frame(b, &q, b->l, &all, 1);
    uint32_t owned = 0;
    for (uint32_t y = 0; y < SIDE; ++y)
        for (uint32_t x = 0; x < SIDE; ++x) {
            const uint8_t *at = pixel(rgba, x, SIDE - 1 - y);
            const uint32_t colour = (uint32_t)at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16;
            assert_int_equal(colour != 0, id_at(&p, x, y) != 0);
            if (!colour) continue;
            uint32_t *known = &colours[item_of_triangle(b->s, id_at(&p, x, y) - 1)];
            if (!*known) *known = colour;
            assert_int_equal(*known, colour);
            owned++;
        }
    assert_true(owned > SIDE * SIDE / 4);
    drop_pixels(rgba);
    id_picture_free(&p, allocator_heap());
}

static void draw_calls_and_state_changes_are_a_constant(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    random_scene(b, 10);
    for (uint32_t mode = 0; mode < 5; ++mode) {
        const frame_request q = request(&c, MODES[mode]);
        assert_int_equal(renderer_begin(b->g, &q, &b->r), RESULT_OK);
        cull_run runs[QUADS / 2];
        for (uint32_t i = 0; i < QUADS / 2; ++i) runs[i] = (cull_run){2 * i, 1};
        for (uint32_t i = 0; i < 10; ++i) bed_draw(b, b->l, runs + 10 * i, 10);
        renderer_end(b->g);
        assert_in_range(renderer_draw_calls(b->g), 2, 3); // opaque, translucent, and the palette of overdraw
        assert_in_range(renderer_state_changes(b->g), 0, 30);
    }
}

static void a_lit_wall_shows_its_colour_and_the_sky_stays_behind(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    const frame_request q = request(&c, RENDER_SHADED);
    quad quads[] = {quad_at(-5, -5, 0, 5, 5)}; // the upper half: top rows come first
    quads[0].colour = 0xff0000ffu;
    bed_scene(b, quads, 1, NULL);
    uint8_t *rgba = bed_frame(b, &q, b->l, &(cull_run){0, 1}, 1);
    const uint8_t *wall = pixel(rgba, 32, 10), *sky = pixel(rgba, 32, 50);
    assert_true(wall[0] > 60 && wall[1] == 0 && wall[2] == 0);
    assert_true(sky[2] > sky[0] && sky[0] > 100);
    assert_int_equal(wall[3], 255);
    drop_pixels(rgba);
}

static void surfaces_of_different_slope_are_lit_differently(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 1, 0);
    const frame_request q = request(&c, RENDER_SHADED);
    quad quads[] = {quad_at(-9, -20, 0, 20, 20), quad_at(-9, -20, 0, 20, 0)};
    quads[1].corners[0][2] = quads[1].corners[1][2] = -1; // a floor up to the wall
    bed_scene(b, quads, 2, NULL);
    uint8_t *rgba = bed_frame(b, &q, b->l, &(cull_run){0, 2}, 1);
    assert_int_not_equal(pixel(rgba, 32, 10)[0], pixel(rgba, 32, 60)[0]);
    drop_pixels(rgba);
}

static void translucent_quads_mix_farthest_first(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    const frame_request q = request(&c, RENDER_SHADED);
    quad quads[] = {quad_at(-4, -20, -20, 20, 20), quad_at(-6, -20, -20, 20, 20), quad_at(-8, -20, -20, 20, 20)};
    for (int i = 0; i < 2; ++i) {
        quads[i].material = i ? "*green" : "*red";
        quads[i].colour = i ? 0xff00ff00u : 0xff0000ffu;
        quads[i].material_flags = MATERIAL_TRANSLUCENT;
    }
    quads[2].material = "white";
    quads[2].colour = 0xffffffffu;
    bed_scene(b, quads, 3, NULL);
    const cull_run runs[] = {{0, 1}, {1, 1}, {2, 1}};
    uint8_t *rgba = bed_frame(b, &q, b->l, runs, 3);
    const uint8_t *p = pixel(rgba, 32, 32); // red 1/2, green 1/4, white 1/4
    assert_true(p[0] > p[1] + 20 && p[1] > p[2] + 20 && p[2] > 20);
    drop_pixels(rgba);
}

static void depth_darkens_and_overdraw_heats(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    const quad quads[] = {quad_at(-8, -20, -20, 20, 20), quad_at(-4, -20, -20, 0, 20)};
    bed_scene(b, quads, 2, NULL);
    frame_request q = request(&c, RENDER_DEPTH);
    uint8_t *rgba = bed_frame(b, &q, b->l, &(cull_run){0, 2}, 1);
    assert_true(pixel(rgba, 10, 32)[0] > pixel(rgba, 40, 32)[0]);
    drop_pixels(rgba);
    q.mode = RENDER_OVERDRAW;
    rgba = bed_frame(b, &q, b->l, &(cull_run){0, 2}, 1);
    const uint8_t *once = pixel(rgba, 40, 32), *twice = pixel(rgba, 10, 32);
    assert_true(once[2] > once[1] && once[0] < 30); // blue
    assert_true(twice[1] > once[1] + 60);           // towards cyan
    drop_pixels(rgba);
    rgba = bed_frame(b, &q, b->l, &(cull_run){1, 1}, 1);
    assert_int_equal(pixel(rgba, 40, 32)[0] + pixel(rgba, 40, 32)[1] + pixel(rgba, 40, 32)[2], 0);
    drop_pixels(rgba);
}

static void back_faces_are_dropped_on_request(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    frame_request q = request(&c, RENDER_ITEMS);
    quad quads[] = {quad_reversed(quad_at(-5, -20, -20, 0, 20)), quad_reversed(quad_at(-5, 0, -20, 20, 20))};
    quads[1].item_flags = CULL_ITEM_TWO_SIDED;
    bed_scene(b, quads, 2, NULL);
    for (int front = 0; front < 2; ++front) {
        q.faces = front ? FACES_FRONT : FACES_ALL;
        uint8_t *rgba = bed_frame(b, &q, b->l, &(cull_run){0, 2}, 1);
        assert_int_equal(pixel(rgba, 10, 32)[0] != 0, !front);
        assert_int_not_equal(pixel(rgba, 50, 32)[0], 0);
        drop_pixels(rgba);
    }
}

static void a_frame_allocates_nothing(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    random_scene(b, 12);
    for (int round = 0; round < 2; ++round) {
        const uint64_t before = b->memory.calls;
        for (uint32_t mode = 0; mode < 5; ++mode) {
            const frame_request q = request(&c, MODES[mode]);
            assert_int_equal(renderer_begin(b->g, &q, &b->r), RESULT_OK);
            bed_draw(b, b->l, &(cull_run){0, QUADS}, 1);
            renderer_end(b->g);
        }
        assert_int_equal(b->memory.calls, before);
    }
}

int main(void)
{
#define T(f) cmocka_unit_test_setup_teardown(f, bed_setup, bed_teardown)
    const struct CMUnitTest frame[] = {
        T(runs_split_at_random_draw_what_one_run_draws),
        T(the_picture_does_not_depend_on_the_layout),
        T(a_run_names_places_of_the_layout_and_movers_behind),
        T(items_mode_shows_one_colour_per_owner_of_the_id_picture),
        T(draw_calls_and_state_changes_are_a_constant),
        T(a_lit_wall_shows_its_colour_and_the_sky_stays_behind),
        T(surfaces_of_different_slope_are_lit_differently),
        T(translucent_quads_mix_farthest_first),
        T(depth_darkens_and_overdraw_heats),
        T(back_faces_are_dropped_on_request),
        T(a_frame_allocates_nothing),
    };
    return RUN_WITH_GL(frame);
}
