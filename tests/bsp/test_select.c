// Tests of bsp's select: the set is that of a loop over the items, whatever the tree, the options and the number of volumes.
// SPDX-License-Identifier: MIT
#include "select_fixture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ITEMS_MOST = 400 };
static const bsp_values all_values[] = {
    {"0", "0", "balance", "off", "auto"}, {"0", "0", "sah", "off", "plain"}, {"0", "0", "first", "off", "auto"},
    {"0", "1", "balance", "off", "auto"}, {"0", "node", "balance", "off", "plain"},
};
enum { VALUES_COUNT = sizeof all_values / sizeof *all_values };

static void must_be_the_loop_set(session *s, culler_host *h, const cull_zone *zone, const made_view *v)
{
    static uint8_t expected[ITEMS_MOST], seen[ITEMS_MOST];
    const uint64_t allocations = h->memory.calls;
    session_select(s, &v->view, v->volumes, v->volume_count);
    assert_true(h->memory.calls == allocations);
    const char *wrong = session_set_any_order(s, seen);
    if (wrong) fail_msg("%s", wrong);
    loop_set(zone, v, expected);
    for (uint32_t i = 0; i < zone->item_count; i++)
        if (seen[i] != expected[i]) fail_msg("item %u of %u: select %u, the loop %u", i, zone->item_count, seen[i], expected[i]);
}

static void select_is_the_set_of_a_loop_over_the_items(void **state)
{
    (void)state;
    static const uint32_t counts[] = {0, 1, 2, 7, 24, 25, 60, 200, ITEMS_MOST};
    uint64_t r = {41};
    for (int kind = 0; kind < SCENE_KIND_COUNT; kind++)
        for (size_t c = 0; c < sizeof counts / sizeof *counts; c++) {
            hand_zone w;
            scene_fill(&r, (scene_kind)kind, counts[c], &w);
            for (int o = 0; o < VALUES_COUNT; o++) {
                culler_host h;
                session s;
                culler_host_init(&h, 0);
                assert_int_equal(bsp_open(&s, &h, &w.zone, &all_values[o]), CULL_OK);
                for (int q = 0; q < 25; q++) {
                    static made_view v;
                    view_fill(&r, &w.zone, q % 3 ? 1 : (uint32_t)(random_bits(&r) % (VIEW_VOLUMES_MOST + 1)), &v);
                    must_be_the_loop_set(&s, &h, &w.zone, &v);
                }
                session_close(&s);
                assert_int_equal(h.memory.live_blocks, 0);
                assert_int_equal(h.memory.live_bytes, 0);
            }
            hand_zone_free(&w);
        }
}

static void what_lies_inside_a_volume_is_found(void **state)
{
    (void)state;
    uint64_t r = {42};
    uint32_t inside = 0;
    for (int kind = 0; kind < SCENE_KIND_COUNT; kind++) {
        hand_zone w;
        culler_host h;
        session s;
        scene_fill(&r, (scene_kind)kind, 120, &w);
        culler_host_init(&h, 0);
        assert_int_equal(bsp_open(&s, &h, &w.zone, &all_values[0]), CULL_OK);
        for (int q = 0; q < 60; q++) {
            static made_view v;
            static uint8_t seen[ITEMS_MOST];
            view_fill(&r, &w.zone, 1 + (uint32_t)q % 2, &v);
            session_select(&s, &v.view, v.volumes, v.volume_count);
            assert_null(session_set_any_order(&s, seen));
            for (uint32_t i = 0; i < w.zone.item_count; i++) {
                if (!item_is_inside(&w.zone, i, &v, 0)) continue;
                inside++;
                assert_int_equal(seen[i], 1);
            }
        }
        session_close(&s);
        hand_zone_free(&w);
    }
    assert_true(inside > 1000);
}

static void walls_seen_from_behind_are_those_that_frustum_drops(void **state)
{
    (void)state;
    const cull_plugin *frustum = plugin_named("frustum");
    const bsp_values values = {"1", "0", "balance", "off", "auto"}, plain = {"1", "0", "balance", "off", "plain"};
    const char *of_frustum[] = {"1", "auto"};
    uint64_t r = {43};
    uint32_t dropped = 0, fewer = 0;
    if (!frustum) skip();
    for (int kind = 0; kind < SCENE_KIND_COUNT; kind++) {
        hand_zone w;
        culler_host h;
        session s[3];
        scene_fill(&r, (scene_kind)kind, 300, &w);
        culler_host_init(&h, 0);
        assert_int_equal(bsp_open(&s[0], &h, &w.zone, &values), CULL_OK);
        assert_int_equal(bsp_open(&s[1], &h, &w.zone, &plain), CULL_OK);
        assert_int_equal(session_open(&s[2], &h, frustum, &w.zone, of_frustum), CULL_OK);
        for (int q = 0; q < 150; q++) {
            static made_view v;
            static uint8_t seen[3][ITEMS_MOST], loop[ITEMS_MOST], everything[ITEMS_MOST];
            const cull_volume all = {NULL, 0, 0};
            view_fill(&r, &w.zone, 1 + (uint32_t)q % 3, &v);
            if (q % 5 == 4) v.view.eye[3] = 0; // a direction
            for (int i = 0; i < 3; i++) {
                session_select(&s[i], &v.view, v.volumes, v.volume_count);
                assert_null(session_set_any_order(&s[i], seen[i]));
            }
            session_select(&s[2], &v.view, &all, 1);
            assert_null(session_set_any_order(&s[2], everything));
            loop_set(&w.zone, &v, loop);
            for (uint32_t i = 0; i < w.zone.item_count; i++) {
                assert_int_equal(seen[0][i], loop[i] & everything[i]);
                assert_int_equal(seen[1][i], seen[0][i]);
                assert_true(seen[0][i] <= seen[2][i]);
                dropped += !everything[i];
                fewer += seen[0][i] < seen[2][i];
            }
        }
        for (int i = 0; i < 3; i++) session_close(&s[i]);
        hand_zone_free(&w);
    }
    assert_true(dropped > 10000 && fewer > 100); // the polygon's clip drops what a box's test keeps
}

static void the_order_of_the_items_and_a_scale_by_a_power_of_two_change_nothing(void **state)
{
    (void)state;
    uint64_t r = {44};
    static const float scales[] = {1, 0x1p-6f, 0x1p7f};
    for (int turn = 0; turn < 6; turn++) {
        hand_zone a, b;
        culler_host h;
        session sa, sb;
        uint32_t places[ITEMS_MOST];
        const float scale = scales[turn % 3];
        scene_fill(&r, turn % 2 ? SCENE_MIXED : SCENE_ROOMS, 150, &a);
        for (uint32_t i = 0; i < a.zone.item_count; i++) places[i] = i;
        for (uint32_t i = a.zone.item_count - 1; i > 0; i--) {
            const uint32_t j = (uint32_t)(random_bits(&r) % (i + 1)), spare = places[i];
            places[i] = places[j];
            places[j] = spare;
        }
        zone_changed(&a, places, scale, &b);
        culler_host_init(&h, 0);
        assert_int_equal(bsp_open(&sa, &h, &a.zone, &all_values[0]), CULL_OK);
        assert_int_equal(bsp_open(&sb, &h, &b.zone, &all_values[0]), CULL_OK);
        for (int q = 0; q < 40; q++) {
            static made_view v;
            static uint8_t seen_a[ITEMS_MOST], seen_b[ITEMS_MOST];
            view_fill(&r, &a.zone, 2, &v);
            session_select(&sa, &v.view, v.volumes, 2);
            assert_null(session_set_any_order(&sa, seen_a));
            for (int k = 0; k < 3; k++) v.view.eye[k] *= scale;
            for (int p = 0; p < 2; p++)
                for (uint32_t k = 0; k < v.parts[p].plane_count; k++) v.parts[p].planes[k].offset *= scale;
            session_select(&sb, &v.view, v.volumes, 2);
            assert_null(session_set_any_order(&sb, seen_b));
            for (uint32_t i = 0; i < a.zone.item_count; i++) assert_int_equal(seen_a[i], seen_b[places[i]]);
        }
        session_close(&sa);
        session_close(&sb);
        hand_zone_free(&a);
        hand_zone_free(&b);
    }
}

static void a_smaller_volume_and_fewer_volumes_give_a_subset(void **state)
{
    (void)state;
    uint64_t r = {45};
    hand_zone w;
    culler_host h;
    session s;
    scene_fill(&r, SCENE_MIXED, 250, &w);
    culler_host_init(&h, 0);
    assert_int_equal(bsp_open(&s, &h, &w.zone, &all_values[0]), CULL_OK);
    for (int q = 0; q < 200; q++) {
        static made_view v;
        static uint8_t whole[ITEMS_MOST], part[ITEMS_MOST];
        view_fill(&r, &w.zone, 3, &v);
        session_select(&s, &v.view, v.volumes, 3);
        assert_null(session_set_any_order(&s, whole));
        if (q % 2)
            for (int p = 0; p < 3; p++)
                for (uint32_t k = 0; k < v.parts[p].plane_count; k++) v.parts[p].planes[k].offset -= 0.25f;
        session_select(&s, &v.view, v.volumes, q % 2 ? 3 : 2);
        assert_null(session_set_any_order(&s, part));
        for (uint32_t i = 0; i < w.zone.item_count; i++) assert_true(part[i] <= whole[i]);
    }
    session_close(&s);
    hand_zone_free(&w);
}

static void cells_only_take_away(void **state)
{
    (void)state;
    static const char *const ways[] = {"off", "rect", "hull", "exact"};
    uint64_t r = {47};
    for (int kind = 0; kind < SCENE_KIND_COUNT; kind++) {
        hand_zone w;
        culler_host h;
        session s[4];
        scene_fill(&r, (scene_kind)kind, 80, &w);
        culler_host_init(&h, 0);
        for (int i = 0; i < 4; i++) {
            const bsp_values values = {"1", "0", "balance", ways[i], i % 2 ? "plain" : "auto"};
            assert_int_equal(bsp_open(&s[i], &h, &w.zone, &values), CULL_OK);
        }
        for (int q = 0; q < 60; q++) {
            static made_view v;
            static uint8_t seen[4][ITEMS_MOST];
            view_fill(&r, &w.zone, q % 5 ? 1 : (uint32_t)(random_bits(&r) % VIEW_VOLUMES_MOST), &v);
            if (q % 7 == 6) v.view.eye[3] = (float)(v.view.eye_exact[3] = 0); // no eye at a point: the tree is walked
            for (int i = 0; i < 4; i++) {
                const uint64_t allocations = h.memory.calls;
                session_select(&s[i], &v.view, v.volumes, v.volume_count);
                assert_true(h.memory.calls == allocations);
                assert_null(session_set_any_order(&s[i], seen[i]));
                for (uint32_t k = 0; k < w.zone.item_count; k++) assert_true(seen[i][k] <= seen[0][k]);
                if (q % 7 == 6) assert_memory_equal(seen[i], seen[0], w.zone.item_count);
            }
        }
        for (int i = 0; i < 4; i++) session_close(&s[i]);
        assert_int_equal(h.memory.live_blocks, 0);
        hand_zone_free(&w);
    }
}

// Rooms in a row, the eye at either end.
static void what_is_near_comes_before_what_is_far(void **state)
{
    (void)state;
    enum { ROOMS = 60, LEAF_ROOMS = 9 }; // items of one leaf come in any order
    hand_zone w;
    culler_host h;
    session s;
    hand_zone_open(&w, 6 * ROOMS, 24 * ROOMS);
    for (int room = 0; room < ROOMS; room++)
        for (int i = 0; i < 6; i++) {
            const float x = (float)(4 * room) + 0.5f * (float)i, z = i % 2 ? 1.0f : -1.0f;
            const cull_vec3 points[4] = {{x, 0, z}, {x, 2, z}, {x, 2, -z}, {x, 0, -z}};
            hand_zone_wall(&w, points, 4, CULL_ITEM_TWO_SIDED);
        }
    hand_zone_end(&w);
    culler_host_init(&h, 0);
    for (int o = 0; o < VALUES_COUNT; o++) {
        assert_int_equal(bsp_open(&s, &h, &w.zone, &all_values[o]), CULL_OK);
        for (int end = 0; end < 2; end++) {
            const float sign = end ? -1.0f : 1.0f;
            const cull_plane ahead = {{sign, 0, 0}, end ? 4 * ROOMS + 10 : 10}; // all are
            const cull_volume volume = {&ahead, 1, 0};
            const cull_view view = {.eye = {end ? 4 * ROOMS + 9 : -9, 1, 0, 1}};
            uint32_t farthest = 0, items = 0;
            session_select(&s, &view, &volume, 1);
            for (uint32_t i = 0; i < s.run_count; i++)
                for (uint32_t k = 0; k < s.runs[i].count; k++, items++) {
                    const uint32_t room = s.built.order[s.runs[i].first + k] / 6, away = end ? ROOMS - 1 - room : room;
                    if (s.run_count == 1) continue; // all in one run: the order of the zone
                    assert_true(away + LEAF_ROOMS >= farthest);
                    farthest = away > farthest ? away : farthest;
                }
            assert_int_equal(items, 6 * ROOMS);
        }
        session_close(&s);
    }
    hand_zone_free(&w);
}

static void a_triangle_beside_the_loop_is_found_too(void **state)
{
    (void)state;
    const cull_vec3 loop[4] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, far_corner = {9, 9, 0};
    const cull_plane far_end = {{1, 0, 0}, -5}, beside_it = {{0.6f, -0.8f, 0}, -0.7f}; // x >= 5; the box reaches there, the triangle doesn't
    const cull_view view = {.eye = {0, 0, 5, 1}};
    for (int beside = 0; beside < 2; beside++) {
        hand_zone w;
        culler_host h;
        session s;
        uint8_t seen[1];
        hand_zone_open(&w, 2, 8);
        hand_zone_wall(&w, loop, 4, 0);
        w.positions[w.zone.position_count++] = far_corner;
        w.rows[3][0] = w.rows[4][0] = 9; // its box
        hand_zone_end(&w);
        if (beside) w.indices[4] = 4; // (0,0) (9,9) (0,1)
        culler_host_init(&h, 0);
        assert_int_equal(bsp_open(&s, &h, &w.zone, &all_values[0]), CULL_OK);
        for (int at = 0; at < 2; at++) {
            const cull_volume volume = {at ? &beside_it : &far_end, 1, 0};
            session_select(&s, &view, &volume, 1);
            assert_null(session_set_any_order(&s, seen));
            assert_int_equal(seen[0], beside && !at);
        }
        session_close(&s);
        hand_zone_free(&w);
    }
}

static void bad_options_are_refused_with_the_legal_values(void **state)
{
    (void)state;
    const bsp_values bad[] = {{"2", "0", "balance", "off", "auto"}, {"0", "2", "balance", "off", "auto"}, {"0", "0", "best", "off", "auto"},
                              {"0", "0", "balance", "on", "auto"}, {"0", "0", "balance", "off", "mmx"}};
    static const char *const says[] = {"backface=2: must be 0 or 1", "split=2: must be 0, 1 or node", "choose=best: must be balance, sah or first",
                                       "cells=on: must be off, rect, hull or exact", "isa=mmx: must be auto, avx2 or plain"};
    hand_zone w;
    culler_host h;
    session s;
    hand_zone_open(&w, 0, 0);
    hand_zone_end(&w);
    culler_host_init(&h, 0);
    for (int i = 0; i < 5; i++) {
        assert_int_equal(bsp_open(&s, &h, &w.zone, &bad[i]), CULL_ERR_OPTION);
        if (!strstr(h.last_line, says[i])) fail_msg("%s", h.last_line);
    }
    assert_int_equal(h.memory.live_blocks, 0);
    hand_zone_free(&w);
}

static void every_allocation_may_fail_and_nothing_is_lost(void **state)
{
    (void)state;
    const bsp_values values[] = {{"1", "0", "balance", "off", "auto"}, {"1", "1", "sah", "off", "auto"}, {"0", "node", "first", "off", "auto"},
                                 {"1", "0", "balance", "exact", "auto"}};
    uint64_t r = {46};
    hand_zone w;
    scene_fill(&r, SCENE_MIXED, 40, &w);
    for (int o = 0; o < 4; o++) {
        uint64_t failures = 0;
        for (uint64_t k = 1;; k++) {
            culler_host h;
            session s;
            culler_host_init(&h, 0);
            h.memory.fail_at = k;
            const cull_result result = bsp_open(&s, &h, &w.zone, &values[o]);
            if (result == CULL_OK) session_close(&s);
            assert_int_equal(h.memory.live_blocks, 0);
            assert_int_equal(h.memory.live_bytes, 0);
            if (result == CULL_OK) break;
            assert_int_equal(result, CULL_ERR_MEMORY);
            failures++;
        }
        assert_true(failures > 20);
    }
    hand_zone_free(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(select_is_the_set_of_a_loop_over_the_items),
        cmocka_unit_test(what_lies_inside_a_volume_is_found),
        cmocka_unit_test(walls_seen_from_behind_are_those_that_frustum_drops),
        cmocka_unit_test(the_order_of_the_items_and_a_scale_by_a_power_of_two_change_nothing),
        cmocka_unit_test(a_smaller_volume_and_fewer_volumes_give_a_subset),
        cmocka_unit_test(cells_only_take_away),
        cmocka_unit_test(what_is_near_comes_before_what_is_far),
        cmocka_unit_test(a_triangle_beside_the_loop_is_found_too),
        cmocka_unit_test(bad_options_are_refused_with_the_legal_values),
        cmocka_unit_test(every_allocation_may_fail_and_nothing_is_lost),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
