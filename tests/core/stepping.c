// Tests of cullers that take several steps, ask box tests, and take and show pictures, with a driver that has no renderer.
// SPDX-License-Identifier: MIT
#include "session.h"
#include "tests/common/test.h"

#include <stdio.h>
#include <string.h>

enum { ITEMS = 100, HALF = ITEMS / 2 };

static uint32_t third_are_hidden(const cull_test *test)
{
    return test->tag % 3 ? test->tag : 0;
}

static uint32_t third_are_hidden_fifth_never_told(const cull_test *test)
{
    return test->tag % 5 == 0 ? FAKE_NO_ANSWER : third_are_hidden(test);
}

static void open_session(session *s, const char *chain)
{
    const session_request q = {.chain = chain, .boxes = {.items = ITEMS, .seed = 11}, .checks = VIEWER_CHECK_ALL};
    assert_int_equal(session_open(s, &q), RESULT_OK);
}

static void assert_events(const session *s, const fake_event *events, uint32_t count)
{
    for (uint32_t i = 0; i < count && i < s->driver.event_count; ++i) assert_int_equal(s->driver.events[i], events[i]);
    assert_int_equal(s->driver.event_count, count);
}

// Each item in the set was drawn once and no other was drawn.
static void assert_drawn_is_the_set(const session *s)
{
    uint32_t times[FAKE_PLACES_MOST];
    session_set_by_item(s, times);
    for (uint32_t i = 0; i < FAKE_PLACES_MOST; ++i) assert_int_equal(s->driver.drawn[i], times[i]);
}

static void assert_hidden_third_is_dropped(const session *s)
{
    uint32_t times[FAKE_PLACES_MOST];
    session_set_by_item(s, times);
    for (uint32_t i = 0; i < ITEMS; ++i) assert_int_equal(times[i], i < HALF || i % 3 != 0);
}

static void waiting_draws_first_then_tests_then_draws_what_was_seen(void **state)
{
    (void)state;
    static session s;
    static const fake_event events[] = {FAKE_COLLECT_READY, FAKE_DRAW, FAKE_TEST, FAKE_COLLECT_ALL, FAKE_DRAW};
    open_session(&s, "testmore[wait=1]");
    s.driver.pixels_of = third_are_hidden;
    for (uint32_t frame = 1; frame < 4; ++frame) {
        session_frame(&s, &(session_view){.frame = frame});
        assert_events(&s, events, 5);
        assert_hidden_third_is_dropped(&s);
        assert_drawn_is_the_set(&s);
        assert_int_equal(s.stats.steps, 2);
        assert_int_equal(s.stats.queries, HALF);
        assert_int_equal(s.stats.stalls, 0);
        assert_int_equal(s.stats.limits_hit, 0);
        assert_int_equal(s.stats.faults, 0);
    }
    session_close(&s);
}

static void waiting_for_a_late_answer_is_a_stall_and_exact(void **state)
{
    (void)state;
    static session s;
    open_session(&s, "testmore[wait=1]");
    s.driver.pixels_of = third_are_hidden;
    s.driver.latency = 2;
    for (uint32_t frame = 1; frame < 4; ++frame) {
        session_frame(&s, &(session_view){.frame = frame});
        assert_int_equal(s.stats.stalls, 1);
        assert_hidden_third_is_dropped(&s);
    }
    session_close(&s);
}

// However many answers of earlier frames come first.
static void waiting_gets_this_step_s_answers_past_any_number_of_old_ones(void **state)
{
    (void)state;
    static const uint32_t old_counts[] = {1, HALF - 1, HALF, HALF + 1, ITEMS, ITEMS + 1, 2 * ITEMS, 2 * ITEMS + 1, 2000};
    for (size_t n = 0; n < sizeof old_counts / sizeof *old_counts; ++n) {
        static session s;
        open_session(&s, "testmore[wait=1]");
        s.driver.pixels_of = third_are_hidden;
        session_frame(&s, &(session_view){.frame = 1});
        for (uint32_t i = 0; i < old_counts[n]; ++i) s.driver.pending[i] = (fake_pending){HALF, 0, 1, 1}; // not ready before the wait
        s.driver.pending_count = old_counts[n];
        session_frame(&s, &(session_view){.frame = 2});
        assert_hidden_third_is_dropped(&s);
        assert_int_equal(s.stats.limits_hit, 0);
        assert_int_equal(s.stats.stalls, 0);
        assert_int_equal(s.driver.pending_count, 0);
        session_close(&s);
    }
}

static void answers_to_tests_older_than_the_query_are_no_answers_to_it(void **state)
{
    (void)state;
    static session s;
    open_session(&s, "testmore[wait=0]");
    s.driver.pixels_of = third_are_hidden;
    for (uint32_t i = 0; i < 40; ++i) s.driver.pending[i] = (fake_pending){HALF + i, 0, 2, 1}; // of the chain before a swap, say
    s.driver.pending_count = 40;
    session_frame(&s, &(session_view){.frame = 5});
    const cull_visit *visit = &s.view->zones[0]->visit;
    assert_int_equal(visit->answer_count, HALF);
    for (uint32_t i = 0; i < HALF; ++i) assert_int_equal(visit->answers[i].age, 0);
    assert_hidden_third_is_dropped(&s);
    assert_int_equal(s.driver.pending_count, 0);
    session_close(&s);
}

static void more_takes_what_is_ready_without_a_stall(void **state)
{
    (void)state;
    static session s;
    static const fake_event events[] = {FAKE_COLLECT_READY, FAKE_DRAW, FAKE_TEST, FAKE_COLLECT_READY, FAKE_DRAW};
    open_session(&s, "testmore[wait=0]");
    s.driver.pixels_of = third_are_hidden;
    session_frame(&s, &(session_view){.frame = 1});
    assert_events(&s, events, 5);
    assert_hidden_third_is_dropped(&s);
    assert_int_equal(s.stats.stalls, 0);
    session_close(&s);
}

static void an_answer_of_an_earlier_frame_is_told_its_age_and_believed_by_no_one(void **state)
{
    (void)state;
    static session s;
    open_session(&s, "testmore[wait=0]");
    s.driver.pixels_of = third_are_hidden;
    s.driver.latency = 1; // ready at the second collect after the test: the next frame's first
    for (uint32_t frame = 1; frame < 6; ++frame) {
        session_frame(&s, &(session_view){.frame = frame});
        assert_int_equal(s.stats.stalls, 0);
        assert_int_equal(s.stats.limits_hit, 1);
        assert_int_equal(s.stats.items_drawn, ITEMS);
        assert_drawn_is_the_set(&s);
        const cull_answer *answers = s.view->zones[0]->answers.items; // of the last collect: late ones came before, at frame start
        if (frame > 1) assert_int_equal(answers[0].age, 1);
        assert_int_equal(s.driver.pending_count, HALF);
    }
    session_close(&s);
}

static void a_missing_answer_counts_as_seen(void **state)
{
    (void)state;
    static session s;
    uint32_t times[FAKE_PLACES_MOST];
    open_session(&s, "testmore[wait=1]");
    s.driver.pixels_of = third_are_hidden_fifth_never_told;
    session_frame(&s, &(session_view){.frame = 1});
    session_set_by_item(&s, times);
    for (uint32_t i = 0; i < ITEMS; ++i) assert_int_equal(times[i], i < HALF || i % 5 == 0 || i % 3 != 0);
    assert_int_equal(s.stats.limits_hit, 1);
    session_close(&s);
}

static void without_a_driver_every_test_counts_as_seen(void **state)
{
    (void)state;
    static session s;
    open_session(&s, "testmore[wait=1]");
    const camera c = box_scene_camera(&s.q.boxes, 0);
    const frame_input input = {.camera = &c, .frame = {.width_px = 64, .height_px = 64, .frame = 1, .purpose = CULL_VIEW_MAIN}};
    world_cull(s.view, &input, &s.set, &s.stats);
    assert_int_equal(s.stats.items_drawn, ITEMS);
    assert_int_equal(s.stats.stalls, 0);
    session_close(&s);
}

// Nobody shows the pictures that stand for items, so the items have to be drawn.
static void without_a_driver_no_item_is_lost_in_a_picture(void **state)
{
    (void)state;
    static const char *const chains[] = {"testpicture[distance=0.5]", "testpicture[distance=0.5]+testfilter[keep=all]"};
    for (int n = 0; n < 2; ++n)
        for (int has_capture = 0; has_capture < 2; ++has_capture) {
            static session s;
            open_session(&s, chains[n]);
            camera c = box_scene_camera(&s.q.boxes, 0);
            c.eye[2] += 200; // from where the picture is taken
            const frame_driver whole = fake_driver_of(&s.driver), half = {.user = &s.driver, .capture = has_capture ? whole.capture : NULL};
            for (uint32_t frame = 1; frame < 4; ++frame) {
                const frame_input input = {.camera = &c, .frame = {.width_px = 64, .height_px = 64, .frame = frame, .purpose = CULL_VIEW_MAIN}, .driver = half};
                fake_driver_new_frame(&s.driver);
                world_cull(s.view, &input, &s.set, &s.stats);
                assert_int_equal(s.stats.items_drawn, ITEMS);
                assert_int_equal(s.stats.faults, 0);
                assert_int_equal(s.stats.pictures, 0);
                if (frame == 1) assert_int_equal(s.stats.limits_hit, 1);
            }
            session_close(&s);
        }
}

// ---- Pictures ----

static const session_view at_picture = {.right_m = 200}, near_picture = {.right_m = 200.25}, off_picture = {.right_m = 201};

static void frame_at(session *s, session_view v, uint32_t frame)
{
    v.frame = frame;
    session_frame(s, &v);
    assert_int_equal(s->stats.faults, 0);
}

// The first half stands in the picture and is not drawn, or the other way round; every item is in D either way.
static void assert_half_is_shown(const session *s, uint32_t shown)
{
    for (uint32_t i = 0; i < ITEMS; ++i) {
        assert_int_equal(s->driver.shown[i], i < HALF ? shown : 0);
        assert_int_equal(s->driver.drawn[i], i < HALF ? !shown : 1);
    }
    assert_int_equal(s->driver.shows, shown);
    assert_int_equal(s->stats.pictures, shown);
    assert_int_equal(s->stats.items_drawn, shown ? HALF : ITEMS);
}

static void a_picture_is_taken_once_and_shown_while_the_eye_stays_near(void **state)
{
    (void)state;
    static session s;
    static const fake_event taking[] = {FAKE_COLLECT_READY, FAKE_DRAW, FAKE_CAPTURE, FAKE_SHOW};
    open_session(&s, "testpicture[distance=0.5]");
    frame_at(&s, at_picture, 1);
    assert_int_equal(s.stats.captures, 1);
    assert_half_is_shown(&s, 1);
    assert_events(&s, taking + 1, 3); // no tests, so nothing to collect
    for (uint32_t frame = 2; frame < 10; ++frame) {
        const uint32_t is_near = frame % 3 != 0;
        frame_at(&s, is_near ? near_picture : off_picture, frame);
        assert_int_equal(s.stats.captures, 0);
        assert_half_is_shown(&s, is_near);
    }
    session_close(&s);
}

static void a_picture_that_is_lost_is_drawn_as_geometry(void **state)
{
    (void)state;
    static session s;
    open_session(&s, "testpicture");
    frame_at(&s, at_picture, 1);
    s.view->zones[0]->slots[0] = 0; // a host may drop a picture at any frame
    frame_at(&s, at_picture, 2);
    assert_half_is_shown(&s, 0);
    session_close(&s);
}

static void a_group_around_the_eye_is_no_picture(void **state)
{
    (void)state;
    static session s;
    open_session(&s, "testpicture");
    frame_at(&s, (session_view){.right_m = 0}, 1);
    assert_int_equal(s.stats.captures, 0);
    assert_half_is_shown(&s, 0);
    session_close(&s);
}

static void each_viewer_has_pictures_of_its_own(void **state)
{
    (void)state;
    static session s;
    world_view *other;
    open_session(&s, "testpicture");
    assert_int_equal(world_view_open(s.world, VIEWER_CHECK_ALL, &s.lines.report, &other), RESULT_OK);
    frame_at(&s, at_picture, 1);
    world_view *first = s.view;
    s.view = other;
    frame_at(&s, near_picture, 1);
    assert_int_equal(s.stats.captures, 1);
    assert_half_is_shown(&s, 1);
    s.view = first;
    world_view_close(other);
    session_close(&s);
}

static void a_filter_behind_a_picture_keeps_it_or_drops_it(void **state)
{
    (void)state;
    static session s;
    static const fake_event keeping[] = {FAKE_DRAW, FAKE_CAPTURE, FAKE_SHOW};
    static const char *const chains[] = {"testpicture+testfilter[keep=all]", "testpicture+testfilter[keep=all]+testfilter[keep=all]"};
    for (int i = 0; i < 2; ++i) {
        open_session(&s, chains[i]);
        frame_at(&s, at_picture, 1);
        assert_events(&s, keeping, 3);
        assert_half_is_shown(&s, 1);
        frame_at(&s, near_picture, 2);
        assert_int_equal(s.stats.captures, 0);
        assert_half_is_shown(&s, 1);
        session_close(&s);
    }
    static const char *const dropping[] = {"testpicture+testfilter[keep=all,pictures=drop]", "testpicture+testfilter[keep=all,pictures=drop]+testfilter[keep=all]",
                                           "testpicture+testfilter[keep=all]+testfilter[keep=all,pictures=drop]"};
    for (int i = 0; i < 3; ++i) {
        open_session(&s, dropping[i]);
        frame_at(&s, at_picture, 1);
        assert_int_equal(s.stats.captures, 0);
        assert_int_equal(s.driver.captures + s.driver.shows, 0);
        assert_int_equal(s.stats.items_drawn, HALF);
        assert_int_equal(s.view->zones[0]->slots[0], 0);
        frame_at(&s, at_picture, 2); // never captured, so the select draws geometry
        assert_half_is_shown(&s, 0);
        session_close(&s);
    }
}

static void a_capture_that_a_kept_picture_shows_is_taken_though_a_filter_drops_it(void **state)
{
    (void)state;
    static session s;
    static const char *const chains[] = {"testpicture+testfilter[keep=all,pictures=torn]", "testpicture+testfilter[keep=all,pictures=torn]+testfilter[keep=all]"};
    for (int i = 0; i < 2; ++i) {
        open_session(&s, chains[i]);
        frame_at(&s, at_picture, 1);
        assert_int_equal(s.stats.captures, 1);
        assert_half_is_shown(&s, 1);
        session_close(&s);
    }
}

static void captures_are_composed_of_earlier_ones_and_kept_with_what_they_need(void **state)
{
    (void)state;
    static const struct { const char *chain; uint32_t captures, shows; } cases[] = {
        {"testbad[fault=picture_composed]", 2, 1},
        {"testbad[fault=picture_composed]+testfilter[keep=all]", 2, 1},
        {"testbad[fault=picture_composed]+testfilter[keep=all,pictures=torn]", 2, 1},
        {"testbad[fault=picture_composed]+testfilter[keep=all,pictures=drop]", 0, 0},
        {"testbad[fault=picture_beside]+testfilter[keep=all]", 2, 1},
        {"testbad[fault=picture_beside]+testfilter[keep=all,pictures=torn]", 1, 1},
    };
    for (size_t n = 0; n < sizeof cases / sizeof *cases; ++n) {
        static session s;
        open_session(&s, cases[n].chain);
        for (uint32_t frame = 1; frame < 3; ++frame) { // the slots are empty in the first and hold old pictures in the next
            frame_at(&s, at_picture, frame);
            assert_int_equal(s.driver.captures, cases[n].captures);
            assert_int_equal(s.stats.captures, cases[n].captures);
            assert_int_equal(s.driver.shows, cases[n].shows);
        }
        session_close(&s);
    }
}

static void a_filter_that_walks_gets_the_select_s_pictures_and_no_candidates(void **state)
{
    (void)state;
    static const struct { const char *chain; uint32_t steps, shown; } cases[] = {
        {"testpicture[hierarchy=1]+testfilter[keep=all,walk=1]", 2, 1},
        {"testpicture[hierarchy=1]+testfilter[keep=even]+testfilter[keep=all,walk=1]", 2, 1},
        {"testpicture[hierarchy=1]+testfilter[keep=all,walk=1]+testfilter[keep=all]", 3, 1},
        {"testpicture[hierarchy=1]+testfilter[keep=all,walk=1,pictures=drop]", 2, 0},
    };
    for (size_t n = 0; n < sizeof cases / sizeof *cases; ++n) {
        static session s;
        open_session(&s, cases[n].chain);
        frame_at(&s, at_picture, 1);
        assert_half_is_shown(&s, cases[n].shown);
        assert_int_equal(s.stats.captures, cases[n].shown);
        assert_int_equal(s.stats.steps, cases[n].steps);
        assert_int_equal(s.stats.nodes_visited, 1);
        session_close(&s);
    }
}

static void without_a_capturing_driver_no_slot_is_filled(void **state)
{
    (void)state;
    static session s;
    open_session(&s, "testpicture");
    const camera c = box_scene_camera(&(box_scene){.at = {200, 0, 0}}, 0);
    for (uint32_t frame = 1; frame < 4; ++frame) {
        const frame_input input = {.camera = &c, .frame = {.width_px = 64, .height_px = 64, .frame = frame, .purpose = CULL_VIEW_MAIN}};
        world_cull(s.view, &input, &s.set, &s.stats);
        assert_int_equal(s.view->zones[0]->slots[0], 0);
        assert_int_equal(s.stats.faults, 0);
        if (frame > 1) assert_int_equal(s.stats.items_drawn, ITEMS);
    }
    session_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(waiting_draws_first_then_tests_then_draws_what_was_seen),
        cmocka_unit_test(waiting_for_a_late_answer_is_a_stall_and_exact),
        cmocka_unit_test(waiting_gets_this_step_s_answers_past_any_number_of_old_ones),
        cmocka_unit_test(answers_to_tests_older_than_the_query_are_no_answers_to_it),
        cmocka_unit_test(more_takes_what_is_ready_without_a_stall),
        cmocka_unit_test(an_answer_of_an_earlier_frame_is_told_its_age_and_believed_by_no_one),
        cmocka_unit_test(a_missing_answer_counts_as_seen),
        cmocka_unit_test(without_a_driver_no_item_is_lost_in_a_picture),
        cmocka_unit_test(without_a_driver_every_test_counts_as_seen),
        cmocka_unit_test(a_picture_is_taken_once_and_shown_while_the_eye_stays_near),
        cmocka_unit_test(a_picture_that_is_lost_is_drawn_as_geometry),
        cmocka_unit_test(a_group_around_the_eye_is_no_picture),
        cmocka_unit_test(each_viewer_has_pictures_of_its_own),
        cmocka_unit_test(a_filter_behind_a_picture_keeps_it_or_drops_it),
        cmocka_unit_test(a_capture_that_a_kept_picture_shows_is_taken_though_a_filter_drops_it),
        cmocka_unit_test(captures_are_composed_of_earlier_ones_and_kept_with_what_they_need),
        cmocka_unit_test(a_filter_that_walks_gets_the_select_s_pictures_and_no_candidates),
        cmocka_unit_test(without_a_capturing_driver_no_slot_is_filled),
    };
    return cmocka_run_group_tests_name("core stepping", tests, NULL, NULL);
}
