// Chains that narrow, mixed over zones with chains that don't: what is reached where all narrow is reached by every mix, and
// what a mix reaches the flood does too. A mix once lost what only the second of two windows of a room showed: its volume
// had come through the first, unclipped, and was taken to lie behind that one's plane.
// SPDX-License-Identifier: MIT
#include "stage.h"
#include "bench/generate.h"
#include "tests/common/random.h"
#include "tests/common/test.h"

#include <stdlib.h>
#include <string.h>

enum { MIXES = 3 };

typedef enum crossers { ALL_NARROW, ALL_FLOOD, MIXED } crossers;

// reached: a byte a zone, view after view.
static void reach(stage *s, const camera_path *path, uint32_t step, crossers how, uint64_t seed, uint8_t *reached)
{
    const uint32_t zones = s->scene->zone_count;
    const chain_spec **by_zone = calloc(zones, sizeof *by_zone);
    assert_non_null(by_zone);
    for (uint32_t zone = 0; zone < zones; zone++) {
        const int narrows = how == ALL_NARROW || (how == MIXED && random_below(&seed, 2));
        by_zone[zone] = stage_chain(s, narrows ? "brute+portal" : "brute");
    }
    stage_open(s, &(stage_world){by_zone, 0});
    for (uint32_t v = 0; v < path->count; v += step, reached += zones) {
        const frame_input q = stage_input(&path->cameras[v], v);
        frame_stats stats;
        memset(reached, 0, zones);
        world_cull(s->view, &q, NULL, &stats);
        const flow_result *f = world_view_flow(s->view);
        for (uint32_t i = 0; i < f->zone_count; i++) reached[f->zones[i].zone] = 1;
    }
    stage_shut(s);
    free(by_zone);
}

static void check_path(stage *s, const camera_path *path, uint32_t step)
{
    const uint32_t zones = s->scene->zone_count, views = (path->count + step - 1) / step;
    const size_t size = (size_t)zones * views;
    uint8_t *narrow = calloc(size, 1), *flood = calloc(size, 1), *mixed = calloc(size, 1);
    uint64_t sums[3] = {0};
    assert_true(narrow && flood && mixed);
    reach(s, path, step, ALL_NARROW, 0, narrow);
    reach(s, path, step, ALL_FLOOD, 0, flood);
    for (uint64_t seed = 1; seed <= MIXES; seed++) {
        reach(s, path, step, MIXED, seed, mixed);
        for (size_t i = 0; i < size; i++) {
            if (narrow[i] && !mixed[i]) fail_msg("view %zu: mix %d loses zone '%s'", i / zones * step, (int)seed, s->scene->zones[i % zones].name);
            if (mixed[i] && !flood[i]) fail_msg("view %zu: mix %d reaches zone '%s', which the flood does not", i / zones * step, (int)seed, s->scene->zones[i % zones].name);
            sums[0] += narrow[i];
            sums[1] += mixed[i];
            sums[2] += flood[i];
        }
    }
    print_message("%u views, zones a view: all narrow %.2f, mixed %.2f, flood %.2f\n", views, (double)sums[0] / views / MIXES, (double)sums[1] / views / MIXES,
                  (double)sums[2] / views / MIXES);
    assert_true(sums[0] <= sums[1] && sums[1] <= sums[2]);
    free(narrow);
    free(flood);
    free(mixed);
}

static void check(const char *kind, uint64_t size, uint32_t step)
{
    static stage s;
    stage_make(&s, kind, size);
    check_path(&s, &s.walk, step);
    check_path(&s, &s.tour, step);
    stage_free(&s);
}

static void what_only_a_second_window_of_a_room_shows_is_reached_whichever_zones_narrow(void **state)
{
    (void)state;
    check("flagship", GENERATE_SIZE_OF_KIND, 1);
    check("house", GENERATE_SIZE_OF_KIND, 1);
}

static void in_mazes_and_rooms_a_mix_reaches_no_less_than_narrowing_and_no_more_than_the_flood(void **state)
{
    (void)state;
    check("maze", 100, 1);
    check("maze", 1000, stage_tier() == TIER_LONG ? 1 : 4);
    check("rooms", 64, 1);
    if (stage_tier() == TIER_LONG) check("maze", 10000, 4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_only_a_second_window_of_a_room_shows_is_reached_whichever_zones_narrow),
        cmocka_unit_test(in_mazes_and_rooms_a_mix_reaches_no_less_than_narrowing_and_no_more_than_the_flood),
    };
    return cmocka_run_group_tests_name("claims mixed", tests, NULL, NULL);
}
