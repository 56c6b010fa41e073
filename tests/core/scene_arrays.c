// Tests of the finished scene's arrays: places, planes, movers, objects, materials, boxes.
// SPDX-License-Identifier: MIT
#include "box_scene.h"
#include "builder_fixture.h"
#include "tests/common/test.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// A unit square wall at z = at[2], facing +z or -z, its plane as an importer would compute it.
static void add_wall(builder_fixture *f, const double at[3], double facing)
{
    const uint32_t first = builder_fixture_vertex(f, at[0], at[1], at[2]);
    builder_fixture_vertex(f, at[0] + 1, at[1], at[2]);
    builder_fixture_vertex(f, at[0] + 1, at[1] + 1, at[2]);
    builder_fixture_vertex(f, at[0], at[1] + 1, at[2]);
    const uint32_t loops[2][4] = {{first, first + 1, first + 2, first + 3}, {first + 3, first + 2, first + 1, first}};
    const uint32_t *l = loops[facing < 0], indices[6] = {l[0], l[1], l[2], l[0], l[2], l[3]}, two = 2;
    const builder_item item = {.indices = indices, .polygon_triangles = &two, .loop = l, .index_count = 6, .polygon_count = 1, .loop_count = 4,
                               .flags = CULL_ITEM_WALL, .plane = {0, 0, facing, -facing * at[2]}};
    assert_int_equal(scene_builder_item(f->builder, &item), RESULT_OK);
}

static void coplanar_walls_facing_one_way_share_a_plane(void **state)
{
    builder_fixture *f = *state;
    static const double walls[][4] = {{0, 0, 3, 1}, {5, 2, 3, 1}, {-9, 0, 3, 1}, {0, 0, 3, -1}, {4, 4, 3, -1}, {0, 0, 3.25, 1}, {0, 0, -3, 1}};
    static const uint32_t plane[] = {0, 0, 0, 1, 1, 2, 3};
    enum { WALLS = sizeof walls / sizeof *walls };
    const double moves[] = {0, 85000, -446001};
    for (int m = 0; m < 3; ++m) {
        builder_fixture_restart(f);
        for (int i = 0; i < WALLS; ++i) {
            const double at[3] = {walls[i][0] + moves[m], walls[i][1], walls[i][2] + moves[m]};
            add_wall(f, at, walls[i][3]);
        }
        assert_int_equal(builder_fixture_finish(f), RESULT_OK);
        const scene *s = f->scene;
        assert_int_equal(s->plane_count, 4);
        for (uint32_t i = 0; i < WALLS; ++i) {
            assert_int_equal(s->walls[i].plane, plane[i]);
            assert_int_equal(s->walls[i].vertex_count, 4);
            for (uint32_t v = 0; v < 4; ++v) { // every corner lies on the wall's plane, which is relative to the origin
                const cull_plane p = s->planes[plane[i]];
                const cull_vec3 at = s->positions[s->wall_vertices[s->walls[i].first_vertex + v]];
                assert_true(p.normal.x * at.x + p.normal.y * at.y + p.normal.z * at.z + p.offset == 0);
            }
        }
    }
}

static void an_item_that_is_no_wall_has_an_empty_wall_beside_those_that_are(void **state)
{
    builder_fixture *f = *state;
    const double at[3] = {0, 0, 0};
    builder_fixture_triangle(f, at, 1);
    assert_int_equal(builder_fixture_finish(f), RESULT_OK);
    assert_null(f->scene->walls);
    scene_free(f->scene, &f->memory.memory);
    f->scene = NULL;
    add_wall(f, at, 1);
    assert_int_equal(builder_fixture_finish(f), RESULT_OK);
    assert_int_equal(f->scene->walls[0].vertex_count, 0);
    assert_int_equal(f->scene->walls[1].vertex_count, 4);
}

// Item i, in the order of adding, is a box whose low corner is at x = 10 i.
static void add_numbered(builder_fixture *f, uint32_t number, const char *name)
{
    const double min[3] = {10.0 * number, 0, 0}, max[3] = {10.0 * number + 1, 2, 3};
    assert_int_equal(box_scene_add(f->builder, min, max, name), RESULT_OK);
}

static void assert_item_is_number(const scene *s, uint32_t item, uint32_t number)
{
    const float low = (float)(10.0 * number - s->whole.origin[0]);
    assert_true(s->boxes.min_x[item] == low && s->boxes.max_x[item] == low + 1);
    assert_true(s->boxes.max_y[item] - s->boxes.min_y[item] == 2 && s->boxes.max_z[item] - s->boxes.min_z[item] == 3);
}

static void movers_stand_behind_all_items_and_each_keeps_its_own_order(void **state)
{
    builder_fixture *f = *state;
    add_numbered(f, 0, "north");
    add_numbered(f, 1, NULL);
    add_numbered(f, 2, NULL);
    add_numbered(f, 3, "south");
    add_numbered(f, 4, NULL);
    assert_int_equal(builder_fixture_finish(f), RESULT_OK);
    const scene *s = f->scene;
    static const uint32_t numbers[] = {1, 2, 4, 0, 3};
    assert_int_equal(s->item_count, 3);
    assert_int_equal(s->mover_count, 2);
    assert_string_equal(s->movers[0].name, "north");
    assert_string_equal(s->movers[1].name, "south");
    uint32_t index = 0, polygon = 0;
    for (uint32_t i = 0; i < 5; ++i) {
        assert_item_is_number(s, i, numbers[i]);
        assert_int_equal(s->items[i].first_index, index); // ascending, without gaps, over movers too
        assert_int_equal(s->items[i].first_polygon, polygon);
        index += s->items[i].index_count;
        polygon += s->items[i].polygon_count;
    }
    assert_int_equal(index, s->index_count);
    assert_int_equal(polygon, s->polygon_count);
    for (uint32_t p = 0; p <= polygon; ++p) assert_int_equal(s->polygon_first_triangle[p], 2 * p);
}

static void a_scene_of_movers_alone_has_no_items(void **state)
{
    builder_fixture *f = *state;
    add_numbered(f, 0, "door");
    assert_int_equal(builder_fixture_finish(f), RESULT_OK);
    assert_int_equal(f->scene->item_count, 0);
    assert_int_equal(f->scene->mover_count, 1);
    assert_item_is_number(f->scene, 0, 0);
}

static void add_of_object(builder_fixture *f, uint32_t object)
{
    const uint32_t indices[3] = {builder_fixture_vertex(f, 0, 0, 0), builder_fixture_vertex(f, 1, 0, 0), builder_fixture_vertex(f, 0, 1, 0)};
    const builder_item item = {.indices = indices, .index_count = 3, .polygon_count = 1, .object = object};
    assert_int_equal(scene_builder_item(f->builder, &item), RESULT_OK);
}

static void an_object_s_range_holds_its_items_and_an_empty_one_none(void **state)
{
    builder_fixture *f = *state;
    uint32_t empty, roof;
    assert_int_equal(scene_builder_object(f->builder, "empty", 5, &empty), RESULT_OK);
    assert_int_equal(scene_builder_object(f->builder, "world", 5, &roof), RESULT_OK); // the same name: another object
    assert_true(roof != 0 && roof != empty);
    add_of_object(f, 0);
    add_of_object(f, 0);
    add_of_object(f, roof);
    add_of_object(f, roof);
    add_of_object(f, roof);
    assert_int_equal(builder_fixture_finish(f), RESULT_OK);
    const scene_object *o = f->scene->objects;
    assert_int_equal(f->scene->object_count, 3);
    assert_true(o[0].first_item == 0 && o[0].item_count == 2);
    assert_true(o[empty].item_count == 0);
    assert_true(o[roof].first_item == 2 && o[roof].item_count == 3);
    assert_string_equal(o[empty].name, "empty");
}

static void materials_are_found_again_by_name(void **state)
{
    builder_fixture *f = *state;
    enum { MATERIALS = 3000 };
    char name[16];
    uint32_t id;
    for (int round = 0; round < 2; ++round)
        for (uint32_t i = 0; i < MATERIALS; ++i) {
            const int length = snprintf(name, sizeof name, "m%u", i);
            assert_int_equal(scene_builder_material(f->builder, name, (size_t)length, 0, &id), RESULT_OK);
            assert_int_equal(id, i + 1);
        }
    assert_int_equal(scene_builder_material(f->builder, "stone and more", 5, 0, &id), RESULT_OK); // length, not the zero, ends it
    assert_int_equal(id, 0);
}

static void the_65536th_material_is_refused(void **state)
{
    builder_fixture *f = *state;
    char name[16];
    uint32_t id;
    for (uint32_t i = 1; i < 65535; ++i) {
        const int length = snprintf(name, sizeof name, "m%u", i);
        assert_int_equal(scene_builder_material(f->builder, name, (size_t)length, 0, &id), RESULT_OK);
    }
    assert_int_equal(scene_builder_material(f->builder, "one more", 8, 0, &id), RESULT_BAD_INPUT);
    assert_int_equal(scene_builder_material(f->builder, "stone", 5, 0, &id), RESULT_OK);
    assert_int_equal(id, 0);
}

static uint32_t flags_with(builder_fixture *f, uint32_t material_flags)
{
    builder_fixture_restart(f);
    uint32_t material, first;
    assert_int_equal(scene_builder_material(f->builder, "other", 5, material_flags, &material), RESULT_OK);
    const builder_vertex v[3] = {{.position = {0, 0, 0}}, {.position = {1, 0, 0}}, {.position = {0, 1, 0}}};
    assert_int_equal(scene_builder_vertices(f->builder, v, 3, material, &first), RESULT_OK);
    const uint32_t indices[3] = {first, first + 1, first + 2};
    const builder_item item = {.indices = indices, .index_count = 3, .polygon_count = 1, .material = material};
    assert_int_equal(scene_builder_item(f->builder, &item), RESULT_OK);
    assert_int_equal(builder_fixture_finish(f), RESULT_OK);
    return f->scene->items[0].flags;
}

static void item_flags_follow_from_the_material(void **state)
{
    builder_fixture *f = *state;
    assert_int_equal(flags_with(f, 0), 0);
    assert_null(f->scene->texcoords);
    assert_int_equal(flags_with(f, MATERIAL_TRANSLUCENT), CULL_ITEM_SEE_THROUGH | CULL_ITEM_TWO_SIDED);
    assert_int_equal(flags_with(f, MATERIAL_CUT_OUT), CULL_ITEM_CUT_OUT | CULL_ITEM_TWO_SIDED);
    assert_non_null(f->scene->texcoords);
}

static void boxes_are_padded_and_the_zone_s_box_covers_them_all(void **state)
{
    builder_fixture *f = *state;
    const box_scene boxes = {.items = 37, .movers = 4, .seed = 5};
    assert_int_equal(box_scene_make(&boxes, &f->memory.memory, &f->lines.report, &f->scene), RESULT_OK);
    const scene *s = f->scene;
    const float *axes[6] = {s->boxes.min_x, s->boxes.min_y, s->boxes.min_z, s->boxes.max_x, s->boxes.max_y, s->boxes.max_z};
    const float zone[6] = {s->whole.box.min.x, s->whole.box.min.y, s->whole.box.min.z, s->whole.box.max.x, s->whole.box.max.y, s->whole.box.max.z};
    for (int k = 0; k < 6; ++k) {
        float most = -INFINITY;
        const float sign = k < 3 ? -1 : 1;
        for (uint32_t i = 0; i < 41; ++i) most = fmaxf(most, sign * axes[k][i]);
        assert_true(most == sign * zone[k]);
        for (uint32_t i = 41; i < 41 + CULL_PADDING; ++i) assert_true(isfinite(axes[k][i]));
        assert_int_equal((uintptr_t)axes[k] % 64, 0);
    }
}

static void different_geometry_has_another_hash(void **state)
{
    builder_fixture *f = *state;
    uint64_t hashes[3];
    for (uint64_t i = 0; i < 3; ++i) {
        builder_fixture_restart(f);
        const box_scene boxes = {.items = 20, .movers = i == 2, .seed = i == 1}; // another place; one item more, a mover
        assert_int_equal(box_scene_make(&boxes, &f->memory.memory, &f->lines.report, &f->scene), RESULT_OK);
        hashes[i] = f->scene->hash;
    }
    assert_true(hashes[0] != hashes[1] && hashes[0] != hashes[2] && hashes[1] != hashes[2]);
}

int main(void)
{
#define TEST(t) cmocka_unit_test_setup_teardown(t, builder_fixture_set_up, builder_fixture_tear_down)
    const struct CMUnitTest tests[] = {
        TEST(coplanar_walls_facing_one_way_share_a_plane),
        TEST(an_item_that_is_no_wall_has_an_empty_wall_beside_those_that_are),
        TEST(movers_stand_behind_all_items_and_each_keeps_its_own_order),
        TEST(a_scene_of_movers_alone_has_no_items),
        TEST(an_object_s_range_holds_its_items_and_an_empty_one_none),
        TEST(materials_are_found_again_by_name),
        TEST(the_65536th_material_is_refused),
        TEST(item_flags_follow_from_the_material),
        TEST(boxes_are_padded_and_the_zone_s_box_covers_them_all),
        TEST(different_geometry_has_another_hash),
    };
    return cmocka_run_group_tests_name("core scene arrays", tests, NULL, NULL);
}
