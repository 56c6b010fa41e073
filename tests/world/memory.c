// Tests of a world's memory: every allocation failing in turn, nothing allocated in frames, and the size of 10,000 zones.
// SPDX-License-Identifier: MIT
#include "site.h"
#include "tests/common/random.h"
#include "tests/common/test.h"

#include <stdio.h>
#include <string.h>

static const char *const chains[] = {"brute+portal", "testmore", "brute+testfilter[keep=all,movers=1]", "testpicture+testfilter", "none", "testorder+testfilter[walk=1]", NULL};

static void cull_some(site *s, const site_grid *g, world_view *v, uint32_t frames)
{
    static site_sight sight;
    uint64_t random = 4;
    for (uint32_t frame = 1; frame <= frames; frame++) {
        const camera c = site_random_camera(&random, g);
        const frame_input q = site_input(&c, frame);
        site_look(s, v, &q, &sight);
        assert_int_equal(sight.stats.faults, 0);
    }
}

// From an empty builder over two views and a swap to a closed world. 1 when the k-th allocation does not exist any more.
static int passes_with_failure(uint64_t k)
{
    static site s;
    const site_grid g = {.wide = 3, .deep = 2, .items = 40, .movers = 4, .seed = 5};
    world_view *views[2] = {NULL, NULL};
    chain_spec other;
    char line[REPORT_LINE_BYTES];
    site_begin(&s, k);
    result done = site_make_grid(&s, &g);
    if (done == RESULT_OK) done = site_open(&s, &(site_world){"brute", chains, 3});
    for (int i = 0; i < 2 && done == RESULT_OK; i++) done = world_view_open(s.world, i ? VIEWER_CHECK_ALL : VIEWER_CHECK_BOUNDS, &s.lines.report, &views[i]);
    if (done == RESULT_OK) done = chain_parse("testmore", &s.texts, &s.lines.report, &other);
    for (uint32_t zone = 0; zone < 2 && done == RESULT_OK; zone++) {
        const chain *old = world_chain(s.world, zone);
        done = world_set_chain(s.world, zone, &other, &s.lines.report);
        if (done != RESULT_OK) assert_ptr_equal(old, world_chain(s.world, zone)); // it stays, and serves:
    }
    for (int i = 0; i < 2; i++)
        if (views[i]) cull_some(&s, &g, views[i], 2);
    const uint64_t failures = s.memory.failures;
    snprintf(line, sizeof line, "%s", s.lines.count ? s.lines.lines[0] : "");
    site_close(&s); // asserts that nothing is left
    if (!failures) assert_int_equal(done, RESULT_OK);
    else if (done != RESULT_NO_MEMORY) fail_msg("allocation %u failed, result %d", (unsigned)k, (int)done);
    if (*line) assert_non_null(strstr(line, "out of memory"));
    return !failures;
}

static void every_allocation_may_fail_without_a_crash_or_a_leak(void **state)
{
    (void)state;
    uint64_t k = 1;
    while (!passes_with_failure(k)) k++;
    assert_true(k > 150); // the way is long enough to mean something
    for (int round = 0; round < 3; round++) assert_true(passes_with_failure(0));
}

static void frames_doors_movers_and_time_allocate_nothing(void **state)
{
    (void)state;
    static site s;
    const site_grid g = {.wide = 3, .deep = 2, .items = 300, .movers = 40, .seed = 6};
    world_view *v = NULL;
    site_begin(&s, 0);
    assert_int_equal(site_make_grid(&s, &g), RESULT_OK);
    assert_int_equal(site_open(&s, &(site_world){"brute", chains, 100}), RESULT_OK);
    assert_int_equal(world_view_open(s.world, VIEWER_CHECK_ALL, &s.lines.report, &v), RESULT_OK);
    const uint64_t calls = s.memory.calls, live = s.memory.live_bytes;
    uint32_t numbers[100];
    for (uint32_t round = 0; round < 20; round++) {
        for (uint32_t i = 0; i < 100; i++) {
            const double x = 0.1 * i, min[3] = {x, 0, x}, max[3] = {x + 1, 1, x + 1};
            assert_int_equal(world_mover_add(s.world, min, max, &numbers[i]), RESULT_OK);
        }
        cull_some(&s, &g, v, 5);
        for (uint32_t i = 0; i < 100; i++) {
            const double min[3] = {-1000, 0, 0}, max[3] = {1000, 1, 1};
            assert_int_equal(world_mover_move(s.world, numbers[i], min, max), RESULT_OK);
        }
        cull_some(&s, &g, v, 5);
        for (uint32_t i = 0; i < 100; i++) assert_int_equal(world_mover_remove(s.world, numbers[i]), RESULT_OK);
        world_set_time(s.world, round);
        world_set_door(s.world, round % s.scene->door_count, round % 2 ? DOORS_OPEN : DOORS_SHUT);
    }
    assert_int_equal(s.memory.calls, calls);
    assert_int_equal(s.memory.live_bytes, live);
    site_close(&s);
}

// What a room costs that lists a few items: the host's share, with a culler that keeps nothing to speak of.
enum { ZONE_BYTES_MOST = 8 * 1024, VIEW_ZONE_BYTES_MOST = 4 * 1024 };

static void ten_thousand_zones_open_small(void **state)
{
    (void)state;
    static site s;
    const site_grid g = {.wide = 100, .deep = 100, .items = 8000, .movers = 10, .seed = 7};
    world_view *v = NULL;
    site_begin(&s, 0);
    assert_int_equal(site_make_grid(&s, &g), RESULT_OK);
    const uint64_t scene_bytes = s.memory.live_bytes;
    assert_int_equal(site_open(&s, &(site_world){.chain = "brute"}), RESULT_OK);
    const uint64_t world_bytes = s.memory.live_bytes - scene_bytes;
    assert_int_equal(world_view_open(s.world, VIEWER_CHECK_BOUNDS, &s.lines.report, &v), RESULT_OK);
    const uint64_t view_bytes = s.memory.live_bytes - scene_bytes - world_bytes;
    cull_some(&s, &g, v, 20);
    print_message("10,000 zones: %u bytes a zone, %u more for each view\n", (unsigned)(world_bytes / 10000), (unsigned)(view_bytes / 10000));
    assert_true(world_bytes < (uint64_t)ZONE_BYTES_MOST * 10000);
    assert_true(view_bytes < (uint64_t)VIEW_ZONE_BYTES_MOST * 10000);
    site_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_allocation_may_fail_without_a_crash_or_a_leak),
        cmocka_unit_test(frames_doors_movers_and_time_allocate_nothing),
        cmocka_unit_test(ten_thousand_zones_open_small),
    };
    return cmocka_run_group_tests_name("world memory", tests, NULL, NULL);
}
