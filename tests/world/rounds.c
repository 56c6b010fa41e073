// Tests of frames over many zones step by step: rounds, a cut of the view, what stepping cullers share, and a culler that
// misbehaves in one zone of many.
// SPDX-License-Identifier: MIT
#include "site.h"
#include "tests/common/random.h"
#include "tests/common/test.h"

#include <stdio.h>
#include <string.h>

static const site_grid rooms = {.wide = 4, .deep = 3, .items = 500, .movers = 20, .seed = 51};
enum { ROOMS = 12 };

static uint32_t every_third_is_hidden(uint32_t zone, const cull_test *t)
{
    (void)zone;
    return t->tag % 3;
}

static world_view *open_grid(site *s, const char *const *chains)
{
    world_view *v = NULL;
    site_begin(s, 0);
    assert_int_equal(site_make_grid(s, &rooms), RESULT_OK);
    if (site_open(s, &(site_world){"brute", chains, 0}) != RESULT_OK) fail_msg("%s", report_lines_only(&s->lines));
    assert_int_equal(world_view_open(s->world, VIEWER_CHECK_ALL, &s->lines.report, &v), RESULT_OK);
    return v;
}

static void all_same(const char **chains, const char *chain)
{
    for (uint32_t i = 0; i <= ROOMS; i++) chains[i] = chain;
}

// The first note of the event at or behind `from`; asserts that the events of one kind stand together there, zones in `order`.
static uint32_t assert_block(const site_driver *d, uint32_t from, site_event event, const uint32_t *order, uint32_t count)
{
    uint32_t at = from, k = 0;
    for (; at < d->note_count && d->notes[at].event == event; at++) {
        while (k < count && order[k] != d->notes[at].zone) k++; // near to far; a zone may have nothing of it
        assert_true(k < count);
    }
    return at;
}

static uint32_t reached_with_items(const site *s, const world_view *v, uint32_t *order)
{
    uint32_t count = 0;
    const flow_result *f = world_view_flow(v);
    for (uint32_t i = 0; i < f->zone_count; i++)
        if (world_chain(s->world, f->zones[i].zone)) order[count++] = f->zones[i].zone;
    return count;
}

static void a_round_is_all_draws_then_all_tests_then_all_answers(void **state)
{
    (void)state;
    static site s;
    static site_driver driver;
    static site_sight sight;
    const char *chains[ROOMS + 1];
    uint32_t order[ROOMS + 1];
    all_same(chains, "testmore[wait=1]");
    chains[5] = chains[6] = "brute"; // done in the first round
    world_view *v = open_grid(&s, chains);
    site_driver_init(&driver, &s);
    driver.pixels_of = every_third_is_hidden;
    uint64_t random = 3;
    for (uint32_t frame = 1; frame <= 30; frame++) {
        const camera c = site_random_camera(&random, &rooms);
        frame_input q = site_input(&c, frame);
        q.driver = site_driver_of(&driver);
        site_driver_new_frame(&driver);
        site_look(&s, v, &q, &sight);
        const uint32_t count = reached_with_items(&s, v, order);
        uint32_t at = assert_block(&driver, 0, SITE_READY, order, count), from;
        from = at, at = assert_block(&driver, at, SITE_DRAW, order, count);
        assert_true(at > from);
        from = at, at = assert_block(&driver, at, SITE_TEST, order, count);
        const uint32_t tests = at - from;
        from = at, at = assert_block(&driver, at, SITE_WAIT, order, count);
        assert_int_equal(at - from, tests);
        from = at, at = assert_block(&driver, at, SITE_DRAW, order, count);
        for (uint32_t i = from; i < at; i++) assert_true(driver.notes[i].zone != 5 && driver.notes[i].zone != 6);
        if (sight.stats.movers_drawn) assert_int_equal(driver.notes[at++].event, SITE_MOVERS);
        assert_int_equal(at, driver.note_count);
        assert_int_equal(sight.stats.stalls, 0);
        assert_int_equal(driver.pending_count, 0);
    }
    site_close(&s);
}

static void after_a_cut_each_zone_goes_to_its_end_before_the_next(void **state)
{
    (void)state;
    static site s;
    static site_driver driver;
    static site_sight sight, rounds;
    const char *chains[ROOMS + 1];
    all_same(chains, "testmore[wait=1]");
    chains[5] = "brute";
    world_view *v = open_grid(&s, chains);
    site_driver_init(&driver, &s);
    driver.pixels_of = every_third_is_hidden;
    const double eye[3] = {2, 1.5, 6}, forward[3] = {1, 0, 0};
    const camera c = site_camera(eye, forward);
    frame_input q = site_input(&c, 1);
    q.driver = site_driver_of(&driver);
    site_look(&s, v, &q, &rounds);
    site_driver_new_frame(&driver);
    q.frame.frame = 2;
    q.frame.flags = CULL_VIEW_CUT;
    site_look(&s, v, &q, &sight);
    assert_true(sight.stats.zones > 3);
    uint32_t left[ROOMS + 1] = {0}, last = SCENE_NONE;
    for (uint32_t i = 0; i < driver.note_count && driver.notes[i].event != SITE_MOVERS; i++) {
        const uint32_t zone = driver.notes[i].zone;
        if (zone == 5) continue; // goes with the next that steps
        assert_int_equal(left[zone], 0);
        if (last != SCENE_NONE && zone != last) left[last] = 1;
        last = zone;
    }
    assert_int_equal(sight.stats.items_drawn, rounds.stats.items_drawn);
    site_close(&s);
}

static int is_work_of(const site_note *n, uint32_t zone)
{
    return n->event != SITE_MOVERS && n->event != SITE_READY && n->zone == zone;
}

// The notes of a frame, zone by zone: asserts that none of `singly` comes back once another zone has been at work, and that all
// nearer zones have drawn when it begins. Returns how many such zones there were.
static uint32_t assert_in_turn(const site_driver *d, const uint8_t *singly, const uint32_t *order, uint32_t count)
{
    uint32_t turns = 0;
    for (uint32_t k = 0; k < count; k++) {
        uint32_t first = d->note_count, end = 0;
        for (uint32_t i = 0; i < d->note_count; i++) {
            if (!is_work_of(&d->notes[i], order[k])) continue;
            first = i < first ? i : first;
            end = i + 1;
        }
        if (!singly[order[k]] || !end) continue;
        for (uint32_t i = first; i < end; i++) assert_true(d->notes[i].event == SITE_READY || d->notes[i].zone == order[k]);
        for (uint32_t n = 0; n < k; n++)
            for (uint32_t i = end; i < d->note_count; i++) assert_false(is_work_of(&d->notes[i], order[n]));
        turns++;
    }
    return turns;
}

static void who_asks_one_test_a_step_begins_when_all_nearer_zones_have_drawn(void **state)
{
    (void)state;
    static site s;
    static site_driver driver;
    static site_sight sight;
    const char *chains[ROOMS + 1];
    uint8_t singly[ROOMS + 1] = {0};
    uint32_t order[ROOMS + 1], turns = 0;
    all_same(chains, "testmore[singly=1]");
    chains[5] = "brute";
    chains[6] = chains[7] = "testmore[wait=1]";
    for (uint32_t i = 0; i <= ROOMS; i++) singly[i] = i < 5 || i > 7;
    world_view *v = open_grid(&s, chains);
    site_driver_init(&driver, &s);
    driver.pixels_of = every_third_is_hidden;
    uint64_t random = 5;
    for (uint32_t frame = 1; frame <= 30; frame++) {
        const camera c = site_random_camera(&random, &rooms);
        frame_input q = site_input(&c, frame);
        q.driver = site_driver_of(&driver);
        site_driver_new_frame(&driver);
        site_look(&s, v, &q, &sight);
        assert_int_equal(sight.stats.faults, 0);
        turns += assert_in_turn(&driver, singly, order, reached_with_items(&s, v, order));
    }
    assert_true(turns > 30);
    site_close(&s);
}

// What the chain `testmore` of a zone keeps under the rule above.
static int testmore_keeps(const zone_data *data, uint32_t place)
{
    return place < data->zone.item_count / 2 || place % 3 != 0;
}

static void stepping_zones_draw_what_they_share_once_and_lose_none_of_it(void **state)
{
    (void)state;
    static site s;
    static site_driver driver;
    static site_sight sight;
    const char *chains[ROOMS + 1];
    all_same(chains, "testmore[wait=1]");
    chains[1] = chains[7] = "none";
    world_view *v = open_grid(&s, chains);
    assert_true(s.world->shared_count > 40);
    site_driver_init(&driver, &s);
    driver.pixels_of = every_third_is_hidden;
    uint64_t random = 4;
    for (uint32_t frame = 1; frame <= 60; frame++) {
        uint8_t wanted[SITE_ITEMS_MOST] = {0};
        const camera c = site_random_camera(&random, &rooms);
        frame_input q = site_input(&c, frame);
        q.driver = site_driver_of(&driver);
        q.frame.flags = frame % 4 ? 0 : CULL_VIEW_CUT;
        site_driver_new_frame(&driver);
        site_look(&s, v, &q, &sight);
        const flow_result *f = world_view_flow(v);
        for (uint32_t i = 0; i < f->zone_count; i++) {
            const zone_data *data = world_zone(s.world, f->zones[i].zone);
            for (uint32_t k = 0; k < data->zone.item_count; k++)
                wanted[data->items[k]] |= chains[data->index][0] == 'n' || testmore_keeps(data, k);
        }
        for (uint32_t i = 0; i < s.scene->item_count; i++) {
            assert_int_equal(sight.items[i], wanted[i]);
            assert_int_equal(driver.drawn[i], wanted[i]);
        }
        for (uint32_t i = 0; i < SITE_MOVERS_MOST; i++) assert_int_equal(driver.movers[i], sight.movers[i]);
    }
    site_close(&s);
}

// ---- A culler that misbehaves ----

static void a_fault_draws_its_own_zone_whole_and_leaves_the_others_exact(void **state)
{
    (void)state;
    static const char *const faults[] = {"run_wild", "replaces_runs", "more_for_ever", "zone_twice_over_steps", "tests_endless"};
    for (size_t n = 0; n < sizeof faults / sizeof *faults; n++) {
        static site s;
        static site_driver driver;
        static site_sight sight;
        static uint8_t wanted[SITE_ITEMS_MOST], movers_wanted[SITE_MOVERS_MOST];
        char bad[96];
        const char *chains[ROOMS + 1];
        enum { BAD = 5 };
        snprintf(bad, sizeof bad, "testbad[fault=%s,movers=%u]", faults[n], (unsigned)n % 2);
        all_same(chains, "brute");
        chains[BAD] = bad;
        world_view *v = open_grid(&s, chains);
        site_driver_init(&driver, &s);
        uint64_t random = 6;
        uint32_t reached = 0;
        for (uint32_t frame = 1; frame <= 40; frame++) {
            const camera c = site_random_camera(&random, &rooms);
            frame_input q = site_input(&c, frame);
            q.driver = site_driver_of(&driver);
            site_driver_new_frame(&driver);
            site_look(&s, v, &q, &sight);
            const char *oracle[ROOMS + 1];
            all_same(oracle, "brute");
            oracle[BAD] = "none"; // whole
            site_oracle(&s, v, oracle, wanted);
            site_oracle_movers(&s, v, movers_wanted);
            uint32_t bad_reached = 0;
            for (uint32_t i = 0; i < world_view_flow(v)->zone_count; i++) bad_reached |= world_view_flow(v)->zones[i].zone == BAD;
            const mover_block *b = bad_reached ? movers_of_zone(world_movers(s.world), BAD) : NULL;
            for (; b; b = movers_next(world_movers(s.world), b))
                for (uint32_t i = 0; i < b->count; i++) movers_wanted[b->mover[i]] = 1;
            assert_int_equal(sight.stats.faults, bad_reached);
            for (uint32_t i = 0; i < s.scene->item_count; i++) {
                assert_int_equal(sight.items[i], wanted[i]);
                assert_int_equal(driver.drawn[i] > 0, wanted[i]);
            }
            for (uint32_t i = 0; i < s.scene->mover_count; i++) assert_int_equal(sight.movers[i], movers_wanted[i]);
            reached += bad_reached;
        }
        assert_true(reached > 3 && reached < 40);
        assert_true(report_lines_is_one_with(&s.lines, "culler 'testbad' misbehaves: ")); // told once
        assert_true(report_lines_is_one_with(&s.lines, "zone 'r5'"));
        site_close(&s);
    }
}

static void a_crosser_that_misbehaves_narrows_nothing(void **state)
{
    (void)state;
    static const char *const faults[] = {"odd", "endless", "nan"};
    for (size_t n = 0; n < sizeof faults / sizeof *faults; n++) {
        static site good, bad;
        static site_sight a, b;
        char chain[64];
        const char *chains[ROOMS + 1];
        uint32_t counted = 0;
        snprintf(chain, sizeof chain, "brute+testcross[fault=%s]", faults[n]);
        all_same(chains, "brute");
        world_view *v = open_grid(&good, chains);
        chains[5] = chain;
        world_view *w = open_grid(&bad, chains);
        uint64_t random = 6;
        for (uint32_t frame = 1; frame <= 40; frame++) {
            const camera c = site_random_camera(&random, &rooms);
            const frame_input q = site_input(&c, frame);
            site_look(&good, v, &q, &a);
            site_look(&bad, w, &q, &b);
            assert_memory_equal(a.items, b.items, sizeof a.items);
            assert_int_equal(a.stats.faults, 0);
            counted += b.stats.faults;
        }
        assert_true(counted > 3);
        assert_true(report_lines_is_one_with(&bad.lines, "culler 'testcross' misbehaves: "));
        assert_true(report_lines_is_one_with(&bad.lines, "zone 'r5'"));
        site_close(&good);
        site_close(&bad);
    }
}

// ---- History ----

static void the_history_of_one_view_changes_no_other_s_answer(void **state)
{
    (void)state;
    static site alone, together;
    static site_driver drivers[3];
    static site_sight a, b, other;
    const char *chains[ROOMS + 1];
    static const char *const some[] = {"testmore[wait=0]", "testpicture[distance=0.5]", "testpicture+testfilter", "frustum", "testorder+testfilter[walk=1]"};
    for (uint32_t i = 0; i <= ROOMS; i++) chains[i] = some[i % 5];
    world_view *v = open_grid(&alone, chains), *w = open_grid(&together, chains), *u = NULL;
    assert_int_equal(world_view_open(together.world, VIEWER_CHECK_ALL, &together.lines.report, &u), RESULT_OK);
    site_driver_init(&drivers[0], &alone);
    site_driver_init(&drivers[1], &together);
    site_driver_init(&drivers[2], &together);
    for (int i = 0; i < 3; i++) drivers[i].pixels_of = every_third_is_hidden;
    uint64_t random = 9, noise = 10;
    for (uint32_t frame = 1; frame <= 60; frame++) {
        const camera c = site_random_camera(&random, &rooms), elsewhere = site_random_camera(&noise, &rooms);
        frame_input q = site_input(&c, frame), p = site_input(&elsewhere, 1000 + 3 * frame);
        for (int i = 0; i < 3; i++) site_driver_new_frame(&drivers[i]);
        q.driver = site_driver_of(&drivers[0]);
        site_look(&alone, v, &q, &a);
        p.driver = site_driver_of(&drivers[2]);
        site_look(&together, u, &p, &other);
        q.driver = site_driver_of(&drivers[1]);
        site_look(&together, w, &q, &b);
        assert_memory_equal(a.items, b.items, sizeof a.items);
        assert_memory_equal(a.movers, b.movers, sizeof a.movers);
        assert_int_equal(a.stats.steps, b.stats.steps);
        assert_int_equal(a.stats.captures, b.stats.captures);
        assert_int_equal(a.stats.pictures, b.stats.pictures);
        assert_int_equal(drivers[0].note_count, drivers[1].note_count);
    }
    site_close(&alone);
    site_close(&together);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_round_is_all_draws_then_all_tests_then_all_answers),
        cmocka_unit_test(after_a_cut_each_zone_goes_to_its_end_before_the_next),
        cmocka_unit_test(who_asks_one_test_a_step_begins_when_all_nearer_zones_have_drawn),
        cmocka_unit_test(stepping_zones_draw_what_they_share_once_and_lose_none_of_it),
        cmocka_unit_test(a_fault_draws_its_own_zone_whole_and_leaves_the_others_exact),
        cmocka_unit_test(a_crosser_that_misbehaves_narrows_nothing),
        cmocka_unit_test(the_history_of_one_view_changes_no_other_s_answer),
    };
    return cmocka_run_group_tests_name("world rounds", tests, NULL, NULL);
}
