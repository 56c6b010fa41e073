// Nothing that can be seen is ever dropped, and what stands behind a wall is: over every chain, method and way of answering.
// SPDX-License-Identifier: MIT
#include "fake_host.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const char *const methods[] = {"twophase", "wait"};

// Streets of houses on a slab, small things between them.
static void town_make(hand_zone *z, uint64_t seed, uint32_t count)
{
    cull_box *boxes = calloc(count, sizeof *boxes);
    boxes[0] = (cull_box){{-60, -1, -60}, {60, 0, 60}};
    for (uint32_t i = 1; i < count; i++) {
        const int is_house = i % 3 != 0;
        const float x = (float)random_between(&seed, -55, 50), zz = (float)random_between(&seed, -55, 50);
        const float w = is_house ? (float)random_between(&seed, 2, 8) : 0.4f, h = is_house ? (float)random_between(&seed, 3, 20) : 0.8f;
        boxes[i] = (cull_box){{x, 0, zz}, {x + w, h, zz + w}};
    }
    zone_of_boxes(boxes, count, z);
    z->zone.mover_capacity = FAKE_MOVERS_MOST;
    free(boxes);
}

static void movers_add(fake_viewer *v, uint64_t seed, uint32_t frame)
{
    v->mover_count = 12;
    for (uint32_t m = 0; m < v->mover_count; m++) {
        const float x = (float)random_between(&seed, -50, 50) + (float)frame * 0.2f, z = (float)random_between(&seed, -50, 50);
        v->movers[m] = (cull_mover){{{x, 0, z}, {x + 1.5f, 1.5f, z + 1.5f}}, v->c->zone->zone.item_count + m, 0};
    }
}

static uint32_t missed(fake_viewer *v, const fake_view *view)
{
    const uint32_t all = v->c->zone->zone.item_count + v->mover_count;
    uint8_t *visible = calloc(all, 1);
    uint32_t count = 0;
    fake_truth(v, view, visible);
    for (uint32_t i = 0; i < all; i++) count += visible[i] && !v->drawn[i];
    free(visible);
    return count;
}

typedef struct walk_how { const char *method; fake_chain chain; fake_answers answers; uint32_t late_frames, halves, jumps, frames; } walk_how;

// A walk through the town that turns, or jumps about; checked frame by frame.
static void walk(const walk_how *how)
{
    hand_zone town;
    fake_culler c;
    fake_viewer v;
    town_make(&town, 3 + how->jumps, 220);
    assert_int_equal(fake_culler_open(&c, &town, how->method, how->chain, 0), CULL_OK);
    fake_viewer_open(&v, &c);
    v.how = how->answers;
    v.late_frames = how->late_frames;
    uint64_t seed = 11;
    for (uint32_t f = 0; f < how->frames; f++) {
        static fake_view view;
        const double s = f;
        cull_vec3 eye = {(float)(-30 + 0.5 * s), 1.7f, (float)(-20 + 0.2 * s)};
        double yaw = 0.8 + 0.06 * s;
        if (how->jumps && f % 2) {
            eye = (cull_vec3){(float)random_between(&seed, -50, 50), (float)random_between(&seed, 1, 30), (float)random_between(&seed, -50, 50)};
            yaw = random_between(&seed, 0, 6.28);
        }
        fake_view_make(&view, eye, yaw, -0.1);
        if (how->halves) fake_view_halve(&view);
        for (uint32_t i = 0; how->chain == CHAIN_CANDIDATES && i < town.zone.item_count; i++) v.allowed[i] = random_below(&seed, 5) != 0;
        movers_add(&v, 5, f);
        const char *fault = fake_frame(&v, &view, how->jumps && random_below(&seed, 2) ? CULL_VIEW_CUT : 0);
        if (fault) fail_msg("%s: %s in frame %u", how->method, fault, f);
        const uint32_t lost = missed(&v, &view);
        if (lost) fail_msg("%s: %u lost in frame %u", how->method, lost, f);
    }
    fake_viewer_close(&v);
    fake_culler_close(&c);
    assert_true(failing_allocator_is_clean(&c.host.memory));
    hand_zone_free(&town);
}

static void nothing_visible_is_dropped_on_a_walk(void **state)
{
    (void)state;
    for (int m = 0; m < 2; m++)
        for (int chain = CHAIN_SELECT; chain <= CHAIN_CANDIDATES; chain++) walk(&(walk_how){methods[m], (fake_chain)chain, ANSWERS_ALL, 0, 0, 0, 20});
}

static void nothing_visible_is_dropped_when_the_view_jumps(void **state)
{
    (void)state;
    for (int m = 0; m < 2; m++)
        for (int chain = CHAIN_SELECT; chain <= CHAIN_CANDIDATES; chain++) walk(&(walk_how){methods[m], (fake_chain)chain, ANSWERS_ALL, 0, 0, 1, 20});
}

static void nothing_visible_is_dropped_through_two_volumes(void **state)
{
    (void)state;
    for (int m = 0; m < 2; m++) {
        walk(&(walk_how){methods[m], CHAIN_SELECT, ANSWERS_ALL, 0, 1, 0, 20});
        walk(&(walk_how){methods[m], CHAIN_LENT, ANSWERS_ALL, 0, 1, 1, 20});
    }
}

static void nothing_visible_is_dropped_whatever_becomes_of_answers(void **state)
{
    static const fake_answers ways[] = {ANSWERS_SOME_LOST, ANSWERS_NONE, ANSWERS_SHUFFLED};
    (void)state;
    for (int m = 0; m < 2; m++)
        for (int way = 0; way < 3; way++) {
            walk(&(walk_how){methods[m], CHAIN_SELECT, ways[way], 0, 0, 0, 20});
            walk(&(walk_how){methods[m], CHAIN_LENT, ways[way], 2, 0, 1, 16});
        }
}

static void nothing_visible_is_dropped_with_answers_of_any_age(void **state)
{
    (void)state;
    for (uint32_t age = 1; age <= 9; age += 4) walk(&(walk_how){"twophase", CHAIN_SELECT, ANSWERS_ALL, age, 0, 0, 20});
}

// ---- What is hidden is dropped ----

enum { CROWD = 300 };
static void crowd_behind_a_wall(hand_zone *z)
{
    cull_box *boxes = calloc(CROWD + 1, sizeof *boxes);
    uint64_t seed = 9;
    boxes[0] = (cull_box){{-40, -40, 10}, {40, 40, 11}};
    for (uint32_t i = 1; i <= CROWD; i++) {
        const float x = (float)random_between(&seed, -20, 20), y = (float)random_between(&seed, -10, 10), zz = (float)random_between(&seed, 20, 60);
        boxes[i] = (cull_box){{x, y, zz}, {x + 1, y + 1, zz + 1}};
    }
    zone_of_boxes(boxes, CROWD + 1, z);
    z->zone.mover_capacity = FAKE_MOVERS_MOST;
    free(boxes);
}

static void what_a_wall_hides_is_not_drawn(void **state)
{
    static fake_view view;
    (void)state;
    fake_view_make(&view, (cull_vec3){0, 0, 0}, 0, 0);
    for (int m = 0; m < 2; m++)
        for (int chain = CHAIN_SELECT; chain <= CHAIN_CANDIDATES; chain++) {
            hand_zone z;
            fake_culler c;
            fake_viewer v;
            crowd_behind_a_wall(&z);
            assert_int_equal(fake_culler_open(&c, &z, methods[m], (fake_chain)chain, 0), CULL_OK);
            fake_viewer_open(&v, &c);
            v.mover_count = 2; // one behind the wall, one before it
            v.movers[0] = (cull_mover){{{0, 0, 30}, {1, 1, 31}}, CROWD + 1, 0};
            v.movers[1] = (cull_mover){{{0, 0, 5}, {1, 1, 6}}, CROWD + 2, 0};
            for (int f = 0; f < 3; f++) assert_null(fake_frame(&v, &view, 0));
            assert_int_equal(v.drawn_count, 2); // the wall, the mover before it
            assert_true(v.drawn[0] && v.drawn[CROWD + 2] && !v.drawn[CROWD + 1]);
            fake_viewer_close(&v);
            fake_culler_close(&c);
            hand_zone_free(&z);
        }
}

static void around_the_corner_it_is_drawn_in_the_same_frame(void **state)
{
    static fake_view before, beside;
    hand_zone z;
    fake_culler c;
    fake_viewer v;
    (void)state;
    crowd_behind_a_wall(&z);
    fake_view_make(&before, (cull_vec3){0, 0, 0}, 0, 0);
    fake_view_make(&beside, (cull_vec3){45, 0, 15}, -0.6, 0); // past the wall's edge
    assert_int_equal(fake_culler_open(&c, &z, "twophase", CHAIN_SELECT, 0), CULL_OK);
    fake_viewer_open(&v, &c);
    for (int f = 0; f < 4; f++) assert_null(fake_frame(&v, &before, 0));
    assert_null(fake_frame(&v, &beside, 0)); // without a word that the view jumped
    assert_int_equal(missed(&v, &beside), 0);
    assert_true(v.drawn_count > CROWD / 4);
    fake_viewer_close(&v);
    fake_culler_close(&c);
    hand_zone_free(&z);
}

static void a_mover_whose_box_is_no_number_is_drawn(void **state)
{
    static const char *const all[] = {"wait", "twophase", "chc"};
    static fake_view view;
    hand_zone town;
    (void)state;
    town_make(&town, 5, 220);
    fake_view_make(&view, (cull_vec3){-30, 1.7f, -20}, 0.8, 0);
    for (size_t m = 0; m < sizeof all / sizeof *all; m++) {
        fake_culler c;
        fake_viewer v;
        assert_int_equal(fake_culler_open(&c, &town, all[m], CHAIN_SELECT, 0), CULL_OK);
        fake_viewer_open(&v, &c);
        for (uint32_t f = 0; f < 6; f++) {
            movers_add(&v, 7, f);
            v.movers[f].box.min.x = v.movers[f].box.max.x = NAN;
            assert_null(fake_frame(&v, &view, 0));
            assert_true(v.drawn[town.zone.item_count + f]);
        }
        fake_viewer_close(&v);
        fake_culler_close(&c);
    }
    hand_zone_free(&town);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_visible_is_dropped_on_a_walk),
        cmocka_unit_test(nothing_visible_is_dropped_when_the_view_jumps),
        cmocka_unit_test(nothing_visible_is_dropped_through_two_volumes),
        cmocka_unit_test(nothing_visible_is_dropped_whatever_becomes_of_answers),
        cmocka_unit_test(nothing_visible_is_dropped_with_answers_of_any_age),
        cmocka_unit_test(what_a_wall_hides_is_not_drawn),
        cmocka_unit_test(around_the_corner_it_is_drawn_in_the_same_frame),
        cmocka_unit_test(a_mover_whose_box_is_no_number_is_drawn),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
