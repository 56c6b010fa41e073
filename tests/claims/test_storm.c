// Ten thousand movers over a world of rooms, moved, teleported, removed and added, with doors that open and shut and views
// culled in between: no growth, nobody lost, judged by a loop over all zones and all their volumes.
// SPDX-License-Identifier: MIT
#include "stage.h"
#include "tests/common/random.h"
#include "tests/common/test.h"

#include <portcullis/plane.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ROOMS = 64, MOVERS = 10000, FRAMES_LONG = 1000, FRAMES_SHORT = 60, TELEPORTS = 50, EXCHANGES = 40 };
static const double INNER_M = 1e-3; // what is this far in is in, whatever margins and roundings are

typedef struct storm {
    stage stage;
    double (*middles)[3], (*speeds)[3], *sizes;
    uint32_t *numbers; // in the world
    uint8_t *seen;     // by number
    uint64_t random, zones_found, seen_count, wanted_count;
} storm;

typedef struct box { double min[3], max[3]; } box;

static box box_of(const storm *s, uint32_t i)
{
    box b;
    for (int k = 0; k < 3; k++) {
        b.min[k] = s->middles[i][k] - s->sizes[i];
        b.max[k] = s->middles[i][k] + s->sizes[i];
    }
    return b;
}

static void place_anew(storm *s, uint32_t i)
{
    const scene_extent *e = &s->stage.scene->whole;
    const float *least = &e->box.min.x, *most = &e->box.max.x;
    for (int k = 0; k < 3; k++) {
        const double out_m = k == 1 ? 0.5 : 2; // some beside the rooms, some over and under them
        s->middles[i][k] = e->origin[k] + random_between(&s->random, (double)least[k] - out_m, (double)most[k] + out_m);
        s->speeds[i][k] = random_between(&s->random, -0.06, 0.06);
    }
    s->sizes[i] = random_between(&s->random, 0.05, i % 1000 == 0 ? 40 : i % 50 == 0 ? 8 : 0.5); // some larger than a room
}

static void storm_open(storm *s)
{
    memset(s, 0, sizeof *s);
    s->random = 7;
    stage_make(&s->stage, "rooms", ROOMS);
    const chain_spec *by_zone[ROOMS + 1];
    const char *const some[] = {"brute", "frustum+portal", "none", "testmore"};
    assert_true(s->stage.scene->zone_count <= ROOMS + 1);
    for (uint32_t zone = 0; zone <= ROOMS; zone++) by_zone[zone] = stage_chain(&s->stage, some[zone % 4]);
    stage_open(&s->stage, &(stage_world){by_zone, MOVERS});
    s->middles = calloc(MOVERS, sizeof *s->middles);
    s->speeds = calloc(MOVERS, sizeof *s->speeds);
    s->sizes = calloc(MOVERS, sizeof *s->sizes);
    s->numbers = calloc(MOVERS, sizeof *s->numbers);
    s->seen = calloc(s->stage.scene->mover_count + MOVERS, 1);
    assert_true(s->middles && s->speeds && s->sizes && s->numbers && s->seen);
}

static void storm_close(storm *s)
{
    stage_shut(&s->stage);
    stage_free(&s->stage);
    free(s->middles);
    free(s->speeds);
    free(s->sizes);
    free(s->numbers);
    free(s->seen);
}

static void add(storm *s, uint32_t i)
{
    place_anew(s, i);
    const box b = box_of(s, i);
    assert_int_equal(world_mover_add(s->stage.world, b.min, b.max, &s->numbers[i]), RESULT_OK);
}

static void move(storm *s, uint32_t i)
{
    const box b = box_of(s, i);
    assert_int_equal(world_mover_move(s->stage.world, s->numbers[i], b.min, b.max), RESULT_OK);
}

static void move_all(storm *s, uint32_t frame)
{
    for (uint32_t i = 0; i < MOVERS; i++) {
        for (int k = 0; k < 3; k++) s->middles[i][k] += frame / 50 % 2 ? -s->speeds[i][k] : s->speeds[i][k];
        move(s, i);
    }
    for (int n = 0; n < TELEPORTS; n++) {
        const uint32_t i = random_below(&s->random, MOVERS);
        place_anew(s, i);
        move(s, i);
    }
    const uint32_t first = random_below(&s->random, MOVERS - EXCHANGES);
    for (uint32_t i = first; i < first + EXCHANGES; i++) assert_int_equal(world_mover_remove(s->stage.world, s->numbers[i]), RESULT_OK);
    for (uint32_t i = first; i < first + EXCHANGES; i++) add(s, i);
    const uint32_t doors = s->stage.scene->door_count;
    if (doors) world_set_door(s->stage.world, frame % doors, frame / doors % 2 ? DOORS_OPEN : DOORS_SHUT);
}

// Rooms are boxes, so a loop over them says it all.
static int overlaps(const box *b, const scene_hull *h, double by)
{
    for (int k = 0; k < 3; k++)
        if (b->max[k] < h->min[k] + by || b->min[k] > h->max[k] - by) return 0;
    return 1;
}

static void check_zones(storm *s, uint32_t i)
{
    const uint32_t *zones;
    const box b = box_of(s, i);
    const uint32_t count = movers_zones(world_movers(s->stage.world), s->numbers[i], &zones);
    uint32_t at = 0, certain = 0;
    for (uint32_t h = 0; h < s->stage.scene->hull_count; h++) {
        const scene_hull *hull = &s->stage.scene->hulls[h];
        const uint32_t is_listed = at < count && zones[at] == hull->zone;
        at += is_listed;
        certain += (uint32_t)overlaps(&b, hull, 0);
        if (count && overlaps(&b, hull, 0) && !is_listed) fail_msg("mover %u is not in zone %u", i, hull->zone);
        if (!overlaps(&b, hull, -INNER_M) && is_listed) fail_msg("mover %u is in zone %u, far from it", i, hull->zone);
    }
    assert_int_equal(at, count);
    if (!count) assert_true(certain == 0 || certain + 2 > MOVER_ZONES_MOST); // everywhere: in none, or in too many
    s->zones_found += count;
}

static cull_box inner_box(const box *b, const double origin[3])
{
    float c[6];
    for (int k = 0; k < 3; k++) {
        c[k] = (float)(b->min[k] + INNER_M - origin[k]);
        c[3 + k] = (float)(b->max[k] - INNER_M - origin[k]);
    }
    return (cull_box){{c[0], c[1], c[2]}, {c[3], c[4], c[5]}};
}

static int is_wanted(const storm *s, const box *b)
{
    const flow_result *f = world_view_flow(s->stage.view);
    for (uint32_t i = 0; i < f->zone_count; i++) {
        const flow_zone *z = &f->zones[i];
        const scene_zone *zone = &s->stage.scene->zones[z->zone];
        if (zone->hull_count && !overlaps(b, &s->stage.scene->hulls[zone->first_hull], INNER_M)) continue;
        for (uint32_t k = 0; k < z->count; k++)
            if (cull_volume_touches(&f->volumes[f->by_zone[z->first + k]].volume, inner_box(b, zone->origin))) return 1;
    }
    return 0;
}

static void check_seen(storm *s, const visible_set *set)
{
    memset(s->seen, 0, s->stage.scene->mover_count + MOVERS);
    for (uint32_t i = 0; i < set->mover_count; i++) assert_int_equal(s->seen[set->movers[i]]++, 0); // each once
    for (uint32_t i = 0; i < MOVERS; i++) {
        const box b = box_of(s, i);
        const int wanted = is_wanted(s, &b);
        if (wanted && !s->seen[s->numbers[i]]) fail_msg("mover %u touches a volume of a zone that is seen and is not in the set", i);
        s->wanted_count += (uint32_t)wanted;
        s->seen_count += s->seen[s->numbers[i]];
    }
}

static void look(storm *s, uint32_t frame)
{
    const camera_path *path = frame % 2 ? &s->stage.walk : &s->stage.tour;
    const frame_input q = stage_input(&path->cameras[frame * 17 % path->count], frame);
    visible_set set;
    frame_stats stats;
    world_cull(s->stage.view, &q, &set, &stats);
    assert_int_equal(stats.faults, 0);
    check_seen(s, &set);
}

static void a_storm_of_ten_thousand_movers_loses_none_and_grows_nothing(void **state)
{
    (void)state;
    static storm s;
    storm_open(&s);
    for (uint32_t i = 0; i < MOVERS; i++) add(&s, i);
    const uint64_t calls = s.stage.counted.calls, bytes = s.stage.counted.live_bytes;
    const uint32_t frames = stage_tier() == TIER_LONG ? FRAMES_LONG : FRAMES_SHORT;
    for (uint32_t frame = 0; frame < frames; frame++) {
        move_all(&s, frame);
        for (uint32_t i = 0; i < MOVERS; i++) check_zones(&s, i);
        look(&s, frame);
    }
    assert_int_equal(s.stage.counted.calls, calls);
    assert_int_equal(s.stage.counted.live_bytes, bytes);
    const mover_counts c = movers_counts(world_movers(s.stage.world));
    assert_int_equal(c.live, s.stage.scene->mover_count + MOVERS);
    assert_true(s.wanted_count > frames && c.everywhere > 0);
    print_message("%u frames of %u movers: %llu moves, %llu changed zones, %.2f zones a mover, %u everywhere; seen %.1f a view, %.1f touch a volume; nothing allocated\n",
                  frames, MOVERS, (unsigned long long)c.moves, (unsigned long long)c.relocations, (double)s.zones_found / MOVERS / frames, c.everywhere,
                  (double)s.seen_count / frames, (double)s.wanted_count / frames);
    storm_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_storm_of_ten_thousand_movers_loses_none_and_grows_nothing),
    };
    return cmocka_run_group_tests_name("claims storm", tests, NULL, NULL);
}
