// Tests of what a select tells about portals (cull.sight/1) in worlds of many zones: used with a crosser alone, its nonsense told once.
// SPDX-License-Identifier: MIT
#include "site.h"
#include "tests/common/random.h"
#include "tests/common/test.h"

#include <stdio.h>
#include <string.h>

static const site_grid rooms = {.wide = 4, .deep = 3, .items = 500, .movers = 20, .seed = 51};
enum { ROOMS = 12, FRAMES = 40 };

static world_view *open_grid(site *s, const char *chain)
{
    world_view *v = NULL;
    site_begin(s, 0);
    assert_int_equal(site_make_grid(s, &rooms), RESULT_OK);
    if (site_open(s, &(site_world){.chain = chain}) != RESULT_OK) fail_msg("%s", report_lines_only(&s->lines));
    assert_int_equal(world_view_open(s->world, VIEWER_CHECK_ALL, &s->lines.report, &v), RESULT_OK);
    return v;
}

typedef struct sums { uint32_t zones, limits, faults; } sums;

// Over the same frames in both worlds; the sets have to be the same.
static sums expect_alike(const char *chain, const char *other, report_lines *lines)
{
    static site a, b;
    static site_sight x, y;
    sums sum = {0, 0, 0};
    world_view *v = open_grid(&a, chain), *w = open_grid(&b, other);
    uint64_t random = 6;
    for (uint32_t frame = 1; frame <= FRAMES; frame++) {
        const camera c = site_random_camera(&random, &rooms);
        const frame_input q = site_input(&c, frame);
        site_look(&a, v, &q, &x);
        site_look(&b, w, &q, &y);
        assert_memory_equal(x.items, y.items, sizeof x.items);
        assert_memory_equal(x.movers, y.movers, sizeof x.movers);
        assert_int_equal(x.stats.faults, 0);
        sum.zones += y.stats.zones;
        sum.limits += y.stats.limits_hit;
        sum.faults += y.stats.faults;
    }
    *lines = b.lines;
    site_close(&a);
    site_close(&b);
    assert_true(sum.zones > FRAMES);
    return sum;
}

static void who_tells_that_all_gets_through_changes_nothing(void **state)
{
    (void)state;
    static report_lines lines;
    static const char *const tells[] = {"all", "copies", "null"};
    for (size_t n = 0; n < sizeof tells / sizeof *tells; n++) {
        char chain[64];
        snprintf(chain, sizeof chain, "testsight[tell=%s]+portal", tells[n]);
        const sums sum = expect_alike("none+portal", chain, &lines);
        assert_int_equal(sum.faults, 0);
        assert_int_equal(sum.limits, 0);
        assert_int_equal(lines.count, 0);
    }
}

static void nonsense_about_parts_passes_everything_counts_each_time_and_is_told_once(void **state)
{
    (void)state;
    static report_lines lines;
    static const char *const tells[][2] = {{"odd", "it returned neither"}, {"planes", "more planes than there is room for"},
                                           {"nan", "not finite"}, {"endless", "more parts than there may be"}};
    for (size_t n = 0; n < sizeof tells / sizeof *tells; n++) {
        char chain[64];
        snprintf(chain, sizeof chain, "testsight[tell=%s]+portal", tells[n][0]);
        const sums sum = expect_alike("none+portal", chain, &lines);
        assert_true(sum.faults > FRAMES / 2);
        assert_true(report_lines_is_one_with(&lines, "culler 'testsight' misbehaves: "));
        assert_true(report_lines_is_one_with(&lines, tells[n][1]));
    }
}

static void without_a_crosser_nobody_asks(void **state)
{
    (void)state;
    static report_lines lines;
    const sums nonsense = expect_alike("none", "testsight[tell=odd]", &lines), nothing = expect_alike("none", "testsight[tell=nothing]", &lines);
    assert_int_equal(nonsense.faults, 0);
    assert_int_equal(nonsense.zones, nothing.zones);
    assert_int_equal(lines.count, 0);
}

static void where_nothing_gets_to_a_portal_only_the_eye_s_zones_are_reached(void **state)
{
    (void)state;
    static site s;
    static site_sight sight;
    world_view *v = open_grid(&s, "testsight[tell=nothing]+portal");
    const double eye[3] = {6, 1.5, 6}, forward[3] = {1, 0, 0.1}; // the middle of room (1, 1)
    const camera c = site_camera(eye, forward);
    const frame_input q = site_input(&c, 1);
    site_look(&s, v, &q, &sight);
    assert_true(sight.stats.zones == 1 || (sight.stats.zones == 2 && s.scene->stray_items > 0));
    assert_true(sight.stats.crossings > 0);
    assert_int_equal(sight.stats.faults, 0);
    site_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(who_tells_that_all_gets_through_changes_nothing),
        cmocka_unit_test(nonsense_about_parts_passes_everything_counts_each_time_and_is_told_once),
        cmocka_unit_test(without_a_crosser_nobody_asks),
        cmocka_unit_test(where_nothing_gets_to_a_portal_only_the_eye_s_zones_are_reached),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
