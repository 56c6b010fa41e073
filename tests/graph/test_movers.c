// Tests of host/core/movers: each mover stands in every zone that its box touches, whatever was done before.
// SPDX-License-Identifier: MIT
#include "fixture.h"

#include "tests/common/failing_allocator.h"
#include "tests/common/random.h"
#include "tests/common/test.h"

#include <math.h>
#include <string.h>

typedef struct fixture {
    zone_fixture zones;
    graph *graph;
    movers *movers;
    failing_allocator memory; // of the movers
} fixture;

static void movers_make(fixture *f, uint32_t capacity)
{
    failing_allocator_init(&f->memory, 0);
    assert_int_equal(graph_open(&f->zones.scene, allocator_heap(), &f->graph), RESULT_OK);
    const movers_request q = {&f->zones.scene, f->graph, capacity};
    assert_int_equal(movers_open(&q, &f->memory.memory, &f->movers), RESULT_OK);
}

static void rooms_make(fixture *f, uint32_t capacity)
{
    fixture_make(&f->zones);
    fixture_rooms(&f->zones, 4, 8, (const double[]){0, 0, 0});
    movers_make(f, capacity);
}

static void fixture_close(fixture *f)
{
    movers_close(f->movers);
    assert_true(failing_allocator_is_clean(&f->memory));
    graph_close(f->graph);
    fixture_free(&f->zones);
}

typedef struct cube { double min[3], max[3]; } cube;

static cube cube_at(double x, double y, double z, double half)
{
    return (cube){{x - half, y - half, z - half}, {x + half, y + half, z + half}};
}

static uint32_t times_listed(const movers *m, uint32_t zone, uint32_t mover)
{
    uint32_t times = 0;
    for (const mover_block *b = movers_of_zone(m, zone); b; b = movers_next(m, b)) {
        assert_in_range(b->count, 1, MOVER_BLOCK);
        for (uint32_t i = 0; i < b->count; i++) times += b->mover[i] == mover;
    }
    return times;
}

static uint32_t times_everywhere(const movers *m, uint32_t mover)
{
    uint32_t count, times = 0;
    const uint32_t *list = movers_everywhere(m, &count);
    for (uint32_t i = 0; i < count; i++) times += list[i] == mover;
    return times;
}

// Listed once in each of these zones and nowhere else. None: everywhere.
static void assert_stands_in(const fixture *f, uint32_t mover, const uint32_t *zones, uint32_t count)
{
    const uint32_t *found;
    assert_int_equal(movers_zones(f->movers, mover, &found), count);
    if (count) assert_memory_equal(found, zones, count * sizeof *zones);
    for (uint32_t z = 0, i = 0; z < f->zones.scene.zone_count; z++) {
        const uint32_t wanted = i < count && zones[i] == z;
        i += wanted;
        assert_int_equal(times_listed(f->movers, z, mover), wanted);
    }
    assert_int_equal(times_everywhere(f->movers, mover), count == 0);
}
#define ASSERT_STANDS_IN(f, mover, ...) \
    assert_stands_in(f, mover, (const uint32_t[]){__VA_ARGS__}, sizeof((const uint32_t[]){__VA_ARGS__}) / sizeof(uint32_t))

static result add(fixture *f, uint32_t mover, cube c)
{
    return movers_add(f->movers, mover, c.min, c.max);
}

static result move(fixture *f, uint32_t mover, cube c)
{
    return movers_move(f->movers, mover, c.min, c.max);
}

static void a_mover_stands_in_all_zones_that_it_touches_and_follows_its_moves(void **state)
{
    (void)state;
    fixture f;
    rooms_make(&f, 4);
    assert_int_equal(add(&f, 2, cube_at(4, 2, 4, 1)), RESULT_OK);
    ASSERT_STANDS_IN(&f, 2, 0);
    assert_int_equal(move(&f, 2, cube_at(8, 2, 4, 1)), RESULT_OK);
    ASSERT_STANDS_IN(&f, 2, 0, 1);
    assert_int_equal(move(&f, 2, cube_at(8, 2, 8, 1)), RESULT_OK);
    ASSERT_STANDS_IN(&f, 2, 0, 1, 4, 5);
    assert_int_equal(move(&f, 2, cube_at(28, 2, 28, 1)), RESULT_OK); // teleported
    ASSERT_STANDS_IN(&f, 2, 15);
    const mover_counts counts = movers_counts(f.movers);
    assert_int_equal(counts.live, 1);
    assert_int_equal(counts.moves, 3);
    assert_int_equal(counts.relocations, 3);
    fixture_close(&f);
}

static void a_mover_that_ends_exactly_on_a_border_stands_on_both_sides(void **state)
{
    (void)state;
    fixture f;
    rooms_make(&f, 4);
    add(&f, 0, (cube){{6, 1, 2}, {8, 2, 3}});
    ASSERT_STANDS_IN(&f, 0, 0, 1);
    add(&f, 1, (cube){{8, 1, 2}, {9, 2, 3}});
    ASSERT_STANDS_IN(&f, 1, 0, 1);
    add(&f, 2, (cube){{8, 1, 8}, {8, 1, 8}}); // a point where four rooms meet
    ASSERT_STANDS_IN(&f, 2, 0, 1, 4, 5);
    fixture_close(&f);
}

static void a_mover_larger_than_a_zone_stands_in_all_that_it_covers(void **state)
{
    (void)state;
    fixture f;
    rooms_make(&f, 4);
    add(&f, 0, (cube){{7, -20, 9}, {25, 50, 15}});
    ASSERT_STANDS_IN(&f, 0, 4, 5, 6, 7);
    fixture_close(&f);
}

static void a_mover_in_more_zones_than_fit_stands_everywhere_and_is_counted(void **state)
{
    (void)state;
    fixture f;
    rooms_make(&f, 4);
    add(&f, 1, cube_at(16, 2, 16, 100));
    assert_stands_in(&f, 1, NULL, 0);
    assert_int_equal(movers_counts(f.movers).everywhere, 1);
    add(&f, 0, cube_at(16, 2, 16, 200));
    move(&f, 1, (cube){{1, 1, 1}, {31, 2, 15}}); // eight rooms: as many as fit
    ASSERT_STANDS_IN(&f, 1, 0, 1, 2, 3, 4, 5, 6, 7);
    assert_stands_in(&f, 0, NULL, 0);
    move(&f, 1, (cube){{1, 1, 1}, {31, 2, 16}}); // touches the next four too
    assert_stands_in(&f, 1, NULL, 0);
    assert_int_equal(movers_remove(f.movers, 1), RESULT_OK);
    assert_int_equal(movers_counts(f.movers).everywhere, 1);
    fixture_close(&f);
}

static void a_mover_that_touches_no_zone_stands_everywhere(void **state)
{
    (void)state;
    fixture f;
    rooms_make(&f, 4);
    add(&f, 0, cube_at(-50, 2, -50, 1));
    assert_stands_in(&f, 0, NULL, 0);
    move(&f, 0, cube_at(4, 2, 4, 1));
    ASSERT_STANDS_IN(&f, 0, 0);
    fixture_close(&f);
}

// Godot #54908 and #61447: what was taken out and put back kept its old room.
static void a_mover_removed_and_added_in_one_frame_is_located_anew(void **state)
{
    (void)state;
    fixture f;
    rooms_make(&f, 4);
    add(&f, 3, cube_at(4, 2, 4, 1));
    assert_int_equal(movers_remove(f.movers, 3), RESULT_OK);
    assert_int_equal(times_listed(f.movers, 0, 3), 0);
    assert_int_equal(add(&f, 3, cube_at(20, 2, 12, 1)), RESULT_OK);
    ASSERT_STANDS_IN(&f, 3, 6);
    fixture_close(&f);
}

// portal64 #344: what is carried over the top of a door never crosses its portal, and was lost.
static void a_mover_carried_over_the_top_of_a_door_is_found_behind_it(void **state)
{
    (void)state;
    fixture f;
    rooms_make(&f, 4);
    add(&f, 0, cube_at(6.5, 3.5, 4, 0.25)); // a door in the wall x = 8 would end at 2 m
    for (double x = 6.5; x <= 9.5; x += 0.25) {
        assert_int_equal(move(&f, 0, cube_at(x, 3.5, 4, 0.25)), RESULT_OK);
        const uint32_t in_both[] = {0, 1};
        if (fabs(x - 8) <= 0.25) assert_stands_in(&f, 0, in_both, 2);
        else assert_stands_in(&f, 0, x < 8 ? in_both : in_both + 1, 1);
    }
    fixture_close(&f);
}

static void a_zone_inside_takes_a_mover_only_when_it_is_wholly_inside(void **state)
{
    (void)state;
    fixture f;
    fixture_make(&f.zones);
    const uint32_t outdoors = fixture_zone(&f.zones, ZONE_EVERYWHERE, SCENE_NONE), house = fixture_zone(&f.zones, 0, outdoors);
    fixture_box(&f.zones, (const double[]){0, 0, 0}, (const double[]){10, 4, 10});
    movers_make(&f, 2);
    add(&f, 0, cube_at(50, 1, 50, 1));
    ASSERT_STANDS_IN(&f, 0, outdoors);
    move(&f, 0, cube_at(10, 2, 5, 1));
    ASSERT_STANDS_IN(&f, 0, outdoors, house);
    move(&f, 0, cube_at(5, 2, 5, 1));
    ASSERT_STANDS_IN(&f, 0, house);
    fixture_close(&f);
}

static void bad_boxes_and_numbers_are_refused_and_change_nothing(void **state)
{
    (void)state;
    fixture f;
    rooms_make(&f, 4);
    assert_int_equal(add(&f, 0, cube_at(4, 2, 4, 1)), RESULT_OK);
    const cube bad[] = {
        {{NAN, 1, 1}, {2, 2, 2}}, {{1, 1, 1}, {2, NAN, 2}}, {{-INFINITY, 1, 1}, {2, 2, 2}}, {{1, 1, 1}, {2, 2, INFINITY}},
        {{2, 1, 1}, {1.999, 2, 2}}, {{-1.0001e9, 1, 1}, {2, 2, 2}}, {{1, 1, 1}, {2, 1.0001e9, 2}},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        assert_int_equal(move(&f, 0, bad[i]), RESULT_BAD_INPUT);
        assert_int_equal(add(&f, 1, bad[i]), RESULT_BAD_INPUT);
    }
    assert_int_equal(add(&f, 0, cube_at(4, 2, 4, 1)), RESULT_BAD_INPUT);  // in use
    assert_int_equal(move(&f, 1, cube_at(4, 2, 4, 1)), RESULT_BAD_INPUT); // not in use
    assert_int_equal(movers_remove(f.movers, 1), RESULT_BAD_INPUT);
    assert_int_equal(add(&f, 4, cube_at(4, 2, 4, 1)), RESULT_BAD_INPUT); // no room
    assert_int_equal(move(&f, UINT32_MAX, cube_at(4, 2, 4, 1)), RESULT_BAD_INPUT);
    assert_int_equal(movers_remove(f.movers, UINT32_MAX), RESULT_BAD_INPUT);
    ASSERT_STANDS_IN(&f, 0, 0);
    double min[3], max[3];
    assert_true(movers_box(f.movers, 0, min, max));
    assert_memory_equal(min, cube_at(4, 2, 4, 1).min, sizeof min);
    assert_false(movers_box(f.movers, 1, min, max));
    assert_false(movers_box(f.movers, 9, min, max));
    assert_int_equal(movers_counts(f.movers).live, 1);
    assert_int_equal(movers_counts(f.movers).moves, 0);
    assert_int_equal(add(&f, 1, (cube){{-1e9, -1e9, -1e9}, {1e9, 1e9, 1e9}}), RESULT_OK); // the farthest that goes
    fixture_close(&f);
}

static void numbers_are_given_from_the_least_that_is_free(void **state)
{
    (void)state;
    enum { CAPACITY = 200 };
    fixture f;
    rooms_make(&f, CAPACITY);
    for (uint32_t i = 0; i < CAPACITY; i++) {
        assert_int_equal(movers_free_number(f.movers), i);
        assert_int_equal(add(&f, i, cube_at(4, 2, 4, 1)), RESULT_OK);
    }
    assert_int_equal(movers_free_number(f.movers), SCENE_NONE);
    const uint32_t freed[] = {199, 130, 64, 63, 128, 0};
    const uint32_t least[] = {199, 130, 64, 63, 63, 0};
    for (size_t i = 0; i < 6; i++) {
        assert_int_equal(movers_remove(f.movers, freed[i]), RESULT_OK);
        assert_int_equal(movers_free_number(f.movers), least[i]);
    }
    fixture_close(&f);
}

static void full_room_refuses_one_more_and_loses_nothing(void **state)
{
    (void)state;
    enum { CAPACITY = 1000 };
    fixture f;
    rooms_make(&f, CAPACITY);
    const uint64_t calls = f.memory.calls;
    for (int round = 0; round < 3; round++) { // every mover in as many zones as may be, then in one
        const cube wide = {{1, 1, 1}, {31, 2, 15}}, narrow = cube_at(4, 2, 4, 1);
        for (uint32_t i = 0; i < CAPACITY; i++) assert_int_equal(add(&f, i, round == 1 ? narrow : wide), RESULT_OK);
        assert_int_equal(add(&f, CAPACITY, narrow), RESULT_BAD_INPUT);
        for (uint32_t i = 0; i < CAPACITY; i++) assert_int_equal(times_listed(f.movers, 0, i), 1);
        assert_int_equal(times_listed(f.movers, 7, CAPACITY - 1), round != 1);
        assert_int_equal(movers_counts(f.movers).everywhere, 0);
        for (uint32_t i = 0; i < CAPACITY; i++) assert_int_equal(movers_remove(f.movers, i), RESULT_OK);
        for (uint32_t z = 0; z < 16; z++) assert_null(movers_of_zone(f.movers, z));
    }
    assert_int_equal(f.memory.calls, calls);
    fixture_close(&f);
}

static void boxes_of_a_zone_hold_the_mover_after_rounding_and_hardly_more(void **state)
{
    (void)state;
    const double corners[][3] = {{0, 0, 0}, {1e7, -1e7, 1e7}, {-3e7, 5, 12345}, {9e8, 9e8, -9e8}};
    uint64_t random = 1;
    for (size_t c = 0; c < sizeof corners / sizeof *corners; c++) {
        fixture f;
        fixture_make(&f.zones);
        fixture_rooms(&f.zones, 2, 8, corners[c]);
        movers_make(&f, 1);
        add(&f, 0, cube_at(corners[c][0], corners[c][1], corners[c][2], 1));
        for (int i = 0; i < 2000; i++) {
            double p[3];
            for (int k = 0; k < 3; k++) p[k] = corners[c][k] + random_between(&random, -1, k == 1 ? 5 : 17);
            const cube own = cube_at(p[0], p[1], p[2], i % 10 ? random_between(&random, 0, 3) : 1e-30);
            assert_int_equal(move(&f, 0, own), RESULT_OK);
            const uint32_t *zones;
            const uint32_t count = movers_zones(f.movers, 0, &zones);
            for (uint32_t z = 0; z < count; z++) {
                const mover_block *b = movers_of_zone(f.movers, zones[z]);
                const double *origin = f.zones.scene.zones[zones[z]].origin;
                const float min[3] = {b->min_x[0], b->min_y[0], b->min_z[0]}, max[3] = {b->max_x[0], b->max_y[0], b->max_z[0]};
                for (int k = 0; k < 3; k++) { // in wider numbers: no rounding here
                    const long double low = (long double)own.min[k] - origin[k], high = (long double)own.max[k] - origin[k];
                    assert_true(min[k] <= low && max[k] >= high);
                    assert_true(nextafterf(min[k], INFINITY) > low - 1e-30L && nextafterf(max[k], -INFINITY) < high + 1e-30L);
                }
            }
        }
        fixture_close(&f);
    }
}

static void a_difference_that_a_double_cannot_hold_is_rounded_outward_too(void **state)
{
    (void)state;
    fixture f;
    fixture_make(&f.zones);
    fixture_zone(&f.zones, ZONE_EVERYWHERE, SCENE_NONE);
    fixture_origin(&f.zones, 0, 1 << 24, -(1 << 24), 0);
    movers_make(&f, 1);
    // 2^-60 is lost beside 2^24 in double: a mere rounding of the difference would leave it outside.
    const double little = 0x1p-60;
    add(&f, 0, (cube){{-little, -little, -little}, {little, little, little}});
    const mover_block *b = movers_of_zone(f.movers, 0);
    assert_true(b->min_x[0] < -0x1p24f && b->max_x[0] > -0x1p24f);
    assert_true(b->min_y[0] < 0x1p24f && b->max_y[0] > 0x1p24f);
    assert_true(b->min_z[0] == -0x1p-60f && b->max_z[0] == 0x1p-60f); // exact
    move(&f, 0, (cube){{-1e-60, 0, 0}, {1e-60, 0, 0}});               // too small for a float
    b = movers_of_zone(f.movers, 0);
    assert_true(b->min_z[0] == 0 && b->max_z[0] == 0 && b->min_x[0] < -0x1p24f);
    move(&f, 0, (cube){{0, 0, -1e-60}, {0, 0, 1e-60}});
    b = movers_of_zone(f.movers, 0);
    assert_true(b->min_z[0] < 0 && b->max_z[0] > 0);
    fixture_close(&f);
}

static void the_order_of_adding_changes_no_set(void **state)
{
    (void)state;
    enum { COUNT = 500 };
    fixture a, b;
    rooms_make(&a, COUNT);
    rooms_make(&b, COUNT);
    cube cubes[COUNT];
    uint64_t random = 9;
    for (uint32_t i = 0; i < COUNT; i++) {
        cubes[i] = cube_at(random_between(&random, 0, 32), 2, random_between(&random, 0, 32), random_between(&random, 0, 6));
    }
    for (uint32_t i = 0; i < COUNT; i++) {
        assert_int_equal(add(&a, i, cubes[i]), RESULT_OK);
        const uint32_t j = i * 271 % COUNT; // 271 and 500 share no factor
        assert_int_equal(add(&b, j, cubes[j]), RESULT_OK);
    }
    for (uint32_t i = 0; i < COUNT; i++) {
        const uint32_t *zones;
        const uint32_t count = movers_zones(a.movers, i, &zones);
        assert_stands_in(&b, i, zones, count);
    }
    fixture_close(&a);
    fixture_close(&b);
}

static void every_allocation_that_fails_is_told_and_leaves_nothing(void **state)
{
    (void)state;
    zone_fixture zones;
    fixture_make(&zones);
    fixture_rooms(&zones, 4, 8, (const double[]){0, 0, 0});
    graph *g;
    assert_int_equal(graph_open(&zones.scene, allocator_heap(), &g), RESULT_OK);
    uint64_t fail_at = 1;
    for (result r = RESULT_NO_MEMORY; r != RESULT_OK; fail_at++) {
        failing_allocator a;
        failing_allocator_init(&a, fail_at);
        movers *m;
        r = movers_open(&(movers_request){&zones.scene, g, 5000}, &a.memory, &m);
        assert_true(r == RESULT_OK || (r == RESULT_NO_MEMORY && a.failures == 1 && m == NULL));
        movers_close(m);
        assert_true(failing_allocator_is_clean(&a));
    }
    assert_true(fail_at > 3);
    graph_close(g);
    fixture_free(&zones);
}

static void ten_thousand_zones_and_movers_take_a_bounded_room(void **state)
{
    (void)state;
    fixture f;
    fixture_make(&f.zones);
    fixture_rooms(&f.zones, 100, 4, (const double[]){0, 0, 0});
    movers_make(&f, 10000);
    assert_true(f.memory.live_bytes < 10u << 20);
    for (uint32_t i = 0; i < 10000; i++) { // one in each zone: every block part full
        assert_int_equal(add(&f, i, cube_at(i % 100 * 4 + 2, 2, i / 100 * 4 + 2, 1)), RESULT_OK);
    }
    assert_int_equal(movers_counts(f.movers).everywhere, 0);
    fixture_close(&f);
}

static void no_room_for_movers_and_more_than_can_be_counted_are_borne(void **state)
{
    (void)state;
    fixture f;
    rooms_make(&f, 0);
    assert_int_equal(movers_free_number(f.movers), SCENE_NONE);
    assert_int_equal(add(&f, 0, cube_at(4, 2, 4, 1)), RESULT_BAD_INPUT);
    movers *m;
    assert_int_equal(movers_open(&(movers_request){&f.zones.scene, f.graph, UINT32_MAX}, &f.memory.memory, &m), RESULT_NO_MEMORY);
    assert_null(m);
    movers_close(NULL);
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_mover_stands_in_all_zones_that_it_touches_and_follows_its_moves),
        cmocka_unit_test(a_mover_that_ends_exactly_on_a_border_stands_on_both_sides),
        cmocka_unit_test(a_mover_larger_than_a_zone_stands_in_all_that_it_covers),
        cmocka_unit_test(a_mover_in_more_zones_than_fit_stands_everywhere_and_is_counted),
        cmocka_unit_test(a_mover_that_touches_no_zone_stands_everywhere),
        cmocka_unit_test(a_mover_removed_and_added_in_one_frame_is_located_anew),
        cmocka_unit_test(a_mover_carried_over_the_top_of_a_door_is_found_behind_it),
        cmocka_unit_test(a_zone_inside_takes_a_mover_only_when_it_is_wholly_inside),
        cmocka_unit_test(bad_boxes_and_numbers_are_refused_and_change_nothing),
        cmocka_unit_test(numbers_are_given_from_the_least_that_is_free),
        cmocka_unit_test(full_room_refuses_one_more_and_loses_nothing),
        cmocka_unit_test(boxes_of_a_zone_hold_the_mover_after_rounding_and_hardly_more),
        cmocka_unit_test(a_difference_that_a_double_cannot_hold_is_rounded_outward_too),
        cmocka_unit_test(the_order_of_adding_changes_no_set),
        cmocka_unit_test(every_allocation_that_fails_is_told_and_leaves_nothing),
        cmocka_unit_test(ten_thousand_zones_and_movers_take_a_bounded_room),
        cmocka_unit_test(no_room_for_movers_and_more_than_can_be_counted_are_borne),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
