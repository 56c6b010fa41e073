// The overlay: lines, triangles and letters stand where they should, over the picture or behind what hides them.
// SPDX-License-Identifier: MIT
#include "fixture.h"

#include <string.h>

enum { SIDE = 128 };
static const uint32_t RED = 0xff0000ffu, HALF_RED = 0x800000ffu;

typedef struct pixels { uint8_t rgba[SIDE * SIDE * 4]; } pixels;

static const uint8_t *pixel(const pixels *p, uint32_t x, uint32_t y_from_top)
{
    return p->rgba + 4 * ((size_t)y_from_top * SIDE + x);
}

static int is_red(const uint8_t *p)
{
    return p[0] == 255 && p[1] == 0 && p[2] == 0;
}

static uint32_t red_pixels(const pixels *p)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < SIDE * SIDE; ++i) count += (uint32_t)is_red(p->rgba + 4 * (size_t)i);
    return count;
}

// A black floorless world: nothing but a grey wall at z -5 over the left half, drawn; the overlay comes next.
static void wall_frame(bed *b, const camera *c, render_mode mode)
{
    const frame_request q = {.camera = c, .width_px = SIDE, .height_px = SIDE, .mode = mode};
    assert_int_equal(renderer_begin(b->g, &q, &b->r), RESULT_OK);
    renderer_draw(b->g, b->l, 0, &(cull_run){0, 1}, 1);
    renderer_end(b->g);
}

static void read_pixels(bed *b, pixels *out)
{
    assert_int_equal(renderer_read(b->g, out->rgba, &b->r), RESULT_OK);
}

static void wall_scene(bed *b, const double offset[3])
{
    const quad q = quad_at(-5, -20, -20, 0, 20);
    bed_scene(b, &q, 1, offset);
}

static void a_line_behind_a_wall_is_hidden_unless_on_top(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    const overlay_vertex line[2] = {{{-7, 0.05, -8}, RED}, {{7, 0.05, -8}, RED}};
    static pixels p;
    wall_scene(b, NULL);
    for (int on_top = 0; on_top < 2; ++on_top) {
        wall_frame(b, &c, RENDER_SHADED);
        renderer_overlay_lines(b->g, line, 2, on_top ? OVERLAY_ON_TOP : OVERLAY_TESTED);
        read_pixels(b, &p);
        const uint32_t y = SIDE / 2 - 1; // just above the middle
        assert_true(is_red(pixel(&p, SIDE * 3 / 4, y)));
        assert_int_equal(is_red(pixel(&p, SIDE / 4, y)), on_top);
        assert_in_range(red_pixels(&p), SIDE * 7 / 16 - 3, SIDE * 7 / 8 + 3);
    }
}

static void triangles_mix_by_their_alpha_and_leave_no_depth(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    const overlay_vertex near_by[3] = {{{-1, -30, -3}, HALF_RED}, {{30, -30, -3}, HALF_RED}, {{-1, 60, -3}, HALF_RED}};
    const overlay_vertex behind[2] = {{{0.5, 0.05, -4}, RED}, {{3.5, 0.05, -4}, RED}};
    static pixels plain, p;
    wall_scene(b, NULL);
    wall_frame(b, &c, RENDER_SHADED);
    read_pixels(b, &plain);
    wall_frame(b, &c, RENDER_SHADED);
    renderer_overlay_triangles(b->g, near_by, 3, OVERLAY_TESTED);
    read_pixels(b, &p);
    const uint8_t *before = pixel(&plain, SIDE * 3 / 4, SIDE / 4), *after = pixel(&p, SIDE * 3 / 4, SIDE / 4);
    assert_in_range(after[0], (255 + before[0]) / 2 - 3, (255 + before[0]) / 2 + 3);
    assert_in_range(after[2], before[2] / 2 - 3, before[2] / 2 + 3);
    renderer_overlay_lines(b->g, behind, 2, OVERLAY_TESTED);
    read_pixels(b, &p);
    assert_true(is_red(pixel(&p, SIDE * 3 / 4, SIDE / 2 - 1)));
}

static void the_overlay_stands_still_1e7_metres_away(void **state)
{
    bed *b = *state;
    const double far_off[3] = {1e7 + 0.25, -1e7, 1e7};
    static pixels near_by, far_away;
    for (int where = 0; where < 2; ++where) {
        camera c = camera_at(0, 0, 0);
        overlay_vertex line[2] = {{{-3, -3, -4}, RED}, {{3, 2, -5}, RED}};
        for (int k = 0; k < 3 && where; ++k) {
            c.eye[k] += far_off[k];
            line[0].position[k] += far_off[k];
            line[1].position[k] += far_off[k];
        }
        wall_scene(b, where ? far_off : NULL);
        wall_frame(b, &c, RENDER_SHADED);
        renderer_overlay_lines(b->g, line, 2, OVERLAY_TESTED);
        read_pixels(b, where ? &far_away : &near_by);
    }
    assert_memory_equal(near_by.rgba, far_away.rgba, sizeof near_by.rgba);
}

static void more_lines_than_a_chunk_are_all_drawn(void **state)
{
    bed *b = *state;
    enum { LINES = 10000 };
    static overlay_vertex lines[2 * LINES];
    static pixels p;
    const camera c = camera_at(0, 0, 0);
    for (uint32_t i = 0; i < LINES; ++i) { // rows of the picture, from the top, again and again
        const double y = 1 - (i % SIDE + 0.5) * 2 / SIDE;
        lines[2 * i] = (overlay_vertex){{-2, y, -1}, i + SIDE < LINES ? 0xff00ff00u : RED};
        lines[2 * i + 1] = (overlay_vertex){{2, y, -1}, i + SIDE < LINES ? 0xff00ff00u : RED};
    }
    wall_scene(b, NULL);
    wall_frame(b, &c, RENDER_SHADED);
    const uint64_t before = b->memory.calls;
    renderer_overlay_lines(b->g, lines, 2 * LINES, OVERLAY_ON_TOP);
    assert_int_equal(b->memory.calls, before);
    read_pixels(b, &p);
    assert_int_equal(red_pixels(&p), SIDE * SIDE);
}

// ---- Letters ----

static void write_text(bed *b, const camera *c, const overlay_text *t, pixels *out)
{
    wall_frame(b, c, RENDER_ITEMS);
    renderer_overlay_text(b->g, t);
    read_pixels(b, out);
}

static uint32_t red_in(const pixels *p, uint32_t x, uint32_t y, uint32_t wide, uint32_t high)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < wide * high; ++i) count += (uint32_t)is_red(pixel(p, x + i % wide, y + i / wide));
    return count;
}

static void every_letter_is_itself_and_stays_in_its_cell(void **state)
{
    bed *b = *state;
    static uint8_t seen[95][8 * 16];
    static pixels p;
    const camera c = camera_at(0, 0, 0);
    wall_scene(b, NULL);
    for (uint32_t i = 0; i < 95; ++i) {
        const char text[2] = {(char)(32 + i), 0};
        write_text(b, &c, &(overlay_text){text, 40, 32, 1, RED}, &p);
        assert_int_equal(red_pixels(&p), red_in(&p, 40, 32, 8, 16));
        assert_int_equal(red_in(&p, 40, 32, 8, 16) == 0, i == 0);
        assert_int_equal(red_in(&p, 47, 32, 1, 16), 0); // letters never touch
        for (uint32_t k = 0; k < 8 * 16; ++k) seen[i][k] = (uint8_t)is_red(pixel(&p, 40 + k % 8, 32 + k / 8));
        for (uint32_t k = 0; k < i; ++k) assert_true(memcmp(seen[i], seen[k], sizeof seen[i]) != 0);
    }
}

static void text_breaks_lines_scales_and_may_leave_the_picture(void **state)
{
    bed *b = *state;
    static pixels small, large, p;
    const camera c = camera_at(0, 0, 0);
    wall_scene(b, NULL);
    write_text(b, &c, &(overlay_text){"HI\nJ", 8, 4, 1, RED}, &small);
    assert_true(red_in(&small, 8, 4, 8, 16) && red_in(&small, 16, 4, 8, 16) && red_in(&small, 8, 20, 8, 16));
    assert_int_equal(red_in(&small, 16, 20, 112, 16), 0);
    write_text(b, &c, &(overlay_text){"HI\nJ", 8, 4, 3, RED}, &large);
    assert_int_equal(red_pixels(&large), 9 * red_pixels(&small));
    write_text(b, &c, &(overlay_text){"\x01", 0, 0, 1, RED}, &p);
    assert_true(red_pixels(&p) > 0); // letters that it lacks are a box
    write_text(b, &c, &(overlay_text){"HHHHHHHHHHHHHHHHHHHHHHHHH", 60, 120, 1, RED}, &p);
    assert_true(red_pixels(&p) > 0);
    write_text(b, &c, &(overlay_text){"H", 4000000000u, 4000000000u, 1000, RED}, &p);
    assert_int_equal(red_pixels(&p), 0);
}

static void in_a_frame_or_before_any_nothing_is_drawn_over_it(void **state)
{
    bed *b = *state;
    static pixels p;
    const camera c = camera_at(0, 0, 0);
    const overlay_vertex line[2] = {{{-7, 0.05, -4}, RED}, {{7, 0.05, -4}, RED}};
    const frame_request q = {.camera = &c, .width_px = SIDE, .height_px = SIDE};
    renderer_overlay_lines(b->g, line, 2, OVERLAY_TESTED);
    wall_scene(b, NULL);
    assert_int_equal(renderer_begin(b->g, &q, &b->r), RESULT_OK);
    renderer_overlay_lines(b->g, line, 2, OVERLAY_TESTED);
    renderer_end(b->g);
    read_pixels(b, &p);
    assert_int_equal(red_pixels(&p), 0);
    renderer_overlay_lines(b->g, line, 1, OVERLAY_TESTED); // half a line
    read_pixels(b, &p);
    assert_int_equal(red_pixels(&p), 0);
}

static void overdraw_shows_tested_lines_too(void **state)
{
    bed *b = *state;
    static pixels p;
    const camera c = camera_at(0, 0, 0);
    const overlay_vertex line[2] = {{{-7, 0.05, -8}, RED}, {{7, 0.05, -8}, RED}};
    wall_scene(b, NULL);
    wall_frame(b, &c, RENDER_SHADED); // leaves depth in the same target
    wall_frame(b, &c, RENDER_OVERDRAW);
    renderer_overlay_lines(b->g, line, 2, OVERLAY_TESTED);
    read_pixels(b, &p);
    assert_in_range(red_pixels(&p), SIDE * 7 / 8 - 3, SIDE * 7 / 8 + 3);
}

int main(void)
{
#define T(f) cmocka_unit_test_setup_teardown(f, bed_setup, bed_teardown)
    const struct CMUnitTest overlay[] = {
        T(a_line_behind_a_wall_is_hidden_unless_on_top),
        T(triangles_mix_by_their_alpha_and_leave_no_depth),
        T(the_overlay_stands_still_1e7_metres_away),
        T(more_lines_than_a_chunk_are_all_drawn),
        T(every_letter_is_itself_and_stays_in_its_cell),
        T(text_breaks_lines_scales_and_may_leave_the_picture),
        T(in_a_frame_or_before_any_nothing_is_drawn_over_it),
        T(overdraw_shows_tested_lines_too),
    };
    return RUN_WITH_GL(overlay);
}
