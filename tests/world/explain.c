// Tests of explain: the lines name portal, door, plane, culler and zone.
// SPDX-License-Identifier: MIT
#include "site.h"
#include "tests/common/test.h"

#include <stdio.h>
#include <string.h>

// A street with a hall behind a door, and a cellar behind a second one; x is the way in.
enum { STREET, HALL, CELLAR, ATTIC };
enum { LAMP, TABLE, SILL, BARREL, BEHIND, CHEST };

static world_view *open_house(site *s, const char *chain)
{
    static const site_box zones[] = {{{-20, 0, 0}, {0, 4, 10}}, {{0, 0, 0}, {10, 4, 10}}, {{10, 0, 0}, {20, 4, 10}}, {{0, 10, 0}, {10, 14, 10}}};
    static const site_box items[] = {{{-4, 0, 5}, {-3, 1, 6}}, {{5, 0, 5}, {6, 1, 6}}, {{-0.5, 0, 5}, {0.5, 1, 6}},
                                     {{14, 0, 5}, {15, 1, 6}}, {{-19, 0, 5}, {-18, 1, 6}}, {{5, 11, 5}, {6, 12, 6}}};
    static const char *const names[] = {"street", "hall", "cellar", "attic"};
    world_view *v = NULL;
    uint32_t zone, front, below;
    site_begin(s, 0);
    for (int i = 0; i < 4; i++) assert_int_equal(site_room(s, names[i], &zones[i], SCENE_NONE, &zone), RESULT_OK);
    assert_int_equal(site_door(s, "front-door", DOORS_OPEN, SCENE_NONE, &front), RESULT_OK);
    assert_int_equal(site_door(s, "cellar-door", DOORS_OPEN, SCENE_NONE, &below), RESULT_OK);
    assert_int_equal(site_portal(s, "front", &(site_hole){{STREET, HALL}, front, 0, 0, {0, 4}, {3, 7}}), RESULT_OK);
    assert_int_equal(site_portal(s, "stairs", &(site_hole){{HALL, CELLAR}, below, 0, 10, {0, 4}, {3, 7}}), RESULT_OK);
    for (int i = 0; i < 6; i++) assert_int_equal(site_item(s, &items[i]), RESULT_OK);
    assert_int_equal(site_end(s), RESULT_OK);
    if (site_open(s, &(site_world){.chain = chain, .more_movers = 4}) != RESULT_OK) fail_msg("%s", report_lines_only(&s->lines));
    assert_int_equal(world_view_open(s->world, VIEWER_CHECK_ALL, &s->lines.report, &v), RESULT_OK);
    return v;
}

static const double eye[3] = {-10, 1.5, 5}, inwards[3] = {1, 0, 0};
enum { TEXT = 4096 };

static void explain(world_view *v, const camera *c, uint32_t frame, uint32_t item, char text[TEXT])
{
    const frame_input q = site_input(c, frame);
    const explain_request e = {&q, item};
    const size_t length = world_explain(v, &e, text, TEXT);
    assert_int_equal(length, strlen(text));
    assert_int_equal(text[length - 1], '\n');
}

static void look_and_explain(const site *s, world_view *v, uint32_t item, char text[TEXT])
{
    static site_sight sight;
    const camera c = site_camera(eye, inwards);
    const frame_input q = site_input(&c, 1);
    site_look(s, v, &q, &sight);
    explain(v, &c, 1, item, text);
    if (item >= s->scene->item_count) return;
    if (!strstr(text, sight.items[item] ? "is drawn in zone" : "is not drawn")) fail_msg("%s", text);
}

static void assert_says(const char *text, const char *part)
{
    if (!strstr(text, part)) fail_msg("'%s' is not in: %s", part, text);
}

static void a_drawn_item_is_explained_by_the_portals_on_the_way_to_it(void **state)
{
    (void)state;
    static site s;
    char text[TEXT];
    world_view *v = open_house(&s, "frustum");
    look_and_explain(&s, v, BARREL, text);
    assert_says(text, "item 3 of object 'boxes' is drawn in zone 'cellar'");
    assert_says(text, "eye in 'street' -> portal 'front' (door 'front-door' open) -> 'hall' -> portal 'stairs' (door 'cellar-door' open) -> 'cellar'");
    assert_says(text, "culler 'frustum' kept it: drawn");
    assert_says(text, "'frustum' says: kept"); // its extension cull.explain/1
    look_and_explain(&s, v, LAMP, text);
    assert_says(text, "eye in 'street'\n");
    site_close(&s);
}

static void a_shut_door_is_named(void **state)
{
    (void)state;
    static site s;
    char text[TEXT];
    world_view *v = open_house(&s, "frustum");
    world_set_door(s.world, 1, DOORS_SHUT);
    look_and_explain(&s, v, BARREL, text);
    assert_says(text, "item 3 of object 'boxes' is not drawn");
    assert_says(text, "zone 'cellar' was not reached:");
    assert_says(text, "portal 'stairs' from 'hall' is shut by door 'cellar-door'");
    world_set_door(s.world, 1, DOORS_OPEN); // the text is of the last frame
    const camera c = site_camera(eye, inwards);
    explain(v, &c, 1, BARREL, text);
    assert_says(text, "is shut by door 'cellar-door'");
    world_set_door(s.world, 0, DOORS_SHUT);
    look_and_explain(&s, v, BARREL, text);
    assert_says(text, "portal 'stairs' from 'hall': 'hall' is not reached itself");
    site_close(&s);
}

static void a_portal_out_of_view_or_turned_away_and_a_zone_without_portals_are_named(void **state)
{
    (void)state;
    static site s;
    static site_sight sight;
    char text[TEXT];
    world_view *v = open_house(&s, "brute");
    const double outwards[3] = {-1, 0, 0};
    const camera c = site_camera(eye, outwards);
    const frame_input q = site_input(&c, 1);
    site_look(&s, v, &q, &sight);
    explain(v, &c, 1, TABLE, text);
    assert_says(text, "portal 'front' from 'street' is outside of all that is seen of 'street'");
    explain(v, &c, 1, CHEST, text);
    assert_says(text, "zone 'attic' was not reached:");
    assert_says(text, "no portal leads into it");
    site_close(&s);
}

static void a_plane_that_has_the_box_outside_is_told_with_metres(void **state)
{
    (void)state;
    static site s;
    char text[TEXT];
    double metres = 0;
    world_view *v = open_house(&s, "brute");
    look_and_explain(&s, v, BEHIND, text);
    assert_says(text, "item 4 of object 'boxes' is not drawn");
    assert_says(text, "zone 'street' was reached, seen through 1 volume:");
    assert_says(text, " m outside plane ");
    assert_says(text, "culler 'brute' dropped it");
    assert_int_equal(sscanf(strstr(text, "its box lies "), "its box lies %lf m", &metres), 1);
    assert_true(metres > 2 && metres < 8); // 8 m behind the eye, between side planes 37 degrees off
    site_close(&s);
}

static void a_filter_that_drops_is_named_and_so_is_the_zone_that_has_drawn_already(void **state)
{
    (void)state;
    static site s;
    char text[TEXT];
    world_view *v = open_house(&s, "frustum+testfilter[keep=even]");
    look_and_explain(&s, v, SILL, text); // place 1 of the street, place 1 of the hall
    (void)text;
    assert_says(text, "zone 'street' was reached");
    assert_says(text, "zone 'hall' was reached");
    chain_spec spec;
    site_parse(&s, "brute+testfilter[keep=even]", &spec);
    assert_int_equal(world_set_chain(s.world, STREET, &spec, &s.lines.report), RESULT_OK);
    site_parse(&s, "brute", &spec);
    assert_int_equal(world_set_chain(s.world, HALL, &spec, &s.lines.report), RESULT_OK);
    look_and_explain(&s, v, SILL, text); // place 1 of the street is dropped
    assert_says(text, "is drawn in zone 'hall'");
    assert_says(text, "culler 'brute' kept it\n    culler 'testfilter' dropped it");
    assert_int_equal(world_set_chain(s.world, STREET, &spec, &s.lines.report), RESULT_OK);
    const camera c = site_camera(eye, inwards);
    explain(v, &c, 1, SILL, text);
    assert_says(text, "its chain was swapped since");
    look_and_explain(&s, v, SILL, text);
    assert_says(text, "is drawn in zone 'street'");
    assert_says(text, "zone 'street' has drawn it already");
    site_close(&s);
}

static void a_culler_that_misbehaved_and_a_picture_in_its_place_are_told(void **state)
{
    (void)state;
    static site s;
    char text[TEXT];
    world_view *v = open_house(&s, "testbad[fault=run_wild]");
    look_and_explain(&s, v, BEHIND, text);
    assert_says(text, "misbehaved: the zone is drawn whole");
    site_close(&s);
}

static void movers_are_explained_behind_the_items(void **state)
{
    (void)state;
    static site s;
    char text[TEXT];
    uint32_t near, behind, hidden;
    world_view *v = open_house(&s, "brute");
    const double a[3] = {-5, 1, 5}, b[3] = {-19, 1, 5}, c[3] = {14, 1, 5};
    const double a2[3] = {-4, 2, 6}, b2[3] = {-18, 2, 6}, c2[3] = {15, 2, 6};
    assert_int_equal(world_mover_add(s.world, a, a2, &near), RESULT_OK);
    assert_int_equal(world_mover_add(s.world, b, b2, &behind), RESULT_OK);
    assert_int_equal(world_mover_add(s.world, c, c2, &hidden), RESULT_OK);
    world_set_door(s.world, 1, DOORS_SHUT);
    look_and_explain(&s, v, s.scene->item_count + near, text);
    assert_says(text, "is drawn");
    assert_says(text, "eye in 'street'");
    look_and_explain(&s, v, s.scene->item_count + behind, text);
    assert_says(text, "is not drawn");
    assert_says(text, " m outside plane ");
    look_and_explain(&s, v, s.scene->item_count + hidden, text);
    assert_says(text, "is shut by door 'cellar-door'");
    assert_int_equal(world_mover_remove(s.world, hidden), RESULT_OK);
    look_and_explain(&s, v, s.scene->item_count + hidden, text);
    assert_says(text, "does not exist");
    site_close(&s);
}

static void a_text_too_long_is_cut_and_its_length_told(void **state)
{
    (void)state;
    static site s;
    char text[TEXT], whole[TEXT];
    world_view *v = open_house(&s, "frustum");
    const camera c = site_camera(eye, inwards);
    explain(v, &c, 1, LAMP, text);
    assert_says(text, "has not been culled yet");
    look_and_explain(&s, v, BARREL, whole);
    const frame_input q = site_input(&c, 1);
    for (size_t size = 0; size < strlen(whole) + 3; size++) {
        memset(text, 'x', sizeof text);
        assert_int_equal(world_explain(v, &(explain_request){&q, BARREL}, text, size), strlen(whole));
        assert_int_equal(text[size], 'x');
        if (size) assert_int_equal(strlen(text), size - 1 < strlen(whole) ? size - 1 : strlen(whole));
        if (size) assert_memory_equal(text, whole, strlen(text));
    }
    explain(v, &c, 1, 12345, text);
    assert_says(text, "there is no item 12345");
    site_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_drawn_item_is_explained_by_the_portals_on_the_way_to_it),
        cmocka_unit_test(a_shut_door_is_named),
        cmocka_unit_test(a_portal_out_of_view_or_turned_away_and_a_zone_without_portals_are_named),
        cmocka_unit_test(a_plane_that_has_the_box_outside_is_told_with_metres),
        cmocka_unit_test(a_filter_that_drops_is_named_and_so_is_the_zone_that_has_drawn_already),
        cmocka_unit_test(a_culler_that_misbehaved_and_a_picture_in_its_place_are_told),
        cmocka_unit_test(movers_are_explained_behind_the_items),
        cmocka_unit_test(a_text_too_long_is_cut_and_its_length_told),
    };
    return cmocka_run_group_tests_name("world explain", tests, NULL, NULL);
}
