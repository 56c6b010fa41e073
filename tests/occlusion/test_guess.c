// History is a guess, one viewer's own, and worth its cost: views never mix, frames repeat, tests stop where they do not pay.
// SPDX-License-Identifier: MIT
#include "fake_host.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "plugins/occlusion/ledger.h"

// Of tests that each take away `gained` polygons, and of which `shown` polygons are left.
static int zone_pays(uint32_t gained, uint32_t shown)
{
    ledger_page zone = {0};
    for (int i = 0; i < 100; i++) ledger_enter_zone(&zone, LEDGER_TEST, gained);
    ledger_show(&zone, shown * 100);
    return ledger_zone_pays(&zone);
}

static void a_zone_pays_whose_tests_bring_in_a_fifth_of_what_is_looked_at(void **state)
{
    (void)state;
    assert_true(zone_pays(2, 8));
    assert_false(zone_pays(2, 9));
    assert_true(zone_pays(1, 0)); // a test is worth two polygons
    assert_false(zone_pays(0, 0));
}

static void a_zone_at_rest_is_tested_again_when_its_pause_is_over_and_much_is_hidden(void **state)
{
    ledger_page zone = {0};
    (void)state;
    ledger_rest(&zone, 100);
    assert_true(ledger_rests(&zone, 101));
    for (int i = 0; i < 30; i++) ledger_enter_zone(&zone, LEDGER_TEST, 10);
    ledger_show(&zone, 600);
    assert_true(ledger_rests(&zone, 107));
    assert_false(ledger_rests(&zone, 109));
    ledger_rest(&zone, 200); // the next pause is longer
    assert_true(ledger_rests(&zone, 215));
    for (int i = 0; i < 30; i++) ledger_enter_zone(&zone, LEDGER_TEST, 10);
    assert_false(ledger_rests(&zone, 202)); // all of it hidden: at once
}

// A field of low boxes seen from above, none behind another; `wall`: and a wall at z = -3 that hides it from before.
static void field_make(hand_zone *z, int has_wall)
{
    enum { SIDE = 16 };
    cull_box boxes[SIDE * SIDE + 1];
    uint32_t count = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        const float x = (float)(i % SIDE * 4 - SIDE * 2), zz = (float)(i / SIDE * 4);
        boxes[count++] = (cull_box){{x, 0, zz}, {x + 3.5f, 0.2f, zz + 3.5f}};
    }
    if (has_wall) boxes[count++] = (cull_box){{-200, 0, -3}, {200, 8, -2.5f}};
    zone_of_boxes(boxes, count, z);
    z->zone.mover_capacity = FAKE_MOVERS_MOST;
}

static void where_nothing_is_hidden_it_stops_asking(void **state)
{
    hand_zone z;
    fake_culler c;
    fake_viewer v;
    uint32_t asked = 0, waits = 0, most = 0;
    (void)state;
    field_make(&z, 0);
    for (int chain = CHAIN_SELECT; chain <= CHAIN_CANDIDATES; chain++) {
        assert_int_equal(fake_culler_open(&c, &z, "twophase", (fake_chain)chain, 0), CULL_OK);
        fake_viewer_open(&v, &c);
        asked = waits = most = 0;
        for (int f = 0; f < 80; f++) {
            static fake_view view;
            fake_view_make(&view, (cull_vec3){(float)f * 0.1f, 85, 28}, 0, -1.5);
            assert_null(fake_frame(&v, &view, f == 0 ? CULL_VIEW_CUT : 0));
            if (f < 10) continue;
            asked += v.tests_asked;
            waits += v.waits;
            most = v.drawn_count > most ? v.drawn_count : most;
        }
        assert_true(most > 150);
        assert_true(asked / 70 < most / 8);
        assert_true(waits < 35);
        fake_viewer_close(&v);
        fake_culler_close(&c);
    }
    hand_zone_free(&z);
}

static void it_asks_again_when_things_come_to_be_hidden(void **state)
{
    hand_zone z;
    fake_culler c;
    fake_viewer v;
    static fake_view above, before;
    uint32_t drawn = 0;
    (void)state;
    field_make(&z, 1);
    fake_view_make(&above, (cull_vec3){0, 40, -20}, 0, -0.8);
    fake_view_make(&before, (cull_vec3){0, 1.5f, -12}, 0, 0);
    assert_int_equal(fake_culler_open(&c, &z, "twophase", CHAIN_SELECT, 0), CULL_OK);
    fake_viewer_open(&v, &c);
    for (int f = 0; f < 60; f++) assert_null(fake_frame(&v, &above, 0));
    for (int f = 0; f < 70; f++) assert_null(fake_frame(&v, &before, 0));
    for (int f = 0; f < 20; f++) {
        assert_null(fake_frame(&v, &before, 0));
        drawn = v.drawn_count > drawn ? v.drawn_count : drawn;
    }
    assert_true(drawn < 10);
    fake_viewer_close(&v);
    fake_culler_close(&c);
    hand_zone_free(&z);
}

static void views_of_one_culler_do_not_mix(void **state)
{
    hand_zone z;
    fake_culler c;
    fake_viewer a, b, alone;
    (void)state;
    field_make(&z, 1);
    assert_int_equal(fake_culler_open(&c, &z, "twophase", CHAIN_LENT, 0), CULL_OK);
    fake_viewer_open(&a, &c);
    fake_viewer_open(&b, &c);
    fake_viewer_open(&alone, &c);
    for (int f = 0; f < 20; f++) {
        static fake_view first, second;
        fake_view_make(&first, (cull_vec3){(float)f * 0.2f, 3, -8}, 0.1, -0.2);
        fake_view_make(&second, (cull_vec3){0, 30, (float)f}, 2, -0.9);
        assert_null(fake_frame(&a, &first, 0));
        assert_null(fake_frame(&b, &second, 0));
        assert_null(fake_frame(&alone, &first, 0));
        assert_memory_equal(a.drawn, alone.drawn, z.zone.item_count);
        assert_int_equal(a.tests_asked, alone.tests_asked);
        assert_int_equal(a.steps, alone.steps);
    }
    fake_viewer_close(&a);
    fake_viewer_close(&b);
    fake_viewer_close(&alone);
    fake_culler_close(&c);
    hand_zone_free(&z);
}

static void a_frame_broken_off_leaves_no_trace_in_the_next(void **state)
{
    hand_zone z;
    fake_culler c;
    fake_viewer v;
    static fake_view view;
    (void)state;
    field_make(&z, 1);
    fake_view_make(&view, (cull_vec3){0, 3, -8}, 0.1, -0.2);
    assert_int_equal(fake_culler_open(&c, &z, "twophase", CHAIN_SELECT, 0), CULL_OK);
    fake_viewer_open(&v, &c);
    for (int f = 0; f < 12; f++) {
        uint8_t visible[600];
        assert_null(fake_frame_cut(&v, &view, 0, 1));
        assert_null(fake_frame(&v, &view, 0));
        fake_truth(&v, &view, visible);
        for (uint32_t i = 0; i < z.zone.item_count; i++) assert_true(!visible[i] || v.drawn[i]);
    }
    fake_viewer_close(&v);
    fake_culler_close(&c);
    hand_zone_free(&z);
}

// Far off it fills few cells of the coarse picture, which leave it for a test: of its parts, as it was found seen.
static void a_far_zone_is_tested_whole_once(void **state)
{
    hand_zone z;
    fake_culler c;
    fake_viewer v;
    static fake_view view;
    cull_box boxes[400], all = {{0, 0, 300}, {0, 0, 300}};
    (void)state;
    for (int i = 0; i < 400; i++) {
        const float x = (float)(i % 20) * 2, zz = (float)(i / 20) * 2 + 300;
        boxes[i] = (cull_box){{x, 0, zz}, {x + 1, 20, zz + 1}};
        all = cull_box_union(all, boxes[i]);
    }
    zone_of_boxes(boxes, 400, &z);
    z.zone.mover_capacity = FAKE_MOVERS_MOST;
    fake_view_make(&view, (cull_vec3){0, 0.5f, 0}, 0, 0);
    assert_int_equal(fake_culler_open(&c, &z, "twophase", CHAIN_SELECT, 0), CULL_OK);
    fake_viewer_open(&v, &c);
    assert_null(fake_frame_cut(&v, &view, 0, 1));
    assert_int_equal(v.tests_asked, 1);
    assert_memory_equal(&v.tests[0].box, &all, sizeof all);
    assert_null(fake_frame_cut(&v, &view, 0, 2));
    assert_true(v.tests_asked > 2);
    for (uint32_t i = 0; i + 1 < v.tests_asked; i++) assert_memory_not_equal(&v.tests[i].box, &all, sizeof all);
    fake_viewer_close(&v);
    fake_culler_close(&c);
    hand_zone_free(&z);
}

// last draws at once what it knows nothing of, drops what was hidden, and is a frame late where something comes into sight.
static void last_is_a_frame_late_and_takes_one_step(void **state)
{
    hand_zone z;
    fake_culler c;
    fake_viewer v;
    static fake_view before, above;
    uint8_t visible[600];
    uint32_t lost = 0;
    (void)state;
    field_make(&z, 1);
    fake_view_make(&before, (cull_vec3){0, 1.5f, -12}, 0, 0);
    fake_view_make(&above, (cull_vec3){0, 20, -12}, 0, -0.3);
    assert_int_equal(fake_culler_open(&c, &z, "last", CHAIN_SELECT, 0), CULL_OK);
    assert_int_equal(c.built.max_steps, 1);
    assert_int_equal(c.built.promises, 0);
    fake_viewer_open(&v, &c);
    for (int f = 0; f < 8; f++) assert_null(fake_frame(&v, &before, 0));
    assert_true(v.drawn_count < 10);
    assert_null(fake_frame(&v, &above, 0));
    fake_truth(&v, &above, visible);
    for (uint32_t i = 0; i < z.zone.item_count; i++) lost += visible[i] && !v.drawn[i];
    assert_true(lost > 0);
    for (int f = 0; f < 8; f++) assert_null(fake_frame(&v, &above, 0));
    for (uint32_t i = 0; i < z.zone.item_count; i++) assert_true(!visible[i] || v.drawn[i]);
    fake_viewer_close(&v);
    fake_culler_close(&c);
    hand_zone_free(&z);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_zone_pays_whose_tests_bring_in_a_fifth_of_what_is_looked_at),
        cmocka_unit_test(a_zone_at_rest_is_tested_again_when_its_pause_is_over_and_much_is_hidden),
        cmocka_unit_test(where_nothing_is_hidden_it_stops_asking),
        cmocka_unit_test(it_asks_again_when_things_come_to_be_hidden),
        cmocka_unit_test(views_of_one_culler_do_not_mix),
        cmocka_unit_test(a_frame_broken_off_leaves_no_trace_in_the_next),
        cmocka_unit_test(a_far_zone_is_tested_whole_once),
        cmocka_unit_test(last_is_a_frame_late_and_takes_one_step),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
