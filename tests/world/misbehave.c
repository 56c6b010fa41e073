// Tests of cullers that break the contract in a world of several zones: their zone is drawn whole, the others stay exact.
// SPDX-License-Identifier: MIT
#include "site.h"
#include "tests/common/test.h"

#include <string.h>

enum { LEFT, RIGHT, MIXED = 80, ITEMS = 320 };

// Two rooms with a hole between them; every second of the first MIXED items stands in the wall, so that both rooms list it,
// the others in the right room.
static world_view *open_rooms(site *s, const char *right, uint32_t more_movers)
{
    static const site_box rooms[] = {{{-40, 0, 0}, {0, 4, 10}}, {{0, 0, 0}, {40, 4, 10}}};
    const char *const chains[] = {"brute", right};
    world_view *v = NULL;
    uint32_t zone;
    site_begin(s, 0);
    assert_int_equal(site_room(s, "left", &rooms[LEFT], SCENE_NONE, &zone), RESULT_OK);
    assert_int_equal(site_room(s, "right", &rooms[RIGHT], SCENE_NONE, &zone), RESULT_OK);
    assert_int_equal(site_portal(s, "hole", &(site_hole){{LEFT, RIGHT}, SCENE_NONE, 0, 0, {0, 0}, {4, 10}}), RESULT_OK);
    for (int i = 0; i < ITEMS; ++i) {
        const double low = i % 2 || i >= MIXED ? 10 : -0.25, at = 0.02 * i;
        assert_int_equal(site_item(s, &(site_box){{low, 1, 1 + at}, {low + 0.5, 2, 1.01 + at}}), RESULT_OK);
    }
    assert_int_equal(site_end(s), RESULT_OK);
    if (site_open(s, &(site_world){.chain = "none", .chains = chains, .more_movers = more_movers}) != RESULT_OK) fail_msg("%s", report_lines_only(&s->lines));
    assert_int_equal(world_view_open(s->world, VIEWER_CHECK_BOUNDS, &s->lines.report, &v), RESULT_OK);
    return v;
}

static void assert_whole_and_told(site *s, world_view *v, const char *says)
{
    static site_sight sight;
    const double eye[3] = {-20, 1.5, 5}, forward[3] = {1, 0, 0};
    const camera c = site_camera(eye, forward);
    const frame_input q = site_input(&c, 1);
    site_look(s, v, &q, &sight);
    assert_int_equal(sight.stats.faults, 1);
    assert_true(report_lines_is_one_with(&s->lines, says));
    for (uint32_t i = 0; i < ITEMS; ++i) assert_int_equal(sight.items[i], 1);
}

static void runs_repeated_round_shared_items_fit_in_no_list_and_draw_the_zone_whole(void **state)
{
    (void)state;
    static site s;
    assert_whole_and_told(&s, open_rooms(&s, "testbad[fault=quarter_often]", 0), "an item given twice");
    site_close(&s);
}

static void a_run_of_movers_that_were_not_lent_is_a_fault(void **state)
{
    (void)state;
    static site s;
    assert_whole_and_told(&s, open_rooms(&s, "testbad[fault=all_movers,movers=1]", 300), "a mover that it was not lent");
    site_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(runs_repeated_round_shared_items_fit_in_no_list_and_draw_the_zone_whole),
        cmocka_unit_test(a_run_of_movers_that_were_not_lent_is_a_fault),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
