// Each allocation of a scene with zones, portals, doors and paths, and of its zone data, fails in turn: nothing is left.
// SPDX-License-Identifier: MIT
#include "zone_scene.h"

#include "host/core/zone_data.h"
#include "tests/common/test.h"
#include "tests/core/box_scene.h"

static result add_rest(scene_builder *b)
{
    static const zone_box west = {{200, 0, 0}, {204, 4, 4}}, east = {{204, 0, 0}, {208, 4, 4}}, leaf = {{204, 1, 1}, {204, 2, 2}};
    static const scene_key keys[2] = {{.time_s = 0}, {.time_s = 1, .offset = {1, 0, 0}}};
    static const double wall[4][3] = {{200, 0, 0}, {200, 4, 0}, {200, 4, 4}, {200, 0, 4}};
    const builder_path path = {.keys = keys, .key_count = 2};
    const camera eye = {.forward = {1, 0, 0}, .up = {0, 1, 0}, .fovy_deg = 60, .aspect = 1, .near_m = 0.25, .far_m = 10};
    const scene_light light = {.name = "lamp", .kind = LIGHT_POINT, .reach = 4};
    const char *fault;
    uint32_t id;
    door_hole hole = {204, {1, 1}, {2, 2}, {0, 0}};
    result done = add_box_zone(b, "west", &west, SCENE_NONE, &hole.zones[0]);
    if (done == RESULT_OK) done = add_box_zone(b, "east", &east, SCENE_NONE, &hole.zones[1]);
    if (done == RESULT_OK) done = add_hole(b, &hole, &id, &fault);
    if (done == RESULT_OK) done = add_wall(b, wall);
    if (done == RESULT_OK) done = box_scene_add(b, leaf.min, leaf.max, "leaf");
    if (done == RESULT_OK) done = scene_builder_door(b, "door", DOORS_SHUT, 0, &id);
    if (done == RESULT_OK) done = scene_builder_mover_path(b, 0, &path);
    if (done == RESULT_OK) done = scene_builder_light(b, &light);
    if (done == RESULT_OK) done = scene_builder_camera_path(b, "walk", &eye, 1);
    return done;
}

static result make(const zone_scene *z, const allocator *memory, report *r, scene **out)
{
    scene_builder *b;
    uint32_t id;
    result done = scene_builder_open(memory, &b);
    if (done != RESULT_OK) return done;
    done = scene_builder_material(b, "stone", 5, 0, &id);
    if (done == RESULT_OK) done = scene_builder_object(b, "boxes", 5, &id);
    if (done == RESULT_OK) done = zone_scene_fill(b, z);
    if (done == RESULT_OK) done = add_rest(b);
    if (done == RESULT_OK) done = scene_builder_finish(b, "zones", r, out);
    scene_builder_close(b);
    return done;
}

static void a_scene_with_zones_is_made_or_leaves_nothing(void **state)
{
    (void)state;
    static const zone_scene small = {.zones = 70, .items = 300, .seed = 2}, open = {.zones = 5, .items = 20, .seed = 3, .outside = OUTSIDE_FIRST};
    const zone_scene *const scenes[] = {&small, &open};
    for (int n = 0; n < 2; ++n) {
        uint64_t k = 0;
        result done = RESULT_NO_MEMORY;
        while (done != RESULT_OK) {
            failing_allocator memory;
            report_lines lines;
            scene *s = NULL;
            failing_allocator_init(&memory, ++k);
            report_lines_init(&lines);
            done = make(scenes[n], &memory.memory, &lines.report, &s);
            assert_true(done == RESULT_OK || done == RESULT_NO_MEMORY);
            assert_true(memory.failures == (done != RESULT_OK));
            scene_free(s, &memory.memory);
            assert_true(failing_allocator_is_clean(&memory));
        }
        assert_true(k > 40);
    }
}

static void zone_data_is_made_or_leaves_nothing(void **state)
{
    (void)state;
    static const zone_scene small = {.zones = 6, .items = 30, .seed = 2, .outside = OUTSIDE_LAST};
    failing_allocator memory;
    report_lines lines;
    scene *s;
    failing_allocator_init(&memory, 0);
    report_lines_init(&lines);
    assert_int_equal(make(&small, &memory.memory, &lines.report, &s), RESULT_OK);
    for (uint32_t z = 0; z < s->zone_count; ++z) {
        const zone_data_request q = {s, z, 0};
        result done = RESULT_NO_MEMORY;
        for (uint64_t k = 1; done != RESULT_OK; ++k) {
            failing_allocator inner;
            zone_data data = {0};
            failing_allocator_init(&inner, k);
            done = zone_data_open(&q, &inner.memory, &data);
            assert_true(done == RESULT_OK || (done == RESULT_NO_MEMORY && inner.live_blocks == 0));
            zone_data_close(&data);
            assert_true(failing_allocator_is_clean(&inner));
        }
    }
    scene_free(s, &memory.memory);
    assert_true(failing_allocator_is_clean(&memory));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_scene_with_zones_is_made_or_leaves_nothing),
        cmocka_unit_test(zone_data_is_made_or_leaves_nothing),
    };
    return cmocka_run_group_tests_name("zones out of memory", tests, NULL, NULL);
}
