// The thesis's rules of zones (edges shared by many polygons, islands, portals) on small scenes, each with its figure.
// SPDX-License-Identifier: MIT
#include "tests/common/test.h"

#include "tests/common/failing_allocator.h"
#include "tests/common/report_lines.h"
#include "zones_fixture.h"

typedef struct expected { uint32_t zones, reached, shells, portals; } expected;

// And the oracle has to agree wherever there are no portals.
static compiled_zones *expect(zone_scene *s, portal_choice choice, expected e)
{
    zone_scene_end(s);
    compiled_zones *z = zones_of(&s->in, choice, NULL);
    assert_int_equal(z->leak, 0);
    assert_int_equal(z->zone_count, e.zones);
    assert_int_equal(zones_reached(z), e.reached);
    assert_int_equal(z->shells, e.shells);
    assert_int_equal(z->portal_count, e.portals);
    assert_int_equal(t_junctions_left(&s->in, z->mesh), 0);
    assert_int_equal(open_edges(&s->in, z), 0);
    if (choice == PORTALS_NONE) {
        oracle_zones o;
        oracle_bsp(&s->in, &o);
        assert_int_equal(o.regions, e.zones);
        assert_int_equal(o.reached, e.reached);
    }
    return z;
}

static void finish(zone_scene *s, compiled_zones *z)
{
    compiled_zones_free(z);
    zone_scene_free(s);
}

static void a_hollow_box_is_one_zone(void **state)
{
    (void)state;
    zone_scene s;
    zone_scene_begin(&s);
    zone_scene_hollow(&s, 0, 0, 0, 128, 128, 128);
    zone_scene_point(&s, "info_player_start", 64, 64, 64);
    compiled_zones *z = expect(&s, PORTALS_NONE, (expected){1, 1, 2, 0});
    assert_int_equal(polygons_in_zone(z, 0), 6);
    assert_int_equal(polygons_in_zone(z, UINT32_MAX), 6); // the outside of the walls
    finish(&s, z);
}

static void four_polygons_on_one_edge_part_nothing_that_is_connected(void **state)
{
    (void)state;
    zone_scene s;
    zone_scene_begin(&s);
    zone_scene_hollow(&s, 0, 0, 0, 256, 256, 256);
    zone_scene_box(&s, BRUSH_ADD, 64, 64, 64, 32, 32, 32);
    zone_scene_box(&s, BRUSH_ADD, 96, 96, 64, 32, 32, 32); // touches the other along an edge
    zone_scene_point(&s, "light", 20, 20, 20);
    finish(&s, expect(&s, PORTALS_NONE, (expected){1, 1, 3, 0})); // the two are one island: the air goes round
}

static void two_hollow_boxes_that_share_an_edge_are_two_zones(void **state)
{
    (void)state;
    zone_scene s; // the rooms' own edge is shared: all four polygons are behind one another
    zone_scene_begin(&s);
    zone_scene_box(&s, BRUSH_ADD, 0, 0, 0, 256, 256, 256);
    zone_scene_box(&s, BRUSH_SUBTRACT, 32, 32, 32, 64, 64, 64);
    zone_scene_box(&s, BRUSH_SUBTRACT, 96, 96, 32, 64, 64, 64);
    zone_scene_point(&s, "light", 64, 64, 64);
    zone_scene_point(&s, "light", 128, 128, 64);
    finish(&s, expect(&s, PORTALS_NONE, (expected){2, 2, 3, 0}));
    zone_scene_begin(&s); // the boxes' outer edge is shared, in a room: all are in front of one another
    zone_scene_hollow(&s, 0, 0, 0, 512, 512, 512);
    zone_scene_hollow(&s, 64, 64, 64, 64, 64, 64);
    zone_scene_hollow(&s, 128, 128, 64, 64, 64, 64);
    zone_scene_point(&s, "light", 20, 20, 20);
    zone_scene_point(&s, "light", 96, 96, 96);
    finish(&s, expect(&s, PORTALS_NONE, (expected){3, 2, 5, 0}));
}

static void partial_edges_meet_one_long_edge(void **state)
{
    (void)state;
    zone_scene s; // three blocks of one height side by side on a step: its edge A faces B, C and D
    zone_scene_begin(&s);
    zone_scene_hollow(&s, 0, 0, 0, 256, 128, 128);
    zone_scene_box(&s, BRUSH_ADD, 8, 8, 8, 240, 16, 40);
    for (int i = 0; i < 3; ++i) zone_scene_box(&s, BRUSH_ADD, 8 + 80 * i, 24, 8, 80, 16 + 8 * i, 40);
    zone_scene_point(&s, "light", 100, 100, 100);
    compiled_zones *z = expect(&s, PORTALS_NONE, (expected){1, 1, 2, 0});
    assert_true(z->t_junctions_inserted > 0);
    finish(&s, z);
}

static void a_block_inside_a_zone_belongs_to_it(void **state)
{
    (void)state;
    zone_scene s;
    zone_scene_begin(&s);
    zone_scene_hollow(&s, 0, 0, 0, 256, 256, 256);
    zone_scene_box(&s, BRUSH_ADD, 96, 96, 96, 64, 64, 64);
    zone_scene_point(&s, "light", 20, 20, 20);
    compiled_zones *z = expect(&s, PORTALS_NONE, (expected){1, 1, 3, 0});
    assert_int_equal(polygons_in_zone(z, 0), 12);
    finish(&s, z);
}

static void a_closed_zone_inside_a_solid_inside_a_zone_stays_one(void **state)
{
    (void)state;
    zone_scene s;
    zone_scene_begin(&s);
    zone_scene_hollow(&s, 0, 0, 0, 256, 256, 256);
    zone_scene_hollow(&s, 64, 64, 64, 128, 128, 128);
    zone_scene_box(&s, BRUSH_ADD, 120, 120, 120, 8, 8, 8);
    zone_scene_point(&s, "light", 20, 20, 20);
    zone_scene_point(&s, "light", 100, 100, 100);
    compiled_zones *z = expect(&s, PORTALS_NONE, (expected){2, 2, 5, 0});
    assert_int_equal(polygons_in_zone(z, 0), 12);
    assert_int_equal(polygons_in_zone(z, 1), 12);
    finish(&s, z);
}

static void eleven_rooms_are_eleven_zones(void **state)
{
    (void)state;
    zone_scene s;
    zone_scene_begin(&s);
    zone_scene_box(&s, BRUSH_ADD, 0, 0, 0, 11 * 64 + 8, 64, 64);
    for (int i = 0; i < 11; ++i) zone_scene_box(&s, BRUSH_SUBTRACT, 8 + 64 * i, 8, 8, 56, 48, 48);
    for (int i = 0; i < 11; ++i) zone_scene_point(&s, "light", 40 + 64 * i, 32, 32);
    finish(&s, expect(&s, PORTALS_NONE, (expected){11, 11, 12, 0}));
}

static void an_edge_against_the_inside_of_a_face_seals(void **state)
{
    (void)state;
    zone_scene s; // a wedge whose edge just touches the far wall parts the room in two
    zone_scene_begin(&s);
    zone_scene_hollow(&s, 0, 0, 0, 256, 128, 128);
    draft_brush(&s.draft, BRUSH_ADD, BRUSH_STRUCTURE, 0);
    s.entities[0].brush_count++;
    const cull_wide_plane planes[5] = {{{1, 0, 1}, cull_wide_from(-(128 + 120) * UNIT)}, {{-1, 0, 1}, cull_wide_from(-(120 - 128) * UNIT)},
                                       {{0, 0, -1}, cull_wide_from(8 * UNIT)},           {{0, -1, 0}, cull_wide_from(8 * UNIT)},
                                       {{0, 1, 0}, cull_wide_from(-120 * UNIT)}};
    for (int i = 0; i < 5; ++i) draft_plane(&s.draft, &planes[i]);
    zone_scene_point(&s, "light", 12, 64, 100);
    zone_scene_point(&s, "light", 240, 64, 100);
    finish(&s, expect(&s, PORTALS_NONE, (expected){2, 2, 3, 0}));
}

// Two rooms and a passage of 32 by 64 in the wall between them, 16 thick.
static void two_rooms(zone_scene *s)
{
    zone_scene_begin(s);
    zone_scene_box(s, BRUSH_ADD, 0, 0, 0, 288, 128, 128);
    zone_scene_box(s, BRUSH_SUBTRACT, 8, 8, 8, 128, 112, 112);
    zone_scene_box(s, BRUSH_SUBTRACT, 152, 8, 8, 128, 112, 112);
    zone_scene_box(s, BRUSH_SUBTRACT, 136, 8, 48, 16, 64, 32);
    zone_scene_point(s, "light", 64, 64, 64);
    zone_scene_point(s, "light", 200, 64, 64);
}

static void a_door_parts_two_rooms_and_its_floor(void **state)
{
    (void)state;
    zone_scene s;
    two_rooms(&s);
    zone_scene_brushes_of(&s, "func_door", BRUSH_ENTITY);
    zone_scene_box(&s, BRUSH_ADD, 140, 8, 48, 8, 64, 16); // two leaves that touch
    zone_scene_brushes_of(&s, "func_door", BRUSH_ENTITY);
    zone_scene_box(&s, BRUSH_ADD, 140, 8, 64, 8, 64, 16);
    zone_scene_end(&s);
    compiled_zones *z = zones_of(&s.in, PORTALS_DOORS, NULL);
    assert_int_equal(z->zone_count, 2);
    assert_int_equal(z->portal_count, 1);
    assert_int_equal(z->portals[0].entity, 3);
    assert_int_equal(t_junctions_left(&s.in, z->mesh), 0);
    for (uint32_t i = 0; i < z->portals[0].vertex_count; ++i) {
        const double *p = z->mesh->vertices[z->mesh->loop[z->portals[0].first_vertex + i]].position;
        assert_true(p[0] == 144 * UNIT && p[1] >= 8 * UNIT && p[1] <= 72 * UNIT && p[2] >= 48 * UNIT && p[2] <= 80 * UNIT);
    }
    const cull_wide_plane plane = plane_table_get(s.in.planes, z->portals[0].plane);
    assert_int_equal(z->portals[0].zones[0], plane.normal[0] > 0 ? 1 : 0); // the front's zone first
    for (uint32_t i = 0; i < z->mesh->polygon_count; ++i) { // nothing reaches over the portal
        const compile_polygon *p = &z->mesh->polygons[i];
        double low = 1e9, high = -1e9;
        for (uint32_t k = 0; k < p->vertex_count && z->polygon_zone[i] != UINT32_MAX; ++k) {
            const double x = z->mesh->vertices[z->mesh->loop[p->first_vertex + k]].position[0];
            low = x < low ? x : low;
            high = x > high ? x : high;
        }
        assert_false(low < 144 * UNIT && high > 144 * UNIT);
    }
    compiled_zones_free(z);
    z = zones_of(&s.in, PORTALS_NONE, NULL);
    assert_int_equal(z->zone_count, 1);
    compiled_zones_free(z);
    z = zones_of(&s.in, PORTALS_AUTHORED, NULL);
    assert_int_equal(z->portal_count, 0);
    finish(&s, z);
}

static void an_authored_portal_parts_two_rooms_and_one_beside_the_way_does_not(void **state)
{
    (void)state;
    zone_scene s;
    two_rooms(&s);
    zone_scene_brushes_of(&s, "zone_portal", BRUSH_PORTAL);
    zone_scene_box(&s, BRUSH_ADD, 142, 4, 44, 4, 72, 40);
    zone_scene_brushes_of(&s, "zone_portal", BRUSH_PORTAL);
    zone_scene_box(&s, BRUSH_ADD, 60, 4, 4, 4, 60, 120); // too low to reach the ceiling
    finish(&s, expect(&s, PORTALS_AUTHORED, (expected){2, 2, 3, 1}));
}

// Up is nothing to the compiler: a map that lies on its side has the same portals.
static void a_lift_parts_its_shaft_like_a_door_whichever_way_is_up(void **state)
{
    (void)state;
    for (int up = 0; up < 3; ++up) {
        int shaft[3] = {64, 64, 64}, air[3] = {48, 48, 48}, lift_at[3] = {8, 8, 8}, lift[3] = {48, 48, 48};
        shaft[up] = 256;
        air[up] = 240;
        lift_at[up] = 120;
        lift[up] = 8;
        zone_scene s;
        zone_scene_begin(&s);
        zone_scene_box(&s, BRUSH_ADD, 0, 0, 0, shaft[0], shaft[1], shaft[2]);
        zone_scene_box(&s, BRUSH_SUBTRACT, 8, 8, 8, air[0], air[1], air[2]);
        zone_scene_point(&s, "light", 32, 32, 32);
        zone_scene_brushes_of(&s, "func_door", BRUSH_ENTITY);
        zone_scene_box(&s, BRUSH_ADD, lift_at[0], lift_at[1], lift_at[2], lift[0], lift[1], lift[2]);
        finish(&s, expect(&s, PORTALS_DOORS, (expected){2, 1, 3, 1}));
    }
}

// None of its axes is the thin one: each is tried, and the one way through it that parts anything stays.
static void a_door_as_thick_as_wide_parts_two_rooms_once(void **state)
{
    (void)state;
    zone_scene s;
    zone_scene_begin(&s);
    zone_scene_box(&s, BRUSH_ADD, 0, 0, 0, 256, 128, 128);
    zone_scene_box(&s, BRUSH_SUBTRACT, 8, 8, 8, 104, 112, 112);
    zone_scene_box(&s, BRUSH_SUBTRACT, 144, 8, 8, 104, 112, 112);
    zone_scene_box(&s, BRUSH_SUBTRACT, 112, 48, 48, 32, 32, 32);
    zone_scene_point(&s, "light", 32, 32, 32);
    zone_scene_point(&s, "light", 200, 32, 32);
    zone_scene_brushes_of(&s, "func_door", BRUSH_ENTITY);
    zone_scene_box(&s, BRUSH_ADD, 112, 48, 48, 32, 32, 32);
    finish(&s, expect(&s, PORTALS_DOORS, (expected){2, 2, 3, 1}));
}

// The last door has the void behind it and parts nothing; without it the one before has, and so on to the first.
static void a_row_of_doors_into_the_void_parts_nothing(void **state)
{
    (void)state;
    enum { DOORS = 6, CELL = 64, LENGTH = (DOORS + 1) * CELL };
    for (int is_closed = 0; is_closed < 2; ++is_closed) {
        zone_scene s;
        zone_scene_begin(&s);
        zone_scene_hollow(&s, 0, 0, 0, 128, 128, 128);
        zone_scene_box(&s, BRUSH_ADD, 292, -16, -16, 16, 96, 96);
        zone_scene_box(&s, BRUSH_ADD, 308, -16, -16, LENGTH, 16, 96);
        zone_scene_box(&s, BRUSH_ADD, 308, 64, -16, LENGTH, 16, 96);
        zone_scene_box(&s, BRUSH_ADD, 308, 0, -16, LENGTH, 64, 16);
        zone_scene_box(&s, BRUSH_ADD, 308, 0, 64, LENGTH, 64, 16);
        if (is_closed) zone_scene_box(&s, BRUSH_ADD, 308 + LENGTH, -16, -16, 16, 96, 96);
        for (int i = 1; i <= DOORS; ++i) {
            zone_scene_brushes_of(&s, "func_door", BRUSH_ENTITY);
            zone_scene_box(&s, BRUSH_ADD, 308 + i * CELL, 0, 0, 8, 64, 64);
        }
        zone_scene_point(&s, "light", 64, 64, 64);
        finish(&s, expect(&s, PORTALS_DOORS, is_closed ? (expected){2 + DOORS, 1, 4 + DOORS, DOORS} : (expected){1, 1, 3, 0}));
    }
}

static void a_leak_is_told_with_a_line_and_leaves_one_open_zone(void **state)
{
    (void)state;
    zone_scene s;
    zone_scene_begin(&s);
    zone_scene_hollow(&s, 0, 0, 0, 128, 128, 128);
    zone_scene_box(&s, BRUSH_SUBTRACT, 100, 60, 60, 64, 8, 8); // through the wall
    zone_scene_point(&s, "info_player_start", 64, 64, 64);
    zone_scene_end(&s);
    report_lines lines;
    report_lines_init(&lines);
    compiled_zones *z = zones_of(&s.in, PORTALS_DOORS, &lines.report);
    assert_true(report_lines_is_one_with(&lines, "leaks"));
    assert_int_equal(z->leak, 1);
    assert_int_equal(z->zone_count, 1);
    assert_int_equal(z->zones[0].is_outside, 1);
    assert_int_equal(polygons_in_zone(z, 0), z->mesh->polygon_count);
    assert_true(z->leak_line_count >= 3);
    const double *first = z->leak_line[0], *last = z->leak_line[z->leak_line_count - 1];
    assert_true(first[0] == 2 && first[1] == 2 && first[2] == 2);
    assert_true(last[0] > 4 || last[0] < 0 || last[1] > 4 || last[1] < 0 || last[2] > 4 || last[2] < 0);
    finish(&s, z);
}

static void water_is_open_but_holds_back_the_void(void **state)
{
    (void)state;
    zone_scene s;
    zone_scene_begin(&s);
    zone_scene_hollow(&s, 0, 0, 0, 128, 128, 128);
    zone_scene_box(&s, BRUSH_SUBTRACT, 100, 8, 8, 64, 40, 112);
    zone_scene_point(&s, "light", 64, 100, 64);
    zone_scene_point(&s, "light", 64, 20, 64);
    zone_scene_brushes_of(&s, "worldspawn", BRUSH_LIQUID);
    zone_scene_box(&s, BRUSH_ADD, 8, 8, 8, 120, 40, 112); // ends with the wall that is open
    zone_scene_end(&s);
    compiled_zones *z = zones_of(&s.in, PORTALS_NONE, NULL);
    assert_int_equal(z->leak, 0);
    assert_int_equal(zones_reached(z), 1);
    assert_int_equal(z->zones[0].entity_count, 2);
    for (uint32_t i = 0; i < z->mesh->polygon_count; ++i)
        if (s.in.brushes[z->mesh->polygons[i].brush].role == BRUSH_LIQUID) assert_int_equal(z->polygon_zone[i], 0);
    finish(&s, z);
}

static void a_zone_info_names_its_zone_and_gives_the_chain(void **state)
{
    (void)state;
    static const char *const keys[] = {"name", "hall", "chain", "bsp+portal"};
    zone_scene s;
    zone_scene_begin(&s);
    zone_scene_hollow(&s, 0, 0, 0, 128, 128, 128);
    zone_scene_point(&s, "zone_info", 64, 64, 64);
    s.entities[1].keys = keys;
    s.entities[1].key_count = 2;
    compiled_zones *z = expect(&s, PORTALS_NONE, (expected){1, 1, 2, 0});
    assert_string_equal(z->zones[0].name, "hall");
    assert_string_equal(z->zones[0].chain, "bsp+portal");
    finish(&s, z);
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    zone_scene s;
    two_rooms(&s);
    zone_scene_brushes_of(&s, "func_door", BRUSH_ENTITY);
    zone_scene_box(&s, BRUSH_ADD, 140, 8, 48, 8, 64, 32);
    zone_scene_brushes_of(&s, "worldspawn", BRUSH_LIQUID);
    zone_scene_box(&s, BRUSH_ADD, 8, 8, 8, 128, 20, 112);
    zone_scene_end(&s);
    report quiet = {0};
    for (uint64_t k = 1;; ++k) {
        assert_true(k < 5000);
        failing_allocator failing;
        failing_allocator_init(&failing, 0);
        csg_counts counts;
        compile_mesh *mesh;
        compiled_zones *z = NULL;
        assert_int_equal(compile_csg(&s.in, &quiet, &failing.memory, &mesh, &counts), RESULT_OK);
        failing.fail_at = failing.calls + k;
        const result r = compile_zones(&s.in, mesh, PORTALS_DOORS, &quiet, &failing.memory, &z);
        if (r == RESULT_OK) compiled_zones_free(z);
        else assert_int_equal(r, RESULT_NO_MEMORY);
        assert_true(failing_allocator_is_clean(&failing));
        if (!failing.failures) break;
    }
    zone_scene_free(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_hollow_box_is_one_zone),
        cmocka_unit_test(four_polygons_on_one_edge_part_nothing_that_is_connected),
        cmocka_unit_test(two_hollow_boxes_that_share_an_edge_are_two_zones),
        cmocka_unit_test(partial_edges_meet_one_long_edge),
        cmocka_unit_test(a_block_inside_a_zone_belongs_to_it),
        cmocka_unit_test(a_closed_zone_inside_a_solid_inside_a_zone_stays_one),
        cmocka_unit_test(eleven_rooms_are_eleven_zones),
        cmocka_unit_test(an_edge_against_the_inside_of_a_face_seals),
        cmocka_unit_test(a_door_parts_two_rooms_and_its_floor),
        cmocka_unit_test(an_authored_portal_parts_two_rooms_and_one_beside_the_way_does_not),
        cmocka_unit_test(a_lift_parts_its_shaft_like_a_door_whichever_way_is_up),
        cmocka_unit_test(a_door_as_thick_as_wide_parts_two_rooms_once),
        cmocka_unit_test(a_row_of_doors_into_the_void_parts_nothing),
        cmocka_unit_test(a_leak_is_told_with_a_line_and_leaves_one_open_zone),
        cmocka_unit_test(water_is_open_but_holds_back_the_void),
        cmocka_unit_test(a_zone_info_names_its_zone_and_gives_the_chain),
        cmocka_unit_test(every_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
