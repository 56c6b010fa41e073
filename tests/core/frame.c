// Tests of frames: sets against plain loops, movers, filters, order, several viewers, and that a frame allocates nothing.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "session.h"
#include "tests/common/random.h"
#include "tests/common/test.h"

#include <portcullis/plane.h>

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

enum { ITEMS = 1500, MOVERS = 300, ALL = ITEMS + MOVERS, VIEWS = 40 };

static session_view random_view(uint64_t *random, uint32_t frame)
{
    return (session_view){.frame = frame, .yaw_deg = random_between(random, 0, 360), .right_m = random_between(random, -80, 80)};
}

static camera camera_of(const session *s, const session_view *v)
{
    camera c = box_scene_camera(&s->q.boxes, v->yaw_deg);
    c.eye[0] -= c.forward[2] * v->right_m;
    c.eye[2] += c.forward[0] * v->right_m;
    return c;
}

// The oracle: which items and movers touch the view's volume, by the definition, one plane after the other.
static void touched(const session *s, const session_view *v, uint8_t *out)
{
    const camera c = camera_of(s, v);
    const view_frame f = {.width_px = 640, .height_px = 360, .frame = v->frame, .purpose = CULL_VIEW_MAIN};
    cull_view view;
    view_volume volume;
    view_derive(&c, &f, s->scene->whole.origin, &s->scene->whole.box, &view, &volume);
    for (uint32_t i = 0; i < s->scene->item_count + s->scene->mover_count; ++i) {
        out[i] = 1;
        for (uint32_t p = 0; p < volume.plane_count; ++p) out[i] &= cull_plane_touches(volume.planes[p], cull_box_at(&s->scene->boxes, i));
    }
}

// A second oracle, of the picture itself in double: a box with a corner in the picture must be in any set.
static int has_corner_in_picture(const session *s, const session_view *v, uint32_t i)
{
    const camera c = camera_of(s, v);
    double right[3], up[3], back[3];
    camera_axes(&c, right, up, back);
    const cull_box b = cull_box_at(&s->scene->boxes, i);
    const double tangent = tan(c.fovy_deg * 0.017453292519943295 / 2);
    for (int corner = 0; corner < 8; ++corner) {
        const double p[3] = {(double)(corner & 1 ? b.max.x : b.min.x) + s->scene->whole.origin[0] - c.eye[0],
                             (double)(corner & 2 ? b.max.y : b.min.y) + s->scene->whole.origin[1] - c.eye[1],
                             (double)(corner & 4 ? b.max.z : b.min.z) + s->scene->whole.origin[2] - c.eye[2]};
        double x = 0, y = 0, depth = 0;
        for (int k = 0; k < 3; ++k) {
            x += right[k] * p[k];
            y += up[k] * p[k];
            depth -= back[k] * p[k];
        }
        if (depth > c.near_m && fabs(x) <= tangent * c.aspect * depth && fabs(y) <= tangent * depth) return 1;
    }
    return 0;
}

static void open_session(session *s, const char *chain)
{
    const session_request q = {.chain = chain, .boxes = {.items = ITEMS, .movers = MOVERS, .seed = 21}, .checks = VIEWER_CHECK_ALL};
    assert_int_equal(session_open(s, &q), RESULT_OK);
}

static void assert_stats_are_of_the_set(const session *s, const uint32_t *times)
{
    uint64_t items = 0, movers = 0;
    for (uint32_t i = 0; i < ALL; ++i) *(i < ITEMS ? &items : &movers) += times[i];
    assert_int_equal(s->stats.items_drawn, items);
    assert_int_equal(s->stats.movers_drawn, movers);
    assert_int_equal(s->stats.movers_tested, MOVERS);
    assert_int_equal(s->stats.faults, 0);
    assert_int_equal(s->stats.portal_merges, 0);
    assert_true(s->stats.cull_ns >= 0);
}

static void brute_s_set_and_the_movers_are_those_of_the_plain_loop(void **state)
{
    (void)state;
    static const char *const chains[] = {"brute", "brute[isa=plain]", "brute[isa=avx2]", "brute[isa=avx512]"};
    for (int n = 0; n < 4; ++n) {
        static session s;
        uint8_t wanted[ALL];
        uint32_t times[FAKE_PLACES_MOST], found = 0;
        const session_request q = {.chain = chains[n], .boxes = {.items = ITEMS, .movers = MOVERS, .seed = 21}, .checks = VIEWER_CHECK_ALL};
        if (session_open(&s, &q) != RESULT_OK) {
            fprintf(stderr, "core frame: '%s' is NOT tested: %s\n", chains[n], s.lines.lines[0]);
            assert_true(n > 1);
            session_close(&s);
            continue;
        }
        uint64_t random = 5;
        for (uint32_t view = 1; view <= VIEWS; ++view) {
            const session_view v = random_view(&random, view);
            session_frame(&s, &v);
            touched(&s, &v, wanted);
            session_set_by_item(&s, times);
            for (uint32_t i = 0; i < ALL; ++i) {
                assert_int_equal(times[i], wanted[i]);
                assert_int_equal(s.driver.drawn[i], wanted[i]);
                if (has_corner_in_picture(&s, &v, i)) assert_int_equal(wanted[i], 1);
                found += wanted[i];
            }
            assert_stats_are_of_the_set(&s, times);
        }
        assert_true(found > VIEWS * ALL / 20 && found < VIEWS * ALL / 2); // the views see some and miss some
        session_close(&s);
    }
}

static void none_draws_all_items_and_the_movers_in_view(void **state)
{
    (void)state;
    static session s;
    uint8_t wanted[ALL];
    uint32_t times[FAKE_PLACES_MOST];
    open_session(&s, "none");
    const session_view v = {.frame = 1, .yaw_deg = 77};
    session_frame(&s, &v);
    touched(&s, &v, wanted);
    session_set_by_item(&s, times);
    for (uint32_t i = 0; i < ALL; ++i) assert_int_equal(times[i], i < ITEMS ? 1 : wanted[i]);
    assert_int_equal(s.set.zone_count, 1);
    assert_int_equal(s.set.zones[0].run_count, 1);
    assert_stats_are_of_the_set(&s, times);
    session_close(&s);
}

// ---- Filters ----

static void a_filter_gets_the_select_s_set_and_no_other(void **state)
{
    (void)state;
    static const char *const chains[] = {"brute+testfilter[keep=even]", "brute+testfilter[keep=all]+testfilter[keep=even]", "brute+testcross+testfilter[keep=even]"};
    for (int n = 0; n < 3; ++n) {
        static session s;
        uint8_t wanted[ALL];
        uint32_t times[FAKE_PLACES_MOST];
        uint64_t random = 6;
        open_session(&s, chains[n]);
        for (uint32_t view = 1; view <= VIEWS; ++view) {
            const session_view v = random_view(&random, view);
            session_frame(&s, &v);
            touched(&s, &v, wanted);
            session_set_by_item(&s, times);
            for (uint32_t i = 0; i < ALL; ++i) {
                assert_int_equal(times[i], wanted[i] && (i >= ITEMS || i % 2 == 0));
                assert_int_equal(s.driver.drawn[i], times[i]);
            }
            assert_int_equal(s.stats.steps, n == 1 ? 3 : 2);
            assert_stats_are_of_the_set(&s, times);
        }
        session_close(&s);
    }
}

static void a_filter_that_takes_movers_decides_about_those_in_view(void **state)
{
    (void)state;
    static session s;
    uint8_t wanted[ALL];
    uint32_t times[FAKE_PLACES_MOST];
    uint64_t random = 7;
    open_session(&s, "brute+testfilter[keep=all,movers=1]");
    for (uint32_t view = 1; view <= VIEWS; ++view) {
        const session_view v = random_view(&random, view);
        session_frame(&s, &v);
        touched(&s, &v, wanted);
        session_set_by_item(&s, times);
        uint8_t lent[ALL] = {0};
        const viewer *zone = s.view->zones[0];
        const cull_mover *movers = zone->visit.movers;
        for (uint32_t i = 0; i < zone->visit.mover_count; ++i) lent[movers[i].id] = i % 2 ? 1 : 2;
        for (uint32_t i = 0; i < ALL; ++i) {
            if (i >= ITEMS) assert_int_equal(lent[i] != 0, wanted[i]);
            const uint32_t kept = wanted[i] && (i < ITEMS || lent[i] == 2); // every second of those that it is lent
            assert_int_equal(times[i], kept);
            assert_int_equal(s.driver.drawn[i], kept); // by the filter's own batch, not again behind it
        }
        assert_stats_are_of_the_set(&s, times);
    }
    session_close(&s);
}

static void a_filter_behind_an_order_sees_the_boxes_in_it(void **state)
{
    (void)state;
    static const char *const chains[] = {"testorder+testfilter[keep=right]", "testorder+testfilter[keep=right,walk=1]", "none+testfilter[keep=right]"};
    for (int n = 0; n < 3; ++n) {
        static session s;
        uint32_t times[FAKE_PLACES_MOST];
        open_session(&s, chains[n]);
        session_frame(&s, &(session_view){.frame = 1});
        session_set_by_item(&s, times); // maps places back by the order
        for (uint32_t i = 0; i < ITEMS; ++i) assert_int_equal(times[i], s.scene->boxes.min_x[i] >= 0);
        session_close(&s);
    }
}

static void a_filter_that_walks_the_hierarchy_has_no_select_run_before_it(void **state)
{
    (void)state;
    static const struct { const char *chain; uint32_t steps, nodes; } cases[] = {
        {"testorder+testfilter[keep=even,walk=1]", 1, 3},
        {"testorder+testfilter[keep=even]", 2, 0},
        {"testorder+testfilter[keep=all,walk=1]+testfilter[keep=even]", 2, 3},
        {"testorder+testfilter[keep=all]+testfilter[keep=even,walk=1]", 1, 3},
    };
    for (size_t n = 0; n < sizeof cases / sizeof *cases; ++n) {
        static session s;
        uint32_t times[FAKE_PLACES_MOST];
        open_session(&s, cases[n].chain);
        session_frame(&s, &(session_view){.frame = 1});
        session_set_by_item(&s, times);
        for (uint32_t place = 0; place < ITEMS; ++place) assert_int_equal(times[s.chain->order[place]], place % 2 == 0);
        assert_int_equal(s.stats.steps, cases[n].steps);
        assert_int_equal(s.stats.nodes_visited, cases[n].nodes);
        session_close(&s);
    }
}

// ---- Memory, viewers, time ----

static void a_frame_allocates_nothing(void **state)
{
    (void)state;
    static const char *const chains[] = {"none", "brute", "testmore", "testpicture", "testorder+testfilter[walk=1]", "brute+testfilter[movers=1]", "testpicture+testfilter",
                                         "testbad[fault=run_wild,movers=1]"};
    for (size_t n = 0; n < sizeof chains / sizeof *chains; ++n) {
        static session s;
        uint64_t random = 8;
        open_session(&s, chains[n]);
        const uint64_t calls = s.memory.calls, live = s.memory.live_bytes;
        for (uint32_t view = 1; view <= 20; ++view) {
            const session_view v = random_view(&random, view);
            session_frame(&s, &v);
            assert_int_equal(s.memory.calls, calls);
            assert_int_equal(s.memory.live_bytes, live);
        }
        session_close(&s);
    }
}

static void viewers_of_one_chain_do_not_disturb_each_other(void **state)
{
    (void)state;
    static session s;
    uint8_t wanted[ALL];
    uint32_t times[FAKE_PLACES_MOST];
    world_view *views[2];
    uint64_t random = 9;
    open_session(&s, "brute+testfilter[keep=all]");
    views[0] = s.view;
    assert_int_equal(world_view_open(s.world, VIEWER_CHECK_BOUNDS, &s.lines.report, &views[1]), RESULT_OK);
    for (uint32_t view = 1; view <= VIEWS; ++view) {
        session_view v[2];
        visible_set sets[2];
        for (int k = 0; k < 2; ++k) {
            v[k] = random_view(&random, view);
            s.view = views[k];
            session_frame(&s, &v[k]);
            sets[k] = s.set;
        }
        for (int k = 0; k < 2; ++k) { // a set stays good while another viewer runs
            s.set = sets[k];
            touched(&s, &v[k], wanted);
            session_set_by_item(&s, times);
            for (uint32_t i = 0; i < ALL; ++i) assert_int_equal(times[i], wanted[i]);
        }
    }
    s.view = views[0];
    world_view_close(views[1]);
    session_close(&s);
}

static void a_scene_of_movers_alone_or_of_one_item_has_frames(void **state)
{
    (void)state;
    static const char *const chains[] = {"none", "brute", "testmore", "testpicture", "none+testfilter[keep=all,movers=1]"};
    for (size_t n = 0; n < sizeof chains / sizeof *chains; ++n)
        for (uint32_t items = 0; items < 3; ++items) {
            static session s;
            const session_request q = {.chain = chains[n], .boxes = {.items = items, .movers = 2, .seed = 3}, .checks = VIEWER_CHECK_ALL};
            assert_int_equal(session_open(&s, &q), RESULT_OK);
            for (uint32_t frame = 1; frame < 4; ++frame) {
                session_frame(&s, &(session_view){.frame = frame, .right_m = 200});
                assert_int_equal(s.stats.faults, 0);
            }
            session_close(&s);
        }
}

static void burn(double ns)
{
    struct timespec from, now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &from);
    do clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    while ((double)(now.tv_sec - from.tv_sec) * 1e9 + (double)(now.tv_nsec - from.tv_nsec) < ns);
}

static const double BURNT_NS = 2e7; // a hundred times what a frame of this scene takes

static void slow_draw(void *user, uint32_t zone, const cull_run *runs, uint32_t count)
{
    (void)user;
    (void)zone;
    (void)runs;
    (void)count;
    burn(BURNT_NS);
}

static void slow_test(void *user, uint32_t zone, const cull_test *tests, uint32_t count, uint32_t frame)
{
    (void)user;
    (void)zone;
    (void)tests;
    (void)count;
    (void)frame;
    burn(BURNT_NS);
}

static uint32_t slow_collect(void *user, uint32_t zone, collect_how how, uint32_t frame, cull_answer *answers, uint32_t capacity,
                             uint32_t *stalled)
{
    (void)user;
    (void)zone;
    (void)how;
    (void)frame;
    (void)answers;
    (void)capacity;
    *stalled = 1;
    burn(BURNT_NS);
    return 0;
}

static void the_driver_s_time_is_not_the_cullers(void **state)
{
    (void)state;
    static session s;
    open_session(&s, "testmore");
    const camera c = box_scene_camera(&s.q.boxes, 0);
    const frame_input input = {.camera = &c,
                               .frame = {.width_px = 64, .height_px = 64, .frame = 1, .purpose = CULL_VIEW_MAIN},
                               .driver = {.draw = slow_draw, .test = slow_test, .collect = slow_collect}};
    world_cull(s.view, &input, NULL, &s.stats);
    assert_true(s.stats.cull_ns > 0 && s.stats.cull_ns < BURNT_NS);
    assert_int_equal(s.stats.stalls, 2); // one at frame start, one at WAIT
    session_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(brute_s_set_and_the_movers_are_those_of_the_plain_loop),
        cmocka_unit_test(none_draws_all_items_and_the_movers_in_view),
        cmocka_unit_test(a_filter_gets_the_select_s_set_and_no_other),
        cmocka_unit_test(a_filter_that_takes_movers_decides_about_those_in_view),
        cmocka_unit_test(a_filter_behind_an_order_sees_the_boxes_in_it),
        cmocka_unit_test(a_filter_that_walks_the_hierarchy_has_no_select_run_before_it),
        cmocka_unit_test(a_frame_allocates_nothing),
        cmocka_unit_test(viewers_of_one_chain_do_not_disturb_each_other),
        cmocka_unit_test(a_scene_of_movers_alone_or_of_one_item_has_frames),
        cmocka_unit_test(the_driver_s_time_is_not_the_cullers),
    };
    return cmocka_run_group_tests_name("core frame", tests, NULL, NULL);
}
