// method=hiz in every place of a chain, through the plugin itself: as a select, behind a lent tree, behind candidates; through two volumes,
// with movers, where the view jumps.
// SPDX-License-Identifier: MIT
#include "fake_host.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const char *const methods[] = {"hiz", "hiz threads=4", "hiz prune=off isa=plain"};
enum { METHODS = 3, ITEMS = 240 };

static void town_make(hand_zone *z)
{
    cull_box boxes[ITEMS];
    uint64_t seed = 7;
    boxes[0] = (cull_box){{-60, -1, -60}, {60, 0, 60}};
    for (uint32_t i = 1; i < ITEMS; i++) {
        const int is_house = i % 3 != 0;
        const float x = (float)random_between(&seed, -55, 50), zz = (float)random_between(&seed, -55, 50);
        const float w = is_house ? (float)random_between(&seed, 2, 8) : 0.4f, h = is_house ? (float)random_between(&seed, 3, 20) : 0.8f;
        boxes[i] = (cull_box){{x, 0, zz}, {x + w, h, zz + w}};
    }
    zone_of_boxes(boxes, ITEMS, z);
    z->zone.mover_capacity = FAKE_MOVERS_MOST;
}

static uint32_t missed(fake_viewer *v, const fake_view *view)
{
    static uint8_t visible[ITEMS + FAKE_MOVERS_MOST];
    uint32_t count = 0;
    memset(visible, 0, sizeof visible);
    fake_truth(v, view, visible);
    for (uint32_t i = 0; i < ITEMS + v->mover_count; i++) count += visible[i] && !v->drawn[i];
    return count;
}

static void jump(fake_view *view, uint64_t *seed, int halves)
{
    const cull_vec3 eye = {(float)random_between(seed, -50, 50), (float)random_between(seed, 1, 30), (float)random_between(seed, -50, 50)};
    fake_view_make(view, eye, random_between(seed, 0, 6.28), random_between(seed, -0.6, 0.2));
    if (halves) fake_view_halve(view);
}

// Returns how many of all were drawn, in all frames.
static uint32_t walk(const char *method, fake_chain chain, int halves)
{
    static fake_view view;
    hand_zone town;
    fake_culler c;
    fake_viewer v;
    uint64_t seed = 11;
    uint32_t drawn = 0;
    town_make(&town);
    assert_int_equal(fake_culler_open(&c, &town, method, chain, 0), CULL_OK);
    assert_int_equal(c.built.max_steps, 1);
    fake_viewer_open(&v, &c);
    for (uint32_t f = 0; f < 12; f++) {
        jump(&view, &seed, halves);
        for (uint32_t i = 0; chain == CHAIN_CANDIDATES && i < ITEMS; i++) v.allowed[i] = random_below(&seed, 5) != 0;
        v.mover_count = f % 3 * 10;
        for (uint32_t m = 0; m < v.mover_count; m++) {
            const float x = (float)random_between(&seed, -50, 50), z = (float)random_between(&seed, -50, 50);
            v.movers[m] = (cull_mover){{{x, 0, z}, {x + 1.5f, 1.5f, z + 1.5f}}, ITEMS + m, 0};
        }
        const char *fault = fake_frame(&v, &view, 0);
        if (fault) fail_msg("%s: %s in frame %u", method, fault, f);
        const uint32_t lost = missed(&v, &view);
        if (lost) fail_msg("%s: %u lost in frame %u", method, lost, f);
        assert_int_equal(v.tests_asked, 0);
        drawn += v.drawn_count;
    }
    fake_viewer_close(&v);
    fake_culler_close(&c);
    assert_true(failing_allocator_is_clean(&c.host.memory));
    hand_zone_free(&town);
    return drawn;
}

static void nothing_visible_is_dropped_in_any_chain(void **state)
{
    (void)state;
    for (int m = 0; m < METHODS; m++)
        for (int chain = CHAIN_SELECT; chain <= CHAIN_CANDIDATES; chain++)
            for (int halves = 0; halves < 2; halves++) walk(methods[m], (fake_chain)chain, halves);
}

static void all_ways_of_computing_draw_as_much(void **state)
{
    (void)state;
    for (int chain = CHAIN_SELECT; chain <= CHAIN_CANDIDATES; chain++) {
        const uint32_t drawn = walk(methods[0], (fake_chain)chain, 0);
        assert_true(drawn > 0 && drawn < 12 * ITEMS / 2); // and hides something
        for (int m = 1; m < METHODS; m++) assert_int_equal(walk(methods[m], (fake_chain)chain, 0), drawn);
    }
}

static void a_broken_allocation_breaks_nothing_else(void **state)
{
    hand_zone town;
    (void)state;
    town_make(&town);
    for (uint64_t fail_at = 1; fail_at < 100; fail_at++) {
        fake_culler c;
        const cull_result result = fake_culler_open(&c, &town, "hiz", CHAIN_SELECT, fail_at);
        if (result == CULL_OK) fake_culler_close(&c);
        assert_true(failing_allocator_is_clean(&c.host.memory));
        if (result == CULL_OK) break;
        assert_int_equal(result, CULL_ERR_MEMORY);
    }
    hand_zone_free(&town);
}

// ---- Whether it pays ----

enum { SIDE = 6, FIELD = SIDE * SIDE, WALL = FIELD, SCENE = FIELD + 1 };

// Low boxes far apart, and a wall that hides them all from behind it.
static void field_make(hand_zone *z)
{
    cull_box boxes[SCENE];
    for (int i = 0; i < FIELD; i++) {
        const float x = 10 * (float)(i % SIDE) - 30, at = 10 * (float)(i / SIDE);
        boxes[i] = (cull_box){{x, 0, at}, {x + 6, 2, at + 6}};
    }
    boxes[WALL] = (cull_box){{-200, -100, -31}, {200, 200, -30}};
    zone_of_boxes(boxes, SCENE, z);
    for (int i = 0; i < SCENE; i++) z->items[i].polygon_count = 6; // less than 128 in all are not worth it behind another culler
    z->zone.mover_capacity = FAKE_MOVERS_MOST;
}

static void field_frame(fake_viewer *v, const fake_view *view)
{
    static uint8_t visible[SCENE + FAKE_MOVERS_MOST];
    const char *fault = fake_frame(v, view, 0);
    if (fault) fail_msg("%s", fault);
    memset(visible, 0, sizeof visible);
    fake_truth(v, view, visible);
    for (uint32_t i = 0; i < SCENE; i++) assert_true(!visible[i] || v->drawn[i]);
}

static void where_nothing_is_hidden_it_rests_until_something_is(void **state)
{
    static fake_view above, behind;
    hand_zone field;
    (void)state;
    field_make(&field);
    fake_view_make(&above, (cull_vec3){0, 60, -10}, 0, -1);
    fake_view_make(&behind, (cull_vec3){0, 5, -40}, 0, 0);
    for (int chain = CHAIN_SELECT; chain <= CHAIN_CANDIDATES; chain++) {
        fake_culler c;
        fake_viewer v;
        uint32_t rested = 0;
        assert_int_equal(fake_culler_open(&c, &field, "hiz", (fake_chain)chain, 0), CULL_OK);
        fake_viewer_open(&v, &c);
        field_frame(&v, &behind);
        assert_true(v.drawn_count < 4); // it pays at once
        for (uint32_t f = 0; f < 80; f++) field_frame(&v, &above);
        for (uint32_t f = 0; f < 80; f++) {
            field_frame(&v, &behind);
            rested += v.drawn_count > 10;
        }
        assert_in_range(rested, 1, 64); // it was off, and is on again before the longest pause is over
        assert_true(v.drawn_count < 4);
        fake_viewer_close(&v);
        fake_culler_close(&c);
        assert_true(failing_allocator_is_clean(&c.host.memory));
    }
    hand_zone_free(&field);
}

static void each_reason_is_told(void **state)
{
    static fake_view behind;
    hand_zone field;
    fake_culler c;
    fake_viewer v;
    char text[128];
    (void)state;
    field_make(&field);
    fake_view_make(&behind, (cull_vec3){0, 5, -40}, 0, 0);
    assert_int_equal(fake_culler_open(&c, &field, "hiz", CHAIN_CANDIDATES, 0), CULL_OK);
    fake_viewer_open(&v, &c);
    v.allowed[20] = 0;
    field_frame(&v, &behind);
    const cull_explain *explain = c.plugin->get_extension(c.culler, CULL_EXT_EXPLAIN);
    const cull_run all[2] = {{0, 20}, {21, SCENE - 21}};
    cull_visit visit = {.view = &behind.view, .volumes = behind.volumes, .volume_count = behind.volume_count, .candidates = all, .candidate_count = 2, .scratch = v.scratch};
    explain->item(v.query, &visit, WALL, text, sizeof text);
    assert_non_null(strstr(text, "kept"));
    explain->item(v.query, &visit, 2, text, sizeof text);
    assert_non_null(strstr(text, "hides its box"));
    explain->item(v.query, &visit, 20, text, sizeof text);
    assert_non_null(strstr(text, "left it out"));
    fake_view_make(&behind, (cull_vec3){0, 5, -40}, 3.14159, 0);
    visit.volumes = behind.volumes;
    explain->item(v.query, &visit, 2, text, sizeof text);
    assert_non_null(strstr(text, "outside every volume"));
    fake_viewer_close(&v);
    fake_culler_close(&c);
    hand_zone_free(&field);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_visible_is_dropped_in_any_chain),
        cmocka_unit_test(all_ways_of_computing_draw_as_much),
        cmocka_unit_test(where_nothing_is_hidden_it_rests_until_something_is),
        cmocka_unit_test(each_reason_is_told),
        cmocka_unit_test(a_broken_allocation_breaks_nothing_else),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
