// Tests of the grid's view culling and order against oracles: a separating-axis test of cell columns and the view's pyramid, and rays.
// PORTCULLIS_LONG=1: a million views.
// SPDX-License-Identifier: MIT
#include "grid_score.h"
#include "tests/common/test.h"

#include <portcullis/plane.h>

#include <stdlib.h>
#include <string.h>

static const double DEGREE = 3.14159265358979323846 / 180;

static uint32_t view_count(uint32_t few)
{
    return getenv("PORTCULLIS_LONG") ? 100 * few : few;
}

// Mostly few cells, where every one can be judged often; at times 2^8 a side.
static uint32_t level_of(uint32_t view)
{
    return view % 1000 == 999 ? 8 : view % 50 == 49 ? 6 : view % 6;
}

static void no_cell_in_view_is_lost_and_no_ray_meets_cells_out_of_order(void **state)
{
    (void)state;
    uint64_t r = 6001;
    grid_score s = {0};
    grid_bench benches[9];
    for (uint32_t level = 0; level < 9; level++) grid_bench_open(&benches[level], level);
    for (uint32_t k = 0; k < view_count(10000); k++) {
        grid_bench *b = &benches[level_of(k)];
        grid_view v;
        grid_view_random(&r, &b->ground, grid_turn_random(&r), GRID_EYES_ANYWHERE, &v);
        grid_find(b, &v, GRID_RINGS);
        grid_score_cells(b, &v, &s);
        grid_score_rays(b, &v, 2, &r, &s);
    }
    for (uint32_t level = 0; level < 9; level++) grid_bench_close(&benches[level]);
    print_message("%llu views, %llu cells touched, %llu extra, %llu rays\n", (unsigned long long)s.views, (unsigned long long)s.touched,
                  (unsigned long long)s.extra, (unsigned long long)s.rays);
    assert_int_equal(s.lost, 0);
    assert_int_equal(s.inversions, 0);
    assert_true(s.touched > s.views);
    assert_true(s.extra * 500 <= s.touched); // 0.2 %
}

static void rings_give_each_cell_of_the_footprint_once_either_way(void **state)
{
    (void)state;
    uint64_t r = 6002;
    grid_score s = {0};
    for (uint32_t level = 0; level < 8; level++) {
        grid_bench b;
        grid_bench_open(&b, level);
        for (uint32_t k = 0; k < view_count(level < 6 ? 400 : 40); k++) {
            grid_view v;
            grid_view_random(&r, &b.ground, grid_turn_random(&r), GRID_EYES_ANYWHERE, &v);
            grid_score_rings(&b, &v, &s);
        }
        grid_bench_close(&b);
    }
    assert_int_equal(s.disorder, 0);
}

static void nodes_of_mixed_levels_are_in_order_for_every_eye(void **state)
{
    (void)state;
    uint64_t r = 6003;
    grid_score s = {0};
    for (uint32_t level = 0; level < 6; level++) {
        grid_bench b;
        grid_bench_open(&b, level);
        for (uint32_t k = 0; k < view_count(300); k++) {
            grid_view v;
            grid_view_random(&r, &b.ground, grid_turn_random(&r), GRID_EYES_ANYWHERE, &v);
            grid_score_nodes(&b, &v, &r, &s);
        }
        grid_bench_close(&b);
    }
    assert_int_equal(s.disorder, 0);
    assert_int_equal(s.inversions, 0);
}

static void the_reports_border_loses_cells_and_its_slope_inverts(void **state)
{
    (void)state;
    static const double fovs[] = {30, 60, 90};
    uint64_t r = 6004, before = 0;
    for (int f = 0; f < 3; f++) {
        grid_score s = {0};
        grid_bench b;
        grid_bench_open(&b, 6);
        for (uint32_t k = 0; k < 200; k++) {
            grid_view v;
            grid_view_random(&r, &b.ground, grid_turn_level(&r, fovs[f] * DEGREE), GRID_EYES_INSIDE, &v);
            grid_find(&b, &v, GRID_REPORT);
            grid_score_cells(&b, &v, &s);
            grid_score_rays(&b, &v, 60, &r, &s);
        }
        assert_true(s.lost * 100 > s.touched);         // more than 1 %
        assert_true(s.views_lost * 10 > s.views * 8);  // in more than 80 % of views
        assert_true(s.views_inverted > before);        // more with wider fields of view
        before = s.views_inverted;
        grid_bench_close(&b);
    }
}

static void a_far_away_viewers_cells_are_in_order(void **state)
{
    (void)state;
    const double ways[5][4] = {{1, -1, 2, 0}, {-3, 0, 1, 0}, {0, 1, 0, 0}, {0, 0, -1, 0}, {-1, 0, 0, 0}};
    const cull_box box = {{0, 0, 0}, {100, 10, 90}};
    const ground g = ground_of(box, 5);
    for (int k = 0; k < 5; k++) {
        const cull_volume all = {NULL, 0, 0};
        footprint f;
        rings rings;
        rings_ring ring;
        double last = -INFINITY;
        uint32_t count = 0;
        footprint_of(&g, &all, &f);
        rings_start(&f, ground_eye(&g, ways[k]), RINGS_NEAR_FIRST, &rings);
        while (rings_next(&rings, &ring))
            for (uint32_t s = 0; s < ring.span_count; s++) {
                // Towards the viewer each step away along x or z falls or stays, so the ring's number rises: cells behind come later.
                const ground_cell c = ring.spans[s].first;
                const double sum = -((ways[k][0] > 0) - (ways[k][0] < 0)) * c.i - ((ways[k][2] > 0) - (ways[k][2] < 0)) * c.j;
                if (ways[k][0] != 0 && ways[k][2] != 0) assert_true(sum >= last);
                last = sum;
                count += ring.spans[s].count;
            }
        assert_int_equal(count, ground_cell_count(&g));
    }
}

// Any planes at all: each point of the ground that all of them hold lies in a kept cell.
static void volumes_of_any_planes_keep_the_cells_of_their_points(void **state)
{
    (void)state;
    uint64_t r = 6005, inside = 0;
    const cull_box box = {{-50, -5, -20}, {50, 25, 60}};
    for (uint32_t k = 0; k < view_count(3000); k++) {
        const ground g = ground_of(box, random_below(&r, 9));
        cull_plane planes[CULL_MAX_PLANES];
        const cull_volume volume = {planes, random_below(&r, CULL_MAX_PLANES + 1), 0};
        footprint f;
        for (uint32_t p = 0; p < volume.plane_count; p++) {
            double n[3];
            random_direction(&r, n);
            if (random_unit(&r) < 0.2) n[1] = random_unit(&r) < 0.5 ? 0 : 1e-20;
            if (random_unit(&r) < 0.1) n[0] = n[2] = 0;
            const double off = random_between(&r, -5, 60) - 20 * n[2];
            planes[p] = (cull_plane){{(float)n[0], (float)n[1], (float)n[2]}, (float)off};
        }
        footprint_of(&g, &volume, &f);
        for (int at = 0; at < 300; at++) {
            const double p[3] = {random_between(&r, -50, 50), random_between(&r, -5, 25), random_between(&r, -20, 60)};
            int is_inside = 1;
            for (uint32_t q = 0; q < volume.plane_count && is_inside; q++)
                is_inside = (double)planes[q].normal.x * p[0] + (double)planes[q].normal.y * p[1] + (double)planes[q].normal.z * p[2] + (double)planes[q].offset >= 0;
            if (!is_inside) continue;
            inside++;
            const ground_cell c = {ground_index(g.x, g.size, (int32_t)g.columns, p[0]), ground_index(g.z, g.size, (int32_t)g.rows, p[2])};
            assert_true(footprint_keeps(&f, c));
        }
    }
    assert_true(inside > 10000);
}

// Cells and their order are the same bytes from every compiler: nothing of a view here is made by functions whose last bits differ.
static void compilers_agree_on_cells_and_order(void **state)
{
    (void)state;
    const cull_box box = {{-50, -5, -20}, {50, 25, 60}};
    uint64_t r = 6006, hash = 0xcbf29ce484222325u, cells = 0;
    for (uint32_t k = 0; k < 500; k++) {
        const ground g = ground_of(box, k % 9);
        const double eye[4] = {random_between(&r, -90, 90), random_between(&r, -5, 25), random_between(&r, -60, 90), 1};
        cull_plane planes[4];
        const cull_volume volume = {planes, 4, 0};
        footprint f;
        rings rings;
        rings_ring ring;
        for (int p = 0; p < 4; p++) {
            double n[3];
            random_direction(&r, n);
            const cull_plane plane = {{(float)n[0], (float)n[1], (float)n[2]}, (float)(random_between(&r, 0, 20) - n[0] * eye[0] - n[2] * eye[2])};
            planes[p] = plane;
        }
        footprint_of(&g, &volume, &f);
        rings_start(&f, ground_eye(&g, eye), k & 1 ? RINGS_FAR_FIRST : RINGS_NEAR_FIRST, &rings);
        while (rings_next(&rings, &ring))
            for (uint32_t s = 0; s < ring.span_count; s++) {
                hash = (hash ^ ground_number(&g, ring.spans[s].first)) * 0x100000001b3u;
                hash = (hash ^ ring.spans[s].count) * 0x100000001b3u;
                cells += ring.spans[s].count;
            }
    }
    if (hash != 0x9a330fb27579f9e9u || cells != 779291u) fail_msg("0x%llxu, %llu cells", (unsigned long long)hash, (unsigned long long)cells);
}

static void a_volume_that_holds_nothing_of_the_ground_has_no_cells(void **state)
{
    (void)state;
    const cull_box box = {{0, 0, 0}, {64, 8, 64}};
    const ground g = ground_of(box, 4);
    const cull_plane above = {{0, 1, 0}, -9}, beside = {{1, 0, 0}, -70}, slanted = {{0.8f, 0.6f, 0}, -60};
    const cull_plane *const planes[] = {&above, &beside, &slanted};
    for (int k = 0; k < 3; k++) {
        const cull_volume volume = {planes[k], 1, 0};
        footprint f;
        rings rings;
        rings_ring ring;
        footprint_of(&g, &volume, &f);
        assert_int_equal(f.point_count, 0);
        rings_start(&f, (ground_cell){3, 3}, RINGS_NEAR_FIRST, &rings);
        assert_false(rings_next(&rings, &ring));
        rings_start(&f, (ground_cell){3, 3}, RINGS_FAR_FIRST, &rings);
        assert_false(rings_next(&rings, &ring));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_cell_in_view_is_lost_and_no_ray_meets_cells_out_of_order),
        cmocka_unit_test(rings_give_each_cell_of_the_footprint_once_either_way),
        cmocka_unit_test(nodes_of_mixed_levels_are_in_order_for_every_eye),
        cmocka_unit_test(the_reports_border_loses_cells_and_its_slope_inverts),
        cmocka_unit_test(a_far_away_viewers_cells_are_in_order),
        cmocka_unit_test(volumes_of_any_planes_keep_the_cells_of_their_points),
        cmocka_unit_test(compilers_agree_on_cells_and_order),
        cmocka_unit_test(a_volume_that_holds_nothing_of_the_ground_has_no_cells),
    };
    return cmocka_run_group_tests_name("image cache: grid", tests, NULL, NULL);
}
