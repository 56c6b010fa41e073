// Polygons made of planes against GMP: every corner's side, every part of a cut, whichever way the planes lie.
// SPDX-License-Identifier: MIT
#include "plugins/bsp/exact_polygon.h"
#include "tests/bsp/cells_fixture.h"
#include "tests/common/random.h"
#include "tests/common/test.h"
#include "tests/compile/exact_oracle.h"

#include <math.h>


enum { BOX = 6, GROUPS = 3, PLANES = BOX + 4 * GROUPS + 2, TRIALS = 4000 };

typedef struct table { exact_plane planes[PLANES]; uint32_t scratch[64]; } table;

static void plane_set(table *t, uint32_t i, cull_wide_plane p)
{
    t->planes[i] = (exact_plane){.plane = p, .row = cull_row_of(&p)};
}

// A box about all that the grid can hold, groups of a family, and two planes once more: one turned, one with all numbers doubled.
static void table_make(table *t, plane_family family, uint64_t *seed)
{
    for (int i = 0; i < BOX; i++) {
        cull_wide_plane p = {{0, 0, 0}, cull_wide_from(CULL_GRID_MOST + 1)};
        p.normal[i / 2] = i & 1 ? -1 : 1;
        plane_set(t, (uint32_t)i, p);
    }
    for (uint32_t g = 0; g < GROUPS; g++) {
        cull_wide_plane four[4];
        family_planes(family, seed, four);
        for (uint32_t k = 0; k < 4; k++) plane_set(t, BOX + 4 * g + k, four[k]);
    }
    plane_set(t, PLANES - 2, cull_wide_plane_flipped(t->planes[BOX].plane));
    cull_wide_plane doubled = t->planes[BOX + 1].plane;
    for (int i = 0; i < 3; i++) doubled.normal[i] *= 2;
    doubled.offset = cull_wide_add(doubled.offset, doubled.offset);
    plane_set(t, PLANES - 1, family == FAMILY_LARGEST || family == FAMILY_RANDOM ? t->planes[BOX + 1].plane : doubled);
    exact_planes_match(t->planes, PLANES, t->scratch, 64);
}

static void meet_of(const exact_pool *pool, const exact_polygon *p, uint32_t i, cull_wide_plane out[4])
{
    const exact_edge *edges = exact_edges(pool, p);
    out[0] = pool->planes[p->plane].plane;
    out[1] = pool->planes[edges[i ? i - 1 : p->count - 1].plane].plane;
    out[2] = pool->planes[edges[i].plane].plane;
}

static int gmp_side(const exact_pool *pool, const exact_polygon *p, uint32_t i, uint32_t by)
{
    cull_wide_plane four[4];
    meet_of(pool, p, i, four);
    four[3] = pool->planes[by].plane;
    return gmp_four_sign(four) * gmp_normals_sign(four);
}

static void assert_sound(const exact_pool *pool, const exact_polygon *p)
{
    const exact_edge *edges = exact_edges(pool, p);
    assert_true(p->count >= 3);
    for (uint32_t i = 0; i < p->count; i++) {
        cull_wide_plane three[4];
        meet_of(pool, p, i, three);
        assert_int_not_equal(gmp_normals_sign(three), 0);
        assert_true(gmp_position_is_near(three, edges[i].start, CULL_MEET_ERROR));
        int inside = 0;
        for (uint32_t k = 0; k < p->count; k++) { // strictly convex: all others on one side of each edge
            const int side = gmp_side(pool, p, k, edges[i].plane);
            if (k == i || k == (i + 1) % p->count) assert_int_equal(side, 0);
            else assert_int_not_equal(side, 0);
            if (side && inside) assert_int_equal(side, inside);
            if (side) inside = side;
        }
    }
}

static double area_along(const exact_pool *pool, const exact_polygon *p) // positive: counterclockwise from the front
{
    const exact_edge *e = exact_edges(pool, p);
    const double *n = pool->planes[p->plane].row.n;
    double sum = 0;
    for (uint32_t i = 1; i + 1 < p->count; i++) {
        double u[3], v[3];
        for (int k = 0; k < 3; k++) {
            u[k] = e[i].start[k] - e[0].start[k];
            v[k] = e[i + 1].start[k] - e[0].start[k];
        }
        for (int k = 0; k < 3; k++) sum += n[k] * (u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3]);
    }
    return sum / 2 / sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
}

static exact_place assert_place(exact_pool *pool, const exact_polygon *p, uint32_t by)
{
    exact_place place;
    assert_true(exact_polygon_place(pool, p, by, &place));
    const int8_t *signs = pool->signs.items;
    for (uint32_t i = 0; i < p->count; i++) assert_int_equal(signs[i], gmp_side(pool, p, i, by));
    return place;
}

static void assert_part(exact_pool *pool, const exact_polygon *part, uint32_t by, int side)
{
    assert_sound(pool, part);
    uint32_t on = 0;
    for (uint32_t i = 0; i < part->count; i++) {
        const int s = gmp_side(pool, part, i, by);
        assert_true(s == 0 || s == side);
        on += s == 0;
    }
    assert_int_equal(on, 2);
}

// Cuts on, keeping a side by chance; returns how often it cut.
static uint32_t cut_on(exact_pool *pool, exact_polygon shape, uint64_t *seed)
{
    uint32_t cuts = 0;
    for (uint32_t step = 0; step < 24; step++) {
        const uint32_t by = random_below(seed, PLANES);
        if (assert_place(pool, &shape, by) != EXACT_ACROSS) continue;
        const double area = area_along(pool, &shape);
        exact_polygon parts[2];
        assert_true(exact_polygon_cut(pool, &shape, by, &parts[0], &parts[1]));
        for (int side = 0; side < 2; side++) assert_part(pool, &parts[side], by, side ? -1 : 1);
        assert_true(area > -16); // corners are off by 2^-26 steps, edges up to 2^26 long
        assert_true(fabs(area_along(pool, &parts[0]) + area_along(pool, &parts[1]) - area) <= 1e-9 * area + 16);
        shape = parts[random_below(seed, 2)];
        cuts++;
    }
    return cuts;
}

static void every_cut_is_what_gmp_says(void **state)
{
    (void)state;
    static const uint32_t box[6] = {0, 1, 2, 3, 4, 5};
    uint64_t seed = 20;
    for (int family = 0; family < FAMILY_COUNT; family++) {
        uint64_t cuts = 0;
        for (uint32_t trial = 0; trial < TRIALS / FAMILY_COUNT; trial++) {
            culler_host h;
            culler_host_init(&h, 0);
            table t;
            table_make(&t, (plane_family)family, &seed);
            exact_pool pool = exact_pool_make(&h.host, t.planes);
            exact_polygon shape;
            assert_true(exact_polygon_whole(&pool, box, BOX + random_below(&seed, PLANES - BOX), &shape));
            assert_sound(&pool, &shape);
            cuts += cut_on(&pool, shape, &seed);
            exact_pool_free(&pool);
            assert_true(failing_allocator_is_clean(&h.memory));
        }
        assert_true(cuts > TRIALS / FAMILY_COUNT); // more than one a polygon
    }
}

static void the_same_plane_is_found_whatever_its_length_and_direction(void **state)
{
    (void)state;
    uint64_t seed = 4;
    for (int i = 0; i < 200; i++) {
        table t;
        table_make(&t, FAMILY_SMALL, &seed);
        assert_int_equal(t.planes[PLANES - 2].same, BOX);
        assert_int_equal(t.planes[PLANES - 2].turned, 1);
        assert_int_equal(t.planes[PLANES - 1].same, t.planes[BOX + 1].same);
        assert_int_equal(t.planes[PLANES - 1].turned, t.planes[BOX + 1].turned);
        for (uint32_t a = 0; a < PLANES; a++) // the first of those with its points, so a number tells the points
            assert_true(t.planes[a].same <= a && t.planes[t.planes[a].same].same == t.planes[a].same);
    }
}

static void no_memory_is_told_and_nothing_leaks(void **state)
{
    (void)state;
    static const uint32_t box[6] = {0, 1, 2, 3, 4, 5};
    uint32_t failures = 0;
    for (uint64_t fail_at = 1; fail_at < 8; fail_at++) {
        uint64_t seed = 9;
        culler_host h;
        culler_host_init(&h, fail_at);
        table t;
        table_make(&t, FAMILY_SMALL, &seed);
        exact_pool pool = exact_pool_make(&h.host, t.planes);
        exact_polygon shape, front, behind;
        exact_place place = EXACT_ON;
        int good = exact_polygon_whole(&pool, box, BOX, &shape);
        for (uint32_t by = 0; by < PLANES && good; by++) {
            good = exact_polygon_place(&pool, &shape, by, &place);
            if (good && place == EXACT_ACROSS) good = exact_polygon_cut(&pool, &shape, by, &front, &behind);
        }
        failures += !good;
        assert_true(good == (h.memory.failures == 0));
        exact_pool_free(&pool);
        assert_true(failing_allocator_is_clean(&h.memory));
    }
    assert_in_range(failures, 2, 7);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_cut_is_what_gmp_says),
        cmocka_unit_test(the_same_plane_is_found_whatever_its_length_and_direction),
        cmocka_unit_test(no_memory_is_told_and_nothing_leaks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
