// Tests of api/portcullis/{box,plane,clip}.h against naive oracles, in C and as compiled by C++.
// SPDX-License-Identifier: MIT
#include "fixture.h"
#include "headers_cxx.h"

#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>
#include <string.h>

static cull_box random_box(uint64_t *r, double reach, double size)
{
    cull_box b;
    float *low = &b.min.x, *high = &b.max.x;
    for (int i = 0; i < 3; i++) {
        low[i] = (float)random_between(r, -reach, reach);
        high[i] = low[i] + (float)random_between(r, 0, size);
    }
    return b;
}

static cull_vec3 corner(cull_box b, int which)
{
    const cull_vec3 c = {which & 1 ? b.max.x : b.min.x, which & 2 ? b.max.y : b.min.y, which & 4 ? b.max.z : b.min.z};
    return c;
}

static void a_plane_touches_a_box_exactly_when_one_of_its_corners_is_inside(void **state)
{
    (void)state;
    uint64_t r = {1};
    int touched = 0, contained = 0;
    for (int k = 0; k < 20000; k++) {
        const cull_box b = random_box(&r, 10, 5);
        double n[3];
        random_direction(&r, n);
        if (k % 7 == 0) n[k % 3] = 0;
        const cull_plane p = {{(float)n[0], (float)n[1], (float)n[2]}, (float)random_between(&r, -8, 8)};
        int inside = 0;
        for (int c = 0; c < 8; c++) inside += cull_plane_height(p, corner(b, c)) >= 0;
        assert_int_equal(cull_plane_touches(p, b), inside > 0);
        assert_int_equal(cull_plane_contains(p, b), inside == 8);
        touched += inside > 0;
        contained += inside == 8;
    }
    assert_in_range(touched, 5000, 19000);
    assert_in_range(contained, 1000, 15000);
}

static void a_union_is_the_smallest_box_that_contains_both(void **state)
{
    (void)state;
    uint64_t r = {2};
    for (int k = 0; k < 5000; k++) {
        const cull_box a = random_box(&r, 10, 5), b = random_box(&r, 10, 5), u = cull_box_union(a, b);
        assert_true(cull_box_contains(u, a) && cull_box_contains(u, b));
        const float *side = &u.min.x, *sa = &a.min.x, *sb = &b.min.x;
        for (int i = 0; i < 6; i++) assert_true(side[i] == sa[i] || side[i] == sb[i]);
        const cull_box cxx = cxx_box_union(a, b), none = cull_box_union(cull_box_none(), a);
        assert_memory_equal(&cxx, &u, sizeof u);
        assert_memory_equal(&none, &a, sizeof a);
    }
}

static void boxes_touch_exactly_when_a_point_is_in_both(void **state)
{
    (void)state;
    for (int a0 = 0; a0 < 4; a0++)
        for (int a1 = a0; a1 < 4; a1++)
            for (int b0 = 0; b0 < 4; b0++)
                for (int b1 = b0; b1 < 4; b1++) {
                    int both = 0;
                    for (int x = 0; x < 4; x++) both |= a0 <= x && x <= a1 && b0 <= x && x <= b1;
                    const cull_box a = {{(float)a0, 0, 0}, {(float)a1, 1, 1}}, b = {{(float)b0, 1, 1}, {(float)b1, 2, 2}};
                    assert_int_equal(cull_box_touches(a, b), both);
                }
}

static void the_radius_is_the_largest_absolute_coordinate(void **state)
{
    (void)state;
    const cull_box b = {{-1, -9, 2}, {3, 4, 5}};
    assert_true(cull_box_radius(b) == 9);
}

static void points_kept_by_a_clip_are_those_inside_and_on_the_border(void **state)
{
    (void)state;
    uint64_t r = {3};
    for (int k = 0; k < 5000; k++) {
        cull_point square[4] = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, out[5], cxx[5];
        const double angle = random_between(&r, 0, 6.28);
        const cull_cut cut = {cos(angle), sin(angle), random_between(&r, -1, 1), random_between(&r, -2, 2)};
        const uint32_t count = cull_polygon_clip(square, 4, cut, out, 5);
        assert_int_equal(cxx_polygon_clip(square, 4, cut, cxx, 5), count);
        assert_memory_equal(out, cxx, count * sizeof *out);
        double area = 0, expected = 0;
        for (uint32_t i = 1; i + 1 < count; i++)
            area += 0.5 * ((out[i].x - out[0].x) * (out[i + 1].y - out[0].y) - (out[i].y - out[0].y) * (out[i + 1].x - out[0].x));
        for (int y = 0; y < 50; y++) // the same area, by columns
            for (int x = 0; x < 50; x++) {
                const cull_point p = {(x + 0.5) / 25 - 1, (y + 0.5) / 25 - 1, 0};
                expected += cull_cut_height(cut, p) >= 0 ? 4.0 / 2500 : 0;
            }
        assert_true(fabs(area - expected) < 0.1);
        for (uint32_t i = 0; i < count; i++) assert_true(cull_cut_height(cut, out[i]) > -1e-12);
    }
}

static void two_polygons_that_share_an_edge_are_cut_at_the_same_point(void **state)
{
    (void)state;
    uint64_t r = {4};
    int cuts = 0;
    for (int k = 0; k < 5000; k++) {
        cull_point p[4];
        for (int i = 0; i < 4; i++) p[i] = (cull_point){random_between(&r, -9, 9), random_between(&r, -9, 9), random_between(&r, -9, 9)};
        const cull_point left[3] = {p[0], p[1], p[2]}, right[3] = {p[1], p[0], p[3]};
        const cull_cut cut = {random_between(&r, -1, 1), random_between(&r, -1, 1), random_between(&r, -1, 1), random_between(&r, -3, 3)};
        cull_point a[4], b[4];
        if ((cull_cut_height(cut, p[0]) > 0) == (cull_cut_height(cut, p[1]) > 0)) continue;
        const uint32_t na = cull_polygon_clip(left, 3, cut, a, 4), nb = cull_polygon_clip(right, 3, cut, b, 4);
        int shared = 0;
        for (uint32_t i = 0; i < na; i++)
            for (uint32_t j = 0; j < nb; j++) shared += memcmp(&a[i], &b[j], sizeof a[i]) == 0;
        assert_in_range(shared, 2, 4); // the inside end, and the cut
        cuts++;
    }
    assert_in_range(cuts, 1000, 5000);
}

static void a_clip_never_writes_more_than_it_has_room_for(void **state)
{
    (void)state;
    const cull_point square[4] = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    cull_point out[5];
    memset(out, 0x55, sizeof out);
    const cull_cut cut = {-1, -1, 0, 1}; // a pentagon
    assert_int_equal(cull_polygon_clip(square, 4, cut, out, 5), 5);
    memset(out, 0x55, sizeof out);
    assert_int_equal(cull_polygon_clip(square, 4, cut, out, 3), 3);
    for (size_t i = 0; i < 2 * sizeof out[0]; i++) assert_int_equal(((unsigned char *)&out[3])[i], 0x55);
}

// The loop as it stands in the paper: each edge's two heights anew.
static uint32_t clip_plainly(const cull_point *in, uint32_t count, cull_cut cut, cull_point *out)
{
    uint32_t written = 0;
    for (uint32_t i = 0; i < count; i++) {
        const cull_point a = in[i], b = in[(i + 1) % count];
        const double ha = cull_cut_height(cut, a), hb = cull_cut_height(cut, b);
        if (ha >= 0) out[written++] = a;
        if (ha > 0 && hb < 0) out[written++] = cull_cut_between(a, ha, b, hb);
        if (ha < 0 && hb > 0) out[written++] = cull_cut_between(b, hb, a, ha);
    }
    return written;
}

static void a_clip_that_knows_heights_gives_the_points_of_one_that_does_not(void **state)
{
    (void)state;
    enum { CORNERS = 9 };
    uint64_t r = {7};
    uint64_t cut_polygons = 0;
    for (int k = 0; k < 50000; k++) {
        cull_point p[CORNERS], plain[2 * CORNERS], carried[2 * CORNERS], known[2 * CORNERS];
        double n[3], heights[CORNERS];
        const uint32_t count = (uint32_t)random_between(&r, 0, CORNERS + 1);
        for (uint32_t i = 0; i < count; i++) // bent loops too, and points on the plane
            p[i] = (cull_point){rint(random_between(&r, -3, 3)), random_between(&r, -3, 3), rint(random_between(&r, -3, 3))};
        random_direction(&r, n);
        const cull_cut cut = k % 2 ? (cull_cut){n[0], n[1], n[2], random_between(&r, -2, 2)} : (cull_cut){1, 0, k % 4 ? 0 : 1, rint(random_between(&r, -2, 2))};
        for (uint32_t i = 0; i < count; i++) heights[i] = cull_cut_height(cut, p[i]);
        const uint32_t written = clip_plainly(p, count, cut, plain);
        assert_int_equal(cull_polygon_clip(p, count, cut, carried, 2 * CORNERS), written);
        assert_int_equal(cull_polygon_clip_at(p, heights, count, known, 2 * CORNERS), written);
        assert_memory_equal(plain, carried, written * sizeof *plain);
        assert_memory_equal(plain, known, written * sizeof *plain);
        cut_polygons += written > 0 && (written != count || memcmp(plain, p, count * sizeof *p) != 0);
    }
    assert_true(cut_polygons > 10000);
}

static void the_next_float_is_the_librarys(void **state)
{
    (void)state;
    uint64_t r = {8};
    const float some[] = {0, -0.0f, 1, -1, FLT_MIN, -FLT_MIN, 1e-45f, -1e-45f, -FLT_MAX, 0.99999994f};
    for (size_t i = 0; i < sizeof some / sizeof *some; i++) {
        const float above = cull_float_above(some[i]), library = nextafterf(some[i], FLT_MAX);
        assert_memory_equal(&above, &library, sizeof above);
    }
    for (int i = 0; i < 200000; i++) {
        const float f = (float)(random_between(&r, -1, 1) * exp2(random_between(&r, -140, 120)));
        assert_true(cull_float_above(f) == nextafterf(f, FLT_MAX));
    }
}

// One function is the guard band: made at once, or in parts that serve many zones.
static void a_plane_guarded_once_for_many_zones_has_the_bits_of_one_guarded_for_each(void **state)
{
    (void)state;
    uint64_t r = {9};
    for (int k = 0; k < 5000; k++) {
        cull_guard g = {.pixel_tangent = random_between(&r, 1e-5, 1e-2), .reach = random_between(&r, 1, 20)};
        double n[3];
        random_direction(&r, n);
        random_direction(&r, g.forward);
        const double distance = k % 2 ? random_between(&r, 1, 1000) : 0;
        const cull_guarded once = cull_guard_direction(&g, n, distance);
        for (int zone = 0; zone < 3; zone++) {
            for (int i = 0; i < 3; i++) g.eye[i] = random_between(&r, -500, 500);
            g.radius = random_between(&r, 1, 1000);
            const cull_plane here = cull_guarded_at(&once, g.eye, g.radius), whole = cull_guard_plane(&g, n, distance);
            assert_memory_equal(&here, &whole, sizeof here);
        }
    }
}

static void a_point_on_the_border_of_a_volume_survives_every_order_of_its_sum(void **state)
{
    (void)state;
    uint64_t r = {5};
    for (int k = 0; k < 200000; k++) {
        double n[3], p[3], radius = exp2(random_between(&r, -10, 13)), offset = 0;
        random_direction(&r, n);
        cull_vec3 q;
        for (int i = 0; i < 3; i++) (&q.x)[i] = (float)random_between(&r, -radius, radius);
        for (int i = 0; i < 3; i++) p[i] = (double)(&q.x)[i];
        for (int i = 0; i < 3; i++) offset -= n[i] * p[i];
        const cull_plane f = cull_plane_outward(n, offset, radius);
        const float x = f.normal.x, y = f.normal.y, z = f.normal.z, d = f.offset;
        assert_true(((x * q.x + y * q.y) + z * q.z) + d >= 0);
        assert_true((x * q.x + y * q.y) + (z * q.z + d) >= 0);
        assert_true((x * q.x + d) + (y * q.y + z * q.z) >= 0);
        assert_true(((d + z * q.z) + y * q.y) + x * q.x >= 0);
        assert_true(fmaf(x, q.x, fmaf(y, q.y, fmaf(z, q.z, d))) >= 0);
        assert_true(fmaf(z, q.z, fmaf(x, q.x, y * q.y)) + d >= 0);
        const double length = sqrt((double)x * x + (double)y * y + (double)z * z);
        assert_true(fabs(length - 1) < 2e-7);
        double exact = -n[0] * p[0] - n[1] * p[1] - n[2] * p[2]; // the float offset is never below the true one
        assert_true((double)d >= exact);
        double height = (double)d; // never further out than said
        for (int i = 0; i < 3; i++) height += (double)(&f.normal.x)[i] * p[i];
        assert_true(height < radius * 0x1p-20 + 1e-30);
    }
}

static void planes_are_the_same_bits_in_c_and_in_cxx(void **state)
{
    (void)state;
    uint64_t r = {6};
    for (int k = 0; k < 2000; k++) {
        cull_guard g = {.pixel_tangent = 1e-3, .reach = random_between(&r, 1, 20), .radius = random_between(&r, 1, 1000)};
        double n[3];
        random_direction(&r, n);
        random_direction(&r, g.forward);
        for (int i = 0; i < 3; i++) g.eye[i] = random_between(&r, -500, 500);
        const double distance = k % 2 ? random_between(&r, 1, 1000) : 0;
        const cull_plane c = cull_guard_plane(&g, n, distance), cxx = cxx_guard_plane(&g, n, distance);
        assert_memory_equal(&c, &cxx, sizeof c);
        const cull_volume v = {&c, 1, 0};
        const cull_box b = random_box(&r, 500, 50);
        assert_int_equal(cull_volume_touches(&v, b), cxx_volume_touches(&v, b));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_plane_touches_a_box_exactly_when_one_of_its_corners_is_inside),
        cmocka_unit_test(a_union_is_the_smallest_box_that_contains_both),
        cmocka_unit_test(boxes_touch_exactly_when_a_point_is_in_both),
        cmocka_unit_test(the_radius_is_the_largest_absolute_coordinate),
        cmocka_unit_test(points_kept_by_a_clip_are_those_inside_and_on_the_border),
        cmocka_unit_test(two_polygons_that_share_an_edge_are_cut_at_the_same_point),
        cmocka_unit_test(a_clip_never_writes_more_than_it_has_room_for),
        cmocka_unit_test(a_clip_that_knows_heights_gives_the_points_of_one_that_does_not),
        cmocka_unit_test(the_next_float_is_the_librarys),
        cmocka_unit_test(a_plane_guarded_once_for_many_zones_has_the_bits_of_one_guarded_for_each),
        cmocka_unit_test(a_point_on_the_border_of_a_volume_survives_every_order_of_its_sum),
        cmocka_unit_test(planes_are_the_same_bits_in_c_and_in_cxx),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
