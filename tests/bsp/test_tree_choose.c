// The choice of a plane against brute force over all planes in whole numbers, and how the work grows.
// SPDX-License-Identifier: MIT
#include "tree_scenes.h"

#include "tests/common/random.h"
#include "tests/common/test.h"

#include <math.h>
#include <stdio.h>

// ---- The tutorial's rule by brute force ----

typedef struct division { uint32_t front, back, spanning; } division;

static cull_wide_plane plane_of_wall(const cull_zone *zone, uint32_t item)
{
    return cull_wide_plane_reduced(cull_wide_plane_from_exact(&zone->exact_planes[zone->walls[item].plane]));
}

static void count_wall(const cull_zone *zone, uint32_t item, const cull_wide_plane *plane, division *d)
{
    const cull_wall *wall = &zone->walls[item];
    int front = 0, back = 0;
    for (uint32_t i = 0; i < wall->vertex_count; i++) {
        const cull_vec3 v = zone->positions[zone->wall_vertices[wall->first_vertex + i]];
        const int32_t p[3] = {(int32_t)(v.x * STEPS_PER_METRE), (int32_t)(v.y * STEPS_PER_METRE), (int32_t)(v.z * STEPS_PER_METRE)};
        const int side = cull_side_of_point(plane, p);
        front |= side > 0;
        back |= side < 0;
    }
    if (!front && !back) {
        const cull_wide_plane own = plane_of_wall(zone, item);
        front = cull_normals_dot_sign(&own, plane) > 0;
        back = !front;
    }
    d->front += (uint32_t)front;
    d->back += (uint32_t)back;
    d->spanning += (uint32_t)(front && back);
}

static division divide_by(const cull_zone *zone, const cull_wide_plane *plane)
{
    division d = {0, 0, 0};
    for (uint32_t i = 0; i < zone->item_count; i++) count_wall(zone, i, plane, &d);
    return d;
}

static double ratio_of(division d)
{
    return d.front < d.back ? (double)d.front / d.back : (double)d.back / d.front;
}

static division best_division(const cull_zone *zone) // of no walls: all are convex
{
    division best = {0, 0, 0};
    int found = 0, useful = 0;
    for (double least = 0.8; !found; least /= 2) {
        for (uint32_t i = 0; i < zone->item_count; i++) {
            const cull_wide_plane plane = plane_of_wall(zone, i);
            const division d = divide_by(zone, &plane);
            useful |= d.back > 0;
            if (d.back == 0 || ratio_of(d) < least) continue;
            if (found && (d.spanning > best.spanning || (d.spanning == best.spanning && ratio_of(d) <= ratio_of(best)))) continue;
            best = d;
            found = 1;
        }
        if (!useful) break;
    }
    return best;
}

static void the_first_plane_is_the_one_that_the_rule_finds_over_all(void **state)
{
    (void)state;
    uint32_t divided = 0;
    for (uint32_t seed = 1; seed <= 60; seed++) {
        hand_zone zone;
        culler_host host;
        bsp_tree tree;
        if (seed % 2) scene_of_polygons(3 + seed, seed, &zone);
        else scene_of_boxes(&(box_scene){1 + seed % 8, 16, 14, seed}, &zone);
        grid_end(&zone, ZONE_EXACT);
        tree_of(&zone, (bsp_wish){BSP_WHOLE, BSP_BALANCE, 0, 0}, &host, &tree);
        const division best = best_division(&zone.zone);
        assert_int_equal(tree.node_count > 0, best.back > 0);
        if (tree.node_count) {
            const division made = divide_by(&zone.zone, &tree.planes[tree.nodes[0].plane].exact);
            assert_int_equal(made.spanning, best.spanning);
            assert_true(ratio_of(made) == ratio_of(best));
            divided++;
        }
        tree_end(&host, &tree);
        hand_zone_free(&zone);
    }
    assert_true(divided > 50);
}

static double cost_of(const bsp_tree *t) // what a random line meets: entries times the area of their leaf's box
{
    double cost = 0;
    for (uint32_t l = 0; l < t->leaf_count; l++) {
        const cull_box b = t->leaf_boxes[l];
        const double x = (double)b.max.x - (double)b.min.x, y = (double)b.max.y - (double)b.min.y, z = (double)b.max.z - (double)b.min.z;
        if (x >= 0) cost += 2 * (x * y + y * z + z * x) * t->leaves[l].entry_count;
    }
    return cost;
}

static void by_surface_area_the_tree_costs_a_line_less_than_by_the_first_plane(void **state)
{
    (void)state;
    double first = 0, sah = 0;
    for (uint32_t seed = 1; seed <= 10; seed++) {
        for (int i = 0; i < 2; i++) {
            hand_zone zone;
            culler_host host;
            bsp_tree tree;
            scene_of_boxes(&(box_scene){60, 16, 40, seed}, &zone);
            grid_end(&zone, ZONE_EXACT);
            tree_of(&zone, (bsp_wish){BSP_WHOLE, i ? BSP_SAH : BSP_FIRST, 0, 0}, &host, &tree);
            *(i ? &sah : &first) += cost_of(&tree);
            tree_end(&host, &tree);
            hand_zone_free(&zone);
        }
    }
    assert_true(sah < 0.8 * first);
}

// ---- How the work grows: pieces held against planes, not time ----

static uint64_t work_of(const hand_zone *zone, bsp_wish wish, bsp_tree *figures)
{
    culler_host host;
    bsp_tree tree;
    culler_host_init(&host, 0);
    const bsp_source from = {&zone->zone, NULL, wish};
    assert_int_equal(bsp_tree_build(&host.host, &from, &tree), CULL_OK);
    *figures = tree;
    tree_end(&host, &tree);
    return figures->classified;
}

static void to_100000_polygons_the_work_grows_as_n_log_n(void **state)
{
    (void)state;
    static const bsp_choose choices[2] = {BSP_BALANCE, BSP_SAH};
    for (int c = 0; c < 2; c++) {
        double before = 0;
        for (uint32_t boxes = 1041; boxes <= (choices[c] == BSP_SAH ? 4164u : 16666u); boxes *= 4) {
            hand_zone zone;
            bsp_tree figures;
            const int32_t room = (int32_t)(14 * cbrt((double)boxes)); // as dense at every size
            scene_of_boxes(&(box_scene){boxes, 16, room, boxes}, &zone);
            grid_end(&zone, ZONE_EXACT);
            const double n = zone.zone.item_count, each = (double)work_of(&zone, (bsp_wish){BSP_WHOLE, choices[c], 0, 0}, &figures) / (n * log2(n));
            print_message("%.0f walls: %.1f tests a wall and level, depth %u, %u nodes, %u cuts, %u bent leaves\n", n, each, figures.depth,
                          figures.node_count, figures.splits, figures.bent_leaves);
            assert_int_equal(figures.bent_leaves, 0);
            assert_true(figures.depth < 6 * log2(n));
            assert_true(each < 128);
            if (before > 0) assert_true(each < 1.4 * before);
            before = each;
            hand_zone_free(&zone);
        }
    }
}

static void ten_thousand_coincident_polygons_are_one_leaf_in_one_pass(void **state)
{
    (void)state;
    hand_zone zone;
    bsp_tree figures;
    const grid_loop loop = {{{0, 0, 0}, {64, 0, 0}, {64, 64, 0}, {0, 64, 0}}, 4};
    hand_zone_open(&zone, 10000, 40000);
    for (int i = 0; i < 10000; i++) grid_wall(&zone, &loop);
    for (int kind = 0; kind < 2; kind++) {
        grid_end(&zone, kind ? ZONE_FLOAT : ZONE_EXACT);
        assert_true(work_of(&zone, (bsp_wish){BSP_WHOLE, BSP_BALANCE, 0, 0}, &figures) <= 20000);
        assert_int_equal(figures.leaf_count, 1);
        assert_int_equal(figures.entry_count, 10000);
    }
    hand_zone_free(&zone);
}

static void a_column_of_thousands_of_walls_stays_within_the_depth_and_the_work(void **state)
{
    (void)state;
    for (int faces = 0; faces < 2; faces++) {
        hand_zone zone;
        bsp_tree figures;
        scene_of_column(8000, faces ? FACE_IN : FACE_OUT, &zone);
        grid_end(&zone, ZONE_EXACT);
        const double n = zone.zone.item_count, work = (double)work_of(&zone, (bsp_wish){BSP_WHOLE, BSP_BALANCE, 0, 0}, &figures);
        assert_true(figures.depth <= 512);
        assert_true(work < 10000 * n);
        if (faces) assert_int_equal(figures.leaf_count, 1); // a room: convex
        hand_zone_free(&zone);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_first_plane_is_the_one_that_the_rule_finds_over_all),
        cmocka_unit_test(by_surface_area_the_tree_costs_a_line_less_than_by_the_first_plane),
        cmocka_unit_test(to_100000_polygons_the_work_grows_as_n_log_n),
        cmocka_unit_test(ten_thousand_coincident_polygons_are_one_leaf_in_one_pass),
        cmocka_unit_test(a_column_of_thousands_of_walls_stays_within_the_depth_and_the_work),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
