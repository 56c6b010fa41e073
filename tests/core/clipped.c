// Tests of clipped items in a frame, of slots that a driver or a change empties, and of the costs that plugins are lent.
// SPDX-License-Identifier: MIT
#include "session.h"
#include "tests/common/test.h"

#include <string.h>

enum { ITEMS = 16, HALF = ITEMS / 2, CLIPPED = 3 };
static const session_view at_picture = {.right_m = 200};

static void open_session(session *s, const char *chain)
{
    const session_request q = {.chain = chain, .boxes = {.items = ITEMS, .movers = 2, .seed = 5}, .checks = VIEWER_CHECK_ALL};
    assert_int_equal(session_open(s, &q), RESULT_OK);
}

static void frame_at(session *s, session_view v, uint32_t frame)
{
    v.frame = frame;
    session_frame(s, &v);
    assert_int_equal(s->stats.faults, 0);
}

static void assert_clipped(const session *s, uint32_t times)
{
    for (uint32_t i = 0; i < ITEMS; ++i) assert_int_equal(s->driver.clipped[i], i < ITEMS - CLIPPED ? 0 : times);
    for (uint32_t i = ITEMS - CLIPPED; i < ITEMS; ++i) assert_int_equal(s->driver.drawn[i], 0);
    assert_int_equal(s->stats.clipped, times);
    assert_int_equal(s->driver.clips, times);
}

static void a_clipped_item_is_drawn_once_for_each_seam_after_runs_and_before_captures(void **state)
{
    (void)state;
    static session s;
    static const fake_event order[] = {FAKE_DRAW, FAKE_DRAW_CLIPPED, FAKE_CAPTURE, FAKE_SHOW};
    static const char *const chains[] = {"testpicture[clip=3]", "testpicture[clip=3]+testfilter[keep=all]",
                                         "testpicture[clip=3]+testfilter[keep=all]+testfilter[keep=all]"};
    for (int i = 0; i < 3; ++i) {
        open_session(&s, chains[i]);
        frame_at(&s, at_picture, 1);
        assert_clipped(&s, 2);
        assert_memory_equal(s.driver.events, order, sizeof order);
        assert_int_equal(s.stats.items_drawn, ITEMS - HALF - CLIPPED);
        frame_at(&s, at_picture, 2);
        assert_clipped(&s, 2);
        session_close(&s);
    }
}

static void a_filter_drops_clipped_items(void **state)
{
    (void)state;
    static session s;
    static const char *const chains[] = {"testpicture[clip=3]+testfilter[keep=all,pictures=drop]",
                                         "testpicture[clip=3]+testfilter[keep=all,pictures=drop]+testfilter[keep=all]",
                                         "testpicture[clip=3]+testfilter[keep=all]+testfilter[keep=all,pictures=drop]"};
    for (int i = 0; i < 3; ++i) {
        open_session(&s, chains[i]);
        frame_at(&s, at_picture, 1);
        assert_clipped(&s, 0);
        session_close(&s);
    }
}

static void where_nobody_clips_the_zone_is_drawn_whole(void **state)
{
    (void)state;
    static session s;
    static const char *const chains[] = {"testpicture[clip=3]", "testpicture[clip=3]+testfilter[keep=all]"};
    for (int i = 0; i < 2; ++i) {
        open_session(&s, chains[i]);
        frame_driver driver = fake_driver_of(&s.driver);
        driver.draw_clipped = NULL;
        const camera c = box_scene_camera(&s.q.boxes, 0);
        const frame_input input = {.camera = &c, .frame = {.width_px = 64, .height_px = 64, .frame = 1, .purpose = CULL_VIEW_MAIN}, .driver = driver};
        fake_driver_new_frame(&s.driver);
        world_cull(s.view, &input, &s.set, &s.stats);
        for (uint32_t item = 0; item < ITEMS; ++item) assert_int_equal(s.driver.drawn[item], 1);
        assert_int_equal(s.stats.items_drawn, ITEMS);
        assert_int_equal(s.stats.limits_hit, 1);
        assert_int_equal(s.stats.clipped, 0);
        session_close(&s);
    }
}

static void assert_shows(const session *s, uint32_t shown, uint32_t captured)
{
    assert_int_equal(s->driver.shows, shown);
    assert_int_equal(s->driver.captures, captured);
    for (uint32_t i = 0; i < HALF; ++i) assert_int_equal(s->driver.drawn[i], !shown);
}

static void a_picture_that_the_driver_gives_up_is_told_before_the_next_step(void **state)
{
    (void)state;
    static session s;
    open_session(&s, "testpicture");
    frame_at(&s, at_picture, 1);
    assert_shows(&s, 1, 1);
    frame_at(&s, at_picture, 2);
    assert_shows(&s, 1, 0);
    s.driver.loses_slots = 1;
    frame_at(&s, at_picture, 3);
    assert_shows(&s, 0, 0);
    session_close(&s);
}

static void a_change_empties_the_pictures_that_its_box_touches_in_every_view(void **state)
{
    (void)state;
    static session s;
    world_view *other, *first;
    open_session(&s, "testpicture");
    frame_at(&s, at_picture, 1);
    assert_int_equal(world_view_open(s.world, VIEWER_CHECK_ALL, &s.lines.report, &other), RESULT_OK);
    first = s.view;
    s.view = other;
    frame_at(&s, at_picture, 1);
    s.view = first;
    const cull_box box = first->zones[0]->slot_boxes[0];
    const double *o = s.scene->zones[0].origin, eps = 1e-3;
    const double min[3] = {(double)box.min.x + o[0], (double)box.min.y + o[1], (double)box.min.z + o[2]};
    const double max[3] = {(double)box.max.x + o[0], (double)box.max.y + o[1], (double)box.max.z + o[2]};
    for (int axis = 0; axis < 3; ++axis) { // beside it
        double beside_min[3] = {min[0], min[1], min[2]}, beside_max[3] = {max[0], max[1], max[2]};
        beside_min[axis] = max[axis] + eps;
        beside_max[axis] = max[axis] + 1;
        world_changed(s.world, beside_min, beside_max);
        beside_min[axis] = min[axis] - 1;
        beside_max[axis] = min[axis] - eps;
        world_changed(s.world, beside_min, beside_max);
    }
    assert_int_equal(first->zones[0]->slots[0] + other->zones[0]->slots[0], 2);
    world_changed(s.world, max, max); // its corner
    assert_int_equal(first->zones[0]->slots[0] + other->zones[0]->slots[0], 0);
    frame_at(&s, at_picture, 2);
    assert_shows(&s, 0, 0);
    world_view_close(other);
    session_close(&s);
}

static void costs_are_lent_fixed_until_somebody_sets_others(void **state)
{
    (void)state;
    static session s;
    open_session(&s, "testpicture");
    const cull_host *host = &s.services.host, *of_stage = &s.chain->stages[0].host;
    const cull_costs *lent = host->get_extension(host, NULL, CULL_EXT_COSTS);
    assert_non_null(lent);
    assert_ptr_equal(of_stage->get_extension(of_stage, NULL, CULL_EXT_COSTS), lent);
    assert_null(host->get_extension(host, &s.chain->zone, CULL_EXT_COSTS));
    assert_null(host->get_extension(host, NULL, "cull.costs/2"));
    assert_int_equal(lent->is_measured, 0);
    assert_true(lent->polygon_ns > 0 && lent->picture_bytes > 0);
    cull_costs other = *lent;
    other.polygon_ns = 77;
    host_costs_set(&s.services, &other);
    assert_true(lent->polygon_ns > 76.5 && lent->polygon_ns < 77.5);
    session_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_clipped_item_is_drawn_once_for_each_seam_after_runs_and_before_captures),
        cmocka_unit_test(a_filter_drops_clipped_items),
        cmocka_unit_test(where_nobody_clips_the_zone_is_drawn_whole),
        cmocka_unit_test(a_picture_that_the_driver_gives_up_is_told_before_the_next_step),
        cmocka_unit_test(a_change_empties_the_pictures_that_its_box_touches_in_every_view),
        cmocka_unit_test(costs_are_lent_fixed_until_somebody_sets_others),
    };
    return cmocka_run_group_tests_name("core clipped", tests, NULL, NULL);
}
