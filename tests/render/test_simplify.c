// Coarser triangles: no point moves farther than the bound, both ways and group by group, as brute force over points and triangles says; open edges, creases and what is
// kept stay; random soups, failing memory, the same result twice.
// SPDX-License-Identifier: MIT
#include "host/render/simplify.h"
#include "tests/common/failing_allocator.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { SIDE = 24, UP = 127 << 8 };

typedef struct surface {
    float (*positions)[3];
    uint32_t *normals, *groups, *corners, *coarse;
    uint32_t position_count, triangle_count;
} surface;

static void *room(size_t count, size_t size)
{
    void *memory = calloc(count + 1, size);
    assert_non_null(memory);
    return memory;
}

static surface surface_of(uint32_t positions, uint32_t triangles)
{
    const surface s = {room(positions, 12), room(positions, 4), room(triangles, 4), room(triangles, 12), room(triangles, 12), positions, triangles};
    return s;
}

static void surface_free(surface *s)
{
    free(s->positions);
    free(s->normals);
    free(s->groups);
    free(s->corners);
    free(s->coarse);
}

static void put_quad(surface *s, uint32_t at, const uint32_t v[4], uint32_t group)
{
    const uint32_t corners[6] = {v[0], v[1], v[2], v[2], v[1], v[3]};
    memcpy(s->corners + (size_t)3 * at, corners, sizeof corners);
    s->groups[at] = s->groups[at + 1] = group;
}

// Hills of that height over a square, its left half of another group.
static surface hills(float height)
{
    surface s = surface_of((SIDE + 1) * (SIDE + 1), 2 * SIDE * SIDE);
    for (uint32_t i = 0; i < s.position_count; ++i) {
        const float x = (float)(i % (SIDE + 1)), z = (float)(i / (SIDE + 1));
        s.positions[i][0] = x;
        s.positions[i][1] = height * sinf(x * 0.37f) * cosf(z * 0.29f);
        s.positions[i][2] = z;
        s.normals[i] = UP;
    }
    for (uint32_t q = 0; q < SIDE * SIDE; ++q) {
        const uint32_t a = q / SIDE * (SIDE + 1) + q % SIDE, v[4] = {a, a + SIDE + 1, a + 1, a + SIDE + 2};
        put_quad(&s, 2 * q, v, q % SIDE < SIDE / 2 ? 0 : 1);
    }
    return s;
}

static uint32_t simplify_by(surface *s, double bound_m)
{
    const simplify_input in = {s->positions[0], s->normals, s->groups, s->position_count, s->triangle_count};
    simplify *work = NULL;
    memcpy(s->coarse, s->corners, (size_t)12 * s->triangle_count);
    assert_int_equal(simplify_open(&in, s->coarse, allocator_heap(), &work), RESULT_OK);
    const uint32_t left = simplify_to(work, bound_m);
    simplify_close(work);
    uint32_t counted = 0;
    for (uint32_t t = 0; t < s->triangle_count; ++t) counted += s->coarse[3 * t] != SIMPLIFY_GONE;
    assert_int_equal(counted, left);
    return left;
}

// ---- The oracle: Ericson, "Real-time collision detection", 5.1.5 ----

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static double segment_distance2(const double p[3], const double a[3], const double b[3])
{
    double along[3], off[3];
    for (int k = 0; k < 3; ++k) along[k] = b[k] - a[k], off[k] = p[k] - a[k];
    const double length2 = dot(along, along), share = length2 > 0 ? fmin(1, fmax(0, dot(off, along) / length2)) : 0;
    for (int k = 0; k < 3; ++k) off[k] -= share * along[k];
    return dot(off, off);
}

static double distance2(const double p[3], double v[3][3])
{
    double u[3], w[3], n[3], off[3];
    double least = fmin(segment_distance2(p, v[0], v[1]), fmin(segment_distance2(p, v[1], v[2]), segment_distance2(p, v[2], v[0])));
    for (int k = 0; k < 3; ++k) u[k] = v[1][k] - v[0][k], w[k] = v[2][k] - v[0][k], off[k] = p[k] - v[0][k];
    for (int k = 0; k < 3; ++k) n[k] = u[(k + 1) % 3] * w[(k + 2) % 3] - u[(k + 2) % 3] * w[(k + 1) % 3];
    const double uu = dot(u, u), uw = dot(u, w), ww = dot(w, w), ou = dot(off, u), ow = dot(off, w), det = uu * ww - uw * uw;
    if (!(det > 0)) return least;
    const double s = (ww * ou - uw * ow) / det, t = (uu * ow - uw * ou) / det;
    if (s >= 0 && t >= 0 && s + t <= 1) least = fmin(least, dot(off, n) * dot(off, n) / dot(n, n));
    return least;
}

static void points_of(const surface *s, const uint32_t *corners, double v[3][3])
{
    for (int c = 0; c < 3; ++c)
        for (int k = 0; k < 3; ++k) v[c][k] = (double)s->positions[corners[c]][k];
}

// Of points of the one from the other's triangles of the same group.
static double farthest(const surface *s, const uint32_t *from, const uint32_t *to)
{
    static const double places[7][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.5, 0.5, 0}, {0, 0.5, 0.5}, {0.5, 0, 0.5}, {0.3, 0.3, 0.4}};
    double most = 0, v[3][3], p[3];
    for (uint32_t t = 0; t < s->triangle_count; ++t) {
        if (from[3 * t] == SIMPLIFY_GONE) continue;
        for (int i = 0; i < 7; ++i) {
            double least = INFINITY;
            points_of(s, from + 3 * (size_t)t, v);
            for (int k = 0; k < 3; ++k) p[k] = places[i][0] * v[0][k] + places[i][1] * v[1][k] + places[i][2] * v[2][k];
            for (uint32_t u = 0; u < s->triangle_count && least > 0; ++u) {
                if (to[3 * u] == SIMPLIFY_GONE || s->groups[u] != s->groups[t]) continue;
                points_of(s, to + 3 * (size_t)u, v);
                least = fmin(least, distance2(p, v));
            }
            most = fmax(most, least);
        }
    }
    return sqrt(most);
}

static void check_bound(const surface *s, double bound_m)
{
    const double slack = 1e-9; // metres: the oracle's own rounding
    assert_true(farthest(s, s->corners, s->coarse) <= bound_m + slack);
    assert_true(farthest(s, s->coarse, s->corners) <= bound_m + slack);
}

// ---- Tests ----

static void no_point_moves_farther_than_the_bound(void **state)
{
    (void)state;
    surface s = hills(1.5f);
    uint32_t last = s.triangle_count;
    for (int i = -6; i <= 0; i += 2) {
        const double bound_m = ldexp(1, i);
        const uint32_t left = simplify_by(&s, bound_m);
        assert_true(left < last);
        check_bound(&s, bound_m);
        last = left;
    }
    assert_true(last < s.triangle_count / 2);
    surface_free(&s);
}

static void steps_of_one_simplifier_add_up_to_the_last_bound(void **state)
{
    (void)state;
    surface s = hills(1);
    const simplify_input in = {s.positions[0], s.normals, s.groups, s.position_count, s.triangle_count};
    simplify *work = NULL;
    memcpy(s.coarse, s.corners, (size_t)12 * s.triangle_count);
    assert_int_equal(simplify_open(&in, s.coarse, allocator_heap(), &work), RESULT_OK);
    for (int i = -7; i <= -1; ++i) {
        simplify_to(work, ldexp(1, i));
        check_bound(&s, ldexp(1, i));
    }
    simplify_close(work);
    surface_free(&s);
}

static void a_flat_sheet_loses_all_but_its_outline_and_where_groups_meet(void **state)
{
    (void)state;
    surface s = hills(0);
    const uint32_t left = simplify_by(&s, 1.0 / 1024);
    assert_in_range(left, 4 * SIDE - 2, 4 * SIDE + 40); // an outline of 4 SIDE points, cut in two by one line
    uint8_t *used = room(s.position_count, 1);
    for (uint32_t c = 0; c < 3 * s.triangle_count; ++c)
        if (s.coarse[c / 3 * 3] != SIMPLIFY_GONE) used[s.coarse[c]] = 1;
    for (uint32_t i = 0; i < s.position_count; ++i) {
        const uint32_t x = i % (SIDE + 1), z = i / (SIDE + 1);
        if (x == 0 || z == 0 || x == SIDE || z == SIDE) assert_true(used[i]); // open edges stay, point by point
    }
    free(used);
    surface_free(&s);
}

static void what_is_kept_or_has_no_normal_stays(void **state)
{
    (void)state;
    surface s = hills(0.5f);
    for (uint32_t t = 0; t < s.triangle_count; ++t) s.groups[t] = SIMPLIFY_KEPT;
    assert_int_equal(simplify_by(&s, 10), s.triangle_count);
    assert_memory_equal(s.coarse, s.corners, (size_t)12 * s.triangle_count);
    for (uint32_t t = 0; t < s.triangle_count; ++t) s.groups[t] = 0;
    memset(s.normals, 0, (size_t)4 * s.position_count);
    assert_int_equal(simplify_by(&s, 10), s.triangle_count);
    surface_free(&s);
}

// A roof of two slopes, each with vertices and normals of its own along the ridge.
static void a_crease_keeps_its_line_and_its_looks(void **state)
{
    enum { WIDE = 13, DEEP = 7 };
    (void)state;
    surface s = surface_of(2 * WIDE * DEEP, 4 * (WIDE - 1) * (DEEP - 1));
    for (uint32_t i = 0; i < s.position_count; ++i) {
        const uint32_t half = i / (WIDE * DEEP), row = i / WIDE % DEEP;
        s.positions[i][0] = (float)(i % WIDE);
        s.positions[i][1] = -(float)row;
        s.positions[i][2] = half ? -(float)row : (float)row;
        s.normals[i] = 90u << 8 | (half ? 0xa6u : 90u) << 16;
    }
    for (uint32_t q = 0; q < 2 * (WIDE - 1) * (DEEP - 1); ++q) {
        const uint32_t half = q / ((WIDE - 1) * (DEEP - 1)), rest = q % ((WIDE - 1) * (DEEP - 1));
        const uint32_t a = half * WIDE * DEEP + rest / (WIDE - 1) * WIDE + rest % (WIDE - 1);
        const uint32_t front[4] = {a, a + WIDE, a + 1, a + WIDE + 1}, back[4] = {a, a + 1, a + WIDE, a + WIDE + 1};
        put_quad(&s, 2 * q, half ? back : front, 0);
    }
    assert_true(simplify_by(&s, 0.01) < s.triangle_count / 3);
    check_bound(&s, 0.01);
    for (uint32_t t = 0; t < s.triangle_count; ++t) {
        const uint32_t *c = s.coarse + 3 * (size_t)t;
        if (c[0] == SIMPLIFY_GONE) continue;
        assert_int_equal(s.normals[c[0]], s.normals[c[1]]);
        assert_int_equal(s.normals[c[0]], s.normals[c[2]]);
    }
    surface_free(&s);
}

static uint32_t next_random(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(*state >> 33);
}

// A rough sheet of 5 x 5 points, somewhat bent sideways, some triangles of it anywhere else: several on an edge, twice the same point, none of area.
static surface rough(uint64_t *random)
{
    enum { POINTS = 6 };
    surface s = surface_of(POINTS * POINTS, 2 * (POINTS - 1) * (POINTS - 1));
    for (uint32_t i = 0; i < s.position_count; ++i) {
        s.positions[i][0] = (float)(i % POINTS) + (float)(next_random(random) % 8) / 16;
        s.positions[i][1] = (float)(next_random(random) % 16) / 16;
        s.positions[i][2] = (float)(i / POINTS) + (float)(next_random(random) % 8) / 16;
        s.normals[i] = next_random(random) % 16 ? UP : next_random(random);
    }
    for (uint32_t q = 0; q < s.triangle_count / 2; ++q) {
        const uint32_t a = q / (POINTS - 1) * POINTS + q % (POINTS - 1), v[4] = {a, a + POINTS, a + 1, a + POINTS + 1};
        put_quad(&s, 2 * q, v, next_random(random) % 16 ? q % (POINTS - 1) < 3 : SIMPLIFY_KEPT);
    }
    for (uint32_t n = next_random(random) % 4; n > 0; --n) s.corners[next_random(random) % (3 * s.triangle_count)] = next_random(random) % s.position_count;
    return s;
}

static void rough_and_broken_sheets_keep_the_bound(void **state)
{
    (void)state;
    uint64_t random = 5;
    uint32_t gone = 0;
    for (int round = 0; round < 300; ++round) {
        surface s = rough(&random);
        const double bound_m = ldexp(1, (int)(next_random(&random) % 4) - 3);
        gone += s.triangle_count - simplify_by(&s, bound_m);
        check_bound(&s, bound_m);
        surface_free(&s);
    }
    assert_true(gone > 300);
}

static void the_same_mesh_comes_out_the_same_whoever_compiled_it(void **state)
{
    (void)state;
    surface s = surface_of(65 * 65, 2 * 64 * 64);
    uint64_t hash = 14695981039346656037u;
    for (uint32_t i = 0; i < s.position_count; ++i) { // no libm: its last bits differ
        const float x = (float)(i % 65), z = (float)(i / 65);
        s.positions[i][0] = x;
        s.positions[i][1] = (x * x - z * x + 40) * 0.01f;
        s.positions[i][2] = z;
        s.normals[i] = UP;
    }
    for (uint32_t q = 0; q < 64 * 64; ++q) {
        const uint32_t a = q / 64 * 65 + q % 64, v[4] = {a, a + 65, a + 1, a + 66};
        put_quad(&s, 2 * q, v, q % 64 / 16);
    }
    simplify_by(&s, 0.125);
    for (uint32_t c = 0; c < 3 * s.triangle_count; ++c) hash = (hash ^ s.coarse[c]) * 1099511628211u;
    assert_int_equal(hash, 0xafbfa6ef3c4bfb88u);
    surface_free(&s);
}

static void failing_memory_is_said_and_nothing_leaks(void **state)
{
    (void)state;
    surface s = hills(1);
    const simplify_input in = {s.positions[0], s.normals, s.groups, s.position_count, s.triangle_count};
    result done = RESULT_NO_MEMORY;
    uint32_t failures = 0;
    for (uint64_t at = 1; done != RESULT_OK; ++at) {
        failing_allocator f;
        failing_allocator_init(&f, at);
        simplify *work = NULL;
        memcpy(s.coarse, s.corners, (size_t)12 * s.triangle_count);
        done = simplify_open(&in, s.coarse, &f.memory, &work);
        failures += done != RESULT_OK;
        assert_true(done == RESULT_OK || !work);
        simplify_close(work);
        assert_true(failing_allocator_is_clean(&f));
    }
    assert_true(failures >= 6);
    surface_free(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_point_moves_farther_than_the_bound),
        cmocka_unit_test(steps_of_one_simplifier_add_up_to_the_last_bound),
        cmocka_unit_test(a_flat_sheet_loses_all_but_its_outline_and_where_groups_meet),
        cmocka_unit_test(what_is_kept_or_has_no_normal_stays),
        cmocka_unit_test(a_crease_keeps_its_line_and_its_looks),
        cmocka_unit_test(rough_and_broken_sheets_keep_the_bound),
        cmocka_unit_test(the_same_mesh_comes_out_the_same_whoever_compiled_it),
        cmocka_unit_test(failing_memory_is_said_and_nothing_leaks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
