// Bad and extreme zones: nothing is lost, everything is defined.
// SPDX-License-Identifier: MIT
#include "tree_scenes.h"

#include "tests/common/test.h"

#include <stdlib.h>
#include <string.h>

static void tree_of_both_kinds(hand_zone *zone, bsp_split split, bsp_tree figures[2])
{
    for (int kind = 0; kind < 2; kind++) {
        culler_host host;
        grid_end(zone, kind ? ZONE_FLOAT : ZONE_EXACT);
        tree_of(zone, (bsp_wish){split, BSP_BALANCE, 0, 0}, &host, &figures[kind]);
        const bsp_tree kept = figures[kind];
        tree_end(&host, &figures[kind]);
        figures[kind] = kept; // its numbers; the arrays are gone
    }
}

static void a_zone_of_nothing_is_one_empty_leaf(void **state)
{
    (void)state;
    hand_zone zone;
    bsp_tree figures[2];
    hand_zone_open(&zone, 1, 1);
    tree_of_both_kinds(&zone, BSP_WHOLE, figures);
    assert_int_equal(figures[0].leaf_count, 1);
    assert_int_equal(figures[0].entry_count, 0);
    hand_zone_free(&zone);
}

static void a_zone_without_polygons_is_one_leaf_of_all_items(void **state)
{
    (void)state;
    hand_zone zone;
    bsp_tree figures[2];
    hand_zone_open(&zone, 50, 1);
    for (int i = 0; i < 50; i++) hand_zone_cluster(&zone, (cull_box){{(float)i, 0, 0}, {(float)i + 1, 1, 1}});
    tree_of_both_kinds(&zone, BSP_WHOLE, figures);
    assert_int_equal(figures[1].leaf_count, 1);
    assert_int_equal(figures[1].entry_count, 50);
    hand_zone_free(&zone);
}

static void walls_without_a_plane_are_kept_by_their_boxes(void **state)
{
    (void)state;
    hand_zone zone;
    culler_host host;
    bsp_tree tree;
    const int32_t low[3] = {-320, -320, -320}, high[3] = {320, 320, 320}, small[3] = {-32, -32, -32}, large[3] = {32, 32, 32};
    hand_zone_open(&zone, 40, 200);
    grid_box(&zone, low, high, FACE_IN);
    grid_box(&zone, small, large, FACE_OUT);
    const cull_vec3 line[3] = {{-5, -5, -5}, {0, 0, 5}, {5, 5, 15}}, point[3] = {{2, 2, 2}, {2, 2, 2}, {2, 2, 2}};
    const cull_vec3 bent[4] = {{-5, 3, -5}, {5, 5, -5}, {5, 3, 5}, {-5, 5, 5}}; // metres off any plane
    hand_zone_wall(&zone, line, 3, 0);
    hand_zone_wall(&zone, point, 3, 0);
    hand_zone_wall(&zone, bent, 4, 0);
    hand_zone_wall(&zone, line, 2, 0);
    grid_end(&zone, ZONE_FLOAT);
    tree_of(&zone, (bsp_wish){BSP_WHOLE, BSP_BALANCE, 0, 0}, &host, &tree);
    assert_int_equal(tree.boxed_walls, 4);
    assert_int_equal(host.lines, 1);
    assert_non_null(strstr(host.last_line, "4 walls have no plane"));
    for (uint32_t item = 12; item < 16; item++) assert_true(tree_leaves_of(&tree, item) >= 1);
    tree_end(&host, &tree);
    hand_zone_free(&zone);
}

static void a_wall_of_no_area_on_an_exact_plane_stays_a_wall(void **state)
{
    (void)state;
    hand_zone zone;
    bsp_tree figures[2];
    const int32_t low[3] = {-320, -320, -320}, high[3] = {320, 320, 320};
    const grid_loop line = {{{-320, 0, 0}, {0, 0, 0}, {320, 0, 0}}, 3};
    hand_zone_open(&zone, 10, 40);
    grid_box(&zone, low, high, FACE_IN);
    grid_wall(&zone, &line);
    tree_of_both_kinds(&zone, BSP_WHOLE, figures);
    assert_int_equal(figures[0].boxed_walls, 0);
    assert_int_equal(figures[1].boxed_walls, 1);
    hand_zone_free(&zone);
}

static void planes_that_are_none_are_made_from_the_vertices(void **state)
{
    (void)state;
    hand_zone zone;
    culler_host host;
    bsp_tree tree;
    scene_of_boxes(&(box_scene){5, 32, 16, 4}, &zone);
    grid_end(&zone, ZONE_EXACT);
    memset(&zone.exact[3], 0, sizeof *zone.exact);
    zone.exact[4].normal[1] = INT64_MIN;
    tree_of(&zone, (bsp_wish){BSP_WHOLE, BSP_BALANCE, 0, 0}, &host, &tree);
    assert_int_equal(tree.boxed_walls, 0);
    tree_end(&host, &tree);
    hand_zone_free(&zone);
}

static void walls_that_their_exact_planes_miss_are_kept_by_their_boxes(void **state)
{
    (void)state;
    hand_zone zone;
    culler_host host;
    bsp_tree tree;
    scene_of_boxes(&(box_scene){5, 32, 16, 4}, &zone);
    grid_end(&zone, ZONE_EXACT);
    zone.exact[zone.walls[7].plane].offset += 320; // by ten metres
    tree_of(&zone, (bsp_wish){BSP_WHOLE, BSP_BALANCE, 0, 0}, &host, &tree);
    assert_true(tree.boxed_walls >= 1);
    tree_end(&host, &tree);
    hand_zone_free(&zone);
}

static void fronts_and_backs_of_one_plane_part_into_two_leaves(void **state)
{
    (void)state;
    hand_zone zone;
    bsp_tree figures[2];
    const grid_loop front = {{{0, 0, 0}, {64, 0, 0}, {64, 64, 0}, {0, 64, 0}}, 4}, back = {{{0, 64, 0}, {64, 64, 0}, {64, 0, 0}, {0, 0, 0}}, 4};
    hand_zone_open(&zone, 10000, 40000);
    for (int i = 0; i < 5000; i++) {
        grid_wall(&zone, &front);
        grid_wall(&zone, &back);
    }
    grid_end(&zone, ZONE_EXACT);
    for (int split = 0; split < 3; split++) {
        culler_host host;
        culler_host_init(&host, 0);
        const bsp_source from = {&zone.zone, NULL, {(bsp_split)split, BSP_BALANCE, 0, 0}};
        assert_int_equal(bsp_tree_build(&host.host, &from, &figures[0]), CULL_OK);
        assert_int_equal(figures[0].leaf_count, 2);
        assert_int_equal(figures[0].entry_count, 10000);
        assert_int_equal(figures[0].nodes[0].entry_count, split == BSP_SPLIT_NODES ? 10000 : 0);
        tree_end(&host, &figures[0]);
    }
    hand_zone_free(&zone);
}

static void thin_double_walls_closer_than_float_can_tell_are_kept(void **state)
{
    (void)state;
    hand_zone zone;
    bsp_tree figures[2];
    hand_zone_open(&zone, 400, 1600);
    for (int i = 0; i < 100; i++) {
        const float x = 100 + (float)(i % 4) * 7.62939453125e-06f, z = (float)(i % 10); // one step of float at 100
        const cull_vec3 front[4] = {{x, 0, z + 1}, {x, 0, z}, {x, 3, z}, {x, 3, z + 1}}, back[4] = {{x, 0, z}, {x, 0, z + 1}, {x, 3, z + 1}, {x, 3, z}};
        hand_zone_wall(&zone, i % 2 ? front : back, 4, 0);
    }
    grid_end(&zone, ZONE_FLOAT);
    culler_host host;
    bsp_tree tree;
    tree_of(&zone, (bsp_wish){BSP_SPLIT_LEAVES, BSP_BALANCE, 0, 0}, &host, &tree);
    assert_int_equal(tree.splits, 0);
    tree_end(&host, &tree);
    (void)figures;
    hand_zone_free(&zone);
}

static void large_items_in_a_deep_tree_do_not_multiply_without_end(void **state)
{
    (void)state;
    hand_zone zone;
    culler_host host;
    bsp_tree tree;
    scene_of_boxes(&(box_scene){600, 16, 60, 1}, &zone);
    hand_zone all;
    hand_zone_open(&all, 8000, 20000);
    for (uint32_t i = 0; i < zone.zone.item_count; i++) {
        cull_vec3 p[4];
        for (uint32_t k = 0; k < 4; k++) p[k] = zone.positions[zone.wall_vertices[zone.walls[i].first_vertex + k]];
        hand_zone_wall(&all, p, 4, 0);
    }
    for (int i = 0; i < 2000; i++) hand_zone_cluster(&all, (cull_box){{-30, -30, -30}, {30, 30, 30}});
    grid_end(&all, ZONE_FLOAT);
    culler_host_init(&host, 0);
    const bsp_source from = {&all.zone, NULL, {BSP_WHOLE, BSP_BALANCE, 0, 0}};
    assert_int_equal(bsp_tree_build(&host.host, &from, &tree), CULL_OK);
    assert_int_equal(tree.leaf_count, 1);
    assert_int_equal(tree.entry_count, all.zone.item_count);
    assert_non_null(strstr(host.last_line, "one leaf"));
    tree_end(&host, &tree);
    hand_zone_free(&all);
    hand_zone_free(&zone);
}

static void polygons_that_all_cross_stop_at_a_bound_and_are_all_there(void **state)
{
    (void)state;
    hand_zone zone;
    culler_host host;
    bsp_tree tree;
    scene_of_polygons(1500, 77, &zone);
    grid_end(&zone, ZONE_EXACT);
    culler_host_init(&host, 0);
    const bsp_source from = {&zone.zone, NULL, {BSP_WHOLE, BSP_FIRST, 0, 0}};
    assert_int_equal(bsp_tree_build(&host.host, &from, &tree), CULL_OK);
    assert_true(tree.bent_leaves > 0);
    assert_true(tree.entry_count < 1500 * 16 + 65536);
    for (uint32_t item = 0; item < 1500; item += 7) assert_true(tree_leaves_of(&tree, item) >= 1);
    tree_end(&host, &tree);
    hand_zone_free(&zone);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_zone_of_nothing_is_one_empty_leaf),
        cmocka_unit_test(a_zone_without_polygons_is_one_leaf_of_all_items),
        cmocka_unit_test(walls_without_a_plane_are_kept_by_their_boxes),
        cmocka_unit_test(a_wall_of_no_area_on_an_exact_plane_stays_a_wall),
        cmocka_unit_test(planes_that_are_none_are_made_from_the_vertices),
        cmocka_unit_test(walls_that_their_exact_planes_miss_are_kept_by_their_boxes),
        cmocka_unit_test(fronts_and_backs_of_one_plane_part_into_two_leaves),
        cmocka_unit_test(thin_double_walls_closer_than_float_can_tell_are_kept),
        cmocka_unit_test(large_items_in_a_deep_tree_do_not_multiply_without_end),
        cmocka_unit_test(polygons_that_all_cross_stop_at_a_bound_and_are_all_there),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
