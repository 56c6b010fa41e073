// Tests of the visible sets of worlds of many zones: chains mixed over them, against a plain loop over all items.
// SPDX-License-Identifier: MIT
#include "site.h"
#include "tests/common/random.h"
#include "tests/common/test.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const site_grid rooms = {.wide = 5, .deep = 4, .items = 900, .movers = 60, .seed = 41, .at = {-8, 0, -8}};
enum { ROOMS = 20, VIEWS = 150 };

static const char *const exact[] = {"brute", "frustum", "none", "brute+flood", "brute+testfilter[keep=right]", "frustum+flood", "none+testfilter[keep=right]",
                                   "brute+portal", "frustum+portal", "none+portal", "frustum+testfilter[keep=right]+portal"};
enum { EXACT = sizeof exact / sizeof *exact };

static void mixed(const char **chains, uint32_t count, uint64_t seed)
{
    for (uint32_t i = 0; i < count; i++) chains[i] = exact[random_below(&seed, EXACT)];
}

static void open_grid(site *s, const site_grid *g, const char *const *chains)
{
    site_begin(s, 0);
    assert_int_equal(site_make_grid(s, g), RESULT_OK);
    assert_int_equal(s->scene->zone_count - (s->scene->stray_items > 0), g->wide * g->deep);
    if (site_open(s, &(site_world){"brute", chains, 0}) != RESULT_OK) fail_msg("%s", report_lines_only(&s->lines));
}

static world_view *open_view(site *s)
{
    world_view *v = NULL;
    assert_int_equal(world_view_open(s->world, VIEWER_CHECK_ALL, &s->lines.report, &v), RESULT_OK);
    return v;
}

// Items and movers exactly as the oracle has them.
static uint32_t assert_sight(const site *s, world_view *v, const frame_input *q, const char *const *chains)
{
    static site_sight sight;
    static uint8_t items[SITE_ITEMS_MOST], movers_wanted[SITE_MOVERS_MOST];
    uint32_t seen = 0;
    site_look(s, v, q, &sight);
    site_oracle(s, v, chains, items);
    site_oracle_movers(s, v, movers_wanted);
    for (uint32_t i = 0; i < s->scene->item_count; i++)
        if (sight.items[i] != items[i]) fail_msg("frame %u: item %u is %d times in the set, %d wanted", q->frame.frame, i, sight.items[i], items[i]);
        else seen += items[i];
    for (uint32_t i = 0; i < SITE_MOVERS_MOST; i++)
        if (sight.movers[i] != movers_wanted[i]) fail_msg("frame %u: mover %u is %d times in the set, %d wanted", q->frame.frame, i, sight.movers[i], movers_wanted[i]);
    assert_int_equal(sight.stats.faults, 0);
    return seen;
}

static void the_set_of_mixed_chains_is_that_of_a_loop_over_all_zones(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 4; seed++) {
        static site s;
        const char *chains[ROOMS + 1];
        uint32_t seen = 0;
        mixed(chains, ROOMS + 1, seed);
        open_grid(&s, &rooms, chains);
        assert_true(s.world->shared_count > 50);
        world_view *v = open_view(&s);
        uint64_t random = seed;
        for (uint32_t frame = 1; frame <= VIEWS; frame++) {
            const camera c = site_random_camera(&random, &rooms);
            const frame_input q = site_input(&c, frame);
            seen += assert_sight(&s, v, &q, chains);
        }
        assert_true(seen > VIEWS * 5 && seen < VIEWS * rooms.items);
        site_close(&s);
    }
}

// Items that several zones list are looked up run by run: whatever order a culler gives those in.
static void runs_in_any_order_draw_each_shared_item_once(void **state)
{
    (void)state;
    static const char *const ways[] = {"testsingles[way=forwards]+portal", "testsingles[way=backwards]+portal", "testsingles[way=crossed]+portal"};
    static site whole, singles;
    static site_sight a, b;
    for (int way = 0; way < 3; way++) {
        const char *plain[ROOMS + 1], *single[ROOMS + 1];
        for (uint32_t i = 0; i <= ROOMS; i++) {
            plain[i] = "none+portal";
            single[i] = ways[way];
        }
        open_grid(&whole, &rooms, plain);
        open_grid(&singles, &rooms, single);
        assert_true(whole.world->shared_count > 50);
        world_view *x = open_view(&whole), *y = open_view(&singles);
        uint64_t random = 5;
        for (uint32_t frame = 1; frame <= 60; frame++) {
            const camera c = site_random_camera(&random, &rooms);
            const frame_input q = site_input(&c, frame);
            site_look(&whole, x, &q, &a);
            site_look(&singles, y, &q, &b);
            assert_memory_equal(a.items, b.items, sizeof a.items);
            for (uint32_t i = 0; i < whole.scene->item_count; i++) assert_true(b.items[i] <= 1);
        }
        site_close(&whole);
        site_close(&singles);
    }
}

static void far_from_the_world_s_origin_the_set_is_the_same(void **state)
{
    (void)state;
    static site near, far;
    site_grid moved = rooms;
    const char *chains[ROOMS + 1];
    static site_sight a, b;
    uint32_t differences = 0;
    mixed(chains, ROOMS + 1, 3);
    moved.at[0] += 1e7;
    moved.at[2] -= 1e7;
    open_grid(&near, &rooms, chains);
    open_grid(&far, &moved, chains);
    world_view *v = open_view(&near), *w = open_view(&far);
    uint64_t random = 5;
    for (uint32_t frame = 1; frame <= VIEWS; frame++) {
        camera c = site_random_camera(&random, &rooms);
        for (int k = 0; k < 3; k++) c.eye[k] = floor(c.eye[k] * 1024) / 1024; // exact far away too
        const frame_input q = site_input(&c, frame);
        site_look(&near, v, &q, &a);
        for (int k = 0; k < 3; k++) c.eye[k] += moved.at[k] - rooms.at[k];
        site_look(&far, w, &q, &b);
        assert_int_equal(a.stats.zones, b.stats.zones);
        for (uint32_t i = 0; i < near.scene->item_count; i++) differences += a.items[i] != b.items[i];
    }
    assert_int_equal(differences, 0);
    site_close(&near);
    site_close(&far);
}

// ---- Named cases: two rooms and what joins them ----

typedef struct pair { uint32_t left, right, doors[2]; } pair; // rooms of 8 m by 4 m by 8 m beside each other at x = 0

static const site_box left_room = {{-8, 0, 0}, {0, 4, 8}}, right_room = {{0, 0, 0}, {8, 4, 8}};

static void begin_pair(site *s, pair *p, uint32_t portals)
{
    site_begin(s, 0);
    assert_int_equal(site_room(s, "left", &left_room, SCENE_NONE, &p->left), RESULT_OK);
    assert_int_equal(site_room(s, "right", &right_room, SCENE_NONE, &p->right), RESULT_OK);
    for (uint32_t i = 0; i < portals; i++) {
        assert_int_equal(site_door(s, i ? "back" : "front", DOORS_OPEN, SCENE_NONE, &p->doors[i]), RESULT_OK);
        const site_hole hole = {{p->left, p->right}, p->doors[i], 0, 0, {0, i ? 5 : 1}, {2, i ? 7 : 3}};
        assert_int_equal(site_portal(s, i ? "back" : "front", &hole), RESULT_OK);
    }
    const site_box crates[] = {{{-4, 0, 1}, {-3, 1, 2}}, {{-0.5, 0.5, 1.5}, {0.5, 1, 2.5}}, {{4, 0, 1}, {5, 1, 2}}, {{4, 0, 5}, {5, 1, 6}}};
    for (uint32_t i = 0; i < 4; i++) assert_int_equal(site_item(s, &crates[i]), RESULT_OK); // left, in the doorway, right front, right back
}
enum { CRATE_LEFT, CRATE_DOORWAY, CRATE_FRONT, CRATE_BACK };

static void end_pair(site *s, const char *left, const char *right)
{
    const char *chains[] = {left, right, "brute"};
    assert_int_equal(site_end(s), RESULT_OK);
    if (site_open(s, &(site_world){"brute", chains, 8}) != RESULT_OK) fail_msg("%s", report_lines_only(&s->lines));
}

static const double eye_left[3] = {-7, 1, 4}, to_right[3] = {1, 0, 0};

static void an_item_in_two_zones_seen_through_two_portals_is_drawn_once(void **state)
{
    (void)state;
    static site s;
    static site_sight sight;
    static site_driver driver;
    pair p;
    begin_pair(&s, &p, 2);
    end_pair(&s, "brute+portal", "brute");
    world_view *v = open_view(&s);
    const camera c = site_camera(eye_left, to_right);
    frame_input q = site_input(&c, 1);
    site_driver_init(&driver, &s);
    q.driver = site_driver_of(&driver);
    site_look(&s, v, &q, &sight);
    assert_int_equal(s.world->shared_count, 1);
    assert_int_equal(sight.stats.zones, 2);
    assert_int_equal(world_view_flow(v)->zones[1].count, 2); // both portals count
    for (uint32_t i = 0; i < 4; i++) {
        assert_int_equal(sight.items[i], 1);
        assert_int_equal(driver.drawn[i], 1);
    }
    assert_int_equal(sight.set.zones[0].zone, p.left); // the doorway's crate stands with the near zone
    assert_int_equal(sight.set.zones[0].runs[0].count, 2);
    site_close(&s);
}

// Godot issue 51688: who only looked at an item took it from the one that sees it.
static void an_item_that_the_near_zone_drops_and_the_far_one_keeps_is_drawn(void **state)
{
    (void)state;
    static site s;
    static site_sight sight;
    pair p;
    begin_pair(&s, &p, 1);
    end_pair(&s, "brute+testfilter[keep=even]", "brute"); // drops place 1 of the left zone: the doorway's crate
    world_view *v = open_view(&s);
    const camera c = site_camera(eye_left, to_right);
    const frame_input q = site_input(&c, 1);
    site_look(&s, v, &q, &sight);
    assert_int_equal(sight.items[CRATE_LEFT], 1);
    assert_int_equal(sight.items[CRATE_DOORWAY], 1);
    assert_int_equal(sight.set.zone_count, 2);
    assert_int_equal(sight.set.zones[1].runs[0].first, 0); // by the far zone
    site_close(&s);
}

static void a_mover_over_the_top_of_the_door_is_found_from_both_rooms(void **state)
{
    (void)state;
    static site s;
    static site_sight sight;
    pair p;
    uint32_t mover;
    begin_pair(&s, &p, 1);
    end_pair(&s, "brute", "frustum");
    const double min[3] = {-0.5, 1.5, 1}, max[3] = {0.5, 3.5, 3}; // through the hole and the wall above it
    assert_int_equal(world_mover_add(s.world, min, max, &mover), RESULT_OK);
    world_view *v = open_view(&s);
    const double eye_right[3] = {7, 1, 2}, to_left[3] = {-1, 0, 0};
    for (uint32_t i = 0; i < 2; i++) {
        const camera c = site_camera(i ? eye_right : eye_left, i ? to_left : to_right);
        frame_input q = site_input(&c, 1 + i);
        site_look(&s, v, &q, &sight);
        assert_int_equal(sight.movers[mover], 1);
        world_set_door(s.world, p.doors[0], DOORS_SHUT); // it stands in both rooms, so a shut door takes it from neither
        site_look(&s, v, &q, &sight);
        assert_int_equal(sight.stats.zones, 1);
        assert_int_equal(sight.movers[mover], 1);
        world_set_door(s.world, p.doors[0], DOORS_OPEN);
    }
    site_close(&s);
}

static void a_shut_door_hides_what_is_behind_it_and_costs_neither_memory_nor_a_build(void **state)
{
    (void)state;
    static site s;
    static site_sight sight;
    pair p;
    begin_pair(&s, &p, 1);
    end_pair(&s, "brute", "frustum");
    world_view *v = open_view(&s);
    const chain *chains[2] = {world_chain(s.world, 0), world_chain(s.world, 1)};
    const uint64_t calls = s.memory.calls;
    const camera c = site_camera(eye_left, to_right);
    for (uint32_t frame = 1; frame <= 100; frame++) {
        const door_state door = frame % 2 ? DOORS_SHUT : DOORS_OPEN;
        world_set_door(s.world, p.doors[0], door);
        assert_int_equal(world_door(s.world, p.doors[0]), door);
        const frame_input q = site_input(&c, frame);
        site_look(&s, v, &q, &sight);
        assert_int_equal(sight.items[CRATE_FRONT], door == DOORS_OPEN);
        assert_int_equal(sight.items[CRATE_DOORWAY], 1); // it is in this room too
    }
    assert_int_equal(s.memory.calls, calls);
    assert_ptr_equal(chains[0], world_chain(s.world, 0));
    assert_ptr_equal(chains[1], world_chain(s.world, 1));
    site_close(&s);
}

static void six_faces_of_a_cube_see_every_item_of_the_room_and_no_face_another_s_history(void **state)
{
    (void)state;
    static site s;
    static site_sight sight;
    static const double faces[6][3] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    const char *chains[ROOMS + 1];
    uint8_t seen[SITE_ITEMS_MOST] = {0};
    mixed(chains, ROOMS + 1, 8);
    for (uint32_t i = 0; i <= ROOMS; i++) chains[i] = i % 2 ? "brute" : "frustum";
    open_grid(&s, &rooms, chains);
    world_view *views[6];
    const double eye[3] = {2, 1.5, 2}; // the middle of room (2, 2)
    for (uint32_t f = 0; f < 6; f++) {
        views[f] = open_view(&s);
        camera c = site_camera(eye, faces[f]);
        c.fovy_deg = 90;
        c.aspect = 1;
        if (f == 2 || f == 3) c.up[0] = 1, c.up[1] = 0;
        frame_input q = site_input(&c, 1);
        q.frame.purpose = CULL_VIEW_CUBE_FACE;
        q.frame.height_px = q.frame.width_px;
        site_look(&s, views[f], &q, &sight);
        (void)assert_sight(&s, views[f], &q, chains);
        for (uint32_t i = 0; i < s.scene->item_count; i++) seen[i] |= sight.items[i];
    }
    const zone_data *room = world_zone(s.world, 12);
    assert_true(room->zone.item_count > 10);
    for (uint32_t i = 0; i < room->zone.item_count; i++) assert_int_equal(seen[room->items[i]], 1);
    site_close(&s);
}

static void a_shadow_view_from_another_zone_beside_the_main_view_leaves_it_as_it_was(void **state)
{
    (void)state;
    static site s;
    static site_sight before, after;
    const char *chains[ROOMS + 1];
    mixed(chains, ROOMS + 1, 9);
    open_grid(&s, &rooms, chains);
    world_view *main_view = open_view(&s), *shadow = open_view(&s);
    uint64_t random = 77;
    for (uint32_t frame = 1; frame <= 50; frame++) {
        const camera c = site_random_camera(&random, &rooms);
        camera light = site_random_camera(&random, &rooms);
        light.far_m = 10;
        const frame_input q = site_input(&c, frame);
        frame_input from_light = site_input(&light, frame);
        from_light.frame.purpose = CULL_VIEW_SHADOW;
        site_look(&s, main_view, &q, &before);
        (void)assert_sight(&s, shadow, &from_light, chains);
        site_look(&s, main_view, &q, &after);
        assert_memory_equal(before.items, after.items, sizeof before.items);
        assert_memory_equal(before.movers, after.movers, sizeof before.movers);
    }
    site_close(&s);
}

static void two_eyes_a_hand_apart_each_see_what_is_theirs(void **state)
{
    (void)state;
    static site s;
    const char *chains[ROOMS + 1];
    mixed(chains, ROOMS + 1, 10);
    open_grid(&s, &rooms, chains);
    world_view *eyes[2] = {open_view(&s), open_view(&s)};
    uint64_t random = 78;
    for (uint32_t frame = 1; frame <= 50; frame++) {
        const camera c = site_random_camera(&random, &rooms);
        double right[3], up[3], back[3];
        camera_axes(&c, right, up, back);
        for (int eye = 0; eye < 2; eye++) {
            camera at = c;
            for (int k = 0; k < 3; k++) at.eye[k] += right[k] * (eye ? 0.032 : -0.032);
            const frame_input q = site_input(&at, frame);
            (void)assert_sight(&s, eyes[eye], &q, chains);
        }
    }
    site_close(&s);
}

static void an_eye_outside_every_zone_sees_every_zone(void **state)
{
    (void)state;
    static site s;
    const char *chains[ROOMS + 1];
    mixed(chains, ROOMS + 1, 11);
    open_grid(&s, &rooms, chains);
    world_view *v = open_view(&s);
    const double eye[3] = {-60, 30, -60}, forward[3] = {1, -0.5, 1};
    const camera c = site_camera(eye, forward);
    const frame_input q = site_input(&c, 1);
    assert_true(assert_sight(&s, v, &q, chains) > 100);
    assert_int_equal(world_view_flow(v)->is_everything, 1);
    site_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_set_of_mixed_chains_is_that_of_a_loop_over_all_zones),
        cmocka_unit_test(runs_in_any_order_draw_each_shared_item_once),
        cmocka_unit_test(far_from_the_world_s_origin_the_set_is_the_same),
        cmocka_unit_test(an_item_in_two_zones_seen_through_two_portals_is_drawn_once),
        cmocka_unit_test(an_item_that_the_near_zone_drops_and_the_far_one_keeps_is_drawn),
        cmocka_unit_test(a_mover_over_the_top_of_the_door_is_found_from_both_rooms),
        cmocka_unit_test(a_shut_door_hides_what_is_behind_it_and_costs_neither_memory_nor_a_build),
        cmocka_unit_test(six_faces_of_a_cube_see_every_item_of_the_room_and_no_face_another_s_history),
        cmocka_unit_test(a_shadow_view_from_another_zone_beside_the_main_view_leaves_it_as_it_was),
        cmocka_unit_test(two_eyes_a_hand_apart_each_see_what_is_theirs),
        cmocka_unit_test(an_eye_outside_every_zone_sees_every_zone),
    };
    return cmocka_run_group_tests_name("world sets", tests, NULL, NULL);
}
