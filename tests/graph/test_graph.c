// Tests of host/core/graph: which zones a point or box touches, against brute force and at borders.
// SPDX-License-Identifier: MIT
#include "fixture.h"

#include "host/core/zone_seam.h"
#include "tests/common/failing_allocator.h"
#include "tests/common/random.h"
#include "tests/common/test.h"

#include <math.h>
#include <string.h>

enum { ZONES_MOST = 4096 };

static graph *open_graph(const zone_fixture *f)
{
    graph *g;
    assert_int_equal(graph_open(&f->scene, allocator_heap(), &g), RESULT_OK);
    return g;
}

static void assert_zones(const uint32_t *found, uint32_t count, const uint32_t *wanted, uint32_t wanted_count)
{
    assert_int_equal(count, wanted_count);
    assert_memory_equal(found, wanted, count * sizeof *found);
}

#define ASSERT_AT(g, x, y, z, distance, ...)                                                    \
    do {                                                                                        \
        const uint32_t wanted_[] = {__VA_ARGS__};                                               \
        uint32_t found_[64];                                                                    \
        const uint32_t count_ = graph_zones_at(g, (const double[]){x, y, z}, distance, found_, 64); \
        assert_zones(found_, count_, wanted_, sizeof wanted_ / sizeof *wanted_);                \
    } while (0)

static void a_point_is_in_its_room_and_on_a_wall_in_both(void **state)
{
    (void)state;
    zone_fixture f;
    fixture_make(&f);
    fixture_rooms(&f, 4, 8, (const double[]){0, 0, 0});
    graph *g = open_graph(&f);
    ASSERT_AT(g, 4, 2, 4, 0, 0);
    ASSERT_AT(g, 12, 2, 4, 0, 1);
    ASSERT_AT(g, 8, 2, 4, 0, 0, 1);
    ASSERT_AT(g, nextafter(8, 9), 2, 4, 0, 1);
    ASSERT_AT(g, nextafter(8, 7), 2, 4, 0, 0);
    ASSERT_AT(g, 8, 2, 8, 0, 0, 1, 4, 5); // where four meet
    ASSERT_AT(g, 9, 2, 4, 1, 0, 1);       // a metre from the wall
    ASSERT_AT(g, 9.001, 2, 4, 1, 1);
    uint32_t none;
    assert_int_equal(graph_zones_at(g, (const double[]){-1, 2, 4}, 0.5, &none, 1), 0);
    graph_close(g);
    fixture_free(&f);
}

static void a_zone_inside_takes_what_is_deeper_in_it_than_the_distance(void **state)
{
    (void)state;
    zone_fixture f;
    fixture_make(&f);
    const uint32_t outdoors = fixture_zone(&f, ZONE_EVERYWHERE, SCENE_NONE), house = fixture_zone(&f, 0, outdoors);
    fixture_box(&f, (const double[]){0, 0, 0}, (const double[]){10, 6, 10});
    const uint32_t cellar = fixture_zone(&f, 0, house);
    fixture_box(&f, (const double[]){2, 1, 2}, (const double[]){8, 5, 8});
    fixture_zone(&f, ZONE_STRAY | ZONE_EVERYWHERE, SCENE_NONE); // stray zones are never found
    fixture_zone(&f, ZONE_STRAY, SCENE_NONE);
    fixture_box(&f, (const double[]){-100, -100, -100}, (const double[]){100, 100, 100});
    graph *g = open_graph(&f);
    ASSERT_AT(g, 50, 2, 50, 0, outdoors);
    ASSERT_AT(g, 0, 2, 5, 0, outdoors, house); // on the border
    ASSERT_AT(g, 1, 2, 5, 0, house);
    ASSERT_AT(g, 1, 2, 5, 1, outdoors, house, cellar);
    ASSERT_AT(g, 2, 2, 5, 0, house, cellar);
    ASSERT_AT(g, 5, 3, 5, 0, cellar); // taken from the house and from outdoors
    ASSERT_AT(g, 5, 3, 5, 1.9, cellar);
    ASSERT_AT(g, 5, 3, 5, 2.5, house, cellar); // 2 m to the cellar's ceiling, 3 m to the house's
    graph_close(g);
    fixture_free(&f);
}

static void a_zone_inside_takes_nothing_that_lies_over_two_of_its_hulls(void **state)
{
    (void)state;
    zone_fixture f;
    fixture_make(&f);
    const uint32_t outer = fixture_zone(&f, 0, SCENE_NONE);
    fixture_box(&f, (const double[]){-20, -20, -20}, (const double[]){20, 20, 20});
    const uint32_t inner = fixture_zone(&f, 0, outer);
    fixture_box(&f, (const double[]){-4, -4, -4}, (const double[]){0, 4, 4});
    fixture_box(&f, (const double[]){0, -4, -4}, (const double[]){4, 4, 4});
    graph *g = open_graph(&f);
    ASSERT_AT(g, -1, 0, 0, 0, inner);
    ASSERT_AT(g, 0, 0, 0, 0, outer, inner);
    uint32_t zones[8];
    assert_int_equal(graph_zones_of_box(g, (const double[]){-3, -1, -1}, (const double[]){-1, 1, 1}, zones, 8), 1);
    assert_int_equal(zones[0], inner);
    assert_int_equal(graph_zones_of_box(g, (const double[]){-1, -1, -1}, (const double[]){1, 1, 1}, zones, 8), 2);
    graph_close(g);
    fixture_free(&f);
}

static void a_box_touches_within_one_step_and_is_held_beyond_two(void **state)
{
    (void)state;
    zone_fixture f;
    fixture_make(&f);
    const uint32_t outer = fixture_zone(&f, ZONE_EVERYWHERE, SCENE_NONE), inner = fixture_zone(&f, 0, outer);
    fixture_box(&f, (const double[]){0, 0, 0}, (const double[]){8, 8, 8});
    graph *g = open_graph(&f);
    uint32_t zones[4];
    const double step = FIXTURE_STEP, max[3] = {7, 7, 7};
    const struct { double gap; uint32_t zones; } cases[] = {
        // gap: of the box's far end to the border x = 8, outward
        {-3 * step, 1}, {-2 * step, 2}, {0, 2}, {step, 2}, {1, 2},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const double far_end[3] = {8 + cases[i].gap, max[1], max[2]};
        assert_int_equal(graph_zones_of_box(g, (const double[]){1, 1, 1}, far_end, zones, 4), cases[i].zones);
        assert_int_equal(zones[cases[i].zones - 1], inner);
    }
    const struct { double start; uint32_t zones; } outside[] = {{8 + step, 2}, {8 + 2 * step, 1}};
    for (size_t i = 0; i < 2; i++) {
        assert_int_equal(graph_zones_of_box(g, (const double[]){outside[i].start, 1, 1}, (const double[]){12, 2, 2}, zones, 4), outside[i].zones);
        assert_int_equal(zones[0], outer);
    }
    graph_close(g);
    fixture_free(&f);
}

static void a_zone_of_many_hulls_is_told_once_and_zones_ascend(void **state)
{
    (void)state;
    zone_fixture f;
    fixture_make(&f);
    for (int z = 0; z < 20; z++) {
        fixture_zone(&f, 0, SCENE_NONE);
        for (int i = 0; i < 5; i++) fixture_box(&f, (const double[]){-1 - i, -1, -1}, (const double[]){1 + i, 1, 1 + z});
    }
    graph *g = open_graph(&f);
    uint32_t zones[20];
    assert_int_equal(graph_zones_at(g, (const double[]){0, 0, 0}, 0, zones, 20), 20);
    for (uint32_t i = 0; i < 20; i++) assert_int_equal(zones[i], i);
    graph_close(g);
    fixture_free(&f);
}

static void room_for_fewer_zones_gives_the_least_and_tells_how_many_there_are(void **state)
{
    (void)state;
    zone_fixture f;
    fixture_make(&f);
    fixture_rooms(&f, 4, 8, (const double[]){0, 0, 0});
    graph *g = open_graph(&f);
    uint32_t zones[4] = {77, 77, 77, 77};
    const double min[3] = {1, 1, 1}, max[3] = {31, 2, 31};
    assert_int_equal(graph_zones_of_box(g, min, max, NULL, 0), 16);
    assert_int_equal(graph_zones_of_box(g, min, max, zones, 3), 16);
    assert_zones(zones, 4, (const uint32_t[]){0, 1, 2, 77}, 4);
    assert_true(graph_few_zones_of_box(g, min, max, zones, 3) > 3);
    assert_int_equal(zones[3], 77);
    assert_int_equal(graph_few_zones_of_box(g, (const double[]){1, 1, 1}, (const double[]){15, 2, 15}, zones, 4), 4);
    assert_zones(zones, 4, (const uint32_t[]){0, 1, 4, 5}, 4);
    graph_close(g);
    fixture_free(&f);
}

// Gems and boxes at random in a nest of zones.
static void random_zones(zone_fixture *f, uint64_t seed)
{
    fixture_make(f);
    fixture_zone(f, ZONE_EVERYWHERE, SCENE_NONE);
    fixture_zone(f, ZONE_STRAY, SCENE_NONE);
    for (uint32_t z = 2; z < 150; z++) {
        const uint32_t parent = random_below(&seed, z);
        fixture_zone(f, 0, parent == 1 ? SCENE_NONE : parent);
        const uint32_t hulls = random_below(&seed, 5);
        for (uint32_t h = 0; h < hulls; h++) {
            double centre[3], max[3];
            for (int k = 0; k < 3; k++) centre[k] = random_between(&seed, -30, 30);
            const double size = random_between(&seed, 0.5, random_below(&seed, 4) ? 6 : 30);
            for (int k = 0; k < 3; k++) max[k] = centre[k] + size * (k + 1);
            if (random_below(&seed, 2)) fixture_gem(f, centre, size, random_between(&seed, 0, 6));
            else fixture_box(f, centre, max);
        }
    }
}

static void points_and_boxes_find_what_trying_all_hulls_finds(void **state)
{
    (void)state;
    uint64_t random = 7, found_most = 0;
    for (uint64_t seed = 1; seed <= 20; seed++) {
        zone_fixture f;
        random_zones(&f, seed);
        graph *g = open_graph(&f);
        uint32_t zones[ZONES_MOST], wanted[ZONES_MOST];
        for (int i = 0; i < 1000; i++) {
            double min[3], max[3];
            const double size = i % 3 ? random_between(&random, 0, 3) : random_between(&random, 0, 40);
            for (int k = 0; k < 3; k++) {
                min[k] = random_between(&random, -35, 35);
                max[k] = min[k] + random_between(&random, 0, size);
            }
            const uint32_t count = graph_zones_of_box(g, min, max, zones, ZONES_MOST);
            assert_zones(zones, count, wanted, oracle_zones_of_box(&f, min, max, wanted));
            const uint32_t room = random_below(&random, 12), kept = count < room ? count : room;
            uint32_t few[12];
            assert_int_equal(graph_zones_of_box(g, min, max, few, room), count);
            assert_zones(few, kept, wanted, kept);
            const uint32_t few_count = graph_few_zones_of_box(g, min, max, few, room);
            assert_true(count > room ? few_count > room : few_count == count);
            if (count <= room) assert_zones(few, count, wanted, count);
            const double distance = i % 2 ? 0 : random_between(&random, 0, 4);
            const uint32_t at = graph_zones_at(g, min, distance, zones, ZONES_MOST);
            assert_zones(zones, at, wanted, oracle_zones(&f, min, min, (oracle_margins){distance, distance}, wanted));
            found_most = count > found_most ? count : found_most;
        }
        graph_close(g);
        fixture_free(&f);
    }
    assert_true(found_most > 20);
}

// Also of points exactly as far as that, and beyond the sharp edges of hulls, where bounds say nothing.
static void a_zone_reaches_a_point_exactly_when_its_height_is_no_more(void **state)
{
    (void)state;
    zone_fixture f;
    graph *g = NULL;
    uint64_t seed = 29, reached = 0, far = 0;
    random_zones(&f, 23);
    assert_int_equal(graph_open(&f.scene, allocator_heap(), &g), RESULT_OK);
    for (int i = 0; i < 20000; i++) {
        const uint32_t zone = random_below(&seed, f.scene.zone_count);
        double p[3], distance = i % 3 ? random_between(&seed, -1, 2) : 0;
        for (int k = 0; k < 3; k++) p[k] = random_between(&seed, -60, 60);
        const double height = zone_height(&f.scene, zone, p);
        if (i % 4 == 1 && isfinite(height)) distance = height;
        if (i % 4 == 2 && isfinite(height)) distance = nextafter(height, -INFINITY);
        assert_int_equal(graph_zone_reaches(g, zone, p, distance), height <= distance);
        reached += height <= distance;
        far += height > distance;
    }
    assert_true(reached > 4000 && far > 4000);
    graph_close(g);
    fixture_free(&f);
}

static void zones_told_in_another_order_are_found_the_same(void **state)
{
    (void)state;
    enum { COUNT = 400 };
    uint32_t order[COUNT];
    uint64_t random = 3;
    for (uint32_t i = 0; i < COUNT; i++) order[i] = i;
    for (uint32_t i = COUNT; i-- > 1;) {
        const uint32_t j = random_below(&random, i + 1), t = order[i];
        order[i] = order[j];
        order[j] = t;
    }
    zone_fixture told, shuffled;
    fixture_make(&told);
    fixture_make(&shuffled);
    for (uint32_t i = 0; i < COUNT; i++) {
        fixture_zone(&told, 0, SCENE_NONE);
        fixture_box(&told, (const double[]){i % 20, 0, i / 20}, (const double[]){i % 20 + 1.5, 2, i / 20 + 1.5});
        fixture_zone(&shuffled, 0, SCENE_NONE);
        const uint32_t j = order[i];
        fixture_box(&shuffled, (const double[]){j % 20, 0, j / 20}, (const double[]){j % 20 + 1.5, 2, j / 20 + 1.5});
    }
    graph *a = open_graph(&told), *b = open_graph(&shuffled);
    for (int i = 0; i < 2000; i++) {
        const double p[3] = {random_between(&random, -1, 22), 1, random_between(&random, -1, 22)};
        uint32_t zones[COUNT], others[COUNT];
        uint8_t is_found[COUNT] = {0};
        const uint32_t count = graph_zones_at(a, p, 0.25, zones, COUNT);
        assert_int_equal(graph_zones_at(b, p, 0.25, others, COUNT), count);
        for (uint32_t k = 0; k < count; k++) is_found[zones[k]] = 1;
        for (uint32_t k = 0; k < count; k++) assert_true(is_found[order[others[k]]]);
    }
    graph_close(a);
    graph_close(b);
    fixture_free(&told);
    fixture_free(&shuffled);
}

static void rooms_ten_thousand_kilometres_out_are_found_as_at_the_origin(void **state)
{
    (void)state;
    const double far_out = 1e7; // where a double tells 2 nanometres apart
    zone_fixture near_by, far_off;
    fixture_make(&near_by);
    fixture_make(&far_off);
    fixture_rooms(&near_by, 16, 4, (const double[]){0, 0, 0});
    fixture_rooms(&far_off, 16, 4, (const double[]){far_out, -far_out, far_out});
    graph *a = open_graph(&near_by), *b = open_graph(&far_off);
    uint64_t random = 11;
    for (int i = 0; i < 5000; i++) {
        double p[3], q[3];
        for (int k = 0; k < 3; k++) { // on the step, so that both places are exact
            p[k] = floor(random_between(&random, -1, k == 1 ? 5 : 65) / FIXTURE_STEP) * FIXTURE_STEP;
            if (i % 4 == 0) p[k] = floor(p[k] / 4) * 4; // on walls
            q[k] = p[k] + (k == 1 ? -far_out : far_out);
        }
        uint32_t zones[64], others[64];
        const uint32_t count = graph_zones_at(a, p, 0.125, zones, 64);
        assert_zones(others, graph_zones_at(b, q, 0.125, others, 64), zones, count);
    }
    graph_close(a);
    graph_close(b);
    fixture_free(&near_by);
    fixture_free(&far_off);
}

static void hulls_with_equal_centres_make_no_deeper_tree_than_others(void **state)
{
    (void)state;
    enum { HULLS = 25000 };
    zone_fixture f, spread;
    fixture_make(&f);
    fixture_make(&spread);
    fixture_zone(&f, 0, SCENE_NONE);
    fixture_zone(&spread, 0, SCENE_NONE);
    for (int i = 0; i < HULLS; i++) {
        fixture_box(&f, (const double[]){-1, -1, -1}, (const double[]){1, 1, 1});
        fixture_box(&spread, (const double[]){i, -1, i % 7}, (const double[]){i + 1, 1, i % 7 + 1});
    }
    graph *g = open_graph(&f), *other = open_graph(&spread);
    assert_int_equal(graph_depth(g), graph_depth(other));
    assert_true(graph_depth(g) <= 16); // 2^15 > 25,000
    ASSERT_AT(g, 0, 0, 0, 0, 0);
    graph_close(g);
    graph_close(other);
    fixture_free(&f);
    fixture_free(&spread);
}

static void a_scene_without_zones_or_hulls_finds_nothing(void **state)
{
    (void)state;
    zone_fixture f;
    fixture_make(&f);
    graph *g = open_graph(&f);
    uint32_t zone;
    assert_int_equal(graph_zones_at(g, (const double[]){0, 0, 0}, 1, &zone, 1), 0);
    assert_int_equal(graph_depth(g), 0);
    graph_close(g);
    fixture_zone(&f, 0, SCENE_NONE); // empty
    g = open_graph(&f);
    assert_int_equal(graph_zones_at(g, (const double[]){0, 0, 0}, 1, &zone, 1), 0);
    graph_close(g);
    graph_close(NULL);
    fixture_free(&f);
}

static void what_is_no_point_and_no_box_is_nowhere(void **state)
{
    (void)state;
    zone_fixture f;
    fixture_make(&f);
    fixture_zone(&f, 0, SCENE_NONE);
    f.scene.zones[0].flags = ZONE_EVERYWHERE;
    graph *g = open_graph(&f);
    uint32_t zone;
    const double point[3] = {0, 0, 0}, low[3] = {-1, -1, -1}, high[3] = {1, 1, 1}, nan[3] = {0, NAN, 0};
    assert_int_equal(graph_zones_at(g, point, 0, &zone, 1), 1);
    assert_int_equal(graph_zones_of_box(g, low, high, &zone, 1), 1);
    assert_int_equal(graph_zones_at(g, nan, 0, &zone, 1), 0);
    assert_int_equal(graph_zones_of_box(g, high, low, &zone, 1), 0);
    assert_int_equal(graph_zones_of_box(g, low, nan, &zone, 1), 0);
    graph_close(g);
    fixture_free(&f);
}

static void every_allocation_that_fails_is_told_and_leaves_nothing(void **state)
{
    (void)state;
    zone_fixture f;
    random_zones(&f, 5);
    uint64_t fail_at = 1;
    for (result r = RESULT_NO_MEMORY; r != RESULT_OK; fail_at++) {
        failing_allocator a;
        failing_allocator_init(&a, fail_at);
        graph *g;
        r = graph_open(&f.scene, &a.memory, &g);
        assert_true(r == RESULT_OK || (r == RESULT_NO_MEMORY && a.failures == 1 && g == NULL));
        const uint64_t calls = a.calls;
        uint32_t zones[ZONES_MOST];
        if (g) graph_zones_at(g, (const double[]){0, 0, 0}, 1, zones, ZONES_MOST);
        assert_int_equal(a.calls, calls);
        graph_close(g);
        assert_true(failing_allocator_is_clean(&a));
    }
    assert_true(fail_at > 4);
    fixture_free(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_point_is_in_its_room_and_on_a_wall_in_both),
        cmocka_unit_test(a_zone_inside_takes_what_is_deeper_in_it_than_the_distance),
        cmocka_unit_test(a_zone_inside_takes_nothing_that_lies_over_two_of_its_hulls),
        cmocka_unit_test(a_box_touches_within_one_step_and_is_held_beyond_two),
        cmocka_unit_test(a_zone_of_many_hulls_is_told_once_and_zones_ascend),
        cmocka_unit_test(room_for_fewer_zones_gives_the_least_and_tells_how_many_there_are),
        cmocka_unit_test(points_and_boxes_find_what_trying_all_hulls_finds),
        cmocka_unit_test(a_zone_reaches_a_point_exactly_when_its_height_is_no_more),
        cmocka_unit_test(zones_told_in_another_order_are_found_the_same),
        cmocka_unit_test(rooms_ten_thousand_kilometres_out_are_found_as_at_the_origin),
        cmocka_unit_test(hulls_with_equal_centres_make_no_deeper_tree_than_others),
        cmocka_unit_test(a_scene_without_zones_or_hulls_finds_nothing),
        cmocka_unit_test(what_is_no_point_and_no_box_is_nowhere),
        cmocka_unit_test(every_allocation_that_fails_is_told_and_leaves_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
