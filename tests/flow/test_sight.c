// What a straight line from the eye reaches, the flow reaches: random scenes and eyes, every crosser, and the oracle's teeth.
// SPDX-License-Identifier: MIT
#include "tests/flow/fixture.h"
#include "tests/flow/oracle.h"

#include "tests/common/random.h"
#include "tests/common/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct totals { uint64_t points, behind; } totals;

typedef struct looks {
    double low[3], high[3]; // eyes, in the maze's own frame
    uint32_t count, rays;
    uint64_t seed;
} looks;

static void expect_all_seen(maze *m, const camera *c, crosser_kind kind, const looks *l, totals *sum)
{
    flow_result r;
    maze_run(m, c, kind, &r);
    const oracle_answer a = oracle_ask(&(oracle_request){m->scene, m->open, c, &r, l->rays, l->seed});
    if (a.missed > 0)
        fail_msg("crosser %d, eye %.17g %.17g %.17g: %llu of %llu points missed, first in zone %u behind %u portals at %g %g %g", kind, c->eye[0],
                 c->eye[1], c->eye[2], (unsigned long long)a.missed, (unsigned long long)a.points, a.zone, a.portals, a.at[0], a.at[1], a.at[2]);
    sum->points += a.points;
    sum->behind += a.behind;
}

static camera look_around(const maze *m, const looks *l, uint64_t *seed)
{
    double eye[3], forward[3];
    for (int i = 0; i < 3; i++) {
        eye[i] = random_between(seed, l->low[i], l->high[i]);
        forward[i] = random_between(seed, -1, 1) * (i == 1 ? 0.3 : 1);
    }
    forward[0] += forward[0] < 0 ? -0.01 : 0.01;
    camera c = maze_camera(m, eye, forward, random_between(seed, 30, 100));
    if (random_below(seed, 3) == 0) c.far_m = random_between(seed, 2, 20);
    return c;
}

static totals expect_looks(maze *m, const looks *l)
{
    totals sum = {0, 0};
    uint64_t seed = l->seed;
    for (uint32_t i = 0; i < l->count; i++) {
        const camera c = look_around(m, l, &seed);
        for (crosser_kind kind = CROSSER_FLOOD; kind <= CROSSER_BY_ENTRY; kind++) expect_all_seen(m, &c, kind, l, &sum);
    }
    return sum;
}

static void grids_hide_nothing(door_width doors, double far_m)
{
    uint64_t seed = 11 + (uint64_t)doors;
    totals sum = {0, 0};
    for (uint32_t i = 0; i < 12; i++) {
        maze m;
        const pose p = i % 2 ? pose_random(&seed, far_m) : POSE_NONE;
        maze_grid(&m, &(grid_recipe){.wide = 2 + i % 5, .deep = 1 + i % 4, .doors = doors, .seed = random_bits(&seed), .pose = p});
        const looks l = {{0.01, 0.01, 0.01}, {4.0 * (2 + i % 5) - 0.01, 2.99, 4.0 * (1 + i % 4) - 0.01}, 30, 120, random_bits(&seed)};
        const totals t = expect_looks(&m, &l);
        sum.points += t.points;
        sum.behind += t.behind;
        maze_close(&m);
    }
    assert_true(sum.behind > 1000);
}

static void every_point_that_a_ray_reaches_through_doors_of_rooms_is_in_a_volume(void **state)
{
    (void)state;
    grids_hide_nothing(DOORS_RANDOM, 1000);
}

static void every_point_is_in_a_volume_where_whole_faces_are_portals_that_meet_at_edges(void **state)
{
    (void)state;
    grids_hide_nothing(DOORS_WHOLE_FACE, 1000);
}

static void every_point_is_in_a_volume_a_hundred_kilometres_from_the_origin(void **state)
{
    (void)state;
    grids_hide_nothing(DOORS_RANDOM, 100000);
}

static void every_point_is_in_a_volume_through_sloped_portals_of_five_corners(void **state)
{
    (void)state;
    uint64_t seed = 5;
    totals sum = {0, 0};
    for (uint32_t i = 0; i < 8; i++) {
        maze m;
        const pose p = i % 2 ? pose_random(&seed, 500) : POSE_NONE;
        maze_wedges(&m, &p);
        const totals t = expect_looks(&m, &(looks){{0.5, -1.9, -1.9}, {23.5, 1.9, 1.9}, 40, 200, random_bits(&seed)});
        sum.behind += t.behind;
        maze_close(&m);
    }
    assert_true(sum.behind > 1000);
}

static void every_point_is_in_a_volume_from_house_to_house_across_the_open_ground(void **state)
{
    (void)state;
    uint64_t seed = 6;
    totals sum = {0, 0};
    for (uint32_t i = 0; i < 8; i++) {
        maze m;
        const pose p = i % 2 ? pose_random(&seed, 2000) : POSE_NONE;
        maze_village(&m, random_bits(&seed), &p);
        const totals t = expect_looks(&m, &(looks){{-3, 0.1, -3}, {44, 2.9, 18}, 40, 200, random_bits(&seed)});
        sum.behind += t.behind;
        maze_close(&m);
    }
    assert_true(sum.behind > 1000);
}

static void every_point_is_in_a_volume_in_a_closet_in_a_house_in_a_hall(void **state)
{
    (void)state;
    uint64_t seed = 7;
    totals sum = {0, 0};
    for (uint32_t i = 0; i < 8; i++) {
        maze m;
        const pose p = i % 2 ? pose_random(&seed, 300) : POSE_NONE;
        maze_nested(&m, random_bits(&seed), &p);
        const totals t = expect_looks(&m, &(looks){{0.1, 0.1, 0.1}, {15.9, 7.9, 15.9}, 40, 200, random_bits(&seed)});
        sum.behind += t.behind;
        maze_close(&m);
    }
    assert_true(sum.behind > 1000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_point_that_a_ray_reaches_through_doors_of_rooms_is_in_a_volume),
        cmocka_unit_test(every_point_is_in_a_volume_where_whole_faces_are_portals_that_meet_at_edges),
        cmocka_unit_test(every_point_is_in_a_volume_a_hundred_kilometres_from_the_origin),
        cmocka_unit_test(every_point_is_in_a_volume_through_sloped_portals_of_five_corners),
        cmocka_unit_test(every_point_is_in_a_volume_from_house_to_house_across_the_open_ground),
        cmocka_unit_test(every_point_is_in_a_volume_in_a_closet_in_a_house_in_a_hall),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
