// Coarser triangles in captures: what is asked for exactly stays exact to the bit, what may be coarser is, other modes and orders draw all; failing memory.
// SPDX-License-Identifier: MIT
#include "picture_fixture.h"

#include <math.h>
#include <string.h>

enum { CELLS = 48, POINTS = (CELLS + 1) * (CELLS + 1), INDICES = 6 * CELLS * CELLS, ITEM = 384, ITEMS = INDICES / ITEM };

static const cull_run everything = {0, ITEMS};

static int8_t snorm8(double x)
{
    return (int8_t)lround(127 * x);
}

// A wide bowl 10 m away, with the normals of its shape.
static void show_bowl(bed *b)
{
    static double positions[POINTS][3];
    static uint32_t indices[INDICES];
    uint32_t *at = indices;
    for (int i = 0; i < POINTS; ++i) {
        const double x = i % (CELLS + 1) * 16.0 / CELLS - 8, y = i / (CELLS + 1) * 16.0 / CELLS - 8;
        const double place[3] = {x, y, -12 + 0.004 * (x * x + y * y)};
        memcpy(positions[i], place, sizeof place);
    }
    for (uint32_t q = 0; q < CELLS * CELLS; ++q) {
        const uint32_t a = q / CELLS * (CELLS + 1) + q % CELLS, c = a + CELLS + 1, quad[6] = {a, a + 1, c, c, a + 1, c + 1};
        memcpy(at, quad, sizeof quad);
        at += 6;
    }
    bed_mesh(b, (const double(*)[3])positions, POINTS, indices, INDICES, ITEM);
    assert_int_equal(b->s->position_count, POINTS);
    for (int i = 0; i < POINTS; ++i) {
        const double n[3] = {-0.008 * positions[i][0], -0.008 * positions[i][1], 1}, length = sqrt(n[0] * n[0] + n[1] * n[1] + 1);
        b->s->normals[i] = 0;
        for (int k = 0; k < 3; ++k) b->s->normals[i] |= (uint32_t)(uint8_t)snorm8(n[k] / length) << 8 * k;
    }
    render_layout_close(b->l); // it is of the scene without normals
    b->l = NULL;
    assert_int_equal(renderer_upload(b->g, b->s, &b->r), RESULT_OK);
    assert_int_equal(bed_layout(b, NULL, &b->l), RESULT_OK);
    assert_int_equal(render_layout_slots(b->l, &(uint32_t){SLOTS}, &b->r), RESULT_OK);
}

static uint8_t *bowl_frame(bed *b, render_mode mode, float detail_m)
{
    const camera c = camera_at(0, 0, 0);
    frame_request q = request(&c);
    cull_capture taken = whole_picture(b, &c, 4, &everything, 1);
    const cull_picture shown = {.slot = 7, .runs = &everything, .run_count = 1};
    q.mode = mode;
    taken.detail_m = detail_m;
    return frame_with(b, &q, &taken, &shown, NULL);
}

static int is_the_same(bed *b, render_mode mode, float detail_m)
{
    uint8_t *all = bowl_frame(b, mode, 0), *other = bowl_frame(b, mode, detail_m);
    const int same = memcmp(all, other, (size_t)SIDE * SIDE * 4) == 0;
    drop_pixels(all);
    drop_pixels(other);
    return same;
}

static cull_costs levels_of(bed *b)
{
    cull_costs costs = {0};
    assert_int_equal(render_layout_levels(b->l, &b->r, &costs), RESULT_OK);
    return costs;
}

static void levels_are_told_finest_first_each_worth_it(void **state)
{
    bed *b = *state;
    show_bowl(b);
    const cull_costs costs = levels_of(b), again = levels_of(b);
    assert_in_range(costs.level_count, 1, CULL_LEVELS_MOST);
    double polygons = 1, away = 0;
    for (uint32_t k = 0; k < costs.level_count; ++k) {
        assert_true(costs.levels[k].away_m > away && costs.levels[k].polygons <= 0.7 * polygons && costs.levels[k].polygons > 0);
        away = costs.levels[k].away_m;
        polygons = costs.levels[k].polygons;
    }
    assert_memory_equal(&costs, &again, sizeof costs);
}

static void a_capture_is_coarser_only_as_far_as_it_may_be(void **state)
{
    bed *b = *state;
    show_bowl(b);
    uint8_t *before = bowl_frame(b, RENDER_SHADED, 100);
    const cull_costs costs = levels_of(b);
    uint8_t *all = bowl_frame(b, RENDER_SHADED, 0);
    assert_in_range(costs.level_count, 1, CULL_LEVELS_MOST);
    assert_memory_equal(before, all, (size_t)SIDE * SIDE * 4); // nobody had asked for levels
    const double finest = costs.levels[0].away_m;
    assert_true(is_the_same(b, RENDER_SHADED, nextafterf((float)finest, 0)));
    assert_true(is_the_same(b, RENDER_SHADED, NAN));
    assert_true(is_the_same(b, RENDER_SHADED, -1));
    for (uint32_t k = 0; k < costs.level_count; ++k) {
        uint8_t *coarser = bowl_frame(b, RENDER_SHADED, (float)costs.levels[k].away_m);
        assert_memory_not_equal(coarser, all, (size_t)SIDE * SIDE * 4);
        assert_in_range(pixels_that_differ(coarser, all), 0, SIDE * SIDE / 50);
        drop_pixels(coarser);
    }
    drop_pixels(before);
    drop_pixels(all);
}

static void modes_that_tell_triangles_draw_all_of_them(void **state)
{
    bed *b = *state;
    show_bowl(b);
    levels_of(b);
    assert_true(is_the_same(b, RENDER_ITEMS, 100));
    assert_true(is_the_same(b, RENDER_ZONES, 100));
    assert_false(is_the_same(b, RENDER_SHADED, 100));
}

static void another_order_draws_all_until_levels_are_asked_for_again(void **state)
{
    bed *b = *state;
    uint32_t order[ITEMS];
    show_bowl(b);
    levels_of(b);
    for (uint32_t i = 0; i < ITEMS; ++i) order[i] = ITEMS - 1 - i;
    assert_int_equal(render_layout_reorder(b->l, 0, order, &b->r), RESULT_OK);
    assert_true(is_the_same(b, RENDER_SHADED, 100));
    uint8_t *all = bowl_frame(b, RENDER_SHADED, 0);
    levels_of(b);
    uint8_t *coarser = bowl_frame(b, RENDER_SHADED, 100);
    assert_memory_not_equal(coarser, all, (size_t)SIDE * SIDE * 4);
    assert_in_range(pixels_that_differ(coarser, all), 0, SIDE * SIDE / 50);
    drop_pixels(all);
    drop_pixels(coarser);
}

static void failing_memory_leaves_every_triangle_drawn(void **state)
{
    bed *b = *state;
    uint32_t failures = 0;
    result done = RESULT_NO_MEMORY;
    for (uint64_t at = 1; done != RESULT_OK; ++at) {
        cull_costs costs = {0};
        show_bowl(b);
        b->memory.fail_at = b->memory.calls + at;
        done = render_layout_levels(b->l, &b->r, &costs);
        b->memory.fail_at = 0;
        if (done == RESULT_OK) continue;
        assert_int_equal(done, RESULT_NO_MEMORY);
        assert_true(is_the_same(b, RENDER_SHADED, 100));
        failures++;
    }
    assert_true(failures > 10);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(levels_are_told_finest_first_each_worth_it, bed_setup, bed_teardown),
        cmocka_unit_test_setup_teardown(a_capture_is_coarser_only_as_far_as_it_may_be, bed_setup, bed_teardown),
        cmocka_unit_test_setup_teardown(modes_that_tell_triangles_draw_all_of_them, bed_setup, bed_teardown),
        cmocka_unit_test_setup_teardown(another_order_draws_all_until_levels_are_asked_for_again, bed_setup, bed_teardown),
        cmocka_unit_test_setup_teardown(failing_memory_leaves_every_triangle_drawn, bed_setup, bed_teardown),
    };
    return RUN_WITH_GL(tests);
}
