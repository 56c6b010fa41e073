// Levels of detail: a point that stands off is never seen farther from its place than is said, and a level is taken only where it saves more than its error costs.
// SPDX-License-Identifier: MIT
#include "plugins/imagecache/detail.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

static const bound_optics OPTICS = {623.5, 1.55};
static const cull_box BOX = {{-4, 0, -6}, {8, 5, 3}};

static double random_between(uint64_t *state, double low, double high)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return low + (high - low) * (double)(*state >> 11) * 0x1p-53;
}

static void unit(uint64_t *random, double out[3])
{
    double length;
    do {
        for (int k = 0; k < 3; k++) out[k] = random_between(random, -1, 1);
        length = sqrt(bound_dot(out, out));
    } while (!(length > 0.01 && length < 1));
    for (int k = 0; k < 3; k++) out[k] /= length;
}

// Where it stands on the plane at distance 1; 0: outside of the picture.
static int place_of(const double point[3], const double eye[3], const double axis[3], double out[3])
{
    double from_eye[3];
    bound_subtract(point, eye, from_eye);
    const double along = bound_dot(from_eye, axis);
    for (int k = 0; k < 3; k++) out[k] = from_eye[k] / along;
    return along > 0 && bound_dot(out, out) <= OPTICS.reach * OPTICS.reach;
}

static void no_point_is_seen_farther_from_its_place_than_is_said(void **state)
{
    (void)state;
    uint64_t random = 3;
    uint32_t counted = 0;
    double closest = 0;
    for (int i = 0; i < 200000; i++) {
        double eye[3], way[3], off[3], axis[3], point[3], moved[3], a[3], b[3], apart[3];
        const double away = random_between(&random, 0.001, 0.5), far = random_between(&random, 1, 60);
        unit(&random, way);
        unit(&random, off);
        for (int k = 0; k < 3; k++) {
            point[k] = random_between(&random, (double)(&BOX.min.x)[k], (double)(&BOX.max.x)[k]);
            eye[k] = 2 + 12 * way[k] + far * way[k];
            moved[k] = point[k] + away * off[k];
        }
        bound_subtract(point, eye, axis);
        const double length = sqrt(bound_dot(axis, axis));
        for (int k = 0; k < 3; k++) axis[k] = axis[k] / length + random_between(&random, -0.6, 0.6);
        const double turned = sqrt(bound_dot(axis, axis));
        for (int k = 0; k < 3; k++) axis[k] /= turned;
        if (!place_of(point, eye, axis, a) || !place_of(moved, eye, axis, b)) continue;
        bound_subtract(a, b, apart);
        const double seen = sqrt(bound_dot(apart, apart)) * OPTICS.pixels_per_tangent, said = detail_px(away, eye, &BOX, &OPTICS);
        assert_true(seen <= said);
        closest = seen / said > closest ? seen / said : closest;
        counted++;
    }
    assert_true(counted > 50000);
    assert_true(closest > 0.5); // it is no empty bound
}

static void what_is_nearer_than_twice_its_error_has_no_bound(void **state)
{
    (void)state;
    const double inside[3] = {0, 1, 0}, beside[3] = {9, 1, 0};
    assert_true(isinf(detail_px(0.1, inside, &BOX, &OPTICS)));
    assert_true(isinf(detail_px(0.6, beside, &BOX, &OPTICS)));
    assert_true(detail_px(0.1, beside, &BOX, &OPTICS) < INFINITY);
    assert_true(detail_px(0, inside, &BOX, &OPTICS) == 0);
}

static detail_choice choose(double far, double polygons_left, uint32_t polygon_count)
{
    const cull_costs costs = {.polygon_ns = 250, .pixel_ns = 3, .capture_ns = 25000, .capture_pixel_ns = 9, .level_count = 2,
                              .levels = {{1.0 / 128, polygons_left}, {1.0 / 32, polygons_left / 4}}};
    const double eye[3] = {far, 2, 0};
    return detail_choose(&(detail_request){&costs, &OPTICS, eye, &BOX, 1, polygon_count, 0});
}

static void a_level_is_taken_where_it_saves_more_than_its_error_costs(void **state)
{
    (void)state;
    assert_true(choose(40, 0.3, 100000).away_m == 0);          // near: its error is too much
    assert_true(choose(200, 0.3, 100000).away_m == 1.0f / 128);     // farther: the finer one
    assert_true(choose(2000, 0.3, 100000).away_m == 1.0f / 32);    // the coarser
    assert_true(choose(2000, 0.3, 100000).polygons == 0.3 / 4 * 100000);
    assert_true(choose(400, 0.3, 2).away_m == 0);              // nothing to save
    assert_true(choose(200, 0.999, 100000).away_m == 0);       // next to nothing
}

static void the_box_of_what_is_drawn_holds_all_that_moved(void **state)
{
    (void)state;
    const cull_box grown = detail_box(&BOX, 0.1), same = detail_box(&BOX, 0);
    for (int k = 0; k < 3; k++) {
        assert_true((double)(&grown.min.x)[k] <= (double)(&BOX.min.x)[k] - 0.1 && (double)(&grown.max.x)[k] >= (double)(&BOX.max.x)[k] + 0.1);
        assert_true((&same.min.x)[k] == (&BOX.min.x)[k] && (&same.max.x)[k] == (&BOX.max.x)[k]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_point_is_seen_farther_from_its_place_than_is_said),
        cmocka_unit_test(what_is_nearer_than_twice_its_error_has_no_bound),
        cmocka_unit_test(a_level_is_taken_where_it_saves_more_than_its_error_costs),
        cmocka_unit_test(the_box_of_what_is_drawn_holds_all_that_moved),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
