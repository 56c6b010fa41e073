// The sources' own examples: their drawings are lost, so these are floor plans with the relations that the texts tell.
// SPDX-License-Identifier: MIT
#include "tree_fixture.h"

#include "tests/common/test.h"

#include <string.h>

enum { METRE = STEPS_PER_METRE, HEIGHT = 3 * METRE };

typedef struct plan_wall { const char *name; double from[2], to[2]; } plan_wall; // faces to the left of its way; metres

typedef struct built_plan {
    hand_zone zone;
    culler_host host;
    bsp_tree tree;
} built_plan;

static void plan_build(const plan_wall *walls, uint32_t count, bsp_wish wish, built_plan *out)
{
    hand_zone_open(&out->zone, count, count * 4);
    for (uint32_t i = 0; i < count; i++) {
        const int32_t w[4] = {(int32_t)(walls[i].from[0] * METRE), (int32_t)(walls[i].from[1] * METRE), (int32_t)(walls[i].to[0] * METRE),
                              (int32_t)(walls[i].to[1] * METRE)};
        grid_plan(&out->zone, w, HEIGHT);
    }
    grid_end(&out->zone, ZONE_EXACT);
    culler_host_init(&out->host, 0);
    const bsp_source from = {&out->zone.zone, NULL, wish};
    assert_int_equal(bsp_tree_build(&out->host.host, &from, &out->tree), CULL_OK);
    const char *fault = tree_fault(&out->zone.zone, &out->tree);
    assert_string_equal(fault ? fault : "none", "none");
}

static void plan_free(built_plan *p)
{
    bsp_tree_free(&p->host.host, &p->tree);
    assert_true(failing_allocator_is_clean(&p->host.memory));
    hand_zone_free(&p->zone);
}

// Some wall of the plane, or BSP_NONE.
static int node_is_of(const built_plan *p, uint32_t node, uint32_t item)
{
    const uint32_t place = tree_place(&p->tree, item);
    for (uint32_t e = 0; e < p->tree.entry_count; e++)
        if (p->tree.entries[e].item == place) return p->tree.entries[e].plane == p->tree.nodes[node].plane;
    return 0;
}

static void mark_under(const bsp_tree *t, uint32_t child, uint8_t *marks)
{
    for (uint32_t l = 0; l < t->leaf_count; l++) {
        uint32_t at = l | BSP_LEAF, parent = t->leaves[l].parent;
        while (at != child && parent != BSP_NONE) {
            at = parent;
            parent = t->nodes[at].parent;
        }
        if (at != child) continue;
        for (uint32_t e = 0; e < t->leaves[l].entry_count; e++) marks[t->order[t->entries[t->leaves[l].first_entry + e].item]] = 1;
    }
}

static uint32_t items_under(const bsp_tree *t, uint32_t child)
{
    uint8_t marks[64] = {0};
    uint32_t count = 0;
    mark_under(t, child, marks);
    for (uint32_t i = 0; i < t->item_count; i++) count += marks[i];
    return count;
}

// The names of what stands below, in the order of the plan.
static const char *names_under(const bsp_tree *t, const plan_wall *walls, uint32_t child, char out[64])
{
    uint8_t marks[64] = {0};
    out[0] = 0;
    mark_under(t, child, marks);
    for (uint32_t i = 0; i < t->item_count; i++)
        if (marks[i]) strcat(out, walls[i].name);
    return out;
}

// Thesis, non-splitting leaf tree: B splits G into G1 and G2; on B's front I divides, on its back D splits G2; four leaves, G in three.
static const plan_wall AIR_OF_TEN[10] = {
    {"A", {0, 12}, {1, 0}}, {"B", {10, 4}, {10, 6}}, {"C", {20, 4}, {15, 5}}, {"D", {22, 10}, {20, 4}}, {"E", {15, 5}, {10, 4}},
    {"F", {5, 6}, {8, 7}},  {"G", {1, 0}, {30, 0}},  {"H", {30, 0}, {22, 10}}, {"I", {10, 6}, {5, 6}},  {"J", {8, 7}, {0, 12}},
};

static void the_air_of_ten_polygons_has_four_leaves_and_G_in_three_of_them(void **state)
{
    (void)state;
    enum { B = 1, D = 3, G = 6, I = 8 };
    built_plan p;
    char names[64];
    plan_build(AIR_OF_TEN, 10, (bsp_wish){BSP_WHOLE, BSP_BALANCE, 0, 0}, &p);
    assert_int_equal(p.tree.leaf_count, 4);
    assert_true(node_is_of(&p, 0, B));
    assert_true(node_is_of(&p, p.tree.nodes[0].child[0], I));
    assert_true(node_is_of(&p, p.tree.nodes[0].child[1], D));
    assert_string_equal(names_under(&p.tree, AIR_OF_TEN, p.tree.nodes[0].child[0], names), "ABFGIJ");
    assert_string_equal(names_under(&p.tree, AIR_OF_TEN, p.tree.nodes[0].child[1], names), "CDEGH");
    assert_int_equal(tree_leaves_of(&p.tree, G), 3);
    for (uint32_t item = 0; item < 10; item++)
        if (item != G) assert_true(tree_leaves_of(&p.tree, item) <= 2);
    plan_free(&p);
}

// Thesis, drawing: root A has all others in front; then B: front H, G, F and E2, back C, D and E1.
static const plan_wall EIGHT[8] = {
    {"A", {0, 0}, {10, 0}},   {"B", {10, 0}, {10, 5}}, {"C", {10, 5}, {20, 5}}, {"D", {20, 5}, {20, 12}},
    {"E", {20, 12}, {5, 12}}, {"F", {5, 12}, {2, 10}}, {"G", {2, 10}, {0, 7}},  {"H", {0, 7}, {0, 0}},
};

static void of_eight_polygons_A_is_the_root_and_B_splits_E(void **state)
{
    (void)state;
    enum { A, B, E = 4 };
    built_plan p;
    char names[64];
    plan_build(EIGHT, 8, (bsp_wish){BSP_SPLIT_NODES, BSP_FIRST, 0, 0}, &p);
    const bsp_tree *t = &p.tree;
    assert_true(node_is_of(&p, 0, A));
    assert_int_equal(t->nodes[0].entry_count, 1);
    assert_int_equal(t->order[t->entries[t->nodes[0].first_entry].item], A);
    assert_int_equal(items_under(t, t->nodes[0].child[1]), 0);
    const uint32_t second = t->nodes[0].child[0];
    assert_true(node_is_of(&p, second, B));
    assert_int_equal(t->nodes[second].entry_count, 1);
    assert_int_equal(t->order[t->entries[t->nodes[second].first_entry].item], B);
    assert_string_equal(names_under(t, EIGHT, t->nodes[second].child[0], names), "EFGH");
    assert_string_equal(names_under(t, EIGHT, t->nodes[second].child[1], names), "CDE");
    assert_int_equal(t->splits, 1);
    assert_int_equal(tree_leaves_of(t, E), 2);
    plan_free(&p);
}

// Tutorial: 28 one-sided walls; 16 and 17 are collinear and divide 13 to 15; then 4 and 10 (8 to 7) on one side, on the other 21, which
// cuts one (8 to 6), rather than 18, 19, 26, 27, which cut none but divide 10 to 3 (the text has 11 to 3, of 13). 1, 2, 6, 22, 28 are outer.
static const plan_wall FLOOR_PLAN[28] = {
    {"1", {16, -10}, {20, -6}},    {"2", {20, -6}, {20, 4}},     {"3", {0, -10}, {10, -10}},   {"4", {10, -10}, {10, -2}},   {"5", {10, -10}, {16, -10}},
    {"6", {20, 4}, {16, 10}},      {"7", {16, 10}, {10, 10}},    {"8", {4, 10}, {0, 6}},       {"9", {10, -2}, {10, -10}},   {"10", {10, 2}, {10, 10}},
    {"11", {10, 10}, {10, 2}},     {"12", {14, 0}, {14, 4}},     {"13", {-10, 6}, {-3, 9}},   {"14", {-4, 10}, {-14, 6}},   {"15", {-3, 9}, {-4, 10}},
    {"16", {0, -2}, {0, -8}},      {"17", {0, 6}, {0, -2}},      {"18", {-14, 6}, {-16, 6}},   {"19", {0, 6}, {-10, 6}},     {"20", {0, -8}, {0, 6}},
    {"21", {-14, 1.5}, {-4, -6}},  {"22", {-16, -10}, {0, -10}}, {"23", {-16.5, -9}, {-16, -4}}, {"24", {-18, -8}, {-16.5, -9}}, {"25", {-16, 0}, {-18, -8}},
    {"26", {-16, -4}, {-16, -10}}, {"27", {-16, 6}, {-16, 0}},   {"28", {10, 10}, {4, 10}},
};

static void the_floor_plan_of_28_walls_is_divided_as_the_tutorial_has_it(void **state)
{
    (void)state;
    built_plan p;
    plan_build(FLOOR_PLAN, 28, (bsp_wish){BSP_WHOLE, BSP_BALANCE, 0, 0}, &p);
    const bsp_tree *t = &p.tree;
    assert_true(node_is_of(&p, 0, 15) && node_is_of(&p, 0, 16)); // 16 and 17
    const uint32_t front = t->nodes[0].child[0], back = t->nodes[0].child[1];
    assert_int_equal(items_under(t, front), 15);
    assert_int_equal(items_under(t, back), 13);
    assert_true(node_is_of(&p, front, 3) && node_is_of(&p, front, 9)); // 4 and 10
    assert_int_equal(items_under(t, t->nodes[front].child[0]) + items_under(t, t->nodes[front].child[1]), 15);
    assert_in_range(items_under(t, t->nodes[front].child[0]), 7, 8);
    assert_true(node_is_of(&p, back, 20)); // 21
    assert_int_equal(items_under(t, t->nodes[back].child[0]), 8);
    assert_int_equal(items_under(t, t->nodes[back].child[1]), 6);
    static const uint32_t outer[5] = {0, 1, 5, 21, 27};
    for (uint32_t n = 0; n < t->node_count; n++)
        for (int i = 0; i < 5; i++) assert_false(node_is_of(&p, n, outer[i]));
    plan_free(&p);
}

static void leaves_hold_pieces_or_whole_walls_of_one_and_the_same_tree(void **state)
{
    (void)state;
    built_plan whole, split;
    plan_build(FLOOR_PLAN, 28, (bsp_wish){BSP_WHOLE, BSP_BALANCE, 0, 0}, &whole);
    plan_build(FLOOR_PLAN, 28, (bsp_wish){BSP_SPLIT_LEAVES, BSP_BALANCE, 0, 0}, &split);
    assert_null(tree_difference(&whole.tree, &split.tree));
    plan_free(&whole);
    plan_free(&split);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_air_of_ten_polygons_has_four_leaves_and_G_in_three_of_them),
        cmocka_unit_test(of_eight_polygons_A_is_the_root_and_B_splits_E),
        cmocka_unit_test(the_floor_plan_of_28_walls_is_divided_as_the_tutorial_has_it),
        cmocka_unit_test(leaves_hold_pieces_or_whole_walls_of_one_and_the_same_tree),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
