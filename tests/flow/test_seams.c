// Portals that lie a little off the borders of their zones, zones of several hulls, and crossers that write less than they
// might: nothing that is seen is lost, and zones come near to far.
// SPDX-License-Identifier: MIT
#include "tests/flow/fixture.h"
#include "tests/flow/oracle.h"

#include "host/core/flow_internal.h"
#include "tests/common/random.h"
#include "tests/common/test.h"

#include <portcullis/plane.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void expect_seen(maze *m, const camera *c, const flow_result *r, uint32_t rays)
{
    const oracle_answer a = oracle_ask(&(oracle_request){m->scene, m->open, c, r, rays, 79});
    if (a.missed > 0)
        fail_msg("%llu of %llu points missed, first in zone %u at %g %g %g", (unsigned long long)a.missed, (unsigned long long)a.points, a.zone, a.at[0],
                 a.at[1], a.at[2]);
    assert_true(a.points > 0);
}

// ---- Portals off the border ----

// A triangle across x.
static void sheet_add(maze *m, double x, double y, double z)
{
    builder_vertex v[3] = {{.position = {x, y, z}}, {.position = {x, y + 0.125, z}}, {.position = {x, y, z + 0.125}}};
    const uint32_t indices[3] = {0, 1, 2};
    uint32_t first, moved[3];
    assert_int_equal(scene_builder_vertices(m->builder, v, 3, 0, &first), RESULT_OK);
    for (int i = 0; i < 3; i++) moved[i] = first + indices[i];
    assert_int_equal(scene_builder_item(m->builder, &(builder_item){.indices = moved, .index_count = 3, .polygon_count = 1}), RESULT_OK);
}

typedef enum surroundings { IN_THE_OPEN, IN_A_HALL } surroundings;
typedef struct sunk_house { uint32_t outer, house, sheet; } sunk_house;

// A house x 0 .. 8; its portal lies `depth` inside of its face x = 0, and a sheet stands between the two.
static sunk_house sunk_house_make(maze *m, surroundings where, double depth)
{
    sunk_house h;
    maze_begin(m, &POSE_NONE);
    h.outer = where == IN_THE_OPEN ? maze_everywhere(m) : maze_box(m, (const double[3]){-16, -8, -8}, (const double[3]){24, 8, 8}, SCENE_NONE);
    h.house = maze_box(m, (const double[3]){0, 0, 0}, (const double[3]){8, 3, 4}, h.outer);
    (void)maze_opening(m, h.house, h.outer, &(opening){0, depth, {0.5, 1}, {2.5, 3}});
    maze_piece(m, (const double[3]){-5, 1.5, 2});
    h.sheet = where == IN_THE_OPEN ? 2 : 3;
    sheet_add(m, depth / 2, 1.5, 0.75);
    maze_end(m);
    return h;
}

static int lists(const maze *m, uint32_t zone, uint32_t item)
{
    const scene_zone *z = &m->scene->zones[zone];
    for (uint32_t i = 0; i < z->item_count; i++)
        if (m->scene->zone_items[z->first_item + i] == item) return 1;
    return 0;
}

static void an_eye_between_a_portal_and_its_houses_border_sees_what_is_outside(void **state)
{
    (void)state;
    const double depths[4] = {0.0156, 0.03, 0.002, 0.0005};
    for (int i = 0; i < 8; i++) {
        maze m;
        const sunk_house h = sunk_house_make(&m, i / 4 ? IN_A_HALL : IN_THE_OPEN, depths[i % 4]);
        for (int share = 0; share <= 10; share++) {
            camera c = maze_camera(&m, (const double[3]){depths[i % 4] * share / 10, 1.5, 2}, (const double[3]){-1, 0, 0}, 70);
            c.near_m = 1e-5;
            for (crosser_kind kind = CROSSER_FLOOD; kind <= CROSSER_MIXED; kind++) {
                flow_result r;
                maze_run(&m, &c, kind, &r);
                assert_non_null(maze_find(&r, h.outer));
                assert_non_null(maze_find(&r, h.house));
            }
        }
        maze_close(&m);
    }
}

static void what_stands_between_a_portal_and_its_houses_border_is_on_both_sides(void **state)
{
    (void)state;
    const double depths[3] = {0.0156, 0.03, 0.002};
    for (int i = 0; i < 6; i++) {
        maze m;
        const sunk_house h = sunk_house_make(&m, i / 3 ? IN_A_HALL : IN_THE_OPEN, depths[i % 3]);
        const double x = depths[i % 3] / 2, low[3] = {x, 1, 1}, high[3] = {x, 1.25, 1.25}, deep[3] = {2, 1, 1};
        uint32_t zones[2];
        assert_true(lists(&m, h.outer, h.sheet) && lists(&m, h.house, h.sheet));
        assert_int_equal(graph_zones_of_box(m.graph, low, high, zones, 2), 2); // a mover's box
        assert_int_equal(graph_zones_of_box(m.graph, deep, deep, zones, 2), 1);
        assert_int_equal(zones[0], h.house);
        maze_close(&m);
    }
}

static void what_stands_between_a_room_and_its_portal_in_the_next_room_is_on_both_sides(void **state)
{
    (void)state;
    maze m;
    maze_begin(&m, &POSE_NONE);
    const uint32_t a = maze_box(&m, (const double[3]){0, 0, 0}, (const double[3]){4, 3, 4}, SCENE_NONE);
    const uint32_t b = maze_box(&m, (const double[3]){4, 0, 0}, (const double[3]){8, 3, 4}, SCENE_NONE);
    (void)maze_opening(&m, a, b, &(opening){0, 4.015, {0.5, 1}, {2.5, 3}});
    sheet_add(&m, 4.0075, 1.5, 2);
    maze_end(&m);
    assert_true(lists(&m, a, 2) && lists(&m, b, 2));
    maze_close(&m);
}

// ---- Two ways into a zone ----

// From x, which narrows, into the house y, which floods, and out of it by two doors; t has its door before the plane of
// the first and behind that of the second.
static void a_zone_that_only_the_second_of_two_doors_of_a_flooding_house_shows_is_reached(void **state)
{
    (void)state;
    for (int swap = 0; swap < 2; swap++) {
        maze m;
        maze_begin(&m, &POSE_NONE);
        const uint32_t x = maze_box(&m, (const double[3]){-4, 0, 0}, (const double[3]){0, 4, 4}, SCENE_NONE);
        const uint32_t y = maze_box(&m, (const double[3]){0, 0, 0}, (const double[3]){10, 4, 4}, SCENE_NONE);
        const uint32_t e = maze_everywhere(&m), t = maze_box(&m, (const double[3]){6, 0, 5}, (const double[3]){8, 4, 9}, SCENE_NONE);
        maze_piece(&m, (const double[3]){30, 1, 30});
        const opening doors[2] = {{0, 10, {0.2, 0.2}, {3.8, 3.8}}, {2, 4, {1, 0.2}, {9.5, 3.8}}};
        (void)maze_opening(&m, x, y, &(opening){0, 0, {0.2, 0.2}, {3.8, 3.8}});
        for (int i = 0; i < 2; i++) (void)maze_opening(&m, y, e, &doors[i ^ swap]);
        (void)maze_opening(&m, e, t, &(opening){2, 5, {6.2, 0.2}, {7.8, 3.8}});
        maze_end(&m);
        const camera c = maze_camera(&m, (const double[3]){-1, 2, 1}, (const double[3]){1, 0, 0.3}, 90);
        for (crosser_kind kind = CROSSER_FLOOD; kind <= CROSSER_MIXED; kind++) {
            flow_result r;
            maze_run(&m, &c, kind, &r);
            assert_non_null(maze_find(&r, t));
            expect_seen(&m, &c, &r, 4000);
        }
        maze_close(&m);
    }
}

// As before, in zones of several hulls; through a closet in the house where `by_closet`.
static void around_the_corner(maze *m, int swap, int by_closet, uint32_t *t)
{
    const maze_part y_parts[2] = {{{0, 0, 0}, {10, 4, 2}}, {{0, 0, 2}, {by_closet ? 4 : 5, 4, 4}}};
    const maze_part z_parts[4] = {{{10, 0, 0}, {14, 4, 2}}, {{5, 0, 2}, {8, 4, 4}}, {{5, 0, 4}, {14, 4, 6}}, {{10, 0, 2}, {14, 4, 4}}};
    const opening far_door = {0, 10, {0.2, 0.2}, {3.8, 1.8}}, near_door = {0, 5, {0.2, 2.2}, {3.8, 3.8}}, closet_door = {0, 4, {0.2, 2.2}, {3.8, 3.8}};
    maze_begin(m, &POSE_NONE);
    const uint32_t x = maze_box(m, (const double[3]){-4, 0, 0}, (const double[3]){0, 4, 4}, SCENE_NONE);
    const uint32_t y = maze_union(m, y_parts, 2, SCENE_NONE), z = maze_union(m, z_parts, 4, SCENE_NONE);
    *t = maze_box(m, (const double[3]){8, 0, 2}, (const double[3]){10, 4, 4}, SCENE_NONE);
    const uint32_t closet = by_closet ? maze_box(m, (const double[3]){4, 0, 2}, (const double[3]){5, 4, 4}, SCENE_NONE) : y;
    (void)maze_opening(m, x, y, &(opening){0, 0, {0.5, 0.5}, {3.5, 3.5}});
    for (int i = 0; i < 2; i++) {
        if (i == swap) (void)maze_opening(m, y, z, &far_door);
        else (void)maze_opening(m, closet, z, &near_door);
    }
    if (by_closet) (void)maze_opening(m, y, closet, &closet_door);
    (void)maze_opening(m, z, *t, &(opening){0, 8, {0.2, 2.2}, {3.8, 3.8}});
    maze_end(m);
}

typedef enum silence { SILENT_OF_ITS_OWN, SILENT_OF_SOME, SILENT_OF_ALL } silence;
typedef struct quiet { // a crosser that leaves planes out, as any may: that is wider, never narrower
    flow_crosser whole;
    silence kind;
    uint64_t seed;
} quiet;

static cull_crossing crosses_quietly(void *user, uint32_t zone, const cull_view *view, const cull_volume *in, uint32_t portal, cull_plane *planes,
                                     uint32_t *plane_count)
{
    quiet *q = user;
    const cull_crossing answer = q->whole.cross(q->whole.user, zone, view, in, portal, planes, plane_count);
    if (answer != CULL_CROSS_NARROW) return answer;
    if (q->kind == SILENT_OF_ITS_OWN) --*plane_count; // it comes last
    if (q->kind == SILENT_OF_ALL) *plane_count = 0;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < *plane_count; i++)
        if (q->kind != SILENT_OF_SOME || random_below(&q->seed, 2)) planes[kept++] = planes[i];
    *plane_count = kept;
    return answer;
}

static void quiet_run(maze *m, const camera *c, quiet *q, flow_result *out)
{
    q->whole = maze_crosser(m, CROSSER_NARROW);
    const flow_request request = {.camera = c, .frame = {320, 240, 0, 0, CULL_VIEW_MAIN}, .open = m->open, .crosser = {q, crosses_quietly, NULL, NULL}};
    flow_run(m->flow, &request, out);
}

static void zones_of_several_hulls_hide_nothing_around_a_corner(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++) {
        maze m;
        uint32_t t;
        around_the_corner(&m, i % 2, i / 2, &t);
        const camera c = maze_camera(&m, (const double[3]){-2, 2, 2}, (const double[3]){1, 0, 0.01}, 70);
        for (crosser_kind kind = CROSSER_FLOOD; kind <= CROSSER_MIXED; kind++) {
            flow_result r;
            maze_run(&m, &c, kind, &r);
            assert_non_null(maze_find(&r, t));
            expect_seen(&m, &c, &r, 4000);
        }
        maze_close(&m);
    }
}

// The eye sees t through a closet's window only; the wide door beside it leads into the same zone, but t lies before it.
static void a_crosser_that_leaves_out_the_portals_own_plane_loses_nothing(void **state)
{
    (void)state;
    for (int i = 0; i < 2 * 3; i++) {
        maze m;
        maze_begin(&m, &POSE_NONE);
        const uint32_t x = maze_box(&m, (const double[3]){-4, 0, 0}, (const double[3]){0, 4, 4}, SCENE_NONE);
        const uint32_t y = maze_box(&m, (const double[3]){0, 0, 0}, (const double[3]){10, 4, 4}, SCENE_NONE);
        const uint32_t v = maze_box(&m, (const double[3]){4, 0, 2}, (const double[3]){5, 4, 4}, y);
        const maze_part parts[3] = {{{10, 0, 0}, {14, 4, 4}}, {{5, 0, 2}, {8, 4, 4}}, {{5, 4, 2}, {14, 5, 4}}};
        const uint32_t z = maze_union(&m, parts, 3, SCENE_NONE), t = maze_box(&m, (const double[3]){8, 0, 2}, (const double[3]){9.5, 4, 4}, y);
        (void)maze_opening(&m, x, y, &(opening){0, 0, {0.5, 0.5}, {3.5, 3.5}});
        for (int k = 0; k < 2; k++) {
            if (k == i % 2) (void)maze_opening(&m, y, z, &(opening){0, 10, {0.1, 0.1}, {3.9, 3.9}});
            else (void)maze_opening(&m, y, v, &(opening){0, 4, {1.2, 2.2}, {2.8, 2.8}});
        }
        (void)maze_opening(&m, v, z, &(opening){0, 5, {1.2, 2.2}, {2.8, 2.8}});
        (void)maze_opening(&m, z, t, &(opening){0, 8, {0.2, 2.2}, {3.8, 3.8}});
        maze_end(&m);
        const camera c = maze_camera(&m, (const double[3]){-2, 2, 2}, (const double[3]){1, 0, 0.01}, 70);
        flow_result r;
        quiet_run(&m, &c, &(quiet){.kind = (silence)(i / 2), .seed = 3}, &r);
        assert_non_null(maze_find(&r, t));
        maze_close(&m);
    }
}

static void a_crosser_that_writes_only_some_planes_loses_nothing(void **state)
{
    (void)state;
    uint64_t seed = 91;
    for (uint32_t i = 0; i < 9; i++) {
        maze m;
        const uint32_t recipe = i % 3;
        if (recipe == 0) maze_grid(&m, &(grid_recipe){.wide = 4, .deep = 4, .doors = DOORS_RANDOM, .seed = random_bits(&seed), .pose = POSE_NONE});
        else if (recipe == 1) maze_village(&m, random_bits(&seed), &POSE_NONE);
        else maze_nested(&m, random_bits(&seed), &POSE_NONE);
        for (uint32_t k = 0; k < 30; k++) {
            const double eye[3] = {random_between(&seed, 0.1, 15.9), random_between(&seed, 0.1, 2.9), random_between(&seed, 0.1, 15.9)};
            const camera c = maze_camera(&m, eye, (const double[3]){random_between(&seed, -1, 1), 0.1, random_between(&seed, -1, 1) + 0.001}, 75);
            for (silence kind = SILENT_OF_ITS_OWN; kind <= SILENT_OF_ALL; kind++) {
                flow_result r;
                quiet_run(&m, &c, &(quiet){.kind = kind, .seed = seed}, &r);
                expect_seen(&m, &c, &r, 150);
            }
        }
        maze_close(&m);
    }
}

// The closet's door stands through the bent portal, and rises behind its plane by less than the bend.
static void a_portal_that_only_reaches_into_the_bend_of_another_is_crossed(void **state)
{
    (void)state;
    maze m;
    maze_begin(&m, &POSE_NONE);
    const uint32_t a = maze_box(&m, (const double[3]){0, 0, 0}, (const double[3]){4, 3, 4}, SCENE_NONE);
    const uint32_t b = maze_box(&m, (const double[3]){3, 0, 0}, (const double[3]){8, 3, 4}, SCENE_NONE);
    const uint32_t closet = maze_box(&m, (const double[3]){3, 0, 1}, (const double[3]){4.001, 3, 2}, b);
    const double bent[4][3] = {{4.002, 0, 0}, {3.998, 3, 0}, {4.002, 3, 4}, {3.998, 0, 4}};
    (void)maze_portal(&m, a, b, bent, 4);
    (void)maze_opening(&m, b, closet, &(opening){2, 1, {3, 0}, {4.001, 3}});
    maze_end(&m);
    const camera c = maze_camera(&m, (const double[3]){0.5, 1.5, 0.25}, (const double[3]){1, 0, 0.3}, 70);
    for (silence kind = SILENT_OF_ITS_OWN; kind <= SILENT_OF_ALL; kind++) {
        flow_result r;
        quiet_run(&m, &c, &(quiet){.kind = kind, .seed = 3}, &r);
        assert_non_null(maze_find(&r, closet));
    }
    maze_close(&m);
}

// ---- Near to far, and many portals ----

static void a_zone_reached_again_by_a_nearer_way_brings_those_behind_it_nearer(void **state)
{
    (void)state;
    for (int swap = 0; swap < 2; swap++) {
        maze m;
        maze_begin(&m, &POSE_NONE);
        const uint32_t x = maze_box(&m, (const double[3]){0, 0, 0}, (const double[3]){4, 3, 20}, SCENE_NONE);
        const uint32_t t = maze_box(&m, (const double[3]){4, 0, 10}, (const double[3]){8, 3, 20}, SCENE_NONE);
        const uint32_t between = maze_box(&m, (const double[3]){4, 0, 0}, (const double[3]){8, 3, 10}, SCENE_NONE);
        const uint32_t last = maze_box(&m, (const double[3]){8, 0, 0}, (const double[3]){12, 3, 20}, SCENE_NONE);
        const opening doors[2] = {{0, 4, {0.5, 18}, {2.5, 19}}, {0, 4, {0.5, 6}, {2.5, 7}}};
        for (int i = 0; i < 2; i++) (void)maze_opening(&m, x, (i ^ swap) ? between : t, &doors[i ^ swap]);
        (void)maze_opening(&m, between, t, &(opening){2, 10, {5, 0.5}, {7, 2.5}});
        (void)maze_opening(&m, t, last, &(opening){0, 8, {0.5, 10.5}, {2.5, 11.5}});
        maze_end(&m);
        const camera c = maze_camera(&m, (const double[3]){3, 1.5, 5}, (const double[3]){1, 0, 0.4}, 120);
        flow_result r;
        maze_run(&m, &c, CROSSER_FLOOD, &r);
        assert_int_equal(r.zone_count, 4);
        assert_int_equal(r.zones[2].zone, t);
        assert_int_equal(r.zones[3].zone, last);
        assert_true(fabs(r.zones[2].distance - sqrt(4 + 25)) < 1e-9);
        assert_true(fabs(r.zones[3].distance - sqrt(25 + 5.5 * 5.5)) < 1e-9);
        maze_close(&m);
    }
}

// 49 houses with four openings each, about one outdoors.
static void town(maze *m)
{
    maze_begin(m, &POSE_NONE);
    const uint32_t outdoors = maze_everywhere(m);
    for (uint32_t i = 0; i < 49; i++) {
        const double x = 10.0 * (i % 7), z = 10.0 * (i / 7);
        const uint32_t house = maze_box(m, (const double[3]){x, 0, z}, (const double[3]){x + 6, 3, z + 6}, SCENE_NONE);
        for (int k = 0; k < 4; k++) (void)maze_opening(m, house, outdoors, &(opening){0, x + 6 * (k % 2), {0.5, z + 1 + 2 * (k / 2)}, {2.5, z + 2 + 2 * (k / 2)}});
    }
    maze_end(m);
}

static void a_zone_of_many_portals_passes_over_those_alone_that_no_volume_reaches(void **state)
{
    (void)state;
    maze m;
    uint64_t seed = 4;
    town(&m);
    assert_int_equal(m.flow->tree_count, 1);
    for (uint32_t i = 0; i < 200; i++) {
        const double eye[3] = {random_between(&seed, -5, 70), random_between(&seed, 0.1, 2.9), random_between(&seed, -5, 70)};
        const camera c = maze_camera(&m, eye, (const double[3]){random_between(&seed, -1, 1), 0.1, random_between(&seed, -1, 1) + 0.001}, 60);
        for (crosser_kind kind = CROSSER_FLOOD; kind <= CROSSER_MIXED; kind++) {
            uint32_t tree = SCENE_NONE, zones[2], tried[2], reached[2][64];
            for (int k = 0; k < 2; k++) { // with the tree, then trying all
                flow_result r;
                if (k) tree = m.flow->tree_of[0], m.flow->tree_of[0] = SCENE_NONE;
                maze_run(&m, &c, kind, &r);
                if (k) m.flow->tree_of[0] = tree;
                if (!k && i % 8 == 0) expect_seen(&m, &c, &r, 100);
                zones[k] = r.zone_count;
                tried[k] = r.crossings;
                for (uint32_t z = 0; z < 50; z++) reached[k][z] = maze_find(&r, z) != NULL;
            }
            assert_int_equal(zones[0], zones[1]);
            assert_memory_equal(reached[0], reached[1], 50 * sizeof reached[0][0]);
            assert_true(tried[0] <= tried[1]);
        }
    }
    maze_close(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_eye_between_a_portal_and_its_houses_border_sees_what_is_outside),
        cmocka_unit_test(what_stands_between_a_portal_and_its_houses_border_is_on_both_sides),
        cmocka_unit_test(what_stands_between_a_room_and_its_portal_in_the_next_room_is_on_both_sides),
        cmocka_unit_test(a_zone_that_only_the_second_of_two_doors_of_a_flooding_house_shows_is_reached),
        cmocka_unit_test(zones_of_several_hulls_hide_nothing_around_a_corner),
        cmocka_unit_test(a_crosser_that_leaves_out_the_portals_own_plane_loses_nothing),
        cmocka_unit_test(a_crosser_that_writes_only_some_planes_loses_nothing),
        cmocka_unit_test(a_portal_that_only_reaches_into_the_bend_of_another_is_crossed),
        cmocka_unit_test(a_zone_reached_again_by_a_nearer_way_brings_those_behind_it_nearer),
        cmocka_unit_test(a_zone_of_many_portals_passes_over_those_alone_that_no_volume_reaches),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
