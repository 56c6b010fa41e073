// Tests of chains swapped while a world runs: the old one serves until the new one is there, and stays when it fails.
// SPDX-License-Identifier: MIT
#include "site.h"
#include "tests/common/random.h"
#include "tests/common/test.h"

#include <string.h>

static const site_grid rooms = {.wide = 4, .deep = 3, .items = 400, .movers = 10, .seed = 61};
enum { ROOMS = 12 };

static world_view *open_grid(site *s, const char *chain)
{
    world_view *v = NULL;
    site_begin(s, 0);
    assert_int_equal(site_make_grid(s, &rooms), RESULT_OK);
    assert_int_equal(site_open(s, &(site_world){.chain = chain}), RESULT_OK);
    assert_int_equal(world_view_open(s->world, VIEWER_CHECK_ALL, &s->lines.report, &v), RESULT_OK);
    return v;
}

static void swapped_in_every_frame_through_all_chains_the_set_is_that_of_a_fresh_view(void **state)
{
    (void)state;
    static const char *const all[] = {"none", "brute", "frustum", "brute+portal", "testmore", "frustum[backface=0]", "testorder", "testpicture", "none+testfilter[keep=right]",
                                      "brute+testfilter[keep=all,movers=1]", "testorder+testfilter[walk=1,keep=all]", "frustum+flood"};
    enum { CHAINS = sizeof all / sizeof *all };
    static site s;
    static site_sight a, b;
    static uint32_t order[SITE_ITEMS_MOST];
    world_view *v = open_grid(&s, "brute"), *fresh = NULL;
    chain_spec specs[CHAINS];
    uint64_t random = 12;
    for (uint32_t i = 0; i < CHAINS; i++) site_parse(&s, all[i], &specs[i]);
    for (uint32_t frame = 1; frame <= 120; frame++) {
        const uint32_t zone = random_below(&random, ROOMS), which = frame % CHAINS;
        const result done = world_set_chain(s.world, zone, &specs[which], &s.lines.report);
        if (done != RESULT_OK) fail_msg("%s: %s", all[which], report_lines_only(&s.lines));
        const camera c = site_random_camera(&random, &rooms);
        const frame_input q = site_input(&c, frame);
        site_look(&s, v, &q, &a);
        assert_int_equal(world_view_open(s.world, VIEWER_CHECK_ALL, &s.lines.report, &fresh), RESULT_OK);
        site_look(&s, fresh, &q, &b);
        world_view_close(fresh);
        assert_memory_equal(a.items, b.items, sizeof a.items);
        for (uint32_t i = 0; i < s.scene->mover_count; i++) assert_int_equal(a.movers[i], b.movers[i]);
        world_order(s.world, zone, order);
        const zone_data *data = world_zone(s.world, zone);
        const chain *now = world_chain(s.world, zone);
        for (uint32_t i = 0; i < data->zone.item_count; i++) assert_int_equal(order[i], data->items[now->order ? now->order[i] : i]);
    }
    site_close(&s); // nothing is left of any
}

static void a_swap_that_fails_leaves_the_old_chain_and_says_why(void **state)
{
    (void)state;
    static const struct { const char *chain, *says; } cases[] = {
        {"nobody", "no culler 'nobody'"},
        {"brute+nobody", "no culler 'nobody'"},
        {"brute[sieve=1]", "has no option 'sieve'"},
        {"testbad[fault=create_option]", "refused an option"},
        {"testbad[fault=build_zone]", "could not build this zone"},
        {"testbad[fault=steps_none]", "nonsense after build"},
        {"testbad[fault=open_zone]", "could not open a query"}, // found only when the views get theirs
        {"brute+testbad[fault=open_null]", "could not open a query"},
        {"flood", "cannot stand first"},
    };
    static site s;
    static site_sight before, after;
    world_view *v = open_grid(&s, "frustum"), *w = NULL;
    assert_int_equal(world_view_open(s.world, VIEWER_CHECK_BOUNDS, &s.lines.report, &w), RESULT_OK);
    const double eye[3] = {2, 1.5, 6}, forward[3] = {1, 0, 0.1};
    const camera c = site_camera(eye, forward);
    const frame_input q = site_input(&c, 1);
    site_look(&s, v, &q, &before);
    const uint64_t live = s.memory.live_bytes;
    for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
        chain_spec spec;
        arena texts = arena_make(allocator_heap());
        assert_int_equal(chain_parse(cases[n].chain, &texts, &s.lines.report, &spec), RESULT_OK);
        const chain *old = world_chain(s.world, 4);
        report_lines_init(&s.lines);
        assert_int_equal(world_set_chain(s.world, 4, &spec, &s.lines.report), RESULT_BAD_INPUT);
        assert_true(report_lines_is_one_with(&s.lines, cases[n].says));
        assert_ptr_equal(world_chain(s.world, 4), old);
        site_look(&s, v, &q, &after);
        assert_memory_equal(before.items, after.items, sizeof before.items);
        site_look(&s, w, &q, &after);
        assert_memory_equal(before.items, after.items, sizeof before.items);
        arena_free(&texts);
    }
    assert_true(s.memory.live_bytes < live + 4096); // the loader remembers what it refused or opened; nothing else stays
    site_close(&s);
}

static void a_swap_that_is_dropped_leaves_nothing_and_one_that_is_built_serves_nobody_yet(void **state)
{
    (void)state;
    static site s;
    static site_sight sight;
    world_swap *swap = NULL;
    chain_spec spec;
    world_view *v = open_grid(&s, "none");
    const uint32_t whole = world_zone(s.world, 0)->zone.item_count;
    const double eye[3] = {2, 1.5, 2}, forward[3] = {1, 0, 0};
    const camera c = site_camera(eye, forward);
    const frame_input q = site_input(&c, 1);
    site_parse(&s, "brute", &spec);
    const uint64_t live = s.memory.live_bytes;
    assert_int_equal(world_swap_build(s.world, 0, &spec, &s.lines.report, &swap), RESULT_OK);
    site_look(&s, v, &q, &sight);
    assert_int_equal(sight.set.zones[0].runs[0].count, whole);
    world_swap_drop(swap);
    world_swap_drop(NULL);
    assert_int_equal(s.memory.live_bytes, live);
    assert_int_equal(world_swap_build(s.world, 0, &spec, &s.lines.report, &swap), RESULT_OK);
    assert_int_equal(world_swap_commit(s.world, swap, &s.lines.report), RESULT_OK);
    site_look(&s, v, &q, &sight);
    uint32_t drawn = 0;
    for (uint32_t r = 0; r < sight.set.zones[0].run_count; r++) drawn += sight.set.zones[0].runs[r].count;
    assert_true(drawn < whole);
    assert_int_equal(world_swap_build(s.world, 999, &spec, &s.lines.report, &swap), RESULT_BAD_INPUT);
    assert_true(report_lines_is_one_with(&s.lines, "there is no zone 999"));
    site_close(&s);
}

static void a_swap_while_a_view_has_never_been_culled_or_is_closed_between_is_fine(void **state)
{
    (void)state;
    static site s;
    static site_sight sight;
    chain_spec more, brute;
    world_view *v = open_grid(&s, "testpicture"), *w = NULL;
    site_parse(&s, "testmore", &more);
    site_parse(&s, "brute", &brute);
    for (uint32_t zone = 0; zone < ROOMS; zone++) {
        assert_int_equal(world_view_open(s.world, VIEWER_CHECK_ALL, &s.lines.report, &w), RESULT_OK);
        assert_int_equal(world_set_chain(s.world, zone, zone % 2 ? &more : &brute, &s.lines.report), RESULT_OK);
        if (zone % 3) world_view_close(w); // others are left to world_close
    }
    const double eye[3] = {2, 1.5, 2}, forward[3] = {1, 0, 0};
    const camera c = site_camera(eye, forward);
    const frame_input q = site_input(&c, 1);
    site_look(&s, v, &q, &sight);
    assert_true(sight.stats.items_drawn > 0);
    site_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(swapped_in_every_frame_through_all_chains_the_set_is_that_of_a_fresh_view),
        cmocka_unit_test(a_swap_that_fails_leaves_the_old_chain_and_says_why),
        cmocka_unit_test(a_swap_that_is_dropped_leaves_nothing_and_one_that_is_built_serves_nobody_yet),
        cmocka_unit_test(a_swap_while_a_view_has_never_been_culled_or_is_closed_between_is_fine),
    };
    return cmocka_run_group_tests_name("world swaps", tests, NULL, NULL);
}
