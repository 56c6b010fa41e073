// Parallelograms of plugins/imagecache/quad.h cover what they show, texels are never magnified, centre alignment is what section
// 1.7 of the reference page says, and seams are moved out far enough. PORTCULLIS_LONG=1: ten times as many.
// SPDX-License-Identifier: MIT
#include "bound_cases.h"

#include "tests/common/random.h"
#include "tests/common/test.h"

#include <stdlib.h>
#include <string.h>

static uint32_t times(uint32_t count)
{
    return getenv("PORTCULLIS_LONG") ? 10 * count : count;
}

static quad_request request_of(const bound_case *c)
{
    quad_request request = {.box = c->box, .optics = c->taken.optics, .magnification = 1, .most_texels = 1u << 20};
    memcpy(request.eye, c->taken.eye, sizeof request.eye);
    return request;
}

static void numbers_of(cull_vec3 v, double out[3])
{
    out[0] = v.x;
    out[1] = v.y;
    out[2] = v.z;
}

// A texel inside its border, a tenth of it for rounding to floats (FLOATS_PER_TEXEL of quad.c).
static void assert_covers(const quad *q, const double eye[3], const double point[3])
{
    const case_image at = image_of(q, eye, point);
    const long double pad_u = 0.9L / q->width_px, pad_v = 0.9L / q->height_px;
    assert_true(at.u >= pad_u && at.u <= 1 - pad_u);
    assert_true(at.v >= pad_v && at.v <= 1 - pad_v);
}

static void every_point_of_the_box_is_shown_a_texel_inside_the_border(void **unused)
{
    (void)unused;
    uint64_t state = 1;
    uint32_t aligned = 0;
    for (uint32_t i = 0; i < times(3000); i++) {
        const bound_case c = case_random(&state, MOTION_ANY);
        const quad_request request = request_of(&c);
        quad taken;
        const quad_result result = quad_aligned_of(&request, &c.taken, &taken);
        for (int k = 0; k < 40; k++) {
            double point[3];
            case_point(&state, &c.box, point);
            assert_covers(&c.quad, c.taken.eye, point);
            if (result == QUAD_OK) assert_covers(&taken, c.taken.eye, point);
        }
        aligned += result == QUAD_OK;
    }
    assert_true(aligned > times(3000) / 2);
}

static void the_plane_goes_through_the_centre_at_right_angles_to_the_line_of_sight(void **unused)
{
    (void)unused;
    uint64_t state = 2;
    for (uint32_t i = 0; i < times(2000); i++) {
        const bound_case c = case_random(&state, MOTION_ANY);
        double corner[3], right[3], up[3], from_centre[3];
        numbers_of(c.quad.corner, corner);
        numbers_of(c.quad.right, right);
        numbers_of(c.quad.up, up);
        bound_subtract(corner, c.quad.centre, from_centre);
        const double slack = 1e-6 * c.capture.radius; // floats
        assert_true(fabs(bound_dot(c.quad.normal, from_centre)) < slack);
        assert_true(fabs(bound_dot(c.quad.normal, right)) < slack && fabs(bound_dot(c.quad.normal, up)) < slack);
        assert_true(fabs(bound_dot(right, up)) < slack * (sqrt(bound_dot(right, right)) + sqrt(bound_dot(up, up))));
        double turned[3];
        bound_cross(right, up, turned);
        assert_true(bound_dot(turned, c.quad.normal) < 0); // its front to the eye
        assert_true(c.quad.outline_count >= 4 && c.quad.outline_count <= 6);
    }
}

static double area_at(const quad *q, double angle)
{
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (uint32_t i = 0; i < q->outline_count; i++) {
        const double x = q->outline[i][0], y = q->outline[i][1], s = sin(angle), c = cos(angle);
        low[0] = fmin(low[0], c * x + s * y);
        high[0] = fmax(high[0], c * x + s * y);
        low[1] = fmin(low[1], c * y - s * x);
        high[1] = fmax(high[1], c * y - s * x);
    }
    return (high[0] - low[0]) * (high[1] - low[1]);
}

static void no_turned_rectangle_around_the_outline_is_a_tenth_smaller(void **unused)
{
    (void)unused;
    uint64_t state = 3;
    uint32_t exact = 0;
    for (uint32_t i = 0; i < times(1000); i++) {
        const bound_case c = case_random(&state, MOTION_ANY);
        double least = INFINITY;
        for (int k = 0; k < 180; k++) least = fmin(least, area_at(&c.quad, k * 3.14159265358979 / 360));
        assert_true(area_at(&c.quad, 0) * 0.899 <= least);
        exact += area_at(&c.quad, 0) <= least * 1.0001;
    }
    assert_true(exact > times(1000) / 4);
}

// One texel, one place to the side, wherever it is inside the picture.
static double texel_px(const bound_case *c, const quad *q, long double u, long double v, int side)
{
    double corner[3], right[3], up[3];
    long double a[3], b[3];
    numbers_of(q->corner, corner);
    numbers_of(q->right, right);
    numbers_of(q->up, up);
    for (int k = 0; k < 3; k++) {
        a[k] = corner[k] + u * right[k] + v * up[k];
        b[k] = a[k] + (side ? up[k] / q->height_px : right[k] / q->width_px);
    }
    const case_place from = place_of(&c->view, a), to = place_of(&c->view, b);
    if (!place_inside(from, c->wide) && !place_inside(to, c->wide)) return 0;
    return hypot(from.x - to.x, from.y - to.y) * c->view.optics.pixels_per_tangent;
}

static void no_texel_is_magnified_while_the_eye_keeps_to_its_room(void **unused)
{
    (void)unused;
    uint64_t state = 4;
    double most = 0;
    for (uint32_t i = 0; i < times(3000); i++) {
        bound_case c = case_random(&state, MOTION_ANY);
        quad_request request = request_of(&c);
        quad q;
        double way[3], point[3];
        request.room = bound_reach_of_eye(&c.capture, 2, &c.taken.optics);
        request.magnification = random_between(&state, 0.5, 1);
        if (quad_of(&request, &q) != QUAD_OK) continue;
        random_direction(&state, way);
        for (int k = 0; k < 3; k++) c.view.eye[k] = c.taken.eye[k] + request.room * way[k];
        case_point(&state, &c.box, point);
        case_look_at(&state, point, c.wide, &c.view);
        assert_true(quad_magnification(&q, c.view.eye, &c.view.optics) <= request.magnification * (1 + 1e-9));
        for (int k = 0; k < 20; k++) {
            const double px = texel_px(&c, &q, random_unit(&state), random_unit(&state), k % 2) / request.magnification;
            assert_true(px <= 1 + 1e-5); // floats of the parallelogram
            if (px > most) most = px;
        }
    }
    assert_true(most > 0.95); // and no finer than needed
}

static void what_makes_no_picture_is_refused_by_name_and_leaves_nothing_behind(void **unused)
{
    (void)unused;
    quad_request good = {.eye = {0, 0, 30}, .box = {{-5, -4, -5}, {5, 4, 5}}, .optics = {1000, 1.2}, .magnification = 1, .most_texels = 4096};
    quad q;
    memset(&q, 7, sizeof q);
    const quad before = q;
    quad_request bad = good;
    bad.eye[2] = 2;
    assert_int_equal(quad_of(&bad, &q), QUAD_EYE_INSIDE);
    bad.eye[2] = 5; // on its face
    assert_int_equal(quad_of(&bad, &q), QUAD_EYE_INSIDE);
    bad.eye[2] = 5.5;
    assert_int_equal(quad_of(&bad, &q), QUAD_TOO_WIDE);
    bad.near_distance = 1;
    assert_int_equal(quad_of(&bad, &q), QUAD_TOO_NEAR);
    bad = good;
    bad.room = 26;
    assert_int_equal(quad_of(&bad, &q), QUAD_TOO_NEAR);
    bad = good;
    bad.most_texels = 100;
    assert_int_equal(quad_of(&bad, &q), QUAD_TOO_LARGE);
    bad = good;
    bad.magnification = 1e-5;
    assert_int_equal(quad_of(&bad, &q), QUAD_TOO_FINE);
    bad.magnification = (double)NAN;
    assert_int_equal(quad_of(&bad, &q), QUAD_TOO_FINE);
    bound_view away = {.eye = {0, 0, 30}, .right = {1, 0, 0}, .up = {0, 1, 0}, .forward = {0, 0, 1}, .optics = {1000, 1.2}};
    assert_int_equal(quad_aligned_of(&good, &away, &q), QUAD_TOO_NEAR);
    assert_memory_equal(&q, &before, sizeof q);
    assert_int_equal(quad_of(&good, &q), QUAD_OK);
}

static void a_flat_box_seen_from_its_edge_and_one_from_straight_above_are_shown(void **unused)
{
    (void)unused;
    quad_request request = {.eye = {0, 0, 30}, .box = {{-5, 0, -5}, {5, 0, 5}}, .optics = {1000, 1.2}, .magnification = 1, .most_texels = 4096};
    quad q;
    assert_int_equal(quad_of(&request, &q), QUAD_OK);
    assert_int_equal(q.height_px, 3);
    const double point[3] = {5, 0, 5}, above[3] = {0, 30, 0};
    assert_covers(&q, request.eye, point);
    memcpy(request.eye, above, sizeof above);
    assert_int_equal(quad_of(&request, &q), QUAD_OK);
    assert_covers(&q, request.eye, point);
    assert_true(q.width_px > 100 && q.height_px > 100);
}

static void centre_alignment_in_the_capturing_view_shows_the_picture_where_it_was_taken(void **unused)
{
    (void)unused;
    uint64_t state = 5;
    uint32_t asked = 0;
    for (uint32_t i = 0; i < times(1000); i++) {
        bound_case c = case_random(&state, MOTION_CENTRE);
        const quad_request request = request_of(&c);
        quad taken;
        if (quad_aligned_of(&request, &c.taken, &taken) != QUAD_OK) continue;
        c.view = c.taken;
        const quad shown = quad_aligned_shown(&taken, &c.taken);
        double a[3], b[3], point[3];
        numbers_of(taken.corner, a);
        numbers_of(shown.corner, b);
        for (int k = 0; k < 3; k++) assert_true(fabs(a[k] - b[k]) < 1e-6 * c.capture.radius);
        case_point(&state, &c.box, point);
        assert_true(aligned_off_px(&c, &taken, &shown, point) <= bound_centre_px(&c.capture, &c.taken, &c.view));
        asked++;
    }
    assert_true(asked > times(1000) / 2);
}

// Section 1.7: a card 256 px wide, 1280 px, 60 degrees, a yaw of 23 degrees. The page, which scales by the distance (here not at all), is
// off by 30.8 and 16.0 px; scaled by depth, as here, the borders are off by 19.8 and 5.0. The quad in the world is off by nothing.
static void a_yaw_of_23_degrees_puts_centre_alignment_off_by_what_trigonometry_says(void **unused)
{
    (void)unused;
    const double f = 640 / tan(3.14159265358979 / 6), half = 128 / f * 100, yaw = 23 * 3.14159265358979 / 180;
    bound_case c;
    memset(&c, 0, sizeof c);
    c.box = (cull_box){{(float)-half, (float)-half, 0}, {(float)half, (float)half, 0}};
    c.taken = (bound_view){.eye = {0, 0, 100}, .right = {1, 0, 0}, .up = {0, 1, 0}, .forward = {0, 0, -1}, .optics = {f, 1.2}};
    c.view = c.taken;
    c.view.right[0] = cos(yaw);
    c.view.right[2] = -sin(yaw);
    c.view.forward[0] = -sin(yaw);
    c.view.forward[2] = -cos(yaw);
    c.wide[0] = c.wide[1] = 1;
    c.capture = bound_capture_of(c.taken.eye, &c.box);
    const quad_request request = request_of(&c);
    quad taken;
    assert_int_equal(quad_of(&request, &c.quad), QUAD_OK);
    assert_int_equal(quad_aligned_of(&request, &c.taken, &taken), QUAD_OK);
    const quad shown = quad_aligned_shown(&taken, &c.view);
    const double far = tan(yaw + atan(128 / f)) - tan(yaw), near = tan(yaw) - tan(yaw - atan(128 / f));
    const double side[2][3] = {{half, 0, 0}, {-half, 0, 0}};
    const double off[2] = {aligned_off_px(&c, &taken, &shown, side[0]), aligned_off_px(&c, &taken, &shown, side[1])};
    assert_true(fabs(far * f - 128 - 30.8) < 0.05 && fabs(near * f - 128 - 16.0) < 0.05); // the page's
    assert_true(fabs(fmax(off[0], off[1]) - (far * f - 128 / cos(yaw))) < 0.01);
    assert_true(fabs(fmin(off[0], off[1]) - (near * f - 128 / cos(yaw))) < 0.01);
    assert_true(fmax(off[0], off[1]) <= bound_centre_px(&c.capture, &c.taken, &c.view));
    assert_true(shown_off_px(&c, side[0]) < 1e-6 && shown_off_px(&c, side[1]) < 1e-6);
}

// ---- Seams ----

typedef struct strip { // on a surface, between the clip planes of both sides
    double near[2][3], far[2][3]; // two points on each border
    double sine, distance;
} strip;

static void unit(double a[3])
{
    const double length = sqrt(bound_dot(a, a));
    for (int k = 0; k < 3; k++) a[k] /= length;
}

// sine and distance: as a culler has them, of the seam's own line and of all that may be shown near it.
static strip strip_of(uint64_t *state, double delta, double surface[3], double seam[3], double at[3])
{
    strip out = {.sine = 1, .distance = 0};
    double line[3], outward[3];
    bound_cross(surface, seam, line);
    unit(line);
    bound_cross(line, surface, outward);
    const double step = delta / bound_dot(outward, seam), slide = random_between(state, -3, 3);
    for (int e = 0; e < 2; e++) {
        for (int k = 0; k < 3; k++) {
            out.near[e][k] = at[k] - step * outward[k] + (e ? slide : 0) * line[k];
            out.far[e][k] = at[k] + step * outward[k] + (e ? 1 : 0) * line[k];
        }
        for (int side = 0; side < 2; side++) {
            const double *p = side ? out.far[e] : out.near[e];
            const double length = sqrt(bound_dot(p, p));
            out.sine = fmin(out.sine, fabs(bound_dot(surface, p)) / length);
            out.distance = fmax(out.distance, length);
        }
    }
    return out;
}

// Pixels from the place of a point of the near border to the line that the far border is.
static double width_px(const strip *s, const bound_view *view)
{
    case_place p[3];
    for (int i = 0; i < 3; i++) {
        const double *from = i == 0 ? s->near[0] : s->far[i - 1];
        const long double point[3] = {from[0], from[1], from[2]};
        p[i] = place_of(view, point);
        if (!p[i].in_front) return INFINITY;
    }
    const double x = p[2].x - p[1].x, y = p[2].y - p[1].y;
    return fabs(x * (p[0].y - p[1].y) - y * (p[0].x - p[1].x)) / hypot(x, y) * view->optics.pixels_per_tangent;
}

static void strips_at_seams_are_wider_than_what_pictures_are_shown_off(void **unused)
{
    (void)unused;
    uint64_t state = 6;
    uint32_t asked = 0;
    double least = INFINITY;
    for (uint32_t i = 0; i < times(200000); i++) {
        double surface[3], seam[3], at[3];
        random_direction(&state, surface);
        random_direction(&state, seam);
        random_direction(&state, at);
        if (fabs(bound_dot(surface, seam)) > 0.99) continue;
        const double away = random_between(&state, 20, 300);
        for (int k = 0; k < 3; k++) at[k] *= away;
        quad_seam s = {.error_px = random_between(&state, 0.1, 4), .pixels_per_tangent = 1000, .texel = random_between(&state, 0, 0.2)};
        bound_view view = {.eye = {0, 0, 0}, .optics = {s.pixels_per_tangent, 1.2}};
        const double wide[2] = {0.5, 0.3};
        case_look_at(&state, at, wide, &view);
        // The rule wants to know how steep and how far the moved borders are: asked twice, as they follow from it.
        s.sine = fabs(bound_dot(surface, at)) / away;
        s.distance = away;
        strip moved = strip_of(&state, quad_seam_delta(&s), surface, seam, at);
        s.sine = fmin(s.sine, moved.sine) * 0.99;
        s.distance = fmax(s.distance, moved.distance) * 1.01;
        if (s.sine < 0.05) continue;
        moved = strip_of(&state, quad_seam_delta(&s), surface, seam, at);
        if (moved.sine < s.sine || moved.distance > s.distance) continue; // not what was promised to the rule
        const double wanted = s.error_px + s.texel * s.pixels_per_tangent / s.distance;
        assert_true(width_px(&moved, &view) >= wanted);
        least = fmin(least, width_px(&moved, &view) / wanted);
        asked++;
    }
    assert_true(asked > times(200000) / 4);
    assert_true(least < 1.5); // and not much wider
}

static void a_seam_never_moves_less_than_the_page_says_and_more_where_it_is_grazed(void **unused)
{
    (void)unused;
    quad_seam s = {.error_px = 1, .distance = 100, .pixels_per_tangent = 1000, .texel = 0.05, .sine = 1};
    assert_true(fabs(quad_seam_delta(&s) - 0.15) < 1e-12);
    s.sine = 0.1;
    assert_true(fabs(quad_seam_delta(&s) - 0.75) < 1e-12);
    s.error_px = 2;
    assert_true(quad_seam_delta(&s) > 0.75);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_point_of_the_box_is_shown_a_texel_inside_the_border),
        cmocka_unit_test(the_plane_goes_through_the_centre_at_right_angles_to_the_line_of_sight),
        cmocka_unit_test(no_turned_rectangle_around_the_outline_is_a_tenth_smaller),
        cmocka_unit_test(no_texel_is_magnified_while_the_eye_keeps_to_its_room),
        cmocka_unit_test(what_makes_no_picture_is_refused_by_name_and_leaves_nothing_behind),
        cmocka_unit_test(a_flat_box_seen_from_its_edge_and_one_from_straight_above_are_shown),
        cmocka_unit_test(centre_alignment_in_the_capturing_view_shows_the_picture_where_it_was_taken),
        cmocka_unit_test(a_yaw_of_23_degrees_puts_centre_alignment_off_by_what_trigonometry_says),
        cmocka_unit_test(strips_at_seams_are_wider_than_what_pictures_are_shown_off),
        cmocka_unit_test(a_seam_never_moves_less_than_the_page_says_and_more_where_it_is_grazed),
    };
    return cmocka_run_group_tests_name("imagecache_quad", tests, NULL, NULL);
}
