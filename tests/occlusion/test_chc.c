// method=chc: what it saves, what it may not lose, and what it does while answers are out.
// SPDX-License-Identifier: MIT
#include "fake_host.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { HOUSES = 7, THINGS = 5, FRAMES = 24, ITEMS_MOST = HOUSES * HOUSES * (THINGS + 1) };

// Streets of houses, and small things behind each.
static void town_make(hand_zone *z, uint64_t seed)
{
    static cull_box boxes[ITEMS_MOST];
    uint32_t count = 0;
    for (int i = 0; i < HOUSES * HOUSES; i++) {
        const float x = (float)(i % HOUSES * 12 - HOUSES * 6), zz = (float)(i / HOUSES * 12), height = 3 + (float)random_below(&seed, 5);
        boxes[count++] = (cull_box){{x, 0, zz}, {x + 8, height, zz + 8}};
        for (int k = 0; k < THINGS; k++) {
            const float at = (float)random_below(&seed, 80) * 0.1f;
            boxes[count++] = (cull_box){{x + at, 0, zz + 8.5f + (float)k * 0.4f}, {x + at + 0.3f, 0.8f, zz + 8.7f + (float)k * 0.4f}};
        }
    }
    zone_of_boxes(boxes, count, z);
    z->zone.mover_capacity = FAKE_MOVERS_MOST;
}

typedef struct town_walk { uint32_t tests, waits, steps, drawn, frames; } town_walk;

static void expect_nothing_missed(const fake_viewer *v, const fake_view *view)
{
    static uint8_t visible[ITEMS_MOST + FAKE_MOVERS_MOST];
    fake_truth(v, view, visible);
    for (uint32_t i = 0; i < v->c->zone->zone.item_count + v->mover_count; i++) assert_true(!visible[i] || v->drawn[i]);
}

static void town_view(int frame, fake_view *view)
{
    fake_view_make(view, (cull_vec3){-2 + (float)frame * 0.1f, 1.6f, -6}, 0.2 + frame * 0.01, 0);
}

// A smooth walk down a street; what is counted begins at the tenth frame.
static town_walk walk_town(const hand_zone *z, const char *method, fake_viewer *kept, fake_culler *c)
{
    static fake_view view;
    town_walk sum = {0};
    assert_int_equal(fake_culler_open(c, z, method, CHAIN_SELECT, 0), CULL_OK);
    fake_viewer_open(kept, c);
    for (int f = 0; f < FRAMES; f++) {
        town_view(f, &view);
        assert_null(fake_frame(kept, &view, 0));
        if (f % 4 == 3) expect_nothing_missed(kept, &view);
        if (f < 10) continue;
        sum.tests += kept->tests_asked;
        sum.waits += kept->waits;
        sum.steps += kept->steps;
        sum.drawn += kept->drawn_count;
        sum.frames++;
    }
    return sum;
}

static double figure_of(const fake_culler *c, const char *name)
{
    const cull_figures *figures = c->plugin->get_extension(c->culler, CULL_EXT_FIGURES);
    for (uint32_t i = 0; i < figures->count; i++)
        if (strcmp(figures->figures[i].name, name) == 0) return figures->figures[i].value;
    fail_msg("no figure %s", name);
    return 0;
}

static void several_hidden_things_stand_under_one_test(void **state)
{
    hand_zone z;
    fake_culler c;
    fake_viewer v;
    (void)state;
    town_make(&z, 3);
    const town_walk wait = walk_town(&z, "wait", &v, &c);
    fake_viewer_close(&v);
    fake_culler_close(&c);
    const town_walk chc = walk_town(&z, "chc", &v, &c);
    fake_viewer_close(&v);
    const double joint = figure_of(&c, "tests_joint"), hidden = figure_of(&c, "tests_joint_hidden");
    assert_true(chc.tests * 3 < wait.tests * 2);
    assert_true(joint > 40 && hidden > joint * 0.7 && hidden <= joint);
    assert_true(chc.drawn * 10 < wait.drawn * 13);
    fake_culler_close(&c);
    hand_zone_free(&z);
}

static void saved_up_tests_take_fewer_steps_and_turns(void **state)
{
    hand_zone z;
    fake_culler c;
    fake_viewer v;
    (void)state;
    town_make(&z, 4);
    const town_walk on = walk_town(&z, "chc", &v, &c);
    fake_viewer_close(&v);
    const double turns_on = figure_of(&c, "turns_a_frame");
    fake_culler_close(&c);
    const town_walk off = walk_town(&z, "chc batch=off", &v, &c);
    fake_viewer_close(&v);
    const double turns_off = figure_of(&c, "turns_a_frame");
    assert_true(on.steps * 3 < off.steps);
    assert_true(turns_on * 1.5 < turns_off);
    assert_int_equal(figure_of(&c, "tests_joint"), 0);
    fake_culler_close(&c);
    hand_zone_free(&z);
}

static void it_refuses_a_batch_that_is_neither_on_nor_off(void **state)
{
    hand_zone z;
    fake_culler c;
    (void)state;
    town_make(&z, 1);
    assert_int_equal(fake_culler_open(&c, &z, "chc batch=some", CHAIN_SELECT, 0), CULL_ERR_OPTION);
    assert_non_null(strstr(c.host.last_line, "batch=some"));
    assert_true(failing_allocator_is_clean(&c.host.memory));
    hand_zone_free(&z);
}

static void answers_that_come_late_in_part_or_never_lose_nothing(void **state)
{
    static const fake_answers hows[] = {ANSWERS_SHUFFLED, ANSWERS_SOME_LOST, ANSWERS_NONE};
    static const char *const methods[] = {"chc", "chc batch=off"};
    hand_zone z;
    (void)state;
    town_make(&z, 5);
    for (int m = 0; m < 2; m++)
        for (int h = 0; h < 3; h++) {
            fake_culler c;
            fake_viewer v;
            static fake_view view;
            assert_int_equal(fake_culler_open(&c, &z, methods[m], CHAIN_LENT, 0), CULL_OK);
            fake_viewer_open(&v, &c);
            v.how = hows[h];
            v.late_frames = (uint32_t)h;
            for (int f = 0; f < 8; f++) {
                town_view(f * 3, &view);
                assert_null(fake_frame(&v, &view, f == 5 ? CULL_VIEW_CUT : 0));
                expect_nothing_missed(&v, &view);
            }
            fake_viewer_close(&v);
            fake_culler_close(&c);
        }
    hand_zone_free(&z);
}

// Each answer is so many steps on its way: there is other work, so that nobody waits, and nothing is lost.
static void nobody_waits_while_there_is_other_work(void **state)
{
    hand_zone z;
    fake_culler c;
    fake_viewer v;
    static fake_view view;
    uint32_t waits = 0, tests = 0;
    (void)state;
    town_make(&z, 6);
    assert_int_equal(fake_culler_open(&c, &z, "chc", CHAIN_SELECT, 0), CULL_OK);
    fake_viewer_open(&v, &c);
    v.late_steps = 2;
    for (int f = 0; f < FRAMES; f++) {
        town_view(f, &view);
        assert_null(fake_frame(&v, &view, 0));
        expect_nothing_missed(&v, &view);
        if (f > 0) waits += v.waits; // at first the zone's own test is all there is
        else assert_true(v.waits <= 1);
        tests += v.tests_asked;
    }
    assert_true(tests > 200);
    assert_int_equal(waits, 0);
    fake_viewer_close(&v);
    assert_true(figure_of(&c, "tests_waited_for") <= 1);
    fake_culler_close(&c);
    hand_zone_free(&z);
}

// Small things in rows behind a wall that fills the picture: one thing is drawn, so there is nothing to test again meanwhile.
static void wall_make(hand_zone *z)
{
    static cull_box boxes[ITEMS_MOST];
    uint32_t count = 0;
    boxes[count++] = (cull_box){{-60, -60, 2}, {60, 60, 3}};
    for (int i = 0; i < 200; i++) {
        const float x = (float)(i % 20 * 3 - 30), zz = (float)(i / 20 * 6 + 8);
        boxes[count++] = (cull_box){{x, 0, zz}, {x + 1, 2, zz + 1}};
    }
    zone_of_boxes(boxes, count, z);
    z->zone.mover_capacity = FAKE_MOVERS_MOST;
}

static void behind_a_wall_it_finds_out_meanwhile_what_may_stand_together(void **state)
{
    hand_zone z;
    fake_culler c;
    fake_viewer v;
    static fake_view view;
    uint32_t first = 0;
    (void)state;
    wall_make(&z);
    assert_int_equal(fake_culler_open(&c, &z, "chc", CHAIN_SELECT, 0), CULL_OK);
    fake_viewer_open(&v, &c);
    v.late_steps = 2;
    fake_view_make(&view, (cull_vec3){0, 1, -1}, 0, 0);
    for (int f = 0; f < FRAMES; f++) {
        assert_null(fake_frame(&v, &view, 0));
        expect_nothing_missed(&v, &view);
        if (f == 1) first = v.tests_asked;
        if (f > 1) assert_true(v.drawn_count == 1 && v.steps <= 5);
    }
    assert_true(v.tests_asked <= first);
    fake_viewer_close(&v);
    fake_culler_close(&c);
    hand_zone_free(&z);
}

static void what_moves_is_tested_behind_what_stands(void **state)
{
    hand_zone z;
    fake_culler c;
    fake_viewer v;
    static fake_view view;
    uint32_t drawn = 0;
    (void)state;
    town_make(&z, 7);
    assert_int_equal(fake_culler_open(&c, &z, "chc", CHAIN_SELECT, 0), CULL_OK);
    fake_viewer_open(&v, &c);
    v.mover_count = FAKE_MOVERS_MOST;
    for (int f = 0; f < FRAMES; f++) {
        for (uint32_t m = 0; m < v.mover_count; m++) {
            const float x = (float)m * 2 - 30 + (float)f * 0.2f, zz = m % 4 ? 60 + (float)m : -3 + (float)m * 0.1f;
            v.movers[m] = (cull_mover){{{x, 0, zz}, {x + 0.5f, 1.8f, zz + 0.5f}}, z.zone.item_count + m, 0};
        }
        town_view(f, &view);
        assert_null(fake_frame(&v, &view, 0));
        expect_nothing_missed(&v, &view);
        for (uint32_t m = 0; f >= 5 && m < v.mover_count; m++) drawn += v.drawn[z.zone.item_count + m];
    }
    assert_true(drawn > FRAMES - 5 && drawn < (FRAMES - 5) * FAKE_MOVERS_MOST / 2);
    fake_viewer_close(&v);
    fake_culler_close(&c);
    hand_zone_free(&z);
}

// Before the wall, and behind it.
static const cull_box open_place = {{-0.2f, 0.8f, 0.5f}, {0.2f, 1.2f, 0.9f}}, hidden_place = {{-0.2f, 0.8f, 5}, {0.2f, 1.2f, 5.4f}};

typedef struct street { hand_zone z; fake_culler c; fake_viewer v; fake_view view; } street;

static void street_open(street *s)
{
    wall_make(&s->z);
    assert_int_equal(fake_culler_open(&s->c, &s->z, "chc", CHAIN_SELECT, 0), CULL_OK);
    fake_viewer_open(&s->v, &s->c);
    fake_view_make(&s->view, (cull_vec3){0, 1, -1}, 0, 0);
}

static void street_close(street *s)
{
    fake_viewer_close(&s->v);
    fake_culler_close(&s->c);
    hand_zone_free(&s->z);
}

// By place in the list: 1: in the open. Its id goes by its place. Returns the tests asked in so many frames.
static uint32_t look_at_movers(street *s, const uint8_t *in_the_open, int frames)
{
    uint32_t tests = 0;
    for (int f = 0; f < frames; f++) {
        for (uint32_t m = 0; m < s->v.mover_count; m++) {
            const cull_box box = in_the_open[m] ? open_place : hidden_place;
            s->v.movers[m] = (cull_mover){box, s->z.zone.item_count + m, 0};
        }
        assert_null(fake_frame(&s->v, &s->view, 0));
        expect_nothing_missed(&s->v, &s->view);
        tests += s->v.tests_asked;
    }
    return tests;
}

static int is_mover_drawn(const street *s, uint32_t m)
{
    return s->v.drawn[s->z.zone.item_count + m];
}

static void a_mover_seen_is_drawn_untested_for_a_while_and_a_hidden_one_is_not_drawn(void **state)
{
    static const uint8_t mixed[2] = {1, 0};
    static street s;
    (void)state;
    street_open(&s);
    look_at_movers(&s, mixed, 10);
    const uint32_t without = look_at_movers(&s, mixed, 12);
    s.v.mover_count = 2;
    look_at_movers(&s, mixed, 4);
    const uint32_t with = look_at_movers(&s, mixed, 12);
    assert_true(is_mover_drawn(&s, 0));
    assert_false(is_mover_drawn(&s, 1));
    assert_true(with < without + 12 + 9); // the hidden one in each frame at most, the seen one now and then
    street_close(&s);
}

// An id may name another mover in any frame: what was known of it is a guess only.
static void an_id_that_names_another_mover_loses_nothing(void **state)
{
    static const uint8_t before[2] = {1, 0}, after[2] = {0, 1};
    static street s;
    (void)state;
    street_open(&s);
    s.v.mover_count = 2;
    look_at_movers(&s, before, 8);
    look_at_movers(&s, after, 24);
    assert_false(is_mover_drawn(&s, 0));
    assert_true(is_mover_drawn(&s, 1));
    s.v.mover_count = 0;
    look_at_movers(&s, after, 2);
    s.v.mover_count = 2;
    look_at_movers(&s, before, 2); // nothing is known of who was not there
    assert_true(is_mover_drawn(&s, 0));
    assert_false(is_mover_drawn(&s, 1));
    street_close(&s);
}

static void the_same_walk_gives_the_same_frames(void **state)
{
    hand_zone z;
    fake_culler c;
    fake_viewer a, b;
    static fake_view view;
    (void)state;
    town_make(&z, 8);
    assert_int_equal(fake_culler_open(&c, &z, "chc", CHAIN_SELECT, 0), CULL_OK);
    fake_viewer_open(&a, &c);
    fake_viewer_open(&b, &c);
    b.how = ANSWERS_SHUFFLED;
    for (int f = 0; f < 20; f++) {
        town_view(f, &view);
        assert_null(fake_frame(&a, &view, 0));
        assert_null(fake_frame(&b, &view, 0));
        assert_memory_equal(a.drawn, b.drawn, z.zone.item_count);
    }
    fake_viewer_close(&a);
    fake_viewer_close(&b);
    fake_culler_close(&c);
    hand_zone_free(&z);
}

static void every_allocation_of_it_may_fail(void **state)
{
    hand_zone z;
    (void)state;
    town_make(&z, 2);
    for (uint64_t k = 1;; k++) {
        fake_culler c;
        cull_query *query = NULL;
        const cull_result built = fake_culler_open(&c, &z, "chc", CHAIN_SELECT, k);
        if (built != CULL_OK) {
            assert_int_equal(built, CULL_ERR_MEMORY);
            assert_true(failing_allocator_is_clean(&c.host.memory));
            continue;
        }
        const cull_result opened = c.plugin->open(c.culler, &query);
        assert_int_equal(opened == CULL_OK, query != NULL);
        if (query) c.plugin->close(query);
        fake_culler_close(&c);
        assert_true(failing_allocator_is_clean(&c.host.memory));
        if (opened != CULL_OK) continue;
        assert_true(k > 20);
        break;
    }
    hand_zone_free(&z);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(several_hidden_things_stand_under_one_test),
        cmocka_unit_test(saved_up_tests_take_fewer_steps_and_turns),
        cmocka_unit_test(it_refuses_a_batch_that_is_neither_on_nor_off),
        cmocka_unit_test(answers_that_come_late_in_part_or_never_lose_nothing),
        cmocka_unit_test(nobody_waits_while_there_is_other_work),
        cmocka_unit_test(behind_a_wall_it_finds_out_meanwhile_what_may_stand_together),
        cmocka_unit_test(what_moves_is_tested_behind_what_stands),
        cmocka_unit_test(a_mover_seen_is_drawn_untested_for_a_while_and_a_hidden_one_is_not_drawn),
        cmocka_unit_test(an_id_that_names_another_mover_loses_nothing),
        cmocka_unit_test(the_same_walk_gives_the_same_frames),
        cmocka_unit_test(every_allocation_of_it_may_fail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
