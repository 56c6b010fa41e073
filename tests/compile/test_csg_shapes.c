// The CSG on the thesis's figures, on slanted bodies against inclusion and exclusion, on liquids and faces without a material.
// SPDX-License-Identifier: MIT
#include "tests/common/random.h"
#include "tests/common/test.h"

#include "csg_fixture.h"
#include "host/compile/relations.h"

#include <stdlib.h>
#include <string.h>

static cull_wide_plane plane_of(int64_t x, int64_t y, int64_t z, int64_t offset)
{
    return (cull_wide_plane){{x, y, z}, cull_wide_from(offset)};
}

static csg_counts counts_of(scene_draft *d)
{
    const compile_input in = draft_input(d);
    csg_counts counts;
    compile_mesh_free(surface_of(&in, &counts));
    return counts;
}

// ---- Figures ----

// A block, and a slanted bar that crosses only the block's face x = 10 but lies across the plane y = 10 outside of it.
static void add_block_and_bar(scene_draft *d, const int order[4])
{
    const cull_wide_plane sides[4] = {plane_of(1, 0, 0, -10), plane_of(0, 1, 0, -10), plane_of(-1, 0, 0, 0), plane_of(0, -1, 0, 0)};
    const cull_wide_plane ends[2] = {plane_of(0, 0, 1, -10), plane_of(0, 0, -1, 0)};
    const cull_wide_plane bar[6] = {plane_of(-1, 0, 0, 8), plane_of(1, 0, 0, -30), plane_of(-1, 1, 0, 2), plane_of(1, -1, 0, -6), plane_of(0, 0, -1, 2),
                                    plane_of(0, 0, 1, -4)};
    draft_brush(d, BRUSH_ADD, BRUSH_STRUCTURE, 0);
    for (int i = 0; i < 4; ++i) draft_plane(d, &sides[order[i]]);
    for (int i = 0; i < 2; ++i) draft_plane(d, &ends[i]);
    draft_brush(d, BRUSH_ADD, BRUSH_STRUCTURE, 1);
    for (int i = 0; i < 6; ++i) draft_plane(d, &bar[i]);
}

static void test_no_order_of_a_bodys_planes_makes_a_split_that_is_not_needed(void **state)
{
    (void)state;
    for (int code = 0; code < 256; ++code) {
        const int order[4] = {code & 3, code >> 2 & 3, code >> 4 & 3, code >> 6 & 3};
        if ((1 << order[0] | 1 << order[1] | 1 << order[2] | 1 << order[3]) != 15) continue;
        scene_draft d = draft_make();
        add_block_and_bar(&d, order);
        // The block: 5 whole faces, and 4 pieces round the bar. The bar: 4 sides cut once, 1 end.
        assert_int_equal(counts_of(&d).polygons_csg, 14);
        draft_free(&d);
    }
}

static csg_counts two_boxes(const int32_t min[3], const int32_t max[3], brush_kind kind)
{
    static const int32_t low[3] = {0, 0, 0}, high[3] = {16, 16, 16};
    scene_draft d = draft_make();
    draft_box(&d, BRUSH_ADD, low, high, 0);
    draft_box(&d, kind, min, max, 0);
    const csg_counts counts = counts_of(&d);
    draft_free(&d);
    return counts;
}

static void test_boxes_that_share_an_edge_keep_all_four_polygons_on_it(void **state)
{
    (void)state;
    const csg_counts c = two_boxes((const int32_t[3]){16, 16, 0}, (const int32_t[3]){32, 32, 16}, BRUSH_ADD);
    assert_int_equal(c.polygons_csg, 12);
    assert_int_equal(c.polygons_merged, 12);
}

static void test_touching_faces_vanish_and_the_rest_merges(void **state)
{
    (void)state;
    const csg_counts c = two_boxes((const int32_t[3]){16, 0, 0}, (const int32_t[3]){32, 16, 16}, BRUSH_ADD);
    assert_int_equal(c.polygons_csg, 10);
    assert_int_equal(c.polygons_merged, 6);
}

static void test_of_equal_boxes_one_remains(void **state)
{
    (void)state;
    assert_int_equal(two_boxes((const int32_t[3]){0, 0, 0}, (const int32_t[3]){16, 16, 16}, BRUSH_ADD).polygons_csg, 6);
    assert_int_equal(two_boxes((const int32_t[3]){0, 0, 0}, (const int32_t[3]){16, 16, 16}, BRUSH_SUBTRACT).polygons_csg, 0);
}

static void test_a_subtract_that_only_touches_changes_nothing(void **state)
{
    (void)state;
    assert_int_equal(two_boxes((const int32_t[3]){16, 4, 4}, (const int32_t[3]){20, 8, 8}, BRUSH_SUBTRACT).polygons_csg, 6);
    assert_int_equal(two_boxes((const int32_t[3]){40, 40, 40}, (const int32_t[3]){50, 50, 50}, BRUSH_SUBTRACT).polygons_csg, 6);
}

static void test_a_split_whose_parts_all_stay_is_taken_back(void **state)
{
    (void)state;
    // The last box's top crosses a hole that an earlier subtract made, where no solid is left: no reason to cut it.
    static const int32_t corners[3][2][3] = {{{0, 0, 0}, {16, 16, 16}}, {{4, 4, 8}, {12, 12, 30}}, {{6, 6, 10}, {10, 10, 40}}};
    scene_draft d = draft_make();
    draft_box(&d, BRUSH_ADD, corners[0][0], corners[0][1], 0);
    draft_box(&d, BRUSH_SUBTRACT, corners[1][0], corners[1][1], 1);
    draft_box(&d, BRUSH_ADD, corners[2][0], corners[2][1], 2);
    assert_int_equal(counts_of(&d).polygons_csg, 5 + 4 + 5 + 6); // outside, the rim, the hole, the post
    draft_free(&d);
}

static void test_a_block_in_a_room_stands_free(void **state)
{
    (void)state;
    static const int32_t corners[3][2][3] = {{{0, 0, 0}, {32, 32, 32}}, {{4, 4, 4}, {28, 28, 28}}, {{10, 10, 10}, {12, 12, 12}}};
    scene_draft d = draft_make();
    for (uint32_t b = 0; b < 3; ++b) draft_box(&d, b == 1 ? BRUSH_SUBTRACT : BRUSH_ADD, corners[b][0], corners[b][1], b);
    assert_int_equal(counts_of(&d).polygons_csg, 18);
    draft_free(&d);
}

// ---- Slanted bodies ----

enum { BODIES = 5, PLANES = 9 };

typedef struct body { cull_wide_plane planes[PLANES]; brush_kind kind; } body;

static body random_body(uint64_t *seed)
{
    body b = {.kind = random_below(seed, 3) ? BRUSH_ADD : BRUSH_SUBTRACT};
    int64_t middle[3];
    for (int k = 0; k < 3; ++k) {
        middle[k] = (int64_t)random_below(seed, 60) * 64;
        const int64_t half = 64 * (4 + (int64_t)random_below(seed, 24));
        b.planes[2 * k] = plane_of(k == 0, k == 1, k == 2, -(middle[k] + half));
        b.planes[2 * k + 1] = plane_of(-(k == 0), -(k == 1), -(k == 2), middle[k] - half);
    }
    for (int i = 6; i < PLANES; ++i) {
        int64_t n[3], along = 0;
        for (int k = 0; k < 3; ++k) {
            n[k] = (int64_t)random_below(seed, 19) - 9;
            along += n[k] * middle[k];
        }
        if (!n[0] && !n[1] && !n[2]) n[0] = 1;
        b.planes[i] = plane_of(n[0], n[1], n[2], -along - (int64_t)random_below(seed, 9000) - 500);
    }
    return b;
}

static void volume_of(scene_draft *d, mpq_t out)
{
    const compile_input in = draft_input(d);
    csg_counts counts;
    compile_mesh *m = surface_of(&in, &counts);
    mpq_t area[3];
    for (int k = 0; k < 3; ++k) mpq_init(area[k]);
    mesh_measures(&in, m, out, area);
    for (int k = 0; k < 3; ++k) {
        assert_int_equal(mpq_sgn(area[k]), 0);
        mpq_clear(area[k]);
    }
    compile_mesh_free(m);
}

// The bodies of `set` have in common one body with all their planes.
static void common_volume(const body *bodies, unsigned set, mpq_t out)
{
    scene_draft d = draft_make();
    draft_brush(&d, BRUSH_ADD, BRUSH_STRUCTURE, 0);
    for (int b = 0; b < BODIES; ++b)
        for (int p = 0; (set >> b & 1) && p < PLANES; ++p) draft_plane(&d, &bodies[b].planes[p]);
    volume_of(&d, out);
    draft_free(&d);
}

// What an add keeps: itself less what later bodies cover, by inclusion and exclusion.
static void expected_volume(const body *bodies, mpq_t out)
{
    mpq_t part;
    mpq_init(part);
    mpq_set_ui(out, 0, 1);
    for (unsigned set = 1; set < 1u << BODIES; ++set) {
        int first = 0;
        unsigned others = 0;
        while (!(set >> first & 1)) ++first;
        for (int b = first + 1; b < BODIES; ++b) others += set >> b & 1u;
        if (bodies[first].kind == BRUSH_SUBTRACT) continue;
        common_volume(bodies, set, part);
        if (others & 1) mpq_sub(out, out, part);
        else mpq_add(out, out, part);
    }
    mpq_clear(part);
}

static void test_volumes_of_slanted_bodies_equal_inclusion_and_exclusion(void **state)
{
    (void)state;
    uint64_t seed = 3;
    mpq_t got, expected;
    mpq_init(got);
    mpq_init(expected);
    for (int round = 0; round < 60; ++round) {
        body bodies[BODIES];
        scene_draft d = draft_make();
        for (int b = 0; b < BODIES; ++b) {
            bodies[b] = random_body(&seed);
            draft_brush(&d, bodies[b].kind, BRUSH_STRUCTURE, 0);
            for (int p = 0; p < PLANES; ++p) draft_plane(&d, &bodies[b].planes[p]);
        }
        volume_of(&d, got);
        expected_volume(bodies, expected);
        assert_true(mpq_equal(got, expected));
        draft_free(&d);
    }
    mpq_clear(got);
    mpq_clear(expected);
}

// ---- Liquids and faces without a material ----

static void add_water(scene_draft *d, const int32_t min[3], const int32_t max[3])
{
    draft_box(d, BRUSH_ADD, min, max, 3);
    ((compile_brush *)d->brushes.items)[d->brushes.count - 1].role = BRUSH_LIQUID;
}

static void test_liquids_keep_only_what_is_in_the_open_and_cut_nothing(void **state)
{
    (void)state;
    static const int32_t out[2][3] = {{0, 0, 0}, {32, 32, 32}}, room[2][3] = {{4, 4, 4}, {28, 28, 28}};
    static const int32_t left[2][3] = {{4, 4, 4}, {16, 12, 28}}, right[2][3] = {{16, 4, 4}, {30, 12, 28}};
    scene_draft d = draft_make();
    draft_box(&d, BRUSH_ADD, out[0], out[1], 0);
    draft_box(&d, BRUSH_SUBTRACT, room[0], room[1], 1);
    add_water(&d, left[0], left[1]);
    add_water(&d, right[0], right[1]); // reaches into the wall
    const compile_input in = draft_input(&d);
    csg_counts counts;
    compile_mesh *m = surface_of(&in, &counts);
    uint32_t water = 0, between = 0, solid = 0;
    for (uint32_t p = 0; p < m->polygon_count; ++p) {
        const int liquid = in.brushes[m->polygons[p].brush].role == BRUSH_LIQUID;
        const cull_wide_plane plane = plane_table_get(in.planes, m->polygons[p].plane);
        water += liquid && plane.normal[1] == 1;
        between += liquid && plane.normal[0] != 0;
        if (liquid) assert_true(plane.normal[1] == 1 || plane.normal[0] != 0);
        else ++solid;
    }
    assert_int_equal(water, 1);   // the two tops, merged
    assert_int_equal(between, 1); // where they meet: one of the two faces
    assert_int_equal(solid, 12);
    compile_mesh_free(m);
    draft_free(&d);
}

static void test_a_face_without_a_material_still_closes_its_brush(void **state)
{
    (void)state;
    static const int32_t low[3] = {0, 0, 0}, high[3] = {8, 8, 8};
    scene_draft d = draft_make();
    draft_box(&d, BRUSH_ADD, low, high, 0);
    ((compile_face *)d.faces.items)[2].material = COMPILE_NOTHING;
    draft_box(&d, BRUSH_ADD, low, high, COMPILE_NOTHING); // all of it: makes nothing
    const compile_input in = draft_input(&d);
    csg_counts counts;
    compile_mesh *m = surface_of(&in, &counts);
    uint32_t nothing = 0;
    for (uint32_t p = 0; p < m->polygon_count; ++p) nothing += m->polygons[p].material == COMPILE_NOTHING;
    assert_int_equal(m->polygon_count, 6);
    assert_int_equal(nothing, 1);
    compile_mesh_free(m);
    draft_free(&d);
}

static void test_empty_input_makes_an_empty_surface(void **state)
{
    (void)state;
    scene_draft d = draft_make();
    const csg_counts c = counts_of(&d);
    assert_int_equal(c.polygons_in + c.polygons_csg + c.polygons_merged, 0);
    draft_free(&d);
}

static void test_an_open_brush_is_refused(void **state)
{
    (void)state;
    scene_draft d = draft_make();
    draft_brush(&d, BRUSH_ADD, BRUSH_STRUCTURE, 0);
    const cull_wide_plane sides[4] = {plane_of(1, 0, 0, -10), plane_of(0, 1, 0, -10), plane_of(-1, 0, 0, 0), plane_of(0, -1, 0, 0)};
    for (int i = 0; i < 4; ++i) draft_plane(&d, &sides[i]);
    const compile_input in = draft_input(&d);
    report quiet = {0};
    csg_counts counts;
    compile_mesh *m = NULL;
    assert_int_equal(compile_csg(&in, &quiet, allocator_heap(), &m, &counts), RESULT_BAD_INPUT);
    assert_null(m);
    assert_int_equal(quiet.errors, 1);
    draft_free(&d);
}

// ---- Relations ----

typedef struct whole_box { int32_t at[2][3]; } whole_box;

static brush_relation relation_of_boxes(const whole_box *p, const whole_box *q)
{
    int touching = 0, contains = 1, inside = 1;
    for (int k = 0; k < 3; ++k) {
        const int32_t a_low = p->at[0][k], a_high = p->at[1][k], b_low = q->at[0][k], b_high = q->at[1][k];
        if (a_high < b_low || b_high < a_low) return RELATION_APART;
        touching |= a_high == b_low || b_high == a_low;
        contains &= a_low <= b_low && b_high <= a_high;
        inside &= b_low <= a_low && a_high <= b_high;
    }
    return touching ? RELATION_TOUCHING : contains ? RELATION_CONTAINS : inside ? RELATION_INSIDE : RELATION_CROSSING;
}

static void test_relations_of_boxes_are_those_of_their_intervals(void **state)
{
    (void)state;
    enum { BOXES = 120 };
    whole_box boxes[BOXES];
    uint64_t seed = 8;
    scene_draft d = draft_make();
    for (int b = 0; b < BOXES; ++b) {
        for (int k = 0; k < 3; ++k) {
            boxes[b].at[0][k] = (int32_t)random_below(&seed, 20);
            boxes[b].at[1][k] = boxes[b].at[0][k] + 1 + (int32_t)random_below(&seed, 8);
        }
        draft_box(&d, BRUSH_ADD, boxes[b].at[0], boxes[b].at[1], 0);
    }
    const compile_input in = draft_input(&d);
    report quiet = {0};
    brush_bodies bodies;
    relation_table table;
    assert_int_equal(brush_bodies_make(&in, 1u << BRUSH_STRUCTURE, &quiet, allocator_heap(), &bodies), RESULT_OK);
    assert_int_equal(relation_table_make(in.planes, &bodies, allocator_heap(), &table), RESULT_OK);
    uint32_t at = 0;
    for (uint32_t a = 0; a < BOXES; ++a) {
        assert_int_equal(table.first_of[a], at);
        for (uint32_t b = a + 1; b < BOXES; ++b) {
            const brush_relation expected = relation_of_boxes(&boxes[a], &boxes[b]);
            if (expected == RELATION_APART) continue;
            assert_true(at < table.pair_count && table.pairs[at].a == a && table.pairs[at].b == b);
            assert_int_equal(table.pairs[at++].relation, expected);
        }
    }
    assert_int_equal(at, table.pair_count);
    assert_int_equal(table.first_of[BOXES], at);
    relation_table_free(&table, &bodies, allocator_heap());
    brush_bodies_free(&bodies);
    draft_free(&d);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_no_order_of_a_bodys_planes_makes_a_split_that_is_not_needed),
        cmocka_unit_test(test_boxes_that_share_an_edge_keep_all_four_polygons_on_it),
        cmocka_unit_test(test_touching_faces_vanish_and_the_rest_merges),
        cmocka_unit_test(test_of_equal_boxes_one_remains),
        cmocka_unit_test(test_a_subtract_that_only_touches_changes_nothing),
        cmocka_unit_test(test_a_split_whose_parts_all_stay_is_taken_back),
        cmocka_unit_test(test_a_block_in_a_room_stands_free),
        cmocka_unit_test(test_volumes_of_slanted_bodies_equal_inclusion_and_exclusion),
        cmocka_unit_test(test_liquids_keep_only_what_is_in_the_open_and_cut_nothing),
        cmocka_unit_test(test_a_face_without_a_material_still_closes_its_brush),
        cmocka_unit_test(test_empty_input_makes_an_empty_surface),
        cmocka_unit_test(test_an_open_brush_is_refused),
        cmocka_unit_test(test_relations_of_boxes_are_those_of_their_intervals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
