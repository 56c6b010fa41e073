// Ten thousand movers in a grid of rooms with zones inside and ground around, for a thousand frames: moved, teleported,
// removed and added, and compared with trying all zones. No growth, and nobody lost.
// SPDX-License-Identifier: MIT
#include "fixture.h"

#include "tests/common/failing_allocator.h"
#include "tests/common/random.h"
#include "tests/common/test.h"

#include <string.h>

enum {
    SIDE = 16,
    MOVERS = 10000,
    FRAMES = 1000,
    TELEPORTS = 50,  // a frame
    EXCHANGES = 40,  // removed and added a frame
    SPOT_CHECKS = 20, // a frame; what changed zones is checked always
    WHOLE_CHECKS = 4,
};
#define ROOM_M 8.0
#define SPAN_M (SIDE * ROOM_M)

typedef struct storm {
    zone_fixture zones;
    graph *graph;
    movers *movers;
    failing_allocator memory;
    double (*middles)[3], (*speeds)[3], *sizes;
    uint64_t random;
} storm;

static void zones_make(zone_fixture *f, const double corner[3])
{
    fixture_make(f);
    const uint32_t ground = fixture_zone(f, ZONE_EVERYWHERE, SCENE_NONE);
    fixture_rooms(f, SIDE, ROOM_M, corner);
    for (uint32_t z = 1; z <= SIDE * SIDE; z++) f->scene.zones[z].parent = ground;
    for (uint32_t i = 0; i < SIDE * SIDE; i += 5) { // closets of two hulls, some with a chest inside
        const uint32_t room = 1 + i;
        const double x = corner[0] + ROOM_M * (i % SIDE), y = corner[1], z = corner[2] + ROOM_M * (double)(i / SIDE);
        const uint32_t closet = fixture_zone(f, 0, room);
        fixture_origin(f, closet, x, y, z);
        fixture_box(f, (const double[]){x + 1, y, z + 1}, (const double[]){x + 4, y + 3, z + 4});
        fixture_gem(f, (const double[]){x + 5, y + 2, z + 5}, 1.5, 0.1 * i);
        if (i % 10 > 0) continue;
        fixture_origin(f, fixture_zone(f, 0, closet), x, y, z);
        fixture_box(f, (const double[]){x + 1.5, y, z + 1.5}, (const double[]){x + 3.5, y + 2, z + 3.5});
    }
}

static void place_anew(storm *s, uint32_t i)
{
    const double *corner = s->zones.scene.hulls[0].min;
    for (int k = 0; k < 3; k++) {
        s->middles[i][k] = corner[k] + (k == 1 ? random_between(&s->random, -1, 5) : random_between(&s->random, -4, SPAN_M + 4));
        s->speeds[i][k] = random_between(&s->random, -0.06, 0.06);
    }
    const double least = i % 1000 == 0 ? 8 : i % 50 == 0 ? 1 : 0.05; // some larger than a room, some than the scene's half
    s->sizes[i] = random_between(&s->random, least, least * 8);
}

static void box_of(const storm *s, uint32_t i, double min[3], double max[3])
{
    for (int k = 0; k < 3; k++) {
        min[k] = s->middles[i][k] - s->sizes[i];
        max[k] = s->middles[i][k] + s->sizes[i];
    }
}

static void storm_open(storm *s)
{
    *s = (storm){.random = 42};
    zones_make(&s->zones, (const double[]){1000, 0, -3000});
    failing_allocator_init(&s->memory, 0);
    const allocator *memory = &s->memory.memory;
    s->middles = memory_alloc(memory, MOVERS, sizeof *s->middles);
    s->speeds = memory_alloc(memory, MOVERS, sizeof *s->speeds);
    s->sizes = memory_alloc(memory, MOVERS, sizeof *s->sizes);
    assert_true(s->middles && s->speeds && s->sizes);
    assert_int_equal(graph_open(&s->zones.scene, memory, &s->graph), RESULT_OK);
    assert_int_equal(movers_open(&(movers_request){&s->zones.scene, s->graph, MOVERS}, memory, &s->movers), RESULT_OK);
}

static void storm_close(storm *s)
{
    movers_close(s->movers);
    graph_close(s->graph);
    memory_free(&s->memory.memory, s->middles, MOVERS, sizeof *s->middles);
    memory_free(&s->memory.memory, s->speeds, MOVERS, sizeof *s->speeds);
    memory_free(&s->memory.memory, s->sizes, MOVERS, sizeof *s->sizes);
    assert_true(failing_allocator_is_clean(&s->memory));
    fixture_free(&s->zones);
}

static void check(const storm *s, uint32_t i)
{
    enum { ZONES = 512 };
    uint32_t wanted[ZONES];
    const uint32_t *zones;
    double min[3], max[3];
    box_of(s, i, min, max);
    uint32_t count = oracle_zones_of_box(&s->zones, min, max, wanted);
    assert_in_range(count, 1, ZONES); // the ground at least, unless a room has it
    if (count > MOVER_ZONES_MOST) count = 0;
    assert_int_equal(movers_zones(s->movers, i, &zones), count);
    if (count) assert_memory_equal(zones, wanted, count * sizeof *wanted);
}

// What the lists hold is what the movers say: each once in each of its zones, its box round the true one.
static void check_lists(const storm *s)
{
    uint64_t listed = 0, said = 0;
    for (uint32_t z = 0; z < s->zones.scene.zone_count; z++) {
        const double *origin = s->zones.scene.zones[z].origin;
        for (const mover_block *b = movers_of_zone(s->movers, z); b; b = movers_next(s->movers, b)) {
            for (uint32_t i = 0; i < b->count; i++, listed++) {
                double min[3], max[3];
                const uint32_t *zones;
                uint32_t at = 0;
                const uint32_t count = movers_zones(s->movers, b->mover[i], &zones);
                while (at < count && zones[at] != z) at++;
                assert_true(at < count);
                box_of(s, b->mover[i], min, max);
                assert_true(b->min_x[i] <= min[0] - origin[0] && b->min_y[i] <= min[1] - origin[1] && b->min_z[i] <= min[2] - origin[2]);
                assert_true(b->max_x[i] >= max[0] - origin[0] && b->max_y[i] >= max[1] - origin[1] && b->max_z[i] >= max[2] - origin[2]);
            }
        }
    }
    uint32_t everywhere;
    const uint32_t *list = movers_everywhere(s->movers, &everywhere), *zones;
    for (uint32_t i = 0; i < everywhere; i++) assert_int_equal(movers_zones(s->movers, list[i], &zones), 0);
    for (uint32_t i = 0; i < MOVERS; i++) said += movers_zones(s->movers, i, &zones);
    assert_int_equal(listed, said);
    assert_int_equal(movers_counts(s->movers).live, MOVERS);
}

static void put(storm *s, uint32_t i, result (*how)(movers *m, uint32_t mover, const double min[3], const double max[3]))
{
    double min[3], max[3];
    const uint64_t relocations = movers_counts(s->movers).relocations;
    box_of(s, i, min, max);
    assert_int_equal(how(s->movers, i, min, max), RESULT_OK);
    if (how == movers_add || movers_counts(s->movers).relocations != relocations) check(s, i);
}

static void storm_frame(storm *s)
{
    const double *corner = s->zones.scene.hulls[0].min;
    for (uint32_t i = 0; i < MOVERS; i++) {
        for (int k = 0; k < 3; k++) {
            const double far_end = k == 1 ? 5 : SPAN_M + 4;
            s->middles[i][k] += s->speeds[i][k];
            if (s->middles[i][k] < corner[k] - 4 || s->middles[i][k] > corner[k] + far_end) s->speeds[i][k] = -s->speeds[i][k];
        }
        put(s, i, movers_move);
    }
    for (int n = 0; n < TELEPORTS; n++) {
        const uint32_t i = random_below(&s->random, MOVERS);
        place_anew(s, i);
        put(s, i, movers_move);
    }
    uint32_t first = random_below(&s->random, MOVERS - EXCHANGES);
    for (uint32_t i = first; i < first + EXCHANGES; i++) assert_int_equal(movers_remove(s->movers, i), RESULT_OK);
    for (uint32_t n = 0; n < EXCHANGES; n++) {
        const uint32_t i = movers_free_number(s->movers);
        assert_int_equal(i, first + n);
        place_anew(s, i);
        put(s, i, movers_add);
    }
    for (int n = 0; n < SPOT_CHECKS; n++) check(s, random_below(&s->random, MOVERS));
}

static void ten_thousand_movers_in_a_thousand_frames_are_found_in_each_zone_they_touch(void **state)
{
    (void)state;
    storm s;
    storm_open(&s);
    for (uint32_t i = 0; i < MOVERS; i++) {
        place_anew(&s, i);
        put(&s, i, movers_add);
    }
    const uint64_t calls = s.memory.calls;
    for (uint32_t frame = 0; frame < FRAMES; frame++) {
        storm_frame(&s);
        if ((frame + 1) % (FRAMES / WHOLE_CHECKS) > 0) continue;
        for (uint32_t i = 0; i < MOVERS; i++) check(&s, i);
        check_lists(&s);
    }
    assert_int_equal(s.memory.calls, calls); // no growth
    assert_true(movers_counts(s.movers).relocations > 100000);
    assert_true(movers_counts(s.movers).everywhere > 0);
    storm_close(&s);
}

// Godot's #109514 was quadratic in 25,000 equal centres.
static uint64_t writes_of_a_life(double spread_m)
{
    enum { COUNT = 25000 };
    zone_fixture f;
    graph *g;
    movers *m;
    zones_make(&f, (const double[]){0, 0, 0});
    assert_int_equal(graph_open(&f.scene, allocator_heap(), &g), RESULT_OK);
    assert_int_equal(movers_open(&(movers_request){&f.scene, g, COUNT}, allocator_heap(), &m), RESULT_OK);
    for (uint32_t round = 0; round < 3; round++) {
        for (uint32_t i = 0; i < COUNT; i++) { // each in one room, off the walls and clear of its closet
            const double x = 6.75 + ROOM_M * (i % SIDE) * spread_m, z = 1.25 + ROOM_M * (i / SIDE % SIDE) * spread_m;
            const double min[3] = {x, 1 + round, z}, max[3] = {x + 0.5, 1.25 + round, z + 0.5};
            assert_int_equal((round ? movers_move : movers_add)(m, i, min, max), RESULT_OK);
        }
    }
    for (uint32_t i = 0; i < COUNT; i++) assert_int_equal(movers_remove(m, i), RESULT_OK);
    const uint64_t writes = movers_counts(m).writes;
    movers_close(m);
    graph_close(g);
    fixture_free(&f);
    return writes;
}

static void movers_in_one_place_cost_no_more_steps_than_movers_all_over(void **state)
{
    (void)state;
    const uint64_t at_one_place = writes_of_a_life(0), all_over = writes_of_a_life(1);
    assert_true(at_one_place <= all_over + all_over / 100);
    assert_true(at_one_place <= 4 * 25000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ten_thousand_movers_in_a_thousand_frames_are_found_in_each_zone_they_touch),
        cmocka_unit_test(movers_in_one_place_cost_no_more_steps_than_movers_all_over),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
