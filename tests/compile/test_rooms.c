// Automatic rooms: where a map is parted, and by how much. See rooms_merge.c for the rule.
// SPDX-License-Identifier: MIT
#include "items_fixture.h"
#include "tests/common/failing_allocator.h"

#include <stdlib.h>
#include <string.h>

static void take_rooms(compiled *c, const char *text, const zone_options *options)
{
    compile_mesh *mesh = NULL;
    csg_counts counts;
    *c = (compiled){0};
    report_lines_init(&c->lines);
    assert_int_equal(compile_input_map("rooms.map", text, strlen(text), NULL, allocator_heap(), &c->lines.report, &c->in), RESULT_OK); // warnings are fine
    assert_int_equal(compile_csg(c->in, &c->lines.report, allocator_heap(), &mesh, &counts), RESULT_OK);
    assert_int_equal(compile_zones_with(c->in, mesh, options, &c->lines.report, allocator_heap(), &c->zones), RESULT_OK);
    take_items(c);
    expect_sound(c);
}

static void a_doorway_parts_two_rooms(void **state)
{
    (void)state;
    static map_writer w;
    write_rooms_alone(&w, "");
    write_inhabitants(&w);
    const zone_options options = zone_options_of(PORTALS_AUTO);
    compiled c;
    take_rooms(&c, w.text, &options);
    assert_in_range(c.scene->zone_count, 2, 3); // the doorway may be a room of its own
    assert_int_equal(c.scene->portal_count, c.scene->zone_count - 1);
    for (uint32_t i = 0; i < c.scene->portal_count; ++i) assert_int_equal(c.scene->portals[i].door, SCENE_NONE);
    release(&c);
}

static void no_more_rooms_than_asked_for(void **state)
{
    (void)state;
    static map_writer w;
    write_rooms_alone(&w, "");
    write_inhabitants(&w);
    zone_options options = zone_options_of(PORTALS_AUTO);
    compiled c;
    options.rooms.rooms = 1;
    take_rooms(&c, w.text, &options);
    assert_int_equal(c.scene->zone_count, 1);
    assert_int_equal(c.scene->portal_count, 0);
    release(&c);
    options = zone_options_of(PORTALS_AUTO);
    options.rooms.portals = 0;
    take_rooms(&c, w.text, &options);
    assert_int_equal(c.scene->zone_count, 1);
    release(&c);
}

static void a_door_stays_a_portal_of_its_own(void **state)
{
    (void)state;
    static map_writer w;
    write_two_rooms(&w);
    zone_options options = zone_options_of(PORTALS_AUTO);
    options.rooms.rooms = 1; // of what is not parted by doors
    compiled c;
    take_rooms(&c, w.text, &options);
    assert_int_equal(c.scene->zone_count, 2);
    assert_int_equal(c.scene->portal_count, 1);
    assert_int_equal(c.scene->portals[0].door, 0);
    release(&c);
}

static void real_maps_are_parted_into_closed_rooms(void **state)
{
    (void)state;
    size_t size;
    char *text = real_map(real_map_names[0], &size);
    if (!text) skip();
    free(text);
    for (int i = 0; i < (getenv("PORTCULLIS_LONG") ? ID_MAPS : 1); ++i) {
        text = real_map(real_map_names[i], &size);
        const zone_options options = zone_options_of(PORTALS_AUTO);
        compiled c;
        take_rooms(&c, text, &options);
        print_message("%s: %u rooms, %u portals\n", real_map_names[i], c.scene->zone_count, c.scene->portal_count);
        assert_true(c.scene->zone_count > 8);
        assert_in_range(c.scene->portal_count, c.scene->zone_count / 2, 150);
        release(&c);
        free(text);
    }
}

// ---- Memory ----

static result part(const char *text, const allocator *memory, report *r)
{
    compile_input *in;
    compile_mesh *mesh;
    compiled_zones *zones;
    csg_counts counts;
    const zone_options options = zone_options_of(PORTALS_AUTO);
    result done = compile_input_map("rooms.map", text, strlen(text), NULL, memory, r, &in);
    if (done != RESULT_OK) return done;
    done = compile_csg(in, r, memory, &mesh, &counts);
    if (done == RESULT_OK) done = compile_zones_with(in, mesh, &options, r, memory, &zones);
    if (done == RESULT_OK) {
        scene *s = NULL;
        compile_checks checks;
        done = compile_items(in, zones, r, memory, &s, &checks);
        if (done == RESULT_OK) scene_free(s, memory);
        compiled_zones_free(zones);
    }
    compile_input_free(in);
    return done;
}

static void whichever_allocation_fails_all_is_given_back(void **state)
{
    (void)state;
    static map_writer w;
    write_rooms_alone(&w, "");
    write_inhabitants(&w);
    result done = RESULT_NO_MEMORY;
    for (uint64_t at = 1; done != RESULT_OK; ++at) {
        failing_allocator a;
        failing_allocator_init(&a, at);
        report_lines lines;
        report_lines_init(&lines);
        done = part(w.text, &a.memory, &lines.report);
        assert_true(done == RESULT_OK || done == RESULT_NO_MEMORY);
        assert_true(failing_allocator_is_clean(&a));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_doorway_parts_two_rooms),
        cmocka_unit_test(no_more_rooms_than_asked_for),
        cmocka_unit_test(a_door_stays_a_portal_of_its_own),
        cmocka_unit_test(real_maps_are_parted_into_closed_rooms),
        cmocka_unit_test(whichever_allocation_fails_all_is_given_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
