// Tests of host/core/view.c: nothing that projects into the picture is ever outside of the volume, in any float arithmetic.
// The oracle projects in long double, straight from the camera.
// SPDX-License-Identifier: MIT
#include "fixture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>
#include <float.h>
#include <stdio.h>
#include <string.h>

typedef struct exact_camera { long double right[3], up[3], forward[3], tangent_x, tangent_y; } exact_camera;
typedef struct projected { long double x, y, depth; } projected; // x, y: -1 to 1 inside the picture

static long double exact_dot(const long double a[3], const long double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void exact_cross(const long double a[3], const long double b[3], long double out[3])
{
    for (int i = 0; i < 3; i++) out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
    const long double length = sqrtl(exact_dot(out, out));
    for (int i = 0; i < 3; i++) out[i] /= length;
}

static exact_camera exact_axes(const camera *c)
{
    exact_camera e;
    long double forward[3], up[3];
    for (int i = 0; i < 3; i++) {
        forward[i] = c->forward[i];
        up[i] = c->up[i];
    }
    const long double length = sqrtl(exact_dot(forward, forward));
    for (int i = 0; i < 3; i++) e.forward[i] = forward[i] / length;
    exact_cross(e.forward, up, e.right);
    exact_cross(e.right, e.forward, e.up);
    e.tangent_y = tanl((long double)c->fovy_deg * 3.14159265358979323846264338327950288L / 360);
    e.tangent_x = e.tangent_y * c->aspect;
    return e;
}

static projected exact_project(const camera *c, const double origin[3], cull_vec3 p)
{
    const exact_camera e = exact_axes(c);
    const float at[3] = {p.x, p.y, p.z};
    long double v[3];
    for (int i = 0; i < 3; i++) v[i] = (long double)at[i] + origin[i] - c->eye[i];
    const long double depth = exact_dot(v, e.forward);
    const projected out = {exact_dot(v, e.right) / (depth * e.tangent_x), exact_dot(v, e.up) / (depth * e.tangent_y), depth};
    return out;
}

// p-vertex, then the sum in seven orders, some fused.
static int kept_by(cull_plane f, cull_box b)
{
    const cull_vec3 q = cull_box_corner(b, f.normal);
    const float x = f.normal.x, y = f.normal.y, z = f.normal.z, d = f.offset;
    return ((x * q.x + y * q.y) + z * q.z) + d >= 0 && (x * q.x + y * q.y) + (z * q.z + d) >= 0 && (x * q.x + d) + (y * q.y + z * q.z) >= 0 &&
           ((d + z * q.z) + x * q.x) + y * q.y >= 0 && (x * q.x + y * q.y) + z * q.z >= -d &&
           fmaf(x, q.x, fmaf(y, q.y, fmaf(z, q.z, d))) >= 0 && fmaf(z, q.z, fmaf(y, q.y, x * q.x)) + d >= 0;
}

static int kept(const view_volume *v, cull_box b)
{
    for (uint32_t i = 0; i < v->plane_count; i++)
        if (!kept_by(v->planes[i], b)) return 0;
    return 1;
}

typedef struct trial {
    camera c;
    view_frame frame;
    double origin[3], radius;
    cull_vec3 point; // where the camera was aimed
    cull_box zone_box;
} trial;

static float within(double value, double radius)
{
    return (float)fmin(fmax(value, -radius), radius);
}

typedef enum aim { AIM_INSIDE, AIM_OUTSIDE } aim; // on which side of the picture's border a trial aims

// A camera that has a point of the zone very near to (x, y) of its picture.
static trial make_trial(uint64_t *r, aim side)
{
    trial t;
    memset(&t, 0, sizeof t);
    t.frame = (view_frame){1 + (uint32_t)random_between(r, 16, 4096), 1 + (uint32_t)random_between(r, 16, 4096), 7, 0, CULL_VIEW_MAIN};
    t.radius = (double)(float)exp2(random_between(r, -10, 13));
    const float R = (float)t.radius;
    t.zone_box = (cull_box){{-R, -R, -R}, {R, R, R}};
    const double far_away = random_unit(r) < 0.5 ? 0 : exp2(random_between(r, 0, 27));
    for (int i = 0; i < 3; i++) t.origin[i] = rint(random_between(r, -far_away, far_away) * 1024) / 1024;
    t.c.fovy_deg = random_unit(r) < 0.3 ? random_between(r, 1, 170) : random_unit(r) < 0.2 ? (random_unit(r) < 0.5 ? 1 : 170) : 60;
    t.c.aspect = random_unit(r) < 0.7 ? (double)t.frame.width_px / t.frame.height_px : exp2(random_between(r, -3, 3));
    random_direction(r, t.c.forward);
    random_direction(r, t.c.up);
    const double scale = exp2(random_between(r, -30, 30));
    for (int i = 0; i < 3; i++) t.c.forward[i] *= scale;
    t.point = (cull_vec3){within(random_between(r, -1.2, 1.2) * t.radius, t.radius), within(random_between(r, -1.2, 1.2) * t.radius, t.radius),
                          within(random_between(r, -1.2, 1.2) * t.radius, t.radius)};
    const double depth = t.radius * exp2(random_between(r, -16, 10));
    double at[2];
    for (int i = 0; i < 2; i++) {
        double inset = random_unit(r) < 0.5 ? 0 : exp2(random_between(r, -40, 0));
        if (side == AIM_OUTSIDE) inset = -exp2(random_between(r, -30, -6));
        at[i] = random_unit(r) < 0.5 ? random_between(r, -1, 1) : (random_unit(r) < 0.5 ? -1 : 1) * (1 - inset);
    }
    const exact_camera e = exact_axes(&t.c);
    const float p[3] = {t.point.x, t.point.y, t.point.z};
    for (int i = 0; i < 3; i++)
        t.c.eye[i] = (double)(t.origin[i] + (long double)p[i] -
                              depth * (e.forward[i] + (at[0] * e.tangent_x) * e.right[i] + (at[1] * e.tangent_y) * e.up[i]));
    t.c.near_m = depth * 1e-3;
    t.c.far_m = random_unit(r) < 0.4 ? INFINITY : random_unit(r) < 0.5 ? depth : depth * random_between(r, 1, 4);
    return t;
}

static cull_box box_from(uint64_t *r, const trial *t)
{
    cull_box b = {t->point, t->point};
    float *low = &b.min.x, *high = &b.max.x;
    for (int i = 0; i < 3; i++) {
        const double size = random_unit(r) < 0.3 ? 0 : t->radius * exp2(random_between(r, -14, 1));
        if (random_unit(r) < 0.5) low[i] = within((double)low[i] - size, t->radius);
        else high[i] = within((double)high[i] + size, t->radius);
    }
    return b;
}

static void a_box_with_a_point_in_the_picture_is_always_kept(void **state)
{
    (void)state;
    uint64_t r = {11};
    int seen = 0, lost = 0, planes = 0;
    for (int k = 0; k < 60000; k++) {
        const trial t = make_trial(&r, AIM_INSIDE);
        const cull_box b = box_from(&r, &t);
        if (camera_fault(&t.c)) continue;
        const projected p = exact_project(&t.c, t.origin, t.point);
        if (!(fabsl(p.x) <= 1 && fabsl(p.y) <= 1 && p.depth > 0 && p.depth <= t.c.far_m)) continue;
        cull_view view;
        view_volume volume;
        view_derive(&t.c, &t.frame, t.origin, &t.zone_box, &view, &volume);
        seen++;
        planes += (int)volume.plane_count;
        if (!kept(&volume, b) && lost++ < 5) print_error("lost: trial %d, radius %g, fov %g, depth %Lg\n", k, t.radius, t.c.fovy_deg, p.depth);
    }
    assert_in_range(seen, 20000, 60000);
    assert_in_range(planes, 40000, 300000);
    assert_int_equal(lost, 0);
}

// Metres that a point lies outside of the nearest side of the picture, negative inside.
static long double metres_outside(const exact_camera *e, projected p)
{
    const long double x = (fabsl(p.x) - 1) * e->tangent_x * p.depth / sqrtl(1 + e->tangent_x * e->tangent_x);
    const long double y = (fabsl(p.y) - 1) * e->tangent_y * p.depth / sqrtl(1 + e->tangent_y * e->tangent_y);
    return fmaxl(x, y);
}

static void a_box_just_outside_is_kept_within_the_guard_band(void **state)
{
    (void)state;
    uint64_t r = {12};
    int pixels = 0, widened = 0, far_ones = 0;
    for (int k = 0; k < 120000; k++) {
        trial t = make_trial(&r, AIM_OUTSIDE);
        if (camera_fault(&t.c)) continue;
        projected p = exact_project(&t.c, t.origin, t.point);
        const exact_camera e = exact_axes(&t.c);
        const long double tangents = sqrtl(1 + p.x * e.tangent_x * p.x * e.tangent_x + p.y * e.tangent_y * p.y * e.tangent_y);
        const long double widening = 0.99L * 0x1p-20L * p.depth * tangents, px = 0.99L / 64;
        const int near_in_px = (fabsl(p.x) - 1) * t.frame.width_px / 2 <= px && (fabsl(p.y) - 1) * t.frame.height_px / 2 <= px;
        const int near_in_metres = metres_outside(&e, p) <= widening;
        if ((!near_in_px && !near_in_metres) || p.depth <= 0) continue;
        pixels += near_in_px && !near_in_metres;
        widened += !near_in_px && near_in_metres;
        const int tests_far = k % 3 == 0; // and as far beyond the far plane
        t.c.far_m = tests_far ? (double)(p.depth - widening) : INFINITY;
        far_ones += tests_far;
        cull_view view;
        view_volume volume;
        view_derive(&t.c, &t.frame, t.origin, &t.zone_box, &view, &volume);
        assert_true(kept(&volume, (cull_box){t.point, t.point}));
    }
    assert_in_range(pixels, 1000, 120000);
    assert_in_range(widened, 1000, 120000);
    assert_in_range(far_ones, 1000, 120000);
}

static void a_point_well_outside_is_never_kept(void **state)
{
    (void)state;
    uint64_t r = {13};
    int outside = 0, kept_count = 0;
    for (int k = 0; k < 60000; k++) {
        trial t = make_trial(&r, AIM_INSIDE);
        t.c.aspect = (double)t.frame.width_px / t.frame.height_px; // square pixels
        if (camera_fault(&t.c)) continue;
        const cull_vec3 q = {(float)random_between(&r, -t.radius, t.radius), (float)random_between(&r, -t.radius, t.radius),
                             (float)random_between(&r, -t.radius, t.radius)};
        const cull_vec3 point = k % 2 ? q : t.point;
        const projected p = exact_project(&t.c, t.origin, point);
        const exact_camera e = exact_axes(&t.c);
        const long double x = (fabsl(p.x) - 1) * t.frame.width_px / 2, y = (fabsl(p.y) - 1) * t.frame.height_px / 2;
        const long double slack = t.radius * 0x1p-18L;
        const int is_outside = p.depth > 0 && fmaxl(x, y) > 1 && metres_outside(&e, p) > slack;
        const int is_behind = p.depth < -slack;
        const long double reach = sqrtl(1 + e.tangent_x * e.tangent_x + e.tangent_y * e.tangent_y);
        const int is_beyond = p.depth > t.c.far_m * (1 + 0x1p-18L * reach) + slack;
        if (!is_outside && !is_beyond && !(is_behind && t.c.fovy_deg <= 120)) continue;
        cull_view view;
        view_volume volume;
        view_derive(&t.c, &t.frame, t.origin, &t.zone_box, &view, &volume);
        outside++;
        // Behind the eye all four sides must not be passed at once.
        if (kept(&volume, (cull_box){point, point}) && kept_count++ < 5)
            print_error("kept: trial %d, x %Lg px, y %Lg px, depth %Lg, radius %g, fov %g\n", k, x, y, p.depth, t.radius, t.c.fovy_deg);
    }
    assert_in_range(outside, 5000, 60000);
    assert_int_equal(kept_count, 0);
}

static camera plain_camera(void)
{
    const camera c = {{1, 2, 3}, {0, 0, -1}, {0, 1, 0}, 60, 16.0 / 9, 0.1, 1000};
    return c;
}

static void cameras_that_mean_nothing_are_refused_with_a_reason(void **state)
{
    (void)state;
    assert_null(camera_fault(&(camera){{1, 2, 3}, {0, 0, -1}, {0, 1, 0}, 60, 16.0 / 9, 0.1, INFINITY}));
    const double bad[] = {NAN, INFINITY, -INFINITY};
    for (int i = 0; i < 3; i++)
        for (int field = 0; field < 13; field++) {
            camera c = plain_camera();
            double *values[13] = {&c.eye[0], &c.eye[1], &c.eye[2], &c.forward[0], &c.forward[1], &c.forward[2], &c.up[0],
                                  &c.up[1],  &c.up[2],  &c.fovy_deg, &c.aspect, &c.near_m, &c.far_m};
            *values[field] = bad[i];
            if (field == 12 && i == 1) assert_null(camera_fault(&c));
            else assert_non_null(camera_fault(&c));
        }
    camera c = plain_camera();
    c.fovy_deg = 0.99;
    assert_non_null(camera_fault(&c));
    c.fovy_deg = 170.01;
    assert_non_null(camera_fault(&c));
    c = plain_camera();
    c.near_m = 0;
    assert_non_null(camera_fault(&c));
    c.near_m = c.far_m;
    assert_non_null(camera_fault(&c));
    c = plain_camera();
    c.aspect = 0;
    assert_non_null(camera_fault(&c));
    c = plain_camera();
    c.eye[1] = 1e19;
    assert_non_null(camera_fault(&c));
    c = plain_camera();
    memset(c.forward, 0, sizeof c.forward);
    assert_non_null(camera_fault(&c));
    c = plain_camera();
    c.up[0] = 0;
    c.up[1] = 1e-300;
    c.up[2] = 5;
    assert_non_null(camera_fault(&c)); // parallel to forward
    c.up[2] = -5;
    assert_non_null(camera_fault(&c));
    c.up[1] = 1e-3;
    assert_null(camera_fault(&c));
}

static void axes_are_orthonormal_whatever_the_lengths_given(void **state)
{
    (void)state;
    uint64_t r = {14};
    const double scales[] = {1, 1e-310, 1e-160, 1e160, 1e300};
    for (int k = 0; k < 5000; k++) {
        camera c = plain_camera();
        random_direction(&r, c.forward);
        random_direction(&r, c.up);
        for (int i = 0; i < 3; i++) {
            c.forward[i] *= scales[k % 5];
            c.up[i] *= scales[k / 5 % 5];
        }
        if (camera_fault(&c)) continue;
        double axis[3][3];
        camera_axes(&c, axis[0], axis[1], axis[2]);
        for (int a = 0; a < 3; a++)
            for (int b = 0; b < 3; b++) {
                double dot = 0;
                for (int i = 0; i < 3; i++) dot += axis[a][i] * axis[b][i];
                assert_true(fabs(dot - (a == b)) < 1e-9); // a nearly parallel up costs digits
            }
        double handed = 0; // right x up = back
        for (int i = 0; i < 3; i++) {
            const int j = (i + 1) % 3, k2 = (i + 2) % 3;
            handed += (axis[0][j] * axis[1][k2] - axis[0][k2] * axis[1][j]) * axis[2][i];
        }
        assert_true(handed > 0.999);
    }
}

static void the_matrix_gives_the_exact_picture_and_reversed_depth(void **state)
{
    (void)state;
    uint64_t r = {15};
    for (int k = 0; k < 5000; k++) {
        trial t = make_trial(&r, AIM_INSIDE);
        if (camera_fault(&t.c)) continue;
        double m[16], clip[4];
        camera_clip_from_eye(&t.c, m);
        const projected p = exact_project(&t.c, t.origin, t.point);
        const double v[3] = {(double)((long double)t.point.x + t.origin[0] - t.c.eye[0]), (double)((long double)t.point.y + t.origin[1] - t.c.eye[1]),
                             (double)((long double)t.point.z + t.origin[2] - t.c.eye[2])};
        for (int row = 0; row < 4; row++) clip[row] = m[row] * v[0] + m[4 + row] * v[1] + m[8 + row] * v[2] + m[12 + row];
        assert_true(fabsl(clip[0] / clip[3] - p.x) < 1e-9 && fabsl(clip[1] / clip[3] - p.y) < 1e-9);
        assert_true(fabsl(clip[3] - p.depth) <= 1e-9L * p.depth);
        const long double n = t.c.near_m, f = t.c.far_m;
        const long double z = isinf(t.c.far_m) ? n / p.depth : n * (f - p.depth) / (p.depth * (f - n));
        assert_true(fabsl(clip[2] / clip[3] - z) < 1e-9);
    }
}

static void near_and_far_may_be_neighbours_or_worlds_apart(void **state)
{
    (void)state;
    const double pairs[][2] = {{1e-30, 1e300}, {1e-30, INFINITY}, {1, nextafter(1, 2)}, {1e30, INFINITY}, {1e-6, 1e9}};
    for (size_t i = 0; i < sizeof pairs / sizeof pairs[0]; i++) {
        camera c = plain_camera();
        c.near_m = pairs[i][0];
        c.far_m = pairs[i][1];
        assert_null(camera_fault(&c));
        double m[16];
        camera_clip_from_eye(&c, m);
        for (int k = 0; k < 16; k++) assert_true(isfinite(m[k]));
        const double origin[3] = {0, 0, 0};
        const cull_box box = {{-10, -10, -10}, {10, 10, 10}};
        const view_frame frame = {1280, 720, 0, 0, CULL_VIEW_MAIN};
        cull_view view;
        view_volume volume;
        view_derive(&c, &frame, origin, &box, &view, &volume);
        for (uint32_t k = 0; k < volume.plane_count; k++)
            assert_true(isfinite(volume.planes[k].offset) && isfinite(volume.planes[k].normal.x));
    }
}

static void a_zone_wholly_inside_needs_no_planes(void **state)
{
    (void)state;
    camera c = plain_camera();
    const double origin[3] = {1, 2, -50};
    const cull_box box = {{-1, -1, -1}, {1, 1, 1}};
    const view_frame frame = {1280, 720, 3, CULL_VIEW_CUT, CULL_VIEW_CAPTURE};
    cull_view view;
    view_volume volume;
    view_derive(&c, &frame, origin, &box, &view, &volume);
    assert_int_equal(volume.plane_count, 0);
    assert_true(view.eye[0] == 0 && view.eye[1] == 0 && view.eye[2] == 53 && view.eye[3] == 1);
    assert_int_equal(view.purpose, CULL_VIEW_CAPTURE);
    assert_int_equal(view.frame, 3);
    assert_int_equal(view.flags, CULL_VIEW_CUT);
    assert_int_equal(view.width_px, 1280);
    assert_true(fabsf(view.pixels_per_tangent - 623.5383f) < 1e-3f);
    c.far_m = 52.5; // cuts the zone
    view_derive(&c, &frame, origin, &box, &view, &volume);
    assert_int_equal(volume.plane_count, 1);
    assert_true(fabsf(volume.planes[0].offset + 0.5f) < 1e-3f);
    c.far_m = INFINITY;
    c.eye[2] = -50; // in the middle of the zone: four sides
    view_derive(&c, &frame, origin, &box, &view, &volume);
    assert_int_equal(volume.plane_count, 4);
}

static void translating_world_and_camera_by_the_grid_changes_no_bit(void **state)
{
    (void)state;
    uint64_t r = {16};
    for (int k = 0; k < 2000; k++) {
        trial t = make_trial(&r, AIM_INSIDE);
        if (camera_fault(&t.c)) continue;
        for (int i = 0; i < 3; i++) t.c.eye[i] = rint(t.c.eye[i] * 1024) / 1024;
        camera far_camera = t.c;
        double far_origin[3];
        for (int i = 0; i < 3; i++) {
            far_camera.eye[i] += 1 << 27;
            far_origin[i] = t.origin[i] + (1 << 27);
            if (far_camera.eye[i] - (1 << 27) != t.c.eye[i]) goto next; // did not fit
        }
        cull_view a, b;
        view_volume va, vb;
        memset(&va, 0, sizeof va);
        memset(&vb, 0, sizeof vb);
        view_derive(&t.c, &t.frame, t.origin, &t.zone_box, &a, &va);
        view_derive(&far_camera, &t.frame, far_origin, &t.zone_box, &b, &vb);
        assert_memory_equal(&a, &b, sizeof a);
        assert_memory_equal(&va, &vb, sizeof va);
    next:;
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_box_with_a_point_in_the_picture_is_always_kept),
        cmocka_unit_test(a_box_just_outside_is_kept_within_the_guard_band),
        cmocka_unit_test(a_point_well_outside_is_never_kept),
        cmocka_unit_test(cameras_that_mean_nothing_are_refused_with_a_reason),
        cmocka_unit_test(axes_are_orthonormal_whatever_the_lengths_given),
        cmocka_unit_test(the_matrix_gives_the_exact_picture_and_reversed_depth),
        cmocka_unit_test(near_and_far_may_be_neighbours_or_worlds_apart),
        cmocka_unit_test(a_zone_wholly_inside_needs_no_planes),
        cmocka_unit_test(translating_world_and_camera_by_the_grid_changes_no_bit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
