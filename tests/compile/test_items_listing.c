// Which zones list what: walls in the zone that edge tracing gave them, and where zones touch in an edge in both; liquids and
// brush entities in each that they touch.
// SPDX-License-Identifier: MIT
#include "items_fixture.h"

#include <portcullis/box.h>

#include <string.h>

static int is_listed(const scene *s, uint32_t zone, uint32_t item)
{
    const scene_zone *z = &s->zones[zone];
    for (uint32_t i = z->first_item; i < z->first_item + z->item_count; ++i)
        if (s->zone_items[i] == item) return 1;
    return 0;
}

static uint32_t count_listed(const scene *s, uint8_t zones)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < s->item_count; ++i) count += s->listings[i] == zones;
    return count;
}

// Scene metres: its box.
static int lies_left_of(const scene *s, uint32_t item, double x)
{
    return (double)cull_box_at(&s->boxes, item).max.x + s->whole.origin[0] <= x;
}

static int is_structure(const scene *s, uint32_t item)
{
    return strcmp(s->objects[s->items[item].object].name, "worldspawn") == 0;
}

static uint32_t first_wall(const scene *s)
{
    uint32_t i = 0;
    while (!is_structure(s, i)) ++i;
    return i;
}

static void a_wall_is_listed_in_its_own_zone_alone(void **state)
{
    (void)state;
    static map_writer w;
    static compiled c;
    write_two_rooms(&w);
    take_zones(&c, input_of(w.text, NULL), PORTALS_DOORS);
    take_items(&c);
    const scene *s = c.scene;
    assert_int_equal(s->zone_count, 2);
    assert_int_equal(count_listed(s, 1), s->item_count); // the doorway's frame, cut by the portal, too
    const uint32_t wall = first_wall(s), left = is_listed(s, 0, wall) == lies_left_of(s, wall, 264.0 / 32) ? 0 : 1; // the room at the left
    for (uint32_t i = 0; i < s->item_count; ++i) assert_int_equal(is_listed(s, left, i), lies_left_of(s, i, 264.0 / 32));
    release(&c);
}

static void a_liquid_is_listed_in_every_zone_that_it_touches(void **state)
{
    (void)state;
    static map_writer w;
    static compiled c;
    static const double pool[2][3] = {{64, 96, 0}, {400, 160, 16}};
    write_two_rooms(&w);
    open_entity(&w, "func_group");
    write_box(&w, pool[0], pool[1], "*water");
    close_entity(&w);
    take_zones(&c, input_of(w.text, NULL), PORTALS_DOORS);
    take_items(&c);
    const scene *s = c.scene;
    uint32_t surfaces = 0;
    assert_int_equal(s->zone_count, 2);
    const uint32_t wall = first_wall(s), left = is_listed(s, 0, wall) == lies_left_of(s, wall, 264.0 / 32) ? 0 : 1;
    for (uint32_t i = 0; i < s->item_count; ++i) {
        if (!(s->items[i].flags & CULL_ITEM_SEE_THROUGH)) {
            assert_int_equal(s->listings[i], 1);
            continue;
        }
        const cull_box b = cull_box_at(&s->boxes, i);
        const double low = ((double)b.min.x + s->whole.origin[0]) * 32, high = ((double)b.max.x + s->whole.origin[0]) * 32;
        assert_true(is_listed(s, left, i) || low >= 264);
        assert_true(is_listed(s, 1 - left, i) || high <= 264);
        ++surfaces;
    }
    assert_true(surfaces >= 3); // the top and two ends
    assert_true(count_listed(s, 2) >= 1);
    release(&c);
}

// Rooms of 4 m that meet in one upright edge, no portal: its walls' depths are equal there, so each zone lists the other's.
static void walls_of_zones_that_touch_in_an_edge_are_listed_in_both(void **state)
{
    (void)state;
    static const double boxes[][2][3] = {{{-16, -16, -16}, {272, 272, 0}}, {{-16, -16, 128}, {272, 272, 144}}, {{-16, -16, 0}, {272, 0, 128}},
                                         {{-16, 256, 0}, {272, 272, 128}}, {{-16, 0, 0}, {0, 256, 128}},       {{256, 0, 0}, {272, 256, 128}},
                                         {{128, 0, 0}, {256, 128, 128}},   {{0, 128, 0}, {128, 256, 128}}};
    static map_writer w;
    static compiled c;
    w.size = 0;
    open_entity(&w, "worldspawn");
    for (size_t i = 0; i < sizeof boxes / sizeof *boxes; ++i) write_box(&w, boxes[i][0], boxes[i][1], "wall");
    close_entity(&w);
    for (int room = 0; room < 2; ++room) {
        open_entity(&w, "info_player_start");
        write_text(&w, "\"origin\" \"%d %d 64\"\n", 64 + 128 * room, 64 + 128 * room);
        close_entity(&w);
    }
    take_zones(&c, input_of(w.text, NULL), PORTALS_NONE);
    take_items(&c);
    const scene *s = c.scene;
    assert_int_equal(s->zone_count, 2);
    assert_int_equal(s->portal_count, 0);
    assert_int_equal(s->item_count, 12);
    assert_int_equal(count_listed(s, 2), 8); // of each room two walls, floor and ceiling
    assert_int_equal(count_listed(s, 1), 4);
    release(&c);
}

static void a_brush_entity_in_the_doorway_is_listed_in_both_rooms(void **state)
{
    (void)state;
    static map_writer w;
    static compiled c;
    static const double sill[2][3] = {{250, 100, 0}, {278, 150, 8}};
    write_two_rooms(&w);
    open_entity(&w, "func_wall");
    write_box(&w, sill[0], sill[1], "sill");
    close_entity(&w);
    take_zones(&c, input_of(w.text, NULL), PORTALS_DOORS);
    take_items(&c);
    const scene *s = c.scene;
    uint32_t both = 0;
    for (uint32_t i = 0; i < s->item_count; ++i) {
        if (is_structure(s, i)) assert_int_equal(s->listings[i], 1);
        else both += s->listings[i] == 2;
    }
    assert_int_equal(both, 4); // top, bottom and sides; an end lies in one room
    release(&c);
}

// In a hull of which zones the point lies, map units: bits.
static uint32_t zones_at(const scene *s, double x, double y, double z)
{
    const double at[3] = {x / 32, z / 32, -y / 32};
    uint32_t zones = 0;
    for (uint32_t h = 0; h < s->hull_count; ++h)
        if (scene_hull_height(s, h, at) < 0) zones |= 1u << s->hulls[h].zone;
    return zones;
}

// The right room has no floor but water over the void.
static void a_liquid_that_holds_the_void_back_bounds_its_zone(void **state)
{
    (void)state;
    static const double boxes[][2][3] = {{{-16, -16, -16}, {272, 272, 0}}, {{-16, -16, 128}, {544, 272, 144}}, {{-16, -16, -16}, {544, 0, 128}},
                                         {{-16, 256, -16}, {544, 272, 128}}, {{-16, 0, 0}, {0, 256, 128}}, {{528, 0, -16}, {544, 256, 128}},
                                         {{256, 0, 0}, {272, 96, 128}}, {{256, 160, 0}, {272, 256, 128}}, {{256, 96, 96}, {272, 160, 128}}};
    static const double water[2][3] = {{272, 0, -16}, {528, 256, 8}}, door[2][3] = {{256, 96, 0}, {272, 160, 96}};
    static map_writer w;
    static compiled c;
    w.size = 0;
    open_entity(&w, "worldspawn");
    for (size_t i = 0; i < sizeof boxes / sizeof *boxes; ++i) write_box(&w, boxes[i][0], boxes[i][1], "wall");
    write_box(&w, water[0], water[1], "*water");
    close_entity(&w);
    open_entity(&w, "func_door");
    write_text(&w, "\"angle\" \"-1\"\n");
    write_box(&w, door[0], door[1], "gate");
    close_entity(&w);
    write_inhabitants(&w);
    take_zones(&c, input_of(w.text, NULL), PORTALS_DOORS);
    assert_int_equal(c.zones->leak, 0);
    take_items(&c);
    const scene *s = c.scene;
    assert_int_equal(s->zone_count, 2);
    const uint32_t left = zones_at(s, 128, 128, 64), right = zones_at(s, 400, 128, 64);
    assert_int_equal(left + right, 3);
    assert_true(left != right && left != 0 && right != 0);
    assert_int_equal(zones_at(s, 400, 128, 4), right);  // in the water
    assert_int_equal(zones_at(s, 520, 250, -12), right);
    uint32_t seals = 0;
    for (uint32_t i = 0; i < c.zones->mesh->polygon_count; ++i) {
        const uint32_t *of = c.zones->seal_zones[i];
        seals += of[0] != UINT32_MAX || of[1] != UINT32_MAX;
        assert_true(of[0] == UINT32_MAX || of[1] == UINT32_MAX); // the void on one side
    }
    assert_true(seals >= 1);
    for (uint32_t i = 0; i < s->item_count; ++i)
        if (s->items[i].flags & CULL_ITEM_SEE_THROUGH) assert_true(is_listed(s, right >> 1, i));
    release(&c);
}

static void builders_refuse_zones_that_are_not_there(void **state)
{
    (void)state;
    scene_builder *b;
    uint32_t material, object, first, zone;
    const char *fault;
    const uint32_t none[1] = {1}, twice[2] = {0, 0}, good[1] = {0}, indices[3] = {0, 1, 2};
    const builder_vertex v[3] = {{.position = {0, 0, 0}}, {.position = {1, 0, 0}}, {.position = {0, 1, 0}}};
    assert_int_equal(scene_builder_open(allocator_heap(), &b), RESULT_OK);
    assert_int_equal(scene_builder_zone(b, &(builder_zone){.name = "all", .parent = SCENE_NONE}, &zone, &fault), RESULT_OK);
    assert_int_equal(scene_builder_item_zones(b, good, 1), RESULT_BAD_INPUT); // no item yet
    assert_int_equal(scene_builder_material(b, "m", 1, 0, &material), RESULT_OK);
    assert_int_equal(scene_builder_object(b, "o", 1, &object), RESULT_OK);
    assert_int_equal(scene_builder_vertices(b, v, 3, material, &first), RESULT_OK);
    const builder_item item = {.indices = indices, .index_count = 3, .polygon_count = 1, .material = material, .object = object};
    assert_int_equal(scene_builder_item(b, &item), RESULT_OK);
    assert_int_equal(scene_builder_item_zones(b, none, 1), RESULT_BAD_INPUT);
    assert_int_equal(scene_builder_item_zones(b, twice, 2), RESULT_BAD_INPUT);
    assert_int_equal(scene_builder_item_zones(b, good, 0), RESULT_BAD_INPUT);
    assert_int_equal(scene_builder_item_zones(b, good, 1), RESULT_OK);
    assert_int_equal(scene_builder_item_zones(b, good, 1), RESULT_BAD_INPUT); // said already
    scene_builder_close(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_wall_is_listed_in_its_own_zone_alone),
        cmocka_unit_test(a_liquid_is_listed_in_every_zone_that_it_touches),
        cmocka_unit_test(walls_of_zones_that_touch_in_an_edge_are_listed_in_both),
        cmocka_unit_test(a_brush_entity_in_the_doorway_is_listed_in_both_rooms),
        cmocka_unit_test(a_liquid_that_holds_the_void_back_bounds_its_zone),
        cmocka_unit_test(builders_refuse_zones_that_are_not_there),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
