// Triangulation: triangles cover a polygon exactly, keep its orientation and always have area.
// SPDX-License-Identifier: MIT
#include "fixture.h"

#include "host/import/mesh_triangulate.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double FLAT_M = 1e-12; // metres: above the noise of coordinates near 1 m
static const double TURN = 6.283185307179586;

static void area_vector(const double *a, const double *b, const double *c, double out[3])
{
    double u[3], v[3];
    for (int k = 0; k < 3; ++k) {
        u[k] = b[k] - a[k];
        v[k] = c[k] - a[k];
    }
    out[0] = (u[1] * v[2] - u[2] * v[1]) / 2;
    out[1] = (u[2] * v[0] - u[0] * v[2]) / 2;
    out[2] = (u[0] * v[1] - u[1] * v[0]) / 2;
}

static double length(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

typedef struct cover {
    uint32_t triangles;
    double area, net[3]; // sum of areas, and of their vectors
} cover;

static cover triangulate(const double (*points)[3], uint32_t count)
{
    triangulator t = triangulator_make(allocator_heap());
    buffer triangles = buffer_make(allocator_heap(), sizeof(uint32_t));
    assert_int_equal(polygon_triangulate(&t, points, count, FLAT_M, &triangles), RESULT_OK);
    assert_int_equal(triangles.count % 3, 0);
    const uint32_t *at = triangles.items;
    cover c = {.triangles = (uint32_t)(triangles.count / 3)};
    for (size_t i = 0; i < triangles.count; i += 3) {
        double v[3];
        assert_true(at[i] < count && at[i + 1] < count && at[i + 2] < count);
        area_vector(points[at[i]], points[at[i + 1]], points[at[i + 2]], v);
        assert_true(length(v) > 0);
        c.area += length(v);
        for (int k = 0; k < 3; ++k) c.net[k] += v[k];
    }
    buffer_free(&triangles);
    triangulator_free(&t);
    return c;
}

static double polygon_area(const double (*points)[3], uint32_t count)
{
    double net[3] = {0, 0, 0}, v[3];
    for (uint32_t i = 1; i + 1 < count; ++i) {
        area_vector(points[0], points[i], points[i + 1], v);
        for (int k = 0; k < 3; ++k) net[k] += v[k];
    }
    return length(net);
}

// A simple flat polygon: as many triangles as it can have, none turned, together its area.
static void assert_covered(const double (*points)[3], uint32_t count)
{
    const cover c = triangulate(points, count);
    const double area = polygon_area(points, count);
    assert_int_equal(c.triangles, count - 2);
    assert_true(fabs(c.area - area) <= 1e-9 * area);       // an overlap or a turned triangle would add to it
    assert_true(fabs(length(c.net) - area) <= 1e-9 * area);
}

// A polygon given by two coordinates, laid into a plane of any direction.
static void lay(const double (*flat)[2], uint32_t count, uint64_t *random, double (*points)[3])
{
    double u[3], v[3], n[3], origin[3];
    for (int k = 0; k < 3; ++k) {
        u[k] = random_between(random, 0, 1) - 0.5;
        n[k] = random_between(random, 0, 1) - 0.5;
        origin[k] = 100 * random_between(random, 0, 1);
    }
    area_vector((double[3]){0, 0, 0}, u, n, v);
    const double lu = length(u), lv = length(v);
    for (uint32_t i = 0; i < count; ++i)
        for (int k = 0; k < 3; ++k) points[i][k] = origin[k] + flat[i][0] * u[k] / lu + flat[i][1] * v[k] / lv;
}

static void assert_covered_anyhow(const double (*flat)[2], uint32_t count, uint64_t *random)
{
    double(*points)[3] = malloc(count * sizeof *points), (*turned)[3] = malloc(count * sizeof *turned);
    assert_true(points && turned);
    for (int repeat = 0; repeat < 6; ++repeat) {
        lay(flat, count, random, points);
        const uint32_t first = (uint32_t)(random_bits(random) % count);
        for (uint32_t i = 0; i < count; ++i) memcpy(turned[i], points[repeat % 2 ? (first + i) % count : (first + count - i) % count], sizeof *turned);
        assert_covered((const double(*)[3])turned, count);
    }
    free(points);
    free(turned);
}

static void quads_split_on_the_side_that_is_inside(void **state)
{
    static const double arrow[4][2] = {{0, 0}, {2, 1}, {0, 2}, {0.5, 1}}, kite[4][2] = {{0, 0}, {3, 0}, {3, 1}, {0, 2}};
    uint64_t random = 1;
    (void)state;
    assert_covered_anyhow(arrow, 4, &random);
    assert_covered_anyhow(kite, 4, &random);
}

static void a_quad_with_a_straight_corner_keeps_both_triangles(void **state)
{
    static const double straight[4][3] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 2, 0}};
    (void)state;
    for (uint32_t first = 0; first < 4; ++first) {
        double points[4][3];
        for (uint32_t i = 0; i < 4; ++i) memcpy(points[i], straight[(first + i) % 4], sizeof *points);
        assert_covered((const double(*)[3])points, 4);
    }
}

static void stars_and_combs_and_spirals_are_covered(void **state)
{
    double flat[400][2];
    uint64_t random = 2;
    (void)state;
    for (uint32_t count = 5; count < 200; count += 13) {
        for (uint32_t i = 0; i < count; ++i) {
            const double radius = 0.2 + random_between(&random, 0, 1), angle = TURN * i / count;
            flat[i][0] = radius * cos(angle);
            flat[i][1] = radius * sin(angle);
        }
        assert_covered_anyhow((const double(*)[2])flat, count, &random);
    }
    for (uint32_t i = 0; i < 100; ++i) { // teeth of two
        flat[i][0] = i;
        flat[i][1] = i % 2 ? 10 : 1;
    }
    flat[100][0] = 99;
    flat[100][1] = flat[101][1] = 0;
    flat[101][0] = 0;
    assert_covered_anyhow((const double(*)[2])flat, 102, &random);
    for (uint32_t i = 0; i < 200; ++i) { // out along one arm, back along the other
        const double angle = TURN * (i < 100 ? i : 199 - i) / 25, radius = angle + (i < 100 ? 1 : 2.5);
        flat[i][0] = radius * cos(angle);
        flat[i][1] = radius * sin(angle);
    }
    assert_covered_anyhow((const double(*)[2])flat, 200, &random);
}

static void points_on_straight_edges_are_kept(void **state)
{
    double points[40][3];
    (void)state;
    for (uint32_t i = 0; i < 40; ++i) { // ten to a side of a square
        const double along = i % 10, side = i / 10;
        points[i][0] = side == 0 ? along : side == 1 ? 10 : side == 2 ? 10 - along : 0;
        points[i][1] = side == 0 ? 0 : side == 1 ? along : side == 2 ? 10 : 10 - along;
        points[i][2] = 3;
    }
    assert_covered((const double(*)[3])points, 40);
}

static void a_slit_to_a_hole_leaves_the_hole_open(void **state)
{
    static const double ring[10][3] = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {0, 0, 0}, {1, 1, 0}, {1, 3, 0}, {3, 3, 0}, {3, 1, 0}, {1, 1, 0}};
    (void)state;
    assert_covered(ring, 10);
}

static void a_polygon_that_crosses_itself_loses_no_side(void **state)
{
    static const double bow[4][3] = {{0, 0, 0}, {2, 0, 2}, {2, 0, 0}, {0, 0, 2}};
    static const double star[5][3] = {{0, 3, 1}, {2, -2, 1}, {-3, 1, 1}, {3, 1, 1}, {-2, -2, 1}};
    (void)state;
    assert_int_equal(triangulate(bow, 4).triangles, 2);
    assert_true(triangulate(star, 5).triangles >= 2);
    assert_true(triangulate(star, 5).area > 8);
}

static void what_has_no_area_gives_no_triangle(void **state)
{
    double line[7][3];
    static const double point[3][3] = {{1, 2, 3}, {1, 2, 3}, {1, 2, 3}}, back[4][3] = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {1, 1, 1}};
    (void)state;
    for (uint32_t i = 0; i < 7; ++i)
        for (int k = 0; k < 3; ++k) line[i][k] = 0.1 * (double)(i * 3 % 7) * (k + 1);
    assert_int_equal(triangulate((const double(*)[3])line, 7).triangles, 0);
    assert_int_equal(triangulate(point, 3).triangles, 0);
    assert_int_equal(triangulate(back, 4).triangles, 0);
}

static void a_polygon_of_20000_corners_is_covered(void **state)
{
    const uint32_t count = 20000;
    double(*points)[3] = malloc(count * sizeof *points);
    (void)state;
    assert_non_null(points);
    for (uint32_t i = 0; i < count; ++i) {
        const double angle = TURN * i / count, radius = i % 2 ? 1000 : 900;
        points[i][0] = radius * cos(angle);
        points[i][1] = 7;
        points[i][2] = radius * sin(angle);
    }
    assert_covered((const double(*)[3])points, count);
    free(points);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(quads_split_on_the_side_that_is_inside),
        cmocka_unit_test(a_quad_with_a_straight_corner_keeps_both_triangles),
        cmocka_unit_test(stars_and_combs_and_spirals_are_covered),
        cmocka_unit_test(points_on_straight_edges_are_kept),
        cmocka_unit_test(a_slit_to_a_hole_leaves_the_hole_open),
        cmocka_unit_test(a_polygon_that_crosses_itself_loses_no_side),
        cmocka_unit_test(what_has_no_area_gives_no_triangle),
        cmocka_unit_test(a_polygon_of_20000_corners_is_covered),
    };
    return cmocka_run_group_tests_name("triangulate", tests, NULL, NULL);
}
