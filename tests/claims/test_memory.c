// Zones swapped every ten views through all chains: what other frames allocate is nothing, and what is left after all the
// swaps is what a fresh world takes that had each chain once, to the byte. (A view's room is that of the most demanding chain
// that it ever had: it does not shrink.)
// SPDX-License-Identifier: MIT
#include "stage.h"
#include "bench/generate.h"
#include "tests/common/test.h"

#include <stdlib.h>

enum { SWAP_VIEWS = 10 };
static const char *const chains[] = {"scene", "frustum", "none", "frustum+flood", "brute", "frustum+portal", "testmore", "testorder", "brute+testfilter[keep=all,movers=1]"};
enum { CHAINS = sizeof chains / sizeof *chains };

typedef struct counts { uint64_t swaps, calls_in_swaps, items, movers; } counts;

static const chain_spec *chain_at(stage *s, uint32_t zone, uint32_t turn)
{
    return stage_chain_of(s, chains[(zone + turn) % CHAINS], zone);
}

static void swap_all(stage *s, uint32_t turn, counts *c)
{
    const uint64_t calls = s->counted.calls;
    for (uint32_t zone = 0; zone < s->scene->zone_count; zone++) {
        if (!world_chain(s->world, zone)) continue;
        if (world_set_chain(s->world, zone, chain_at(s, zone, turn), &s->lines.report) != RESULT_OK) fail_msg("%s", report_lines_only(&s->lines));
        c->swaps++;
    }
    c->calls_in_swaps += s->counted.calls - calls;
}

static void look(stage *s, const camera *c, uint32_t frame, counts *sum)
{
    const frame_input q = stage_input(c, frame);
    visible_set set;
    frame_stats stats;
    world_cull(s->view, &q, &set, &stats);
    assert_int_equal(stats.faults, 0);
    sum->items += stats.items_drawn;
    sum->movers += stats.movers_drawn;
}

static void open_at(stage *s, uint32_t turn)
{
    const chain_spec **by_zone = calloc(s->scene->zone_count, sizeof *by_zone);
    assert_non_null(by_zone);
    for (uint32_t zone = 0; zone < s->scene->zone_count; zone++) by_zone[zone] = chain_at(s, zone, turn);
    stage_open(s, &(stage_world){by_zone, 0});
    free(by_zone);
}

static void walk_with_swaps(stage *s, const camera_path *path, uint32_t step)
{
    counts sum = {0}, fresh = {0}, again = {0};
    uint32_t turn = 0, frame = 0, last = 0;
    open_at(s, turn);
    for (uint32_t v = 0; v < path->count; v += step, frame++) {
        if (frame % SWAP_VIEWS == SWAP_VIEWS - 1) swap_all(s, ++turn, &sum);
        const uint64_t calls = s->counted.calls, bytes = s->counted.live_bytes;
        world_set_time(s->world, v / 30.0);
        if (s->scene->door_count) world_set_door(s->world, frame % s->scene->door_count, frame % 2 ? DOORS_SHUT : DOORS_OPEN);
        look(s, &path->cameras[last = v], frame, &sum);
        assert_int_equal(s->counted.calls, calls);
        assert_int_equal(s->counted.live_bytes, bytes);
    }
    for (uint32_t door = 0; door < s->scene->door_count; door++) world_set_door(s->world, door, DOORS_OPEN);
    look(s, &path->cameras[last], frame, &again);
    const uint64_t after_swaps = s->counted.live_bytes, blocks = s->counted.live_blocks;
    stage_shut(s);
    open_at(s, turn);
    assert_true(s->counted.live_bytes <= after_swaps && s->counted.live_bytes + after_swaps / 100 > after_swaps);
    for (uint32_t i = 1; i <= CHAINS; i++) swap_all(s, turn + i, &fresh);
    assert_int_equal(s->counted.live_bytes, after_swaps);
    assert_int_equal(s->counted.live_blocks, blocks);
    world_set_time(s->world, last / 30.0);
    for (uint32_t door = 0; door < s->scene->door_count; door++) world_set_door(s->world, door, DOORS_OPEN);
    look(s, &path->cameras[last], frame, &fresh);
    assert_int_equal(again.items, fresh.items);
    assert_int_equal(again.movers, fresh.movers);
    stage_shut(s);
    assert_true(sum.swaps > 0 && sum.items > 0 && turn >= CHAINS); // each zone had each chain
    print_message("%u views, %llu zones swapped, %llu allocations in swaps, 0 in other frames, %llu bytes after them as in a fresh world\n", frame,
                  (unsigned long long)sum.swaps, (unsigned long long)sum.calls_in_swaps, (unsigned long long)after_swaps);
}

static void check(const char *kind, uint64_t size, uint32_t step)
{
    static stage s;
    stage_make(&s, kind, size);
    walk_with_swaps(&s, &s.walk, step);
    walk_with_swaps(&s, &s.tour, step);
    stage_free(&s);
}

static void on_the_flagship_frames_allocate_nothing_and_swaps_leave_no_byte(void **state)
{
    (void)state;
    check("flagship", GENERATE_SIZE_OF_KIND, 1);
}

static void in_mazes_frames_allocate_nothing_and_swaps_leave_no_byte(void **state)
{
    (void)state;
    check("maze", 10, 1);
    check("maze", 100, 1);
    check("maze", 1000, stage_tier() == TIER_LONG ? 1 : 5);
    if (stage_tier() == TIER_LONG) check("maze", 10000, 5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(on_the_flagship_frames_allocate_nothing_and_swaps_leave_no_byte),
        cmocka_unit_test(in_mazes_frames_allocate_nothing_and_swaps_leave_no_byte),
    };
    return cmocka_run_group_tests_name("claims memory", tests, NULL, NULL);
}
