// Clusters: at most 128 triangles, every polygon in one, tight, and the same wherever the mesh stands.
// SPDX-License-Identifier: MIT
#include "fixture.h"

#include "host/import/cluster.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct clustering {
    uint32_t *cluster_of, *triangles; // of a polygon, of a cluster
    uint32_t count;
} clustering;

static clustering split(const cluster_polygon *polygons, uint32_t count)
{
    clustering c = {.cluster_of = malloc(count * sizeof(uint32_t) + 1), .triangles = calloc(count + 1, sizeof(uint32_t))};
    arena scratch = arena_make(allocator_heap());
    assert_true(c.cluster_of && c.triangles);
    assert_int_equal(cluster_split(polygons, count, &scratch, c.cluster_of, &c.count), RESULT_OK);
    arena_free(&scratch);
    uint32_t *members = calloc(count + 1, sizeof *members);
    assert_non_null(members);
    for (uint32_t i = 0; i < count; ++i) {
        assert_true(c.cluster_of[i] < c.count);
        c.triangles[c.cluster_of[i]] += polygons[i].triangles;
        members[c.cluster_of[i]]++;
    }
    for (uint32_t k = 0; k < c.count; ++k) {
        assert_true(members[k] >= 1);
        assert_true(c.triangles[k] <= CLUSTER_TRIANGLES_MOST || members[k] == 1);
    }
    free(members);
    return c;
}

static void clustering_free(clustering *c)
{
    free(c->cluster_of);
    free(c->triangles);
}

// A hilly field of small boxes on millimetres, as maps of cities have them.
static cluster_polygon *make_field(uint32_t side, const double move[3])
{
    cluster_polygon *p = calloc((size_t)side * side, sizeof *p);
    uint64_t random = 3;
    assert_non_null(p);
    for (uint32_t i = 0; i < side * side; ++i) {
        const double low[3] = {(double)(i % side), floor(random_between(&random, 0, 1) * 2000) / 1000, (double)(i / side)};
        p[i].triangles = 1 + (uint32_t)(random_bits(&random) % 3);
        for (int k = 0; k < 3; ++k) {
            p[i].min[k] = low[k] + move[k];
            p[i].max[k] = low[k] + floor(random_between(&random, 0, 1) * 1500) / 1000 + move[k];
        }
    }
    return p;
}

static void a_field_is_split_into_few_compact_clusters(void **state)
{
    const uint32_t side = 200, count = side * side;
    const double here[3] = {0, 0, 0};
    cluster_polygon *field = make_field(side, here);
    (void)state;
    uint32_t total = 0;
    for (uint32_t i = 0; i < count; ++i) total += field[i].triangles;
    clustering c = split(field, count);
    assert_true(c.count <= 2 * (total / CLUSTER_TRIANGLES_MOST + 1));
    double area = 0; // of the clusters' boxes seen from above: 1.0 would be no overlap at all
    for (uint32_t k = 0; k < c.count; ++k) {
        double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
        for (uint32_t i = 0; i < count; ++i) {
            if (c.cluster_of[i] != k) continue;
            for (int a = 0; a < 2; ++a) {
                low[a] = fmin(low[a], field[i].min[2 * a]);
                high[a] = fmax(high[a], field[i].max[2 * a]);
            }
        }
        area += (high[0] - low[0]) * (high[1] - low[1]);
    }
    assert_true(area < 1.5 * side * side);
    clustering_free(&c);
    free(field);
}

static void a_move_by_whole_metres_changes_no_cluster(void **state)
{
    static const double moves[][3] = {{0, 0, 0}, {85000, 0, 446000}, {-3, 17, 1000000}, {123456789, 0, -5}};
    const uint32_t side = 60;
    cluster_polygon *field = make_field(side, moves[0]);
    clustering here = split(field, side * side);
    (void)state;
    for (size_t i = 1; i < sizeof moves / sizeof *moves; ++i) {
        cluster_polygon *there = make_field(side, moves[i]);
        clustering moved = split(there, side * side);
        assert_int_equal(moved.count, here.count);
        assert_memory_equal(moved.cluster_of, here.cluster_of, side * side * sizeof(uint32_t));
        clustering_free(&moved);
        free(there);
    }
    clustering_free(&here);
    free(field);
}

static void a_scale_by_a_power_of_two_changes_no_cluster(void **state)
{
    const double here[3] = {0, 0, 0};
    const uint32_t side = 60;
    cluster_polygon *field = make_field(side, here);
    clustering plain = split(field, side * side);
    (void)state;
    for (int exponent = -13; exponent <= 13; exponent += 13) {
        cluster_polygon *scaled = make_field(side, here);
        for (uint32_t i = 0; i < side * side; ++i)
            for (int k = 0; k < 3; ++k) {
                scaled[i].min[k] = ldexp(field[i].min[k], exponent);
                scaled[i].max[k] = ldexp(field[i].max[k], exponent);
            }
        clustering c = split(scaled, side * side);
        assert_int_equal(c.count, plain.count);
        assert_memory_equal(c.cluster_of, plain.cluster_of, side * side * sizeof(uint32_t));
        clustering_free(&c);
        free(scaled);
    }
    clustering_free(&plain);
    free(field);
}

static void few_triangles_are_one_cluster_and_a_huge_polygon_is_alone(void **state)
{
    const double here[3] = {0, 0, 0};
    cluster_polygon *field = make_field(8, here);
    (void)state;
    for (uint32_t i = 0; i < 64; ++i) field[i].triangles = 2;
    clustering c = split(field, 64);
    assert_int_equal(c.count, 1);
    clustering_free(&c);
    field[17].triangles = 5000;
    c = split(field, 64);
    assert_int_equal(c.triangles[c.cluster_of[17]], 5000);
    clustering_free(&c);
    free(field);
}

static void what_is_scattered_is_split_though_it_is_few_triangles(void **state)
{
    enum { TREES = 5, LEAVES = 16 };
    cluster_polygon *wood = calloc(TREES * LEAVES, sizeof *wood);
    (void)state;
    assert_non_null(wood);
    for (uint32_t i = 0; i < TREES * LEAVES; ++i) {
        const double x = 40.0 * (i / LEAVES), y = i % 4, z = i % LEAVES / 4;
        wood[i] = (cluster_polygon){{x, y, z}, {x + 1, y + 1, z + 1}, 1};
    }
    clustering c = split(wood, TREES * LEAVES);
    assert_int_equal(c.count, TREES);
    for (uint32_t i = 0; i < TREES * LEAVES; ++i) assert_int_equal(c.cluster_of[i], c.cluster_of[i / LEAVES * LEAVES]);
    clustering_free(&c);
    free(wood);
}

static void polygons_all_in_one_place_still_split(void **state)
{
    cluster_polygon *same = calloc(70000, sizeof *same);
    (void)state;
    assert_non_null(same);
    for (uint32_t i = 0; i < 70000; ++i) same[i] = (cluster_polygon){{1, 2, 3}, {4, 5, 6}, 1};
    clustering c = split(same, 70000);
    assert_true(c.count < 2 * 70000 / CLUSTER_TRIANGLES_MOST);
    clustering_free(&c);
    free(same);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_field_is_split_into_few_compact_clusters),
        cmocka_unit_test(a_move_by_whole_metres_changes_no_cluster),
        cmocka_unit_test(a_scale_by_a_power_of_two_changes_no_cluster),
        cmocka_unit_test(few_triangles_are_one_cluster_and_a_huge_polygon_is_alone),
        cmocka_unit_test(what_is_scattered_is_split_though_it_is_few_triangles),
        cmocka_unit_test(polygons_all_in_one_place_still_split),
    };
    return cmocka_run_group_tests_name("cluster", tests, NULL, NULL);
}
