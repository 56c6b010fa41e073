// Popping: places found again in the view before, and errors told apart that go with their surface and that do not. A wall across the view at 8 m,
// 64 pixels wide with a tangent of 1 to each side: a step of a quarter of a metre to the right is one pixel.
// SPDX-License-Identifier: MIT
#include "bench/popping.h"
#include "tests/common/test.h"

#include <math.h>
#include <string.h>

enum { WIDTH = 64, HEIGHT = 32, PIXELS = WIDTH * HEIGHT };
static const double WALL_M = 8, PIXEL_M = 0.25;

typedef struct stand { camera camera; float depths[PIXELS], movers[PIXELS]; } stand;

static camera camera_at(double x)
{
    return (camera){.eye = {1000 + x, 3, -5}, .forward = {0, 0, -1}, .up = {0, 1, 0}, .fovy_deg = 2 * atan(0.5) * 180 / 3.14159265358979323846,
                    .aspect = 2, .near_m = 0.1, .far_m = INFINITY};
}

static float depth_at(const camera *c, double distance)
{
    if (!isfinite(c->far_m)) return (float)(c->near_m / distance);
    return (float)(c->near_m / (c->far_m - c->near_m) * (c->far_m / distance - 1));
}

static void stand_at(double x, stand *out)
{
    memset(out, 0, sizeof *out);
    out->camera = camera_at(x);
    for (int i = 0; i < PIXELS; ++i) out->depths[i] = depth_at(&out->camera, WALL_M);
}

static void trace(const stand *before, const stand *now, uint32_t *from)
{
    popping_trace(&(popping_views){{&before->camera, before->depths, before->movers}, {&now->camera, now->depths, now->movers}, WIDTH, HEIGHT}, from);
}

static void a_camera_that_stays_finds_every_pixel_where_it_was(void **state)
{
    (void)state;
    static stand s;
    static uint32_t from[PIXELS];
    for (int far = 0; far < 2; ++far) {
        stand_at(0, &s);
        if (far) s.camera.far_m = 20;
        for (int i = 0; i < PIXELS; ++i) s.depths[i] = i % 3 == 0 ? 0 : depth_at(&s.camera, 1 + i % 17); // sky among it
        trace(&s, &s, from);
        for (uint32_t i = 0; i < PIXELS; ++i) assert_int_equal(from[i], i);
    }
}

static void a_step_aside_finds_the_wall_as_many_pixels_aside(void **state)
{
    (void)state;
    static stand before, now;
    static uint32_t from[PIXELS];
    stand_at(0, &before);
    stand_at(3 * PIXEL_M, &now);
    trace(&before, &now, from);
    for (uint32_t y = 0; y < HEIGHT; ++y)
        for (uint32_t x = 0; x < WIDTH; ++x) // what is at x now was three pixels farther right
            assert_int_equal(from[y * WIDTH + x], x + 3 < WIDTH ? y * WIDTH + x + 3 : POPPING_NEW);
}

static void rows_of_depths_count_from_the_bottom_and_of_pixels_from_the_top(void **state)
{
    (void)state;
    static stand before, now;
    static uint32_t from[PIXELS];
    stand_at(0, &before);
    stand_at(0, &now);
    now.camera.eye[1] += 2 * PIXEL_M; // what is two rows up in the picture before
    trace(&before, &now, from);
    for (uint32_t y = 0; y < HEIGHT; ++y) assert_int_equal(from[y * WIDTH], y >= 2 ? (y - 2) * WIDTH : POPPING_NEW);
}

static void the_sky_turns_and_does_not_move(void **state)
{
    (void)state;
    static stand before, now;
    static uint32_t from[PIXELS];
    stand_at(0, &before);
    stand_at(100, &now);
    memset(before.depths, 0, sizeof before.depths);
    memset(now.depths, 0, sizeof now.depths);
    trace(&before, &now, from);
    for (uint32_t i = 0; i < PIXELS; ++i) assert_int_equal(from[i], i);
    now.camera.forward[2] = 1; // round about
    trace(&before, &now, from);
    for (uint32_t i = 0; i < PIXELS; ++i) assert_int_equal(from[i], POPPING_NEW);
}

static void what_was_hidden_or_moves_is_new(void **state)
{
    (void)state;
    static stand before, now;
    static uint32_t from[PIXELS];
    stand_at(0, &before);
    stand_at(0, &now);
    before.depths[5] = depth_at(&before.camera, WALL_M / 2); // something stood in front, in the bottom row
    before.depths[6] = 0;
    now.movers[7] = now.depths[7];
    before.movers[8] = before.depths[8];
    before.movers[9] = before.depths[9] / 2; // behind the wall
    trace(&before, &now, from);
    for (uint32_t x = 0; x < WIDTH; ++x)
        assert_int_equal(from[(HEIGHT - 1) * WIDTH + x], x >= 5 && x <= 8 ? POPPING_NEW : (HEIGHT - 1) * WIDTH + x);
}

typedef struct sight { uint8_t truth[PIXELS * 4], shown[PIXELS * 4]; } sight;

// A wall whose columns are numbered in the world, and an error on one of them.
static void paint(int first, int column, int error, sight *out)
{
    for (int i = 0; i < PIXELS; ++i)
        for (int k = 0; k < 4; ++k) {
            const int number = first + i % WIDTH, plain = 60 + number * 37 % 120;
            out->truth[4 * i + k] = (uint8_t)plain;
            out->shown[4 * i + k] = (uint8_t)(number == column ? plain + error : plain);
        }
}

static void look(const sight *before, const sight *now, uint8_t *expected)
{
    static stand from_stand, to_stand;
    static uint32_t from[PIXELS];
    stand_at(0, &from_stand);
    stand_at(2 * PIXEL_M, &to_stand);
    trace(&from_stand, &to_stand, from);
    popping_expect(&(popping_pictures){before->truth, before->shown, now->truth, now->shown, from, PIXELS}, expected);
}

static int count_different(const uint8_t *a, const uint8_t *b)
{
    int count = 0;
    for (int i = 0; i < PIXELS; ++i) count += memcmp(a + 4 * i, b + 4 * i, 3) != 0;
    return count;
}

static void an_error_that_goes_with_its_surface_is_no_popping(void **state)
{
    (void)state;
    static sight before, now;
    static uint8_t expected[PIXELS * 4];
    paint(0, 20, 30, &before);
    paint(2, 20, 30, &now);
    look(&before, &now, expected);
    assert_int_equal(count_different(expected, now.shown), 0);
}

static void an_error_that_jumps_comes_or_goes_is(void **state)
{
    (void)state;
    static sight before, now;
    static uint8_t expected[PIXELS * 4];
    const struct { int from_column, from, to_column, to, columns; } cases[] = {{20, 30, 20, -30, 1}, {20, 30, 21, 30, 2}, {20, 0, 20, 30, 1}, {20, 30, 20, 0, 1}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        paint(0, cases[i].from_column, cases[i].from, &before);
        paint(2, cases[i].to_column, cases[i].to, &now);
        look(&before, &now, expected);
        assert_int_equal(count_different(expected, now.shown), cases[i].columns * HEIGHT);
    }
}

static void an_error_where_nothing_was_before_is_not_counted(void **state)
{
    (void)state;
    static sight before, now;
    static uint8_t expected[PIXELS * 4];
    paint(0, -1, 0, &before);
    paint(2, 2 + WIDTH - 1, 50, &now); // the last column now was out of the picture
    look(&before, &now, expected);
    assert_int_equal(count_different(expected, now.shown), 0);
    assert_int_equal(count_different(now.truth, now.shown), HEIGHT);
}

static void what_is_expected_stays_a_byte(void **state)
{
    (void)state;
    static uint8_t truth_before[4] = {250, 10, 0, 255}, shown_before[4] = {5, 250, 0, 255}, truth[4] = {10, 250, 7, 255}, shown[4] = {1, 2, 3, 255}, expected[4];
    static const uint32_t from[1] = {0};
    popping_expect(&(popping_pictures){truth_before, shown_before, truth, shown, from, 1}, expected);
    assert_int_equal(expected[0], 0);
    assert_int_equal(expected[1], 255);
    assert_int_equal(expected[2], 7);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_camera_that_stays_finds_every_pixel_where_it_was),
        cmocka_unit_test(a_step_aside_finds_the_wall_as_many_pixels_aside),
        cmocka_unit_test(rows_of_depths_count_from_the_bottom_and_of_pixels_from_the_top),
        cmocka_unit_test(the_sky_turns_and_does_not_move),
        cmocka_unit_test(what_was_hidden_or_moves_is_new),
        cmocka_unit_test(an_error_that_goes_with_its_surface_is_no_popping),
        cmocka_unit_test(an_error_that_jumps_comes_or_goes_is),
        cmocka_unit_test(an_error_where_nothing_was_before_is_not_counted),
        cmocka_unit_test(what_is_expected_stays_a_byte),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
