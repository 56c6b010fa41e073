// Tests of movers in views: found in every zone that is reached, decided about by cullers that take them, never lost.
// SPDX-License-Identifier: MIT
#include "site.h"
#include "tests/common/random.h"
#include "tests/common/test.h"

#include <math.h>
#include <string.h>

static const site_grid rooms = {.wide = 5, .deep = 4, .items = 100, .movers = 0, .seed = 71};
enum { ROOMS = 20 };

static world_view *open_world(site *s, const site_world *q)
{
    world_view *v = NULL;
    if (site_open(s, q) != RESULT_OK) fail_msg("%s", report_lines_only(&s->lines));
    assert_int_equal(world_view_open(s->world, VIEWER_CHECK_ALL, &s->lines.report, &v), RESULT_OK);
    return v;
}

static site_box random_box(uint64_t *random, double size)
{
    site_box b;
    for (int k = 0; k < 3; k++) {
        b.min[k] = random_between(random, -3, k == 1 ? 3 : 20);
        b.max[k] = b.min[k] + random_between(random, 0, size);
    }
    return b;
}

static void movers_that_come_go_jump_and_grow_are_those_of_a_loop_over_all(void **state)
{
    (void)state;
    static site s;
    static site_sight sight;
    static uint8_t wanted[SITE_MOVERS_MOST];
    enum { MOST = 400 };
    uint32_t numbers[MOST], count = 0, seen = 0;
    const char *chains[ROOMS + 1];
    for (uint32_t i = 0; i <= ROOMS; i++) chains[i] = i % 3 ? "brute" : "frustum+portal";
    site_begin(&s, 0);
    assert_int_equal(site_make_grid(&s, &rooms), RESULT_OK);
    world_view *v = open_world(&s, &(site_world){"brute", chains, MOST});
    uint64_t random = 31;
    for (uint32_t frame = 1; frame <= 200; frame++) {
        for (uint32_t i = 0; i < 20; i++) {
            const site_box b = random_box(&random, i == 0 ? 30 : 1.5);
            const uint32_t at = count ? random_below(&random, count) : 0;
            switch (random_below(&random, 4)) {
            case 0:
            case 1:
                if (count < MOST) assert_int_equal(world_mover_add(s.world, b.min, b.max, &numbers[count++]), RESULT_OK);
                break;
            case 2:
                if (count) assert_int_equal(world_mover_move(s.world, numbers[at], b.min, b.max), RESULT_OK);
                break;
            case 3:
                if (!count) break;
                assert_int_equal(world_mover_remove(s.world, numbers[at]), RESULT_OK);
                numbers[at] = numbers[--count];
                break;
            }
        }
        const camera c = site_random_camera(&random, &rooms);
        const frame_input q = site_input(&c, frame);
        site_look(&s, v, &q, &sight);
        site_oracle_movers(&s, v, wanted);
        uint32_t everywhere;
        const uint32_t *list = movers_everywhere(world_movers(s.world), &everywhere);
        for (uint32_t i = 0; i < SITE_MOVERS_MOST; i++) {
            int is_everywhere = 0; // the whole picture finds those: more than the volumes do
            for (uint32_t k = 0; k < everywhere; k++) is_everywhere |= list[k] == i;
            if (is_everywhere ? sight.movers[i] < wanted[i] : sight.movers[i] != wanted[i]) fail_msg("frame %u: mover %u: %u, %u wanted", frame, i, sight.movers[i], wanted[i]);
            seen += wanted[i];
        }
        assert_true(sight.stats.movers_tested >= sight.stats.movers_drawn);
    }
    assert_true(seen > 500);
    site_close(&s);
}

// ---- Two rooms of 8 m beside each other at x = 0, joined by a hole ----

static void begin_pair(site *s, double items_of_left)
{
    static const site_box left = {{-8, 0, 0}, {0, 4, 8}}, right = {{0, 0, 0}, {8, 4, 8}};
    uint32_t zones[2];
    site_begin(s, 0);
    assert_int_equal(site_room(s, "left", &left, SCENE_NONE, &zones[0]), RESULT_OK);
    assert_int_equal(site_room(s, "right", &right, SCENE_NONE, &zones[1]), RESULT_OK);
    assert_int_equal(site_portal(s, "hole", &(site_hole){{0, 1}, SCENE_NONE, 0, 0, {0, 1}, {3, 7}}), RESULT_OK);
    const site_box crate = {{4, 0, 4}, {5, 1, 5}}, other = {{-4, 0, 4}, {-3, 1, 5}};
    assert_int_equal(site_item(s, &crate), RESULT_OK);
    if (items_of_left > 0) assert_int_equal(site_item(s, &other), RESULT_OK);
}

static const double eye_left[3] = {-7.5, 2, 4}, to_right[3] = {1, 0, 0}, to_left[3] = {-1, 0, 0};

static uint32_t add(site *s, double x, double y, double z, double size)
{
    const double min[3] = {x, y, z}, max[3] = {x + size, y + size, z + size};
    uint32_t mover = SCENE_NONE;
    assert_int_equal(world_mover_add(s->world, min, max, &mover), RESULT_OK);
    return mover;
}

static void a_mover_that_one_zone_s_filter_drops_and_another_keeps_is_drawn(void **state)
{
    (void)state;
    static const char *const keepers[] = {"brute", "brute+testfilter[keep=all,movers=1]"};
    for (int n = 0; n < 2; n++) {
        static site s;
        static site_sight sight;
        begin_pair(&s, 1);
        assert_int_equal(site_end(&s), RESULT_OK);
        const char *chains[] = {"brute+testfilter[keep=all,movers=1]", keepers[n], "brute"};
        world_view *v = open_world(&s, &(site_world){"brute", chains, 8});
        (void)add(&s, -4, 1, 4, 0.5);
        (void)add(&s, -2, 1, 4, 0.5);
        const uint32_t both = add(&s, -0.25, 1, 4, 0.5); // in both rooms
        const camera c = site_camera(eye_left, to_right);
        frame_input q = site_input(&c, 1);
        site_look(&s, v, &q, &sight);
        const viewer *left = v->zones[0];
        const cull_mover *lent = left->visit.movers;
        assert_int_equal(left->visit.mover_count, 3); // it keeps the first and the third of them
        uint32_t dropped = 0;
        for (uint32_t i = 0; i < 3; i++) {
            const uint32_t slot = lent[i].id - left->chain->zone.item_count;
            const uint32_t mover = left->slot_movers.size ? ((const uint32_t *)left->slot_movers.items)[slot] : slot;
            if (i % 2 == 0 || mover == both) continue;
            dropped = 1;
            assert_int_equal(sight.movers[mover], 0);
        }
        assert_int_equal(sight.movers[both], 1); // in the right room it is the only one
        assert_int_equal(sight.stats.movers_drawn, dropped ? 2 : 3);
        site_close(&s);
    }
}

static void movers_past_the_slots_of_a_zone_are_drawn_and_counted(void **state)
{
    (void)state;
    static site s;
    static site_sight sight;
    enum { COUNT = 300, LENT = 256 };
    begin_pair(&s, 1);
    assert_int_equal(site_end(&s), RESULT_OK);
    const char *chains[] = {"brute+testfilter[keep=all,movers=1]", "brute", "brute"};
    world_view *v = open_world(&s, &(site_world){"brute", chains, 1000});
    for (uint32_t i = 0; i < COUNT; i++) (void)add(&s, -4 + 0.0078125 * i, 1, 4, 0.125);
    const camera c = site_camera(eye_left, to_right);
    const frame_input q = site_input(&c, 1);
    site_look(&s, v, &q, &sight);
    assert_int_equal(v->zones[0]->visit.mover_count, LENT);
    assert_int_equal(sight.stats.limits_hit, COUNT - LENT);
    assert_int_equal(sight.stats.movers_drawn, LENT / 2 + COUNT - LENT);
    assert_int_equal(sight.stats.faults, 0);
    site_close(&s);
}

static void a_mover_keeps_its_id_while_it_stays_in_the_zone(void **state)
{
    (void)state;
    static site s;
    static site_sight sight;
    enum { MOST = 600 };
    uint32_t numbers[MOST], count = 0, last_id[MOST];
    int in_left[MOST];
    begin_pair(&s, 1);
    assert_int_equal(site_end(&s), RESULT_OK);
    const char *chains[] = {"brute+testfilter[keep=all,movers=1]", "brute", "brute"};
    world_view *v = open_world(&s, &(site_world){"brute", chains, MOST});
    uint64_t random = 5;
    memset(in_left, 0, sizeof in_left);
    for (; count < MOST; count++) numbers[count] = add(&s, 4, 1, 1, 0.125); // in the right room
    for (uint32_t frame = 1; frame <= 150; frame++) {
        for (uint32_t i = 0; i < 60; i++) { // about 200 are in the left room
            const uint32_t mover = numbers[random_below(&random, count)];
            const int left = random_below(&random, 3) == 0;
            const double x = left ? random_between(&random, -4, -1) : 4, min[3] = {x, 1, 4}, max[3] = {x + 0.125, 1.25, 4.25};
            assert_int_equal(world_mover_move(s.world, mover, min, max), RESULT_OK);
            if (!left) in_left[mover] = 0;
            else if (!in_left[mover]) in_left[mover] = -1; // new there: its id is not known yet
        }
        const camera c = site_camera(eye_left, to_right);
        const frame_input q = site_input(&c, frame);
        site_look(&s, v, &q, &sight);
        const viewer *zone = v->zones[0];
        const cull_mover *lent = zone->visit.movers;
        uint8_t taken[1024] = {0};
        assert_true(zone->visit.mover_count < 256);
        for (uint32_t i = 0; i < zone->visit.mover_count; i++) {
            const uint32_t slot = lent[i].id - zone->chain->zone.item_count, mover = ((const uint32_t *)zone->slot_movers.items)[slot];
            assert_true(slot < 256);
            assert_false(taken[slot]);
            taken[slot] = 1;
            assert_true(in_left[mover] != 0);
            if (in_left[mover] > 0) assert_int_equal(last_id[mover], slot);
            in_left[mover] = 1;
            last_id[mover] = slot;
        }
    }
    site_close(&s);
}

static void a_mover_in_a_zone_without_items_or_larger_than_any_zone_is_found(void **state)
{
    (void)state;
    static site s;
    static site_sight sight;
    begin_pair(&s, 0); // the left room lists nothing
    assert_int_equal(site_end(&s), RESULT_OK);
    world_view *v = open_world(&s, &(site_world){.chain = "brute", .more_movers = 8});
    assert_null(world_chain(s.world, 0));
    const uint32_t small = add(&s, -2, 1, 4, 0.5), huge = add(&s, -500, -500, -500, 1000);
    const camera c = site_camera(eye_left, to_right);
    const frame_input q = site_input(&c, 1);
    site_look(&s, v, &q, &sight);
    assert_int_equal(sight.movers[small], 1);
    assert_int_equal(sight.movers[huge], 1);
    site_close(&s);
}

static void a_mover_in_too_many_zones_is_seen_from_each_of_them_and_not_from_behind(void **state)
{
    (void)state;
    static site s;
    static site_sight sight;
    site_begin(&s, 0);
    assert_int_equal(site_make_grid(&s, &rooms), RESULT_OK);
    world_view *v = open_world(&s, &(site_world){.chain = "brute", .more_movers = 2});
    uint32_t mover;
    const double min[3] = {0.5, 0.5, 0.5}, max[3] = {18, 1, 15}; // a floor through all rooms
    assert_int_equal(world_mover_add(s.world, min, max, &mover), RESULT_OK);
    uint32_t count;
    (void)movers_everywhere(world_movers(s.world), &count);
    assert_int_equal(count, 1);
    for (uint32_t room = 0; room < ROOMS; room++) {
        const double eye[3] = {4.0 * (room % 5) + 2, 2, 4.0 * (room / 5) + 2}, down[3] = {0.1, -1, 0};
        const camera c = site_camera(eye, down);
        const frame_input q = site_input(&c, 1 + room);
        site_look(&s, v, &q, &sight);
        assert_int_equal(sight.movers[mover], 1);
    }
    const double outside[3] = {-50, 2, 8};
    for (int n = 0; n < 2; n++) {
        const camera c = site_camera(outside, n ? to_left : to_right);
        const frame_input q = site_input(&c, 100);
        site_look(&s, v, &q, &sight);
        assert_int_equal(sight.movers[mover], n == 0);
    }
    site_close(&s);
}

static void a_door_moves_its_mover_and_paths_follow_the_time(void **state)
{
    (void)state;
    static site s;
    static const double aside[3] = {0, 0, 3};
    static const site_box leaf = {{-0.125, 0, 3}, {0.125, 3, 7}};
    double min[3], max[3];
    uint32_t door;
    begin_pair(&s, 1);
    assert_int_equal(site_mover(&s, "leaf", &leaf, aside), RESULT_OK);
    assert_int_equal(site_door(&s, "slide", DOORS_SHUT, 0, &door), RESULT_OK);
    const scene_key keys[2] = {{.time_s = 0}, {.time_s = 2, .offset = {0, 1, 0}}};
    static const site_box lift = {{4, 0, 1}, {5, 0.5, 2}};
    assert_int_equal(site_mover(&s, "lift", &lift, (double[3]){0, 0, 0}), RESULT_OK);
    assert_int_equal(scene_builder_mover_path(s.builder, 1, &(builder_path){keys, NULL, 2, 0}), RESULT_OK);
    assert_int_equal(site_end(&s), RESULT_OK);
    world_view *v = open_world(&s, &(site_world){.chain = "brute"});
    (void)v;
    assert_int_equal(movers_box(world_movers(s.world), 0, min, max), 1);
    assert_true(fabs(min[2] - 3) < 1e-3);
    world_set_door(s.world, door, DOORS_OPEN);
    assert_int_equal(movers_box(world_movers(s.world), 0, min, max), 1);
    assert_true(fabs(min[2] - 6) < 1e-3);
    world_set_door(s.world, door, DOORS_SHUT);
    assert_int_equal(movers_box(world_movers(s.world), 0, min, max), 1);
    assert_true(fabs(min[2] - 3) < 1e-3);
    world_set_time(s.world, 1);
    assert_int_equal(movers_box(world_movers(s.world), 1, min, max), 1);
    assert_true(fabs(min[1] - 0.5) < 1e-3);
    assert_true(fabs(world_poses(s.world)[1].offset[1] - 0.5) < 1e-3);
    // The scene's own movers are not the application's to move.
    assert_int_equal(world_mover_move(s.world, 0, min, max), RESULT_BAD_INPUT);
    assert_int_equal(world_mover_remove(s.world, 1), RESULT_BAD_INPUT);
    assert_int_equal(world_mover_move(s.world, 7, min, max), RESULT_BAD_INPUT);
    site_close(&s);
}

static void a_mover_that_is_not_a_box_is_refused_and_changes_nothing(void **state)
{
    (void)state;
    static site s;
    static site_sight sight;
    begin_pair(&s, 1);
    assert_int_equal(site_end(&s), RESULT_OK);
    world_view *v = open_world(&s, &(site_world){.chain = "brute", .more_movers = 1});
    const double good[3] = {-2, 1, 4}, larger[3] = {-1, 2, 5}, nan_at[3] = {NAN, 1, 4}, far_off[3] = {1e12, 1, 4};
    uint32_t mover = 99;
    assert_int_equal(world_mover_add(s.world, nan_at, larger, &mover), RESULT_BAD_INPUT);
    assert_int_equal(world_mover_add(s.world, larger, good, &mover), RESULT_BAD_INPUT);
    assert_int_equal(world_mover_add(s.world, good, larger, &mover), RESULT_OK);
    assert_int_equal(world_mover_move(s.world, mover, nan_at, larger), RESULT_BAD_INPUT);
    assert_int_equal(world_mover_move(s.world, mover, good, far_off), RESULT_BAD_INPUT);
    uint32_t second;
    assert_int_equal(world_mover_add(s.world, good, larger, &second), RESULT_BAD_INPUT); // no room
    camera c = site_camera(eye_left, to_right);
    frame_input q = site_input(&c, 1);
    site_look(&s, v, &q, &sight);
    assert_int_equal(sight.movers[mover], 1);
    c = site_camera(eye_left, to_left);
    q = site_input(&c, 2);
    site_look(&s, v, &q, &sight);
    assert_int_equal(sight.movers[mover], 0);
    assert_int_equal(world_mover_remove(s.world, mover), RESULT_OK);
    assert_int_equal(world_mover_remove(s.world, mover), RESULT_BAD_INPUT);
    site_close(&s);
}

static void room_for_absurdly_many_movers_is_refused(void **state)
{
    (void)state;
    static const uint32_t absurd[] = {UINT32_MAX, UINT32_MAX - 1, 1u << 24};
    static const double still[3] = {0, 0, 0};
    static const site_box lift = {{4, 0, 1}, {5, 0.5, 2}};
    for (int i = 0; i < 3; i++) {
        static site s;
        begin_pair(&s, 1);
        assert_int_equal(site_mover(&s, "lift", &lift, still), RESULT_OK);
        assert_int_equal(site_end(&s), RESULT_OK);
        assert_int_equal(site_open(&s, &(site_world){.chain = "brute", .more_movers = absurd[i]}), RESULT_BAD_INPUT);
        assert_true(report_lines_is_one_with(&s.lines, "ask for room for fewer"));
        site_close(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(movers_that_come_go_jump_and_grow_are_those_of_a_loop_over_all),
        cmocka_unit_test(a_mover_that_one_zone_s_filter_drops_and_another_keeps_is_drawn),
        cmocka_unit_test(movers_past_the_slots_of_a_zone_are_drawn_and_counted),
        cmocka_unit_test(a_mover_keeps_its_id_while_it_stays_in_the_zone),
        cmocka_unit_test(a_mover_in_a_zone_without_items_or_larger_than_any_zone_is_found),
        cmocka_unit_test(a_mover_in_too_many_zones_is_seen_from_each_of_them_and_not_from_behind),
        cmocka_unit_test(a_door_moves_its_mover_and_paths_follow_the_time),
        cmocka_unit_test(room_for_absurdly_many_movers_is_refused),
        cmocka_unit_test(a_mover_that_is_not_a_box_is_refused_and_changes_nothing),
    };
    return cmocka_run_group_tests_name("world movers", tests, NULL, NULL);
}
