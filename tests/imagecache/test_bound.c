// No point of a box is shown farther off than the bounds of plugins/imagecache/bound.h say, by the oracle of bound_cases.h; and
// they are near to what happens. PORTCULLIS_LONG=1: 10,000,000 points a form instead of 100,000.
// SPDX-License-Identifier: MIT
#include "bound_baselines.h"

#include "tests/common/random.h"
#include "tests/common/test.h"

#include <stdlib.h>
#include <string.h>

enum { POINTS_PER_CASE = 100, GRID = 9 };

static uint32_t case_count(void)
{
    return (getenv("PORTCULLIS_LONG") ? 10000000u : 100000u) / POINTS_PER_CASE;
}

static double distance_moved(const bound_case *c)
{
    double moved[3];
    bound_subtract(c->view.eye, c->capture.eye, moved);
    return sqrt(bound_dot(moved, moved));
}

static void no_point_is_shown_farther_off_than_any_form_of_the_bound_says(void **unused)
{
    (void)unused;
    uint64_t state = 11, seen = 0, bounded = 0;
    for (uint32_t i = 0; i < case_count(); i++) {
        const bound_case c = case_random(&state, MOTION_ANY);
        const double here = bound_quad_px(&c.capture, &c.view), turned = bound_turned_px(&c.capture, c.view.eye, &c.view.optics);
        const double within = bound_within_px(&c.capture, distance_moved(&c), &c.view.optics);
        assert_true(here <= turned);
        if (here < INFINITY) bounded++;
        for (int k = 0; k < POINTS_PER_CASE; k++) {
            double point[3];
            case_point(&state, &c.box, point);
            const double off = shown_off_px(&c, point);
            if (off >= 0) seen++;
            assert_true(off <= here && off <= turned && off <= within);
        }
    }
    assert_true(seen > (uint64_t)case_count() * POINTS_PER_CASE / 3); // it was asked about points in the picture,
    assert_true(bounded > case_count() * 9 / 10);                     // and answered
}

// The eye anywhere that the reach allows, as often at its very end, looking anywhere.
static void accepted_at(double tolerance, uint64_t seed, uint32_t cases)
{
    uint64_t state = seed;
    uint32_t moved = 0;
    double most = 0;
    for (uint32_t i = 0; i < cases; i++) {
        bound_case c = case_random(&state, MOTION_ANY);
        const double reach = bound_reach_of_eye(&c.capture, tolerance, &c.view.optics);
        assert_true(bound_within_px(&c.capture, reach, &c.view.optics) <= tolerance);
        double way[3], point[3];
        random_direction(&state, way);
        const double far = reach * (random_below(&state, 2) ? 1 : random_unit(&state));
        for (int k = 0; k < 3; k++) c.view.eye[k] = c.capture.eye[k] + far * way[k];
        case_point(&state, &c.box, point);
        case_look_at(&state, point, c.wide, &c.view);
        if (reach > 0) moved++;
        for (int k = 0; k < POINTS_PER_CASE; k++) {
            const double off = shown_off_px(&c, point);
            assert_true(off <= tolerance);
            if (off > most) most = off;
            case_point(&state, &c.box, point);
        }
    }
    assert_true(moved > cases * 9 / 10);
    assert_true(most > tolerance * 0.8); // the reach was worth its length
}

static void a_picture_accepted_at_a_tolerance_shows_no_point_farther_off(void **unused)
{
    (void)unused;
    const uint32_t cases = case_count() / 2;
    accepted_at(0.5, 21, cases);
    accepted_at(1, 22, cases);
    accepted_at(2, 23, cases);
}

static void centre_alignment_shows_no_point_farther_off_than_its_bound_says(void **unused)
{
    (void)unused;
    uint64_t state = 31;
    uint32_t asked = 0, bounded = 0;
    while (asked < case_count()) {
        const bound_case c = case_random(&state, random_below(&state, 4) ? MOTION_CENTRE : MOTION_ANY);
        quad taken;
        quad_request request = {.box = c.box, .optics = c.taken.optics, .magnification = 1, .most_texels = 1u << 20};
        memcpy(request.eye, c.capture.eye, sizeof request.eye);
        if (quad_aligned_of(&request, &c.taken, &taken) != QUAD_OK) continue;
        const quad shown = quad_aligned_shown(&taken, &c.view);
        const double bound = bound_centre_px(&c.capture, &c.taken, &c.view);
        asked++;
        if (bound < 1000) bounded++;
        for (int k = 0; k < POINTS_PER_CASE; k++) {
            double point[3];
            case_point(&state, &c.box, point);
            assert_true(aligned_off_px(&c, &taken, &shown, point) <= bound);
        }
    }
    assert_true(bounded > asked / 2);
}

static void kept_depth_leaves_no_point_farther_off_than_its_bound_says(void **unused)
{
    (void)unused;
    uint64_t state = 41;
    uint32_t bounded = 0;
    for (uint32_t i = 0; i < case_count(); i++) {
        const bound_case c = case_random(&state, MOTION_ANY);
        const double step = c.capture.nearest_depth * random_between(&state, 0, 0.1);
        const double bound = bound_depth_px(&c.capture, &c.view, step);
        if (bound < INFINITY) bounded++;
        for (int k = 0; k < POINTS_PER_CASE; k++) {
            double point[3];
            case_point(&state, &c.box, point);
            const double end = random_below(&state, 2) ? step / 2 : -step / 2, error = random_below(&state, 2) ? end : random_unit(&state) * end;
            assert_true(deep_off_px(&c, point, error) <= bound);
        }
    }
    assert_true(bounded > case_count() * 8 / 10);
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double grid_pixels(const bound_case *c)
{
    double most = 0, point[3];
    for (uint32_t k = 0; k < 6 * GRID * GRID; k++) {
        case_grid_point(&c->box, k, GRID, point);
        most = fmax(most, bound_pixels(shown_off_tangent(c, c->view.eye, point), &c->view.optics));
    }
    return most;
}

static void the_bound_is_within_a_tenth_of_the_worst_point_in_half_of_all_cases_and_below_the_pages_formula(void **unused)
{
    (void)unused;
    enum { CASES = 600 };
    static double ours[CASES], pages[CASES];
    uint64_t state = 51;
    uint32_t count = 0;
    while (count < CASES) {
        const bound_case c = case_random(&state, MOTION_ANY);
        const double most = grid_pixels(&c), bound = bound_turned_px(&c.capture, c.view.eye, &c.view.optics);
        const double page = baseline_page_px(&c.capture, c.view.eye, &c.view.optics);
        assert_true(bound >= most);
        if (!(most > 0.25 && most < 16)) continue; // where a tolerance decides
        assert_true(page * (1 + 1e-6) >= most);
        ours[count] = bound / most;
        pages[count++] = page / most;
    }
    qsort(ours, CASES, sizeof ours[0], ascending);
    qsort(pages, CASES, sizeof pages[0], ascending);
    assert_true(ours[CASES / 2] <= 1.1);
    assert_true(ours[CASES * 9 / 10] <= 1.25);
    assert_true(pages[CASES / 2] > 1.3);
}

// The baseline, kept to show what it does.
static void the_eight_corner_test_of_1996_is_no_bound(void **unused)
{
    (void)unused;
    enum { CASES = 2000 };
    uint64_t state = 61;
    uint32_t violations = 0;
    double worst = 0;
    for (uint32_t i = 0; i < CASES; i++) {
        const bound_case c = case_random(&state, MOTION_ANY);
        const double most = grid_pixels(&c), corners = baseline_corners_px(&c);
        if (!(most > corners * 1.001)) continue;
        violations++;
        if (most < INFINITY && most / corners > worst) worst = most / corners;
    }
    print_message("8 corners: %.1f%% of %u cases exceed them, the worst %.2f times\n", 100.0 * violations / CASES, (unsigned)CASES, worst);
    assert_true(violations > CASES / 50);
    assert_true(worst > 1.2);
}

static void turning_alone_displaces_nothing_but_what_rounding_does(void **unused)
{
    (void)unused;
    uint64_t state = 71;
    for (uint32_t i = 0; i < 2000; i++) {
        const bound_case c = case_random(&state, MOTION_TURNED);
        double point[3];
        case_point(&state, &c.box, point);
        assert_true(shown_off_px(&c, point) < 1e-9);
        const double bound = bound_quad_px(&c.capture, &c.view);
        assert_true(bound == bound_rounding_px(&c.capture, 0, &c.view.optics));
        assert_true(bound > 0 && bound < 0.1);
    }
}

static void turning_the_view_does_not_change_what_is_said_of_any_view(void **unused)
{
    (void)unused;
    uint64_t state = 72;
    for (uint32_t i = 0; i < 1000; i++) {
        bound_case c = case_random(&state, MOTION_ANY);
        double point[3];
        const double any = bound_turned_px(&c.capture, c.view.eye, &c.view.optics);
        for (int turn = 0; turn < 8; turn++) {
            case_point(&state, &c.box, point);
            case_look_at(&state, point, c.wide, &c.view);
            assert_true(shown_off_px(&c, point) <= any);
            assert_true(bound_quad_px(&c.capture, &c.view) <= any);
        }
    }
}

static bound_case scaled_by(const bound_case *from, float by)
{
    bound_case to = *from;
    to.box.min = (cull_vec3){from->box.min.x * by, from->box.min.y * by, from->box.min.z * by};
    to.box.max = (cull_vec3){from->box.max.x * by, from->box.max.y * by, from->box.max.z * by};
    for (int k = 0; k < 3; k++) {
        to.taken.eye[k] = from->taken.eye[k] * by;
        to.view.eye[k] = from->view.eye[k] * by;
    }
    to.capture = bound_capture_of(to.taken.eye, &to.box);
    return to;
}

static void scaling_the_world_by_a_power_of_two_changes_no_bit_of_a_bound(void **unused)
{
    (void)unused;
    uint64_t state = 81;
    for (uint32_t i = 0; i < 2000; i++) {
        const bound_case c = case_random(&state, MOTION_CENTRE);
        const float by = ldexpf(1, (int)random_below(&state, 21) - 10);
        const bound_case d = scaled_by(&c, by);
        assert_true(bound_quad_px(&c.capture, &c.view) == bound_quad_px(&d.capture, &d.view));
        assert_true(bound_turned_px(&c.capture, c.view.eye, &c.view.optics) == bound_turned_px(&d.capture, d.view.eye, &d.view.optics));
        assert_true(bound_centre_px(&c.capture, &c.taken, &c.view) == bound_centre_px(&d.capture, &d.taken, &d.view));
        const double step = c.capture.distance / 4096;
        assert_true(bound_depth_px(&c.capture, &c.view, step) == bound_depth_px(&d.capture, &d.view, step * by));
        assert_true(bound_reach_of_eye(&c.capture, 1, &c.view.optics) * by == bound_reach_of_eye(&d.capture, 1, &d.view.optics));
    }
}

static void going_farther_never_lowers_the_bound_and_the_reach_is_its_inverse(void **unused)
{
    (void)unused;
    uint64_t state = 91;
    for (uint32_t i = 0; i < 2000; i++) {
        const bound_case c = case_random(&state, MOTION_ANY);
        double before = 0;
        for (int k = 0; k <= 40; k++) {
            const double now = bound_within_px(&c.capture, c.capture.distance * k / 80, &c.view.optics);
            assert_true(now >= before);
            before = now;
        }
        const double reach = bound_reach_of_eye(&c.capture, 1, &c.view.optics), less = bound_reach_of_eye(&c.capture, 0.5, &c.view.optics);
        assert_true(less <= reach);
        assert_true(bound_within_px(&c.capture, reach, &c.view.optics) <= 1);
        if (reach > 0 && reach < c.capture.distance * 0.49) assert_true(bound_within_px(&c.capture, reach * 1.05, &c.view.optics) > 0.98);
    }
}

// On the ray to the point, the eye at the given distance that sees the largest angle: the maximum in bound.c's "the eye anywhere near".
static void worst_eye(const bound_case *c, const double point[3], double distance, double out[3])
{
    double ray[3], side[3], any[3] = {0.3, 0.5, -0.8};
    bound_subtract(point, c->capture.eye, ray);
    const double near = sqrt(bound_dot(ray, ray)), far = near * c->capture.distance / bound_dot(ray, c->capture.normal);
    bound_cross(ray, any, side);
    const double wide = sqrt(bound_dot(side, side)), cosine = (near + far) * distance / (near * far + distance * distance);
    const double sine = sqrt(1 - cosine * cosine);
    for (int k = 0; k < 3; k++) out[k] = c->capture.eye[k] + distance * (cosine * ray[k] / near + sine * side[k] / wide);
}

static void the_worst_eye_within_a_distance_is_bounded_however_far_it_is(void **unused)
{
    (void)unused;
    uint64_t state = 101;
    double closest = INFINITY;
    for (uint32_t i = 0; i < 4000; i++) {
        const bound_case c = case_random(&state, MOTION_ANY);
        const bound_optics middle = {1000, 1};
        const double distance = c.capture.nearest_depth * random_between(&state, 0.01, 0.8);
        const double bound = bound_within_px(&c.capture, distance, &middle);
        double worst = 0, eye[3], point[3];
        for (uint32_t k = 0; k < 6 * GRID * GRID; k++) {
            case_grid_point(&c.box, k, GRID, point);
            worst_eye(&c, point, distance, eye);
            worst = fmax(worst, bound_pixels(shown_off_tangent(&c, eye, point), &middle));
        }
        assert_true(worst <= bound);
        if (worst > 100) closest = fmin(closest, bound / worst);
    }
    assert_true(closest < 1.001); // some reach it
}

static void an_angle_is_most_pixels_at_the_corner_of_the_picture_and_outward(void **unused)
{
    (void)unused;
    uint64_t state = 111;
    for (uint32_t i = 0; i < 20000; i++) {
        const double corner = random_between(&state, 0.1, 2), t = random_between(&state, 0, 0.4) / corner;
        const bound_optics optics = {1000, sqrt(1 + corner * corner)};
        const double bound = bound_pixels(t, &optics), first = atan(random_unit(&state) * corner), turn = random_between(&state, 0, 6.2832);
        // The second direction at the angle atan(t) from the first, turned about it.
        const double x = sin(first) + t * cos(turn) * cos(first), y = t * sin(turn), z = cos(first) - t * cos(turn) * sin(first);
        assert_true(z > 0 && hypot(x / z - tan(first), y / z) * 1000 <= bound * (1 + 1e-12));
        const double outward = tan(atan(corner) + atan(t)) - corner;
        assert_true(fabs(bound - 1000 * outward) < 1e-9 * bound);
        assert_true(fabs(bound_tangent(bound, &optics) - t) < 1e-12);
    }
}

static void a_segment_is_seen_widest_from_before_its_middle(void **unused)
{
    (void)unused;
    uint64_t state = 121;
    for (uint32_t i = 0; i < 20000; i++) {
        const double length = random_between(&state, 0, 3), away = random_between(&state, 2, 9), slide = random_between(&state, -4, 4);
        const double angle = atan((slide + length) / away) - atan(slide / away);
        assert_true(tan(angle) <= bound_segment(length, away) * (1 + 1e-12));
    }
    assert_true(bound_segment(4, 2) == INFINITY);
}

static void what_cannot_be_bounded_is_infinite(void **unused)
{
    (void)unused;
    const cull_box box = {{-5, -4, -5}, {5, 4, 5}};
    const double outside[3] = {0, 0, 40}, inside[3] = {1, 1, 1};
    const bound_capture capture = bound_capture_of(outside, &box), within = bound_capture_of(inside, &box);
    bound_view view = {.eye = {0, 0, 40}, .right = {1, 0, 0}, .up = {0, 1, 0}, .forward = {0, 0, -1}, .optics = {1000, 1.2}};
    assert_true(bound_quad_px(&capture, &view) < 0.1);
    assert_true(bound_quad_px(&within, &view) == INFINITY);
    assert_true(bound_within_px(&within, 0, &view.optics) == INFINITY);
    assert_true(bound_reach_of_eye(&within, 1, &view.optics) == 0);
    view.eye[2] = 0; // in the box
    assert_true(bound_quad_px(&capture, &view) == INFINITY);
    view.eye[2] = -40; // behind it
    view.forward[2] = 1;
    assert_true(bound_quad_px(&capture, &view) == INFINITY);
    assert_true(bound_within_px(&capture, 40, &view.optics) == INFINITY);
    const bound_optics parallel = {1000, INFINITY};
    assert_true(bound_turned_px(&capture, outside, &parallel) == INFINITY);
    assert_true(bound_reach_of_eye(&capture, 0.001, &view.optics) == 0); // finer than floats are drawn
}

static void a_view_lent_by_the_host_gives_its_axes(void **unused)
{
    (void)unused;
    // Looks along -x from (1, 2, 3), 60 degrees wide, the picture's middle off the axis by a tenth.
    const float r = 1.7320508f, u = 3.0792014f;
    const cull_view lent = {.eye_exact = {1, 2, 3, 1}, .forward = {-1, 0, 0}, .reach = 1.25, .eye = {1, 2, 3, 1}, .pixels_per_tangent = 1108.5f,
                            .clip_from_zone = {0.1f, 0, 0, -1, 0, u, 0, 0, -r, 0, 0, 0, 0, 0, 0.1f, 0}};
    const bound_view view = bound_view_of(&lent);
    const double right[3] = {0, 0, -1}, up[3] = {0, 1, 0};
    for (int k = 0; k < 3; k++) {
        assert_true(fabs(view.right[k] - right[k]) < 1e-12 && fabs(view.up[k] - up[k]) < 1e-12);
        assert_true(view.eye[k] == lent.eye_exact[k]);
    }
    assert_true(view.optics.reach == 1.25 && view.optics.pixels_per_tangent == (double)1108.5f);
    cull_view parallel = lent;
    parallel.eye[3] = 0;
    assert_true(bound_view_of(&parallel).optics.reach == INFINITY);
}

static void frames_count_the_one_that_takes_the_picture(void **unused)
{
    (void)unused;
    assert_true(bound_frames(0, 0.025) == 1);
    assert_true(bound_frames(0.13, 0.025) == 6);
    assert_true(bound_frames(1, 0) == INFINITY);
    assert_true(bound_sampling_px(BOUND_TEXEL_CENTRES, 1) == 0);
    assert_true(fabs(bound_sampling_px(BOUND_NEAREST, 1) - 0.7071) < 1e-4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_point_is_shown_farther_off_than_any_form_of_the_bound_says),
        cmocka_unit_test(a_picture_accepted_at_a_tolerance_shows_no_point_farther_off),
        cmocka_unit_test(centre_alignment_shows_no_point_farther_off_than_its_bound_says),
        cmocka_unit_test(kept_depth_leaves_no_point_farther_off_than_its_bound_says),
        cmocka_unit_test(the_bound_is_within_a_tenth_of_the_worst_point_in_half_of_all_cases_and_below_the_pages_formula),
        cmocka_unit_test(the_eight_corner_test_of_1996_is_no_bound),
        cmocka_unit_test(turning_alone_displaces_nothing_but_what_rounding_does),
        cmocka_unit_test(turning_the_view_does_not_change_what_is_said_of_any_view),
        cmocka_unit_test(scaling_the_world_by_a_power_of_two_changes_no_bit_of_a_bound),
        cmocka_unit_test(going_farther_never_lowers_the_bound_and_the_reach_is_its_inverse),
        cmocka_unit_test(the_worst_eye_within_a_distance_is_bounded_however_far_it_is),
        cmocka_unit_test(an_angle_is_most_pixels_at_the_corner_of_the_picture_and_outward),
        cmocka_unit_test(a_segment_is_seen_widest_from_before_its_middle),
        cmocka_unit_test(what_cannot_be_bounded_is_infinite),
        cmocka_unit_test(a_view_lent_by_the_host_gives_its_axes),
        cmocka_unit_test(frames_count_the_one_that_takes_the_picture),
    };
    return cmocka_run_group_tests_name("imagecache_bound", tests, NULL, NULL);
}
