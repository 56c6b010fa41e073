// Tests of where movers are: keys, loops, doors, turns, and boxes that hold every vertex.
// SPDX-License-Identifier: MIT
#include "zone_scene.h"

#include "tests/common/random.h"
#include "tests/common/test.h"

#include <math.h>
#include <string.h>

static const double STILL[3] = {0, 0, 0};

static uint32_t add_mover(builder_fixture *f, const double open_offset[3])
{
    const uint32_t first = builder_fixture_vertex(f, 1, 2, 3);
    builder_fixture_vertex(f, 2, 2.3, 3);
    builder_fixture_vertex(f, 1, 3, 4.1);
    const uint32_t indices[3] = {first, first + 1, first + 2};
    const builder_item item = {.indices = indices, .index_count = 3, .polygon_count = 1};
    assert_int_equal(scene_builder_mover(f->builder, "mover", open_offset, &item), RESULT_OK);
    return scene_builder_mover_count(f->builder) - 1;
}

static void assert_offset(const scene *s, double time_s, double x, double turn_cosine)
{
    scene_pose pose;
    scene_pose_at(s, 0, time_s, DOORS_OPEN, &pose);
    assert_true(pose.offset[0] == x && pose.offset[1] == 0 && pose.offset[2] == 0);
    assert_true(fabs(pose.rotation[0] - turn_cosine) < 1e-15);
}

static void add_path(builder_fixture *f, uint32_t mover, uint32_t loops)
{
    static const scene_key keys[3] = {
        {.time_s = 1, .offset = {2, 0, 0}}, {.time_s = 2, .offset = {4, 0, 0}, .turn_deg = {0, 0, 60}}, {.time_s = 5, .offset = {1, 0, 0}}};
    const builder_path path = {.keys = keys, .key_count = 3, .loops = loops};
    assert_int_equal(scene_builder_mover_path(f->builder, mover, &path), RESULT_OK);
}

static void a_path_is_straight_between_keys_and_stays_at_its_ends(void **state)
{
    builder_fixture *f = *state;
    add_path(f, add_mover(f, STILL), 0);
    assert_int_equal(builder_fixture_finish(f), RESULT_OK);
    assert_offset(f->scene, -100, 2, 1);
    assert_offset(f->scene, 1, 2, 1);
    assert_offset(f->scene, 1.5, 3, cos(30 * 0.017453292519943295));
    assert_offset(f->scene, 2, 4, cos(60 * 0.017453292519943295));
    assert_offset(f->scene, 3, 3, cos(40 * 0.017453292519943295));
    assert_offset(f->scene, 5, 1, 1);
    assert_offset(f->scene, 1e9, 1, 1);
    assert_offset(f->scene, NAN, 2, 1);
}

static void a_loop_starts_again_behind_its_last_key(void **state)
{
    builder_fixture *f = *state;
    add_path(f, add_mover(f, STILL), 1);
    assert_int_equal(builder_fixture_finish(f), RESULT_OK);
    for (int round = -3; round < 4; ++round) {
        assert_offset(f->scene, 1 + 4 * round, 2, 1);
        assert_offset(f->scene, 1.5 + 4 * round, 3, cos(30 * 0.017453292519943295));
        assert_offset(f->scene, 2 + 4 * round, 4, 0.5);
    }
}

static void paths_that_are_none_are_refused(void **state)
{
    builder_fixture *f = *state;
    const uint32_t mover = add_mover(f, STILL);
    static const scene_key falling[2] = {{.time_s = 1}, {.time_s = 0}}, equal[2] = {{.time_s = 1}, {.time_s = 1}}, late[1] = {{.time_s = INFINITY}},
                           wild[1] = {{.offset = {0, NAN, 0}}}, turned[1] = {{.turn_deg = {0, 0, NAN}}};
    static const double nowhere[3] = {0, 0, NAN};
    const builder_path bad[] = {{.keys = falling, .key_count = 2}, {.keys = equal, .key_count = 2},
                                {.keys = late, .key_count = 1},    {.keys = wild, .key_count = 1},
                                {.keys = turned, .key_count = 1},  {.keys = falling, .key_count = 1, .pivot = nowhere},
                                {.keys = falling, .key_count = 0}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i) assert_int_equal(scene_builder_mover_path(f->builder, mover, &bad[i]), RESULT_BAD_INPUT);
    const builder_path good = {.keys = falling, .key_count = 1};
    assert_int_equal(scene_builder_mover_path(f->builder, mover + 1, &good), RESULT_BAD_INPUT);
    const double infinite[3] = {0, INFINITY, 0};
    const uint32_t indices[3] = {0, 1, 2};
    const builder_item item = {.indices = indices, .index_count = 3, .polygon_count = 1};
    assert_int_equal(scene_builder_mover(f->builder, "wild", infinite, &item), RESULT_BAD_INPUT);
    assert_int_equal(builder_fixture_finish(f), RESULT_OK);
    assert_int_equal(f->scene->key_count, 0);
    assert_int_equal(f->scene->movers[mover].key_count, 0);
    assert_int_equal(f->scene->mover_count, 1);
}

static void a_door_s_mover_stands_where_its_state_says(void **state)
{
    builder_fixture *f = *state;
    static const door_state rests[] = {DOORS_OPEN, DOORS_SHUT};
    static const double up[3] = {0, 2, 0};
    for (int r = 0; r < 2; ++r) {
        builder_fixture_restart(f);
        uint32_t door, again;
        const uint32_t mover = add_mover(f, up), other = add_mover(f, up);
        assert_int_equal(scene_builder_door(f->builder, "door", rests[r], mover, &door), RESULT_OK);
        assert_int_equal(scene_builder_door(f->builder, "two", rests[r], mover, &again), RESULT_BAD_INPUT); // a mover has one door
        assert_int_equal(scene_builder_door(f->builder, "none", rests[r], 9, &again), RESULT_BAD_INPUT);
        assert_int_equal(builder_fixture_finish(f), RESULT_OK);
        const scene *s = f->scene;
        assert_int_equal(s->door_count, 1);
        assert_string_equal(s->doors[door].name, "door");
        assert_int_equal(s->movers[mover].door, door);
        assert_int_equal(s->movers[other].door, SCENE_NONE);
        for (int d = 0; d < 2; ++d) {
            scene_pose pose;
            double min[3], max[3];
            const double moved = rests[r] == rests[d] ? 0 : rests[d] == DOORS_OPEN ? 2 : -2;
            scene_pose_at(s, mover, 0, rests[d], &pose);
            assert_true(pose.offset[1] == moved);
            scene_pose_box(s, mover, &pose, min, max);
            const double low = (double)s->boxes.min_y[mover] + s->whole.origin[1], high = (double)s->boxes.max_y[mover] + s->whole.origin[1];
            assert_true(min[1] == low + moved && max[1] == high + moved); // as tight as the geometry
            scene_pose_at(s, other, 0, rests[d], &pose);
            assert_true(pose.offset[1] == 0);
        }
    }
}

// In long double, which holds the products of doubles with bits to spare.
static void assert_box_holds(const scene *s, uint32_t mover, const scene_pose *pose)
{
    double min[3], max[3];
    long double low[3] = {1e30L, 1e30L, 1e30L}, high[3] = {-1e30L, -1e30L, -1e30L};
    scene_pose_box(s, mover, pose, min, max);
    const scene_item *item = &s->items[s->item_count + mover];
    for (uint32_t i = item->first_index; i < item->first_index + item->index_count; ++i) {
        const cull_vec3 v = s->positions[s->indices[i]];
        const long double p[3] = {(long double)v.x + s->whole.origin[0] - pose->pivot[0], (long double)v.y + s->whole.origin[1] - pose->pivot[1],
                                  (long double)v.z + s->whole.origin[2] - pose->pivot[2]};
        for (int k = 0; k < 3; ++k) {
            const double *row = pose->rotation + 3 * k;
            const long double at = row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + pose->pivot[k] + pose->offset[k];
            low[k] = at < low[k] ? at : low[k];
            high[k] = at > high[k] ? at : high[k];
        }
    }
    for (int k = 0; k < 3; ++k) {
        assert_true(min[k] <= low[k] && high[k] <= max[k]);
        const long double slack = 1e-13L * (1 + fabsl(low[k]) + fabsl(high[k]) + fabs(s->whole.origin[0]) * 3 + 100);
        assert_true(low[k] - min[k] <= slack && max[k] - high[k] <= slack);
    }
}

static void a_pose_s_box_holds_every_vertex_and_hardly_more(void **state)
{
    builder_fixture *f = *state;
    uint64_t random = 1;
    static const double places[] = {0, 1e3, 1e7};
    for (int n = 0; n < 3; ++n) {
        builder_fixture_restart(f);
        const uint32_t first = builder_fixture_vertex(f, places[n], 0, 0);
        uint32_t indices[60];
        for (uint32_t i = 0; i < 60; ++i) {
            builder_fixture_vertex(f, places[n] + random_between(&random, -3, 3), random_between(&random, -3, 3), random_between(&random, -3, 3));
            indices[i] = first + 1 + i;
        }
        const builder_item item = {.indices = indices, .index_count = 60, .polygon_count = 20};
        assert_int_equal(scene_builder_mover(f->builder, "rock", STILL, &item), RESULT_OK);
        enum { KEYS = 40 };
        scene_key keys[KEYS];
        for (int i = 0; i < KEYS; ++i) {
            keys[i] = (scene_key){.time_s = i};
            for (int k = 0; k < 3; ++k) {
                keys[i].offset[k] = random_between(&random, -9, 9);
                keys[i].turn_deg[k] = i % 4 ? random_between(&random, -400, 400) : 90.0 * (double)random_below(&random, 4);
            }
        }
        const builder_path path = {.keys = keys, .key_count = KEYS};
        assert_int_equal(scene_builder_mover_path(f->builder, 0, &path), RESULT_OK);
        assert_int_equal(builder_fixture_finish(f), RESULT_OK);
        for (int i = 0; i < 4 * KEYS; ++i) {
            scene_pose pose;
            scene_pose_at(f->scene, 0, i * 0.25, DOORS_OPEN, &pose);
            for (int a = 0; a < 3; ++a)
                for (int b = 0; b < 3; ++b) {
                    const double *r = pose.rotation;
                    assert_true(fabs(r[3 * a] * r[3 * b] + r[3 * a + 1] * r[3 * b + 1] + r[3 * a + 2] * r[3 * b + 2] - (a == b)) < 1e-14);
                }
            assert_box_holds(f->scene, 0, &pose);
        }
    }
}

static void turns_go_about_x_then_y_then_z(void **state)
{
    builder_fixture *f = *state;
    const uint32_t mover = add_mover(f, STILL);
    static const scene_key key = {.turn_deg = {90, 90, 180}};
    static const double pivot[3] = {5, 6, 7};
    const builder_path path = {.keys = &key, .key_count = 1, .pivot = pivot};
    assert_int_equal(scene_builder_mover_path(f->builder, mover, &path), RESULT_OK);
    assert_int_equal(builder_fixture_finish(f), RESULT_OK);
    scene_pose pose;
    scene_pose_at(f->scene, mover, 0, DOORS_OPEN, &pose);
    // (x, y, z): about x (x, -z, y), about y (y, -z, -x), about z (-y, z, -x)
    static const double expected[9] = {0, -1, 0, 0, 0, 1, -1, 0, 0};
    for (int i = 0; i < 9; ++i) assert_true(pose.rotation[i] == expected[i]);
    assert_memory_equal(pose.pivot, pivot, sizeof pivot);
}

static void a_mover_turns_about_its_middle_when_nothing_else_is_said(void **state)
{
    builder_fixture *f = *state;
    add_path(f, add_mover(f, STILL), 0);
    assert_int_equal(builder_fixture_finish(f), RESULT_OK);
    const double *pivot = f->scene->movers[0].pivot;
    assert_true(pivot[0] == 1.5 && pivot[1] == 2.5 && fabs(pivot[2] - 3.55) < 1e-15);
}

static void a_hull_s_height_is_below_zero_inside(void **state)
{
    builder_fixture *f = *state;
    uint32_t id;
    assert_int_equal(add_box_zone(f->builder, "room", &(zone_box){{0, 0, 0}, {4, 4, 4}}, SCENE_NONE, &id), RESULT_OK);
    builder_fixture_triangle(f, STILL, 1);
    assert_int_equal(builder_fixture_finish(f), RESULT_OK);
    static const double points[4][3] = {{2, 2, 2}, {3, 2, 2}, {4, 1, 1}, {2, -3, 2}};
    static const double heights[4] = {-2, -1, 0, 3};
    for (int i = 0; i < 4; ++i) assert_true(scene_hull_height(f->scene, 0, points[i]) == heights[i]);
}

static void lights_and_camera_paths_are_copied_and_bad_ones_refused(void **state)
{
    builder_fixture *f = *state;
    char name[] = "walk";
    const camera good = {.eye = {1, 2, 3}, .forward = {1, 0, 0}, .up = {0, 1, 0}, .fovy_deg = 60, .aspect = 1, .near_m = 0.25, .far_m = INFINITY};
    camera both[2] = {good, good};
    both[1].fovy_deg = NAN;
    assert_int_equal(scene_builder_camera_path(f->builder, "bad", both, 2), RESULT_BAD_INPUT);
    assert_int_equal(scene_builder_camera_path(f->builder, name, both, 1), RESULT_OK);
    const scene_light light = {.name = name, .kind = LIGHT_POINT, .reach = 3}, wild = {.name = name, .reach = NAN},
                      dark = {.name = name, .colour = {NAN, 0, 0}};
    assert_int_equal(scene_builder_light(f->builder, &light), RESULT_OK);
    assert_int_equal(scene_builder_light(f->builder, &wild), RESULT_BAD_INPUT);
    assert_int_equal(scene_builder_light(f->builder, &dark), RESULT_BAD_INPUT);
    memset(name, 'x', 4);
    builder_fixture_triangle(f, STILL, 1);
    assert_int_equal(builder_fixture_finish(f), RESULT_OK);
    assert_int_equal(f->scene->path_count, 1);
    assert_int_equal(f->scene->camera_count, 1);
    assert_int_equal(f->scene->paths[0].camera_count, 1);
    assert_string_equal(f->scene->paths[0].name, "walk");
    assert_int_equal(f->scene->light_count, 1);
    assert_string_equal(f->scene->lights[0].name, "walk");
}

int main(void)
{
#define TEST(t) cmocka_unit_test_setup_teardown(t, builder_fixture_set_up, builder_fixture_tear_down)
    const struct CMUnitTest tests[] = {
        TEST(a_path_is_straight_between_keys_and_stays_at_its_ends),
        TEST(a_loop_starts_again_behind_its_last_key),
        TEST(paths_that_are_none_are_refused),
        TEST(a_door_s_mover_stands_where_its_state_says),
        TEST(a_pose_s_box_holds_every_vertex_and_hardly_more),
        TEST(turns_go_about_x_then_y_then_z),
        TEST(a_mover_turns_about_its_middle_when_nothing_else_is_said),
        TEST(a_hull_s_height_is_below_zero_inside),
        TEST(lights_and_camera_paths_are_copied_and_bad_ones_refused),
    };
    return cmocka_run_group_tests_name("zones pose", tests, NULL, NULL);
}
