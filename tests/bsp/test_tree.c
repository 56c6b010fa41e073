// The tree of made scenes: whole, the same wherever the scene lies, and nothing left behind where memory ends.
// SPDX-License-Identifier: MIT
#include "tree_scenes.h"

#include "tests/common/random.h"
#include "tests/common/test.h"

#include <string.h>

static const bsp_split SPLITS[3] = {BSP_WHOLE, BSP_SPLIT_LEAVES, BSP_SPLIT_NODES};
static const bsp_choose CHOICES[3] = {BSP_BALANCE, BSP_SAH, BSP_FIRST};

static void trees_of_every_kind(hand_zone *zone)
{
    for (int k = 0; k < 2; k++) {
        grid_end(zone, k ? ZONE_FLOAT : ZONE_EXACT);
        for (int i = 0; i < 9; i++) {
            culler_host host;
            bsp_tree tree;
            tree_of(zone, (bsp_wish){SPLITS[i % 3], CHOICES[i / 3], 0, 0}, &host, &tree);
            assert_int_equal(tree.bent_leaves, 0);
            tree_end(&host, &tree);
        }
    }
}

static void every_wall_is_covered_once_by_pieces_in_convex_leaves(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 12; seed++) {
        hand_zone zone;
        scene_of_boxes(&(box_scene){seed * 3, 32, 20, seed}, &zone);
        trees_of_every_kind(&zone);
        hand_zone_free(&zone);
    }
}

static void walls_that_cross_each_other_at_any_angle_are_cut_right(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 12; seed++) {
        hand_zone zone;
        scene_of_polygons(4 * seed, seed, &zone);
        trees_of_every_kind(&zone);
        hand_zone_free(&zone);
    }
}

static void a_cut_through_two_corners_keeps_the_whole_wall(void **state)
{
    (void)state;
    const grid_loop floor = {{{0, 0, 64}, {64, 0, 64}, {64, 0, 0}, {0, 0, 0}}, 4};
    const grid_loop under = {{{0, -64, 0}, {64, -64, 0}, {64, -64, 64}, {0, -64, 64}}, 4};
    const grid_loop across = {{{0, -64, 0}, {64, -64, 64}, {64, 64, 64}, {0, 64, 0}}, 4};
    hand_zone zone;
    hand_zone_open(&zone, 3, 12);
    grid_wall(&zone, &across);
    grid_wall(&zone, &floor);
    grid_wall(&zone, &under);
    trees_of_every_kind(&zone);
    grid_end(&zone, ZONE_EXACT);
    culler_host host;
    bsp_tree tree;
    tree_of(&zone, (bsp_wish){BSP_WHOLE, BSP_FIRST, 0, 0}, &host, &tree);
    uint32_t triangles = 0;
    for (uint32_t e = 0; e < tree.entry_count; e++) triangles += tree.entries[e].point_count == 3;
    assert_int_equal(triangles, 4); // two halves of floor and under each
    tree_end(&host, &tree);
    hand_zone_free(&zone);
}

// ---- Motions ----

static const grid_motion FAR_AWAY = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, 1, {123457, -65536, 777777}};
static const grid_motion QUARTER_TURN = {{{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}}, 1, {0, 0, 0}};
static const grid_motion ALL_AXES_CHANGE = {{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}}, 1, {64, 0, -32}};
static const grid_motion THREE_FOUR_FIVE = {{{3, 0, -4}, {0, 5, 0}, {4, 0, 3}}, 5, {0, 0, 0}};
static const grid_motion TURNED_TWICE = {{{15, 0, -20}, {16, 15, 12}, {12, -20, 9}}, 25, {4096, 31, 2}}; // 3-4-5 about y, then x

static void the_tree_is_the_same(const hand_zone *zone, bsp_wish wish, const grid_motion *motion)
{
    for (int kind = 0; kind < 2; kind++) {
        hand_zone here, there;
        culler_host host, other;
        bsp_tree tree, moved;
        const grid_motion still = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, 1, {0, 0, 0}};
        grid_moved(zone, &still, kind ? ZONE_FLOAT : ZONE_EXACT, &here);
        grid_moved(zone, motion, kind ? ZONE_FLOAT : ZONE_EXACT, &there);
        tree_of(&here, wish, &host, &tree);
        tree_of(&there, wish, &other, &moved);
        assert_no_fault(tree_difference(&tree, &moved));
        tree_end(&host, &tree);
        tree_end(&other, &moved);
        hand_zone_free(&here);
        hand_zone_free(&there);
    }
}

static void the_tree_is_the_same_after_exact_moves_and_turns(void **state)
{
    (void)state;
    const grid_motion *const motions[5] = {&FAR_AWAY, &QUARTER_TURN, &ALL_AXES_CHANGE, &THREE_FOUR_FIVE, &TURNED_TWICE};
    for (uint32_t seed = 1; seed <= 4; seed++) {
        hand_zone zone;
        scene_of_boxes(&(box_scene){12, 25, 16, seed}, &zone);
        grid_end(&zone, ZONE_EXACT);
        for (int m = 0; m < 5; m++)
            for (int i = 0; i < 3; i++) the_tree_is_the_same(&zone, (bsp_wish){SPLITS[i], i == 2 ? BSP_FIRST : BSP_BALANCE, 0, 0}, motions[m]);
        hand_zone_free(&zone);
    }
}

static void by_surface_area_it_is_the_same_after_moves_and_quarter_turns(void **state)
{
    (void)state;
    const grid_motion *const motions[3] = {&FAR_AWAY, &QUARTER_TURN, &ALL_AXES_CHANGE};
    for (uint32_t seed = 1; seed <= 4; seed++) {
        hand_zone zone;
        scene_of_boxes(&(box_scene){12, 25, 16, seed}, &zone);
        grid_end(&zone, ZONE_EXACT);
        for (int m = 0; m < 3; m++) the_tree_is_the_same(&zone, (bsp_wish){BSP_WHOLE, BSP_SAH, 0, 0}, motions[m]);
        hand_zone_free(&zone);
    }
}

static void exact_and_rounded_planes_of_vertices_on_the_grid_give_one_tree(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 4; seed++) {
        hand_zone zone;
        culler_host host, other;
        bsp_tree tree, rounded;
        scene_of_boxes(&(box_scene){15, 32, 20, seed}, &zone);
        grid_end(&zone, ZONE_EXACT);
        tree_of(&zone, (bsp_wish){BSP_WHOLE, BSP_BALANCE, 0, 0}, &host, &tree);
        grid_end(&zone, ZONE_FLOAT);
        tree_of(&zone, (bsp_wish){BSP_WHOLE, BSP_BALANCE, 0, 0}, &other, &rounded);
        assert_no_fault(tree_difference(&tree, &rounded));
        tree_end(&host, &tree);
        tree_end(&other, &rounded);
        hand_zone_free(&zone);
    }
}

static void a_floor_of_float_walls_turned_by_any_angle_stays_one_plane(void **state)
{
    (void)state;
    const double c = 0.8253356149096783, s = 0.5646424733950354; // of 0.6 rad: corners are rounded to float
    hand_zone zone;
    culler_host host;
    bsp_tree tree;
    hand_zone_open(&zone, 200, 800);
    for (int i = 0; i < 100; i++) {
        cull_vec3 p[4];
        for (int k = 0; k < 4; k++) {
            const double x = 3.0 * (i % 10) + (k == 1 || k == 2 ? 3 : 0), z = 7.0 * (i / 10) + (k < 2 ? 7 : 0);
            p[k] = (cull_vec3){(float)(c * x), (float)(s * x), (float)z};
        }
        hand_zone_wall(&zone, p, 4, 0);
    }
    grid_end(&zone, ZONE_FLOAT);
    tree_of(&zone, (bsp_wish){BSP_WHOLE, BSP_BALANCE, 0, 0}, &host, &tree);
    assert_int_equal(tree.splits, 0);
    assert_int_equal(tree.leaf_count, 1);
    assert_int_equal(tree.boxed_walls, 0);
    tree_end(&host, &tree);
    hand_zone_free(&zone);
}

// ---- What is filed by its box ----

static void mesh_clusters_stand_in_all_leaves_that_their_boxes_reach(void **state)
{
    (void)state;
    uint64_t seed = 3;
    hand_zone zone;
    culler_host host;
    bsp_tree tree;
    hand_zone walls;
    scene_of_boxes(&(box_scene){20, 32, 20, 5}, &walls);
    hand_zone_open(&zone, 1000, 4000);
    for (uint32_t i = 0; i < walls.zone.item_count; i++) {
        cull_vec3 p[4];
        for (uint32_t k = 0; k < 4; k++) p[k] = walls.positions[walls.wall_vertices[walls.walls[i].first_vertex + k]];
        hand_zone_wall(&zone, p, 4, 0);
        const float x = (float)random_between(&seed, -20, 18), y = (float)random_between(&seed, -20, 18), z = (float)random_between(&seed, -20, 18);
        hand_zone_cluster(&zone, (cull_box){{x, y, z}, {x + 2, y + (i % 3 ? 1.0f : 0.0f), z + 3}});
    }
    grid_end(&zone, ZONE_FLOAT);
    for (int i = 0; i < 3; i++) {
        tree_of(&zone, (bsp_wish){SPLITS[i], BSP_BALANCE, 0, 0}, &host, &tree);
        assert_true(tree.entry_count > tree.item_count);
        tree_end(&host, &tree);
    }
    hand_zone_free(&zone);
    hand_zone_free(&walls);
}

static void a_flat_cluster_in_a_dividing_plane_stands_on_both_sides(void **state)
{
    (void)state;
    const grid_loop front = {{{0, 0, 0}, {64, 0, 0}, {64, 64, 0}, {0, 64, 0}}, 4}, back = {{{0, 64, 0}, {64, 64, 0}, {64, 0, 0}, {0, 0, 0}}, 4};
    hand_zone zone;
    culler_host host;
    bsp_tree tree;
    hand_zone_open(&zone, 3, 8);
    grid_wall(&zone, &front);
    grid_wall(&zone, &back);
    hand_zone_cluster(&zone, (cull_box){{0.5f, 0.5f, 0}, {1, 1, 0}});
    grid_end(&zone, ZONE_EXACT);
    tree_of(&zone, (bsp_wish){BSP_WHOLE, BSP_BALANCE, 0, 0}, &host, &tree);
    assert_int_equal(tree.leaf_count, 2);
    assert_int_equal(tree_leaves_of(&tree, 2), 2);
    tree_end(&host, &tree);
    hand_zone_free(&zone);
}

static void a_wish_for_a_shallow_tree_bounds_its_depth(void **state)
{
    (void)state;
    hand_zone zone;
    culler_host host;
    bsp_tree tree;
    scene_of_boxes(&(box_scene){30, 32, 20, 9}, &zone);
    grid_end(&zone, ZONE_EXACT);
    for (uint32_t depth = 1; depth <= 4; depth++) {
        tree_of(&zone, (bsp_wish){BSP_WHOLE, BSP_BALANCE, depth, 0}, &host, &tree);
        assert_int_equal(tree.depth, depth);
        assert_true(tree.bent_leaves > 0);
        tree_end(&host, &tree);
    }
    hand_zone_free(&zone);
}

// ---- Memory ----

static void whichever_allocation_fails_nothing_is_left(void **state)
{
    (void)state;
    hand_zone zone;
    scene_of_boxes(&(box_scene){4, 32, 16, 2}, &zone);
    hand_zone_cluster(&zone, (cull_box){{-1, -1, -1}, {1, 1, 1}});
    for (int kind = 0; kind < 2; kind++) {
        grid_end(&zone, kind ? ZONE_FLOAT : ZONE_EXACT);
        cull_result result = CULL_ERR_MEMORY;
        uint64_t fail_at = 0;
        while (result != CULL_OK) {
            culler_host host;
            bsp_tree tree;
            const bsp_source from = {&zone.zone, NULL, {BSP_WHOLE, BSP_BALANCE, 0, 0}};
            culler_host_init(&host, ++fail_at);
            result = bsp_tree_build(&host.host, &from, &tree);
            if (result == CULL_OK) bsp_tree_free(&host.host, &tree);
            else {
                assert_int_equal(result, CULL_ERR_MEMORY);
                assert_int_equal(host.lines, 1);
            }
            assert_true(failing_allocator_is_clean(&host.memory));
        }
        assert_true(fail_at > 20);
    }
    hand_zone_free(&zone);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_wall_is_covered_once_by_pieces_in_convex_leaves),
        cmocka_unit_test(walls_that_cross_each_other_at_any_angle_are_cut_right),
        cmocka_unit_test(a_cut_through_two_corners_keeps_the_whole_wall),
        cmocka_unit_test(the_tree_is_the_same_after_exact_moves_and_turns),
        cmocka_unit_test(by_surface_area_it_is_the_same_after_moves_and_quarter_turns),
        cmocka_unit_test(exact_and_rounded_planes_of_vertices_on_the_grid_give_one_tree),
        cmocka_unit_test(a_floor_of_float_walls_turned_by_any_angle_stays_one_plane),
        cmocka_unit_test(mesh_clusters_stand_in_all_leaves_that_their_boxes_reach),
        cmocka_unit_test(a_flat_cluster_in_a_dividing_plane_stands_on_both_sides),
        cmocka_unit_test(a_wish_for_a_shallow_tree_bounds_its_depth),
        cmocka_unit_test(whichever_allocation_fails_nothing_is_left),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
