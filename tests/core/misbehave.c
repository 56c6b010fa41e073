// Tests of frames with a culler that breaks the contract: the frame ends, the zone is drawn whole, the fault is counted
// in each frame and told once, and a culler that behaves again is used again.
// SPDX-License-Identifier: MIT
#include "session.h"
#include "tests/common/test.h"

#include <stdio.h>
#include <string.h>

typedef struct fault_case {
    const char *name, *says;
    const char *movers; // the option
} fault_case;

// Faults that a check of bounds and totals finds.
static const fault_case bounds[] = {
    {"run_wild", "a run outside the zone", "0"},
    {"run_wild", "a run outside the zone", "1"},
    {"run_of_a_mover", "a run outside the zone", "0"},
    {"run_past_end", "a run outside the zone", "0"},
    {"run_huge_first", "a run outside the zone", "0"},
    {"run_huge_count", "a run outside the zone", "0"},
    {"run_huge_count", "a run outside the zone", "1"},
    {"run_wraps", "a run outside the zone", "0"},
    {"run_empty", "or an empty one", "0"},
    {"runs_too_many", "more runs than it told", "0"},
    {"runs_too_many", "more runs than it told", "1"},
    {"runs_endless", "more runs than it told", "0"},
    {"zone_twice", "an item given twice", "0"},
    {"mover_over_edge", "a run over items and movers", "1"},
    {"mover_twice", "twice", "1"},
    {"takes_back", "took runs or pictures back", "0"},
    {"returns_odd", "neither DONE, MORE nor WAIT", "0"},
    {"returns_negative", "neither DONE, MORE nor WAIT", "0"},
    {"more_for_ever", "more steps than it told", "0"},
    {"wait_for_ever", "more steps than it told", "0"},
    {"tests_too_many", "more tests than it told", "0"},
    {"test_nan", "not finite or is inside out", "0"},
    {"test_infinite", "not finite or is inside out", "0"},
    {"test_inside_out", "not finite or is inside out", "0"},
    {"captures_too_many", "more captures than it told", "0"},
    {"capture_slot", "a slot that is not there", "0"},
    {"capture_nan", "not finite", "0"},
    {"capture_box", "not finite", "0"},
    {"capture_no_pixels", "no or too many pixels", "0"},
    {"capture_huge", "no or too many pixels", "0"},
    {"capture_clip_count", "over 4 clip planes", "0"},
    {"capture_clip_nan", "clip planes are not finite", "0"},
    {"capture_of_empty_slot", "a slot that is empty", "0"},
    {"capture_of_itself", "a slot that is empty", "0"},
    {"capture_null_slots", "slots that are not there", "0"},
    {"capture_wild_run", "a run outside the zone", "0"},
    {"capture_null_runs", "without its runs", "0"},
    {"capture_endless_runs", "more runs than there are items", "0"},
    {"pictures_too_many", "more pictures than it told", "0"},
    {"picture_empty_slot", "a slot that is empty", "0"},
    {"picture_slot", "a slot that is not there", "0"},
    {"picture_nan_error", "not finite", "0"},
    {"picture_negative_error", "not finite", "0"},
    {"picture_infinite_error", "not finite", "0"},
    {"picture_box", "not finite", "0"},
    {"picture_past_end", "a run outside the zone", "0"},
    {"picture_null_runs", "without its runs", "0"},
    {"pictures_taken_back", "took runs or pictures back", "0"},
    {"replaces_runs", "it replaced a list of the batch", "0"},
    {"replaces_pictures", "it replaced a list of the batch", "0"},
    {"replaces_tests", "it replaced a list of the batch", "0"},
    {"replaces_captures", "it replaced a list of the batch", "0"},
    {"replaces_keep_pictures", "it replaced a list of the batch", "0"},
    {"replaces_keep_captures", "it replaced a list of the batch", "0"},
    {"zone_twice_over_steps", "an item given twice", "0"},
    {"tests_endless", "more tests than it told", "0"},
    {"captures_endless", "more captures than it told", "0"},
    {"pictures_endless", "more pictures than it told", "0"},
    {"capture_composed_early", "a slot that is empty", "0"},
    {"clipped_too_many", "more clipped items than it told", "0"},
    {"clipped_endless", "more clipped items than it told", "0"},
    {"clipped_plane_count", "over 4 clip planes", "0"},
    {"clipped_plane_nan", "clip planes are not finite", "0"},
    {"clipped_plane_infinite", "clip planes are not finite", "0"},
    {"clipped_box", "not finite", "0"},
    {"clipped_null_runs", "without its runs", "0"},
    {"clipped_endless_runs", "more runs than there are items", "0"},
    {"clipped_wild_run", "a run outside the zone", "0"},
    {"clipped_mover", "a run outside the zone", "0"},
    {"clipped_mover", "a run outside the zone", "1"},
    {"clipped_zone_twice", "an item given twice", "0"},
    {"clipped_taken_back", "took runs or pictures back", "0"},
    {"replaces_clipped", "it replaced a list of the batch", "0"},
    {"replaces_keep_clipped", "it replaced a list of the batch", "0"},
};

enum { BAD_FRAMES = 3 };

static void assert_good_frame(session *s, uint32_t frame)
{
    session_frame(s, &(session_view){.frame = frame});
    if (s->stats.faults != 0) fail_msg("%s: frame %u still counts a fault: %s", s->q.chain, frame, report_lines_only(&s->lines));
    assert_int_equal(s->stats.items_drawn, s->scene->item_count);
}

// Runs frames 1 .. BAD_FRAMES with the fault, one more without.
static void assert_fault_is_caught(const session_request *q, const char *says)
{
    static session s;
    assert_int_equal(session_open(&s, q), RESULT_OK);
    for (uint32_t frame = 1; frame <= BAD_FRAMES; ++frame) {
        session_frame(&s, &(session_view){.frame = frame, .yaw_deg = 30});
        if (s.stats.faults != 1) fail_msg("%s: frame %u counts %u faults", q->chain, frame, s.stats.faults);
        session_assert_whole(&s);
        if (s.chain->stage_count == 1) assert_true(s.stats.steps <= s.chain->stages[0].built.max_steps);
    }
    if (!report_lines_is_one_with(&s.lines, says) || !report_lines_is_one_with(&s.lines, "culler 'testbad' misbehaves: ")) fail_msg("%s", q->chain);
    assert_good_frame(&s, BAD_FRAMES + 1);
    assert_int_equal(s.lines.count, 1);
    session_close(&s);
}

static void assert_case_is_caught(const char *format, const fault_case *c, viewer_checks checks)
{
    char stage[96], chain[160];
    snprintf(stage, sizeof stage, "testbad[fault=%s,until=%d,movers=%s]", c->name, BAD_FRAMES + 1, c->movers);
    snprintf(chain, sizeof chain, format, stage);
    const session_request q = {.chain = chain, .boxes = {.items = 16, .movers = 3, .seed = 7}, .checks = checks};
    assert_fault_is_caught(&q, c->says);
}

static void every_fault_of_a_select_is_caught_by_bounds(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof bounds / sizeof *bounds; ++i) assert_case_is_caught("%s", &bounds[i], VIEWER_CHECK_BOUNDS);
}

static void every_fault_of_a_filter_is_caught_by_bounds(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof bounds / sizeof *bounds; ++i) {
        assert_case_is_caught("none+%s", &bounds[i], VIEWER_CHECK_BOUNDS);
        assert_case_is_caught("testorder+testfilter[keep=all,walk=1]+%s", &bounds[i], VIEWER_CHECK_BOUNDS);
    }
}

static void checking_all_catches_the_same_and_an_item_given_twice(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof bounds / sizeof *bounds; ++i) assert_case_is_caught("%s", &bounds[i], VIEWER_CHECK_ALL);
    const fault_case twice = {"item_twice", "an item given twice", "0"};
    assert_case_is_caught("%s", &twice, VIEWER_CHECK_ALL);
    assert_case_is_caught("none+%s", &twice, VIEWER_CHECK_ALL);
    const fault_case over_steps = {"item_twice_over_steps", "an item given twice", "0"};
    assert_case_is_caught("%s", &over_steps, VIEWER_CHECK_ALL);
    assert_case_is_caught("none+%s", &over_steps, VIEWER_CHECK_ALL);
}

static void checking_all_catches_an_item_clipped_twice_at_one_seam_or_clipped_and_whole(void **state)
{
    (void)state;
    static const fault_case cases[] = {{"clipped_item_twice", "an item given twice", "0"},
                                       {"clipped_and_whole", "an item given clipped and whole", "0"},
                                       {"clipped_and_whole", "an item given clipped and whole", "1"},
                                       {"clipped_then_whole", "an item given clipped and whole", "0"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        assert_case_is_caught("%s", &cases[i], VIEWER_CHECK_ALL);
        assert_case_is_caught("none+%s", &cases[i], VIEWER_CHECK_ALL);
    }
}

// What a stage in front of a filter may not do; what else it does wrong is caught as in the last stage.
static void a_stage_that_steps_or_asks_before_the_last_is_caught(void **state)
{
    (void)state;
    static const fault_case early[] = {
        {"more_for_ever", "it steps, but is not the last", "0"},   {"wait_for_ever", "it steps, but is not the last", "0"},
        {"returns_odd", "it steps, but is not the last", "0"},     {"takes_back", "it steps, but is not the last", "0"},
        {"test_given", "it asks for tests, but is not the last", "0"}, {"tests_too_many", "more tests than it told", "0"},
        {"test_nan", "not finite", "0"},                           {"run_wild", "a run outside the zone", "1"},
        {"run_huge_count", "a run outside the zone", "0"},         {"runs_endless", "more runs than it told", "0"},
        {"capture_nan", "not finite", "0"},                        {"picture_empty_slot", "a slot that is empty", "0"},
        {"replaces_runs", "it replaced a list", "0"},              {"replaces_captures", "it replaced a list", "0"},
    };
    static const fault_case middle = {"capture_given", "gives pictures, but is neither first nor last", "0"};
    static const fault_case middle_clip = {"clipped_given", "clips items, but is neither first nor last", "0"};
    for (size_t i = 0; i < sizeof early / sizeof *early; ++i) {
        assert_case_is_caught("%s+testfilter[keep=all]", &early[i], VIEWER_CHECK_BOUNDS);
        assert_case_is_caught("%s+testcross+testfilter[keep=all,movers=1]", &early[i], VIEWER_CHECK_BOUNDS);
        assert_case_is_caught("none+%s+testfilter[keep=all]", &early[i], VIEWER_CHECK_BOUNDS);
    }
    assert_case_is_caught("none+%s+testfilter[keep=all]", &middle, VIEWER_CHECK_BOUNDS);
    assert_case_is_caught("none+%s+testfilter[keep=all]", &middle_clip, VIEWER_CHECK_BOUNDS);
}

static void what_was_drawn_stays_in_the_set_whatever_is_written_over_it(void **state)
{
    (void)state;
    static const char *const chains[] = {"testbad[fault=rewrites_drawn]", "testbad[fault=rewrites_drawn,movers=1]", "none+testbad[fault=rewrites_drawn,movers=1]"};
    for (int n = 0; n < 3; ++n)
        for (int checks = 0; checks < 2; ++checks) {
            static session s;
            const session_request q = {.chain = chains[n], .boxes = {.items = 16, .movers = 3, .seed = 7}, .checks = checks ? VIEWER_CHECK_ALL : VIEWER_CHECK_BOUNDS};
            assert_int_equal(session_open(&s, &q), RESULT_OK);
            for (uint32_t frame = 1; frame <= 3; ++frame) {
                uint32_t times[FAKE_PLACES_MOST];
                session_frame(&s, &(session_view){.frame = frame});
                session_set_by_item(&s, times);
                for (uint32_t i = 0; i < FAKE_PLACES_MOST; ++i) assert_int_equal(s.driver.drawn[i], times[i]);
                assert_int_equal(s.stats.steps, n == 2 ? 3 : 2);
                assert_int_equal(s.stats.items_drawn, 16);
                assert_int_equal(s.stats.faults, 0);
            }
            session_close(&s);
        }
}

static void a_fault_is_told_even_after_many_warnings_of_a_file(void **state)
{
    (void)state;
    static session s;
    const session_request q = {.chain = "testbad[fault=run_wild]", .boxes = {.items = 16, .seed = 7}};
    assert_int_equal(session_open(&s, &q), RESULT_OK);
    for (int i = 0; i < 40; ++i) report_warning(&s.lines.report, "some.map", 1, "a warning");
    const uint32_t before = s.lines.count;
    session_frame(&s, &(session_view){.frame = 1});
    assert_int_equal(s.lines.count, before + 1);
    assert_non_null(strstr(s.lines.lines[before], "culler 'testbad' misbehaves"));
    session_close(&s);
}

static void each_viewer_of_a_bad_culler_tells_of_it_once(void **state)
{
    (void)state;
    static session s;
    const session_request q = {.chain = "testbad[fault=run_wild]", .boxes = {.items = 16, .seed = 7}};
    assert_int_equal(session_open(&s, &q), RESULT_OK);
    for (uint32_t open = 1; open <= 2; ++open) {
        for (uint32_t frame = 1; frame <= 5; ++frame) session_frame(&s, &(session_view){.frame = frame});
        assert_int_equal(s.lines.count, open);
        world_view_close(s.view);
        assert_int_equal(world_view_open(s.world, q.checks, &s.lines.report, &s.view), RESULT_OK);
    }
    session_close(&s);
}

static void without_a_driver_a_bad_culler_harms_nothing_either(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof bounds / sizeof *bounds; ++i) {
        static session s;
        char chain[160];
        snprintf(chain, sizeof chain, "testbad[fault=%s,movers=%s]", bounds[i].name, bounds[i].movers);
        const session_request q = {.chain = chain, .boxes = {.items = 16, .movers = 3, .seed = 7}};
        assert_int_equal(session_open(&s, &q), RESULT_OK);
        const camera c = box_scene_camera(&q.boxes, 0);
        const frame_input input = {.camera = &c, .frame = {.width_px = 64, .height_px = 64, .frame = 1, .purpose = CULL_VIEW_MAIN}};
        world_cull(s.view, &input, NULL, &s.stats);
        assert_int_equal(s.stats.faults, 1);
        assert_int_equal(s.stats.items_drawn, 16);
        assert_int_equal(s.stats.movers_drawn, 3);
        session_close(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_fault_of_a_select_is_caught_by_bounds),
        cmocka_unit_test(every_fault_of_a_filter_is_caught_by_bounds),
        cmocka_unit_test(checking_all_catches_the_same_and_an_item_given_twice),
        cmocka_unit_test(checking_all_catches_an_item_clipped_twice_at_one_seam_or_clipped_and_whole),
        cmocka_unit_test(a_stage_that_steps_or_asks_before_the_last_is_caught),
        cmocka_unit_test(what_was_drawn_stays_in_the_set_whatever_is_written_over_it),
        cmocka_unit_test(a_fault_is_told_even_after_many_warnings_of_a_file),
        cmocka_unit_test(each_viewer_of_a_bad_culler_tells_of_it_once),
        cmocka_unit_test(without_a_driver_a_bad_culler_harms_nothing_either),
    };
    return cmocka_run_group_tests_name("core misbehave", tests, NULL, NULL);
}
