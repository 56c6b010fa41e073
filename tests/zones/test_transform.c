// Tests of the builder's transform: everything goes through it, and nothing changes without one.
// SPDX-License-Identifier: MIT
#include "zone_scene.h"

#include "tests/common/test.h"

#include <math.h>
#include <string.h>

// One of everything: item, wall, mover on a path, door, place, solid, zones, portal, light, cameras.
static void add_everything(builder_fixture *f)
{
    scene_builder *b = f->builder;
    const double wall[4][3] = {{0.3, 0, 0}, {0.3, 2, 0.1}, {0.3, 2, 2}, {0.3, 0, 2}}, at[3] = {1.1, 0.2, 0.7}, offset[3] = {0, 2, 0};
    builder_fixture_triangle(f, at, 2);
    assert_int_equal(add_wall(b, wall), RESULT_OK);
    const builder_vertex v[3] = {{.position = {1, 1, 1}, .normal = {0, 0, 1}}, {.position = {2, 1, 1}}, {.position = {1, 2, 1}}};
    uint32_t first, id;
    assert_int_equal(scene_builder_vertices(b, v, 3, 0, &first), RESULT_OK);
    const uint32_t indices[3] = {first, first + 1, first + 2};
    const builder_item leaf = {.indices = indices, .index_count = 3, .polygon_count = 1};
    assert_int_equal(scene_builder_mover(b, "leaf", offset, &leaf), RESULT_OK);
    static const double pivot[3] = {1, 1, 1};
    static const scene_key keys[2] = {{.time_s = 0}, {.time_s = 2, .offset = {1, 2, 3}, .turn_deg = {0, 90, 0}}};
    const builder_path path = {.keys = keys, .key_count = 2, .pivot = pivot};
    assert_int_equal(scene_builder_mover_path(b, 0, &path), RESULT_OK);
    assert_int_equal(scene_builder_door(b, "door", DOORS_SHUT, 0, &id), RESULT_OK);
    const scene_place place = {{1, 2, 3}, PLACE_PLAYER};
    assert_int_equal(scene_builder_place(b, &place), RESULT_OK);
    scene_solid_plane planes[6];
    const zone_box body = {{0, 0, 0}, {1, 2, 3}}, west = {{0, 0, 0}, {4, 4, 4}}, east = {{4, 0, 0}, {8, 4, 4}};
    box_planes(&body, planes);
    assert_int_equal(scene_builder_solid(b, SOLID_STRUCTURE, planes, 6, body.min, body.max), RESULT_OK);
    door_hole hole = {4, {1, 1}, {2, 2}, {0, 0}};
    const char *fault;
    assert_int_equal(add_box_zone(b, "west", &west, SCENE_NONE, &hole.zones[0]), RESULT_OK);
    assert_int_equal(add_box_zone(b, "east", &east, SCENE_NONE, &hole.zones[1]), RESULT_OK);
    assert_int_equal(add_hole(b, &hole, &id, &fault), RESULT_OK);
    const scene_light light = {.name = "sun", .kind = LIGHT_SUN, .position = {1, 2, 3}, .direction = {0, 1, 0}, .reach = 5, .colour = {1, 1, 1}};
    assert_int_equal(scene_builder_light(b, &light), RESULT_OK);
    const camera eye = {.eye = {1, 2, 3}, .forward = {1, 0, 0}, .up = {0, 1, 0}, .fovy_deg = 60, .aspect = 1, .near_m = 0.25, .far_m = INFINITY};
    assert_int_equal(scene_builder_camera_path(b, "walk", &eye, 1), RESULT_OK);
}

static void the_identity_changes_no_bit(void **state)
{
    builder_fixture *f = *state;
    static const builder_transform identity = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}}, other = {{{0, 0, 3, 5}, {3, 0, 0, 6}, {0, 3, 0, 7}}};
    scene_solid_plane planes[2][64];
    cull_vec3 positions[2][64];
    uint64_t hashes[2];
    for (int i = 0; i < 2; ++i) {
        builder_fixture_restart(f);
        if (i) assert_int_equal(scene_builder_transform(f->builder, &other), RESULT_OK); // each replaces the one before
        if (i) assert_int_equal(scene_builder_transform(f->builder, &identity), RESULT_OK);
        add_everything(f);
        assert_int_equal(builder_fixture_finish(f), RESULT_OK);
        hashes[i] = f->scene->hash;
        memcpy(planes[i], f->scene->hull_planes, f->scene->hull_plane_count * sizeof **planes);
        memcpy(positions[i], f->scene->positions, f->scene->position_count * sizeof **positions);
        assert_memory_equal(planes[i], planes[0], f->scene->hull_plane_count * sizeof **planes);
        assert_memory_equal(positions[i], positions[0], f->scene->position_count * sizeof **positions);
    }
    assert_true(hashes[0] == hashes[1]);
}

// A quarter about y, twice as large, and moved: exact in double. (x, y, z) -> 2 (z, y, -x) + (10, 20, 30)
static const builder_transform quarter = {{{0, 0, 2, 10}, {0, 2, 0, 20}, {-2, 0, 0, 30}}};
static void assert_is(const double got[3], double x, double y, double z)
{
    assert_true(got[0] == x && got[1] == y && got[2] == z);
}

static void everything_that_comes_in_is_turned_scaled_and_moved(void **state)
{
    builder_fixture *f = *state;
    assert_int_equal(scene_builder_transform(f->builder, &quarter), RESULT_OK);
    add_everything(f);
    scene_builder_transform_end(f->builder);
    const double at[3] = {10, 20, 30};
    builder_fixture_triangle(f, at, 1); // no longer
    assert_int_equal(builder_fixture_finish(f), RESULT_OK);
    const scene *s = f->scene;
    assert_is(s->places[0].position, 16, 24, 28);
    assert_is(s->movers[0].open_offset, 0, 4, 0);
    assert_is(s->movers[0].pivot, 12, 22, 28);
    assert_is(s->keys[1].offset, 6, 4, -2);
    assert_is(s->lights[0].position, 16, 24, 28);
    assert_is(s->lights[0].direction, 0, 1, 0);
    assert_true(s->lights[0].reach == 10);
    assert_is(s->cameras[0].eye, 16, 24, 28);
    assert_is(s->cameras[0].forward, 0, 0, -1);
    assert_true(s->cameras[0].near_m == 0.5 && isinf(s->cameras[0].far_m));
    assert_is(s->solids[0].min, 10, 20, 28);
    assert_is(s->solids[0].max, 16, 24, 30);
    assert_is(s->hulls[0].min, 10, 20, 22);
    assert_is(s->hulls[1].min, 10, 20, 14);
    assert_is(s->portals[0].plane, 0, 0, 1); // into the west: against x, now along z
    assert_true(s->portals[0].plane[3] == -22);
    for (uint32_t i = 0; i < 4; ++i) assert_true(s->portal_points[i][2] == 22 && s->portal_points[i][1] >= 22 && s->portal_points[i][1] <= 24);
    assert_true((double)s->positions[s->position_count - 3].x + s->whole.origin[0] == 10); // the one behind the end
    assert_int_equal(s->normals[7] & 0xff, 127); // the leaf's, (0, 0, 1) -> (1, 0, 0)
    const cull_wall *wall = &s->walls[1];
    for (uint32_t i = 0; i < wall->vertex_count; ++i) {
        const cull_vec3 p = s->positions[s->wall_vertices[wall->first_vertex + i]];
        const cull_plane q = s->planes[wall->plane];
        assert_true(fabs((double)q.normal.x * (double)p.x + (double)q.normal.y * (double)p.y + (double)q.normal.z * (double)p.z + (double)q.offset) <
                    1e-5);
    }
}

static void a_path_turns_about_the_axes_of_its_include(void **state)
{
    builder_fixture *f = *state;
    assert_int_equal(scene_builder_transform(f->builder, &quarter), RESULT_OK);
    const double at[3] = {0, 0, 0}, offset[3] = {0, 0, 0};
    builder_fixture_triangle(f, at, 1);
    const uint32_t indices[3] = {0, 1, 2};
    const builder_item item = {.indices = indices, .index_count = 3, .polygon_count = 1};
    assert_int_equal(scene_builder_mover(f->builder, "wheel", offset, &item), RESULT_OK);
    static const scene_key key = {.turn_deg = {90, 0, 0}}; // about x: (x, y, z) -> (x, -z, y)
    static const double pivot[3] = {0, 0, 0};
    const builder_path path = {.keys = &key, .key_count = 1, .pivot = pivot};
    assert_int_equal(scene_builder_mover_path(f->builder, 0, &path), RESULT_OK);
    assert_int_equal(builder_fixture_finish(f), RESULT_OK);
    scene_pose pose;
    scene_pose_at(f->scene, 0, 0, DOORS_OPEN, &pose);
    // x of the file is -z of the world: (a, b, c) of the world is (-c, b, a) of the file, turned (-c, -a, b), back (b, -a, c)
    static const double expected[9] = {0, 1, 0, -1, 0, 0, 0, 0, 1};
    for (int i = 0; i < 9; ++i) assert_true(pose.rotation[i] == expected[i]);
    assert_is(pose.pivot, 10, 20, 30);
}

static void what_is_no_turn_with_one_scale_is_refused_and_the_one_before_stays(void **state)
{
    builder_fixture *f = *state;
    static const builder_transform bad[] = {
        {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, -1, 0}}},          // a mirror
        {{{-2, 0, 0, 0}, {0, -2, 0, 0}, {0, 0, -2, 0}}},        // one too
        {{{1, 0, 0, 0}, {0, 2, 0, 0}, {0, 0, 1, 0}}},           // two scales
        {{{1, 1e-6, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}},        // a shear
        {{{0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}}},           // nothing left
        {{{1, 0, 0, NAN}, {0, 1, 0, 0}, {0, 0, 1, 0}}},         //
        {{{1, 0, 0, INFINITY}, {0, 1, 0, 0}, {0, 0, 1, 0}}},    //
        {{{NAN, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}},         //
        {{{1e200, 0, 0, 0}, {0, 1e200, 0, 0}, {0, 0, 1e200, 0}}}, // its squares are no number
        {{{1, 0, 0, 0}, {1, 0, 0, 0}, {0, 0, 1, 0}}},           // flat
    };
    assert_int_equal(scene_builder_transform(f->builder, &quarter), RESULT_OK);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i) assert_int_equal(scene_builder_transform(f->builder, &bad[i]), RESULT_BAD_INPUT);
    const scene_place place = {{1, 2, 3}, PLACE_OTHER};
    assert_int_equal(scene_builder_place(f->builder, &place), RESULT_OK);
    const double at[3] = {0, 0, 0};
    builder_fixture_triangle(f, at, 1);
    assert_int_equal(builder_fixture_finish(f), RESULT_OK);
    assert_is(f->scene->places[0].position, 16, 24, 28);
}

static void vertices_that_leave_the_numbers_on_the_way_are_refused(void **state)
{
    builder_fixture *f = *state;
    static const builder_transform large = {{{1e150, 0, 0, 0}, {0, 1e150, 0, 0}, {0, 0, 1e150, 0}}};
    assert_int_equal(scene_builder_transform(f->builder, &large), RESULT_OK);
    const builder_vertex v = {.position = {1e200, 0, 0}};
    uint32_t first;
    assert_int_equal(scene_builder_vertices(f->builder, &v, 1, 0, &first), RESULT_BAD_INPUT);
}

static void an_item_that_is_its_box_stays_one_by_quarters_alone(void **state)
{
    builder_fixture *f = *state;
    static const builder_transform turned = {{{0.8, 0, 0.6, 0}, {0, 1, 0, 0}, {-0.6, 0, 0.8, 0}}};
    static const builder_transform *const transforms[] = {NULL, &quarter, &turned};
    for (int i = 0; i < 3; ++i) {
        builder_fixture_restart(f);
        if (transforms[i]) assert_int_equal(scene_builder_transform(f->builder, transforms[i]), RESULT_OK);
        const uint32_t first = builder_fixture_vertex(f, 0, 0, 0), indices[3] = {first, builder_fixture_vertex(f, 1, 0, 0), builder_fixture_vertex(f, 0, 1, 1)};
        const builder_item box = {.indices = indices, .index_count = 3, .polygon_count = 1, .flags = CULL_ITEM_BOX};
        assert_int_equal(scene_builder_item(f->builder, &box), RESULT_OK);
        assert_int_equal(builder_fixture_finish(f), RESULT_OK);
        assert_int_equal((f->scene->items[0].flags & CULL_ITEM_BOX) != 0, i < 2);
    }
}

int main(void)
{
#define TEST(t) cmocka_unit_test_setup_teardown(t, builder_fixture_set_up, builder_fixture_tear_down)
    const struct CMUnitTest tests[] = {
        TEST(the_identity_changes_no_bit),
        TEST(everything_that_comes_in_is_turned_scaled_and_moved),
        TEST(a_path_turns_about_the_axes_of_its_include),
        TEST(what_is_no_turn_with_one_scale_is_refused_and_the_one_before_stays),
        TEST(an_item_that_is_its_box_stays_one_by_quarters_alone),
        TEST(vertices_that_leave_the_numbers_on_the_way_are_refused),
    };
    return cmocka_run_group_tests_name("zones transform", tests, NULL, NULL);
}
