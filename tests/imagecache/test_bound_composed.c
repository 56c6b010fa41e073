// A picture composed of pictures of pictures: the oracle follows each point through every plane it was shown on, in long double.
// PORTCULLIS_LONG=1: 10,000,000 points instead of 100,000.
// SPDX-License-Identifier: MIT
#include "bound_cases.h"

#include "tests/common/random.h"
#include "tests/common/test.h"

#include <stdlib.h>
#include <string.h>

enum { POINTS = 50, LEVELS = 3 };

static uint32_t case_count(void)
{
    return (getenv("PORTCULLIS_LONG") ? 10000000u : 100000u) / POINTS;
}

// Each level's box holds the one below; the eyes moved on between the captures.
typedef struct composed {
    bound_capture capture[LEVELS];
    quad quad[LEVELS];
    double slip[LEVELS];
} composed;

static cull_box grown(uint64_t *state, cull_box box)
{
    float *low = &box.min.x, *high = &box.max.x; // members of one sort, one after the other
    const uint32_t sides = random_below(state, 8);
    for (uint32_t k = 0; k < 3; k++) {
        const float size = high[k] - low[k];
        if (k == 1) continue; // cells part x and z only
        if (sides >> k & 1) low[k] -= size;
        else high[k] += size;
    }
    return box;
}

static int compose_random(uint64_t *state, const bound_case *c, composed *out)
{
    cull_box box = c->box;
    double eye[3];
    memcpy(eye, c->taken.eye, sizeof eye);
    for (int level = 0; level < LEVELS; level++) {
        quad_request request = {.box = box, .optics = c->view.optics, .magnification = 1, .most_texels = 1u << 20};
        memcpy(request.eye, eye, sizeof eye);
        if (quad_of(&request, &out->quad[level]) != QUAD_OK) return 0;
        out->capture[level] = bound_capture_of(eye, &box);
        out->slip[level] = 0;
        if (level > 0) {
            const compose_child child = {&out->capture[level - 1], out->slip[level - 1], 0, BOUND_TEXEL_CENTRES};
            out->slip[level] = compose_slip(&out->capture[level], &child);
        }
        double way[3];
        random_direction(state, way);
        const double moved = out->capture[level].distance * random_between(state, 0, 0.01);
        for (int k = 0; k < 3; k++) eye[k] += moved * way[k];
        box = grown(state, box);
    }
    return out->slip[LEVELS - 1] < INFINITY;
}

// Where the last level shows the point.
static void follow(const composed *all, const double point[3], long double out[3])
{
    double at[3];
    memcpy(at, point, sizeof at);
    for (int level = 0; level < LEVELS; level++) {
        const case_image image = image_of(&all->quad[level], all->capture[level].eye, at);
        for (int k = 0; k < 3; k++) {
            at[k] = (double)image.point[k];
            out[k] = image.point[k];
        }
    }
}

static double off_px(const bound_view *view, const double wide[2], const double point[3], const long double shown[3])
{
    const long double truth[3] = {point[0], point[1], point[2]};
    const case_place a = place_of(view, truth), b = place_of(view, shown);
    if (!place_inside(a, wide) && !place_inside(b, wide)) return -1;
    return a.in_front && b.in_front ? hypot(a.x - b.x, a.y - b.y) * view->optics.pixels_per_tangent : INFINITY;
}

static void no_point_of_a_composed_picture_is_shown_farther_off_than_the_sum_says(void **unused)
{
    (void)unused;
    uint64_t state = 1;
    uint32_t asked = 0, near = 0;
    while (asked < case_count()) {
        bound_case c = case_random(&state, MOTION_ANY);
        composed all;
        double way[3], target[3];
        if (!compose_random(&state, &c, &all)) continue;
        random_direction(&state, way);
        const bound_capture *last = &all.capture[LEVELS - 1];
        for (int k = 0; k < 3; k++) c.view.eye[k] = last->eye[k] + last->distance * random_between(&state, 0, 0.02) * way[k];
        case_point(&state, &c.box, target);
        case_look_at(&state, target, c.wide, &c.view);
        const double here = compose_quad_px(last, all.slip[LEVELS - 1], &c.view);
        const double turned = compose_turned_px(last, all.slip[LEVELS - 1], c.view.eye, &c.view.optics);
        double most = 0;
        asked++;
        assert_true(here <= turned);
        for (int k = 0; k < POINTS; k++) {
            double point[3];
            long double shown[3];
            case_point(&state, &c.box, point);
            follow(&all, point, shown);
            const double off = off_px(&c.view, c.wide, point, shown);
            assert_true(off <= here && off <= turned);
            most = fmax(most, off);
        }
        near += most > here / 4;
    }
    assert_true(near > asked / 4); // the sum isn't far from what happens
}

static void the_eye_may_go_less_far_from_a_composed_picture_and_stays_within_the_tolerance(void **unused)
{
    (void)unused;
    uint64_t state = 2;
    uint32_t moved = 0, asked = 0;
    while (asked < case_count() / 4) {
        bound_case c = case_random(&state, MOTION_ANY);
        composed all;
        double way[3], point[3];
        if (!compose_random(&state, &c, &all)) continue;
        asked++;
        const bound_capture *last = &all.capture[LEVELS - 1];
        const double slip = all.slip[LEVELS - 1], reach = compose_reach_of_eye(last, slip, 2, &c.view.optics);
        assert_true(reach <= bound_reach_of_eye(last, 2, &c.view.optics));
        if (!(reach > 0)) continue; // too much slip already: to be rendered, not composed
        moved++;
        random_direction(&state, way);
        for (int k = 0; k < 3; k++) c.view.eye[k] = last->eye[k] + reach * way[k];
        for (int k = 0; k < POINTS; k++) {
            long double shown[3];
            case_point(&state, &c.box, point);
            if (k % 10 == 0) case_look_at(&state, point, c.wide, &c.view);
            follow(&all, point, shown);
            assert_true(off_px(&c.view, c.wide, point, shown) <= 2);
        }
    }
    assert_true(moved > asked / 20);
}

static void a_parent_of_what_was_just_taken_adds_next_to_nothing(void **unused)
{
    (void)unused;
    uint64_t state = 3;
    for (uint32_t i = 0; i < 500; i++) {
        const bound_case c = case_random(&state, MOTION_ANY);
        const compose_child child = {&c.capture, 0, c.quad.texel[0], BOUND_TEXEL_CENTRES};
        const double slip = compose_slip(&c.capture, &child);
        assert_true(slip < c.capture.distance * 1e-5); // floats
        const compose_child coarse = {&c.capture, 0, c.quad.texel[0], BOUND_NEAREST}, stale = {&c.capture, 1, 0, BOUND_TEXEL_CENTRES};
        assert_true(compose_slip(&c.capture, &coarse) >= slip + c.quad.texel[0] * 0.7);
        assert_true(compose_slip(&c.capture, &stale) >= slip + 1); // what a child carries is never lost
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_point_of_a_composed_picture_is_shown_farther_off_than_the_sum_says),
        cmocka_unit_test(the_eye_may_go_less_far_from_a_composed_picture_and_stays_within_the_tolerance),
        cmocka_unit_test(a_parent_of_what_was_just_taken_adds_next_to_nothing),
    };
    return cmocka_run_group_tests_name("imagecache_bound_composed", tests, NULL, NULL);
}
