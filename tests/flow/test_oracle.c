// The oracle's teeth: a flow that is broken on purpose must be found out.
// SPDX-License-Identifier: MIT
#include "tests/flow/fixture.h"
#include "tests/flow/oracle.h"

#include "tests/common/random.h"
#include "tests/common/test.h"

#include <stdlib.h>
#include <string.h>

typedef enum fault { FAULT_NONE, FAULT_PORTAL, FAULT_ZONE, FAULT_PLANE, FAULT_RECTANGLE, FAULT_VOLUME } fault;

typedef struct broken { // a result that may be changed
    flow_zone zones[64];
    flow_volume volumes[256];
    uint32_t by_zone[256];
    cull_plane planes[256][CULL_MAX_PLANES];
    flow_result result;
} broken;

static void copy(const flow_result *r, broken *out)
{
    assert_true(r->zone_count <= 64 && r->volume_count <= 256);
    memcpy(out->zones, r->zones, r->zone_count * sizeof out->zones[0]);
    memcpy(out->volumes, r->volumes, r->volume_count * sizeof out->volumes[0]);
    memcpy(out->by_zone, r->by_zone, r->volume_count * sizeof out->by_zone[0]);
    for (uint32_t i = 0; i < r->volume_count; i++) {
        memcpy(out->planes[i], r->volumes[i].volume.planes, r->volumes[i].volume.plane_count * sizeof(cull_plane));
        out->volumes[i].volume.planes = out->planes[i];
    }
    out->result = *r;
    out->result.zones = out->zones;
    out->result.volumes = out->volumes;
    out->result.by_zone = out->by_zone;
}

static void break_it(broken *b, fault f, double by_m)
{
    const flow_zone *last = &b->zones[b->result.zone_count - 1];
    if (f == FAULT_ZONE) b->result.zone_count--;
    if (f == FAULT_VOLUME) b->zones[b->result.zone_count - 1].count--;
    for (uint32_t i = last->first; i < last->first + last->count; i++) {
        if (f == FAULT_PLANE) b->planes[i][0].offset -= (float)by_m;
        if (f == FAULT_RECTANGLE) b->volumes[i].rectangle[2] -= (float)by_m / 4;
    }
}

// Views of 200 in which the oracle finds something missed.
static uint32_t views_found_out(fault f, double by_m)
{
    static broken b; // large; written anew in each view
    uint64_t seed = 31;
    uint32_t found = 0;
    maze m;
    maze_grid(&m, &(grid_recipe){.wide = 4, .deep = 4, .doors = DOORS_RANDOM, .seed = 5, .pose = POSE_NONE});
    for (uint32_t i = 0; i < 200; i++) {
        const double eye[3] = {random_between(&seed, 0.1, 15.9), 1.5, random_between(&seed, 0.1, 15.9)};
        const camera c = maze_camera(&m, eye, (const double[3]){random_between(&seed, -1, 1), 0.1, random_between(&seed, -1, 1)}, 75);
        flow_result r;
        if (f == FAULT_PORTAL) m.open[i % m.scene->portal_count] = 0;
        maze_run(&m, &c, CROSSER_NARROW, &r);
        if (f == FAULT_PORTAL) m.open[i % m.scene->portal_count] = 1;
        copy(&r, &b);
        break_it(&b, f, by_m);
        found += oracle_ask(&(oracle_request){m.scene, m.open, &c, &b.result, 1000, i}).missed > 0;
    }
    maze_close(&m);
    return found;
}

static void a_sound_flow_is_never_accused(void **state)
{
    (void)state;
    assert_int_equal(views_found_out(FAULT_NONE, 0), 0);
}

static void a_portal_that_is_not_crossed_is_found_out(void **state)
{
    (void)state;
    assert_in_range(views_found_out(FAULT_PORTAL, 0), 10, 200); // most portals of a view are not in it
}

static void a_zone_that_is_left_out_is_found_out(void **state)
{
    (void)state;
    assert_in_range(views_found_out(FAULT_ZONE, 0), 120, 200);
}

static void a_volume_that_is_left_out_is_found_out(void **state)
{
    (void)state;
    assert_in_range(views_found_out(FAULT_VOLUME, 0), 120, 200);
}

static void a_plane_that_stands_two_millimetres_too_far_in_is_found_out(void **state)
{
    (void)state;
    assert_in_range(views_found_out(FAULT_PLANE, 0.002), 60, 200);
}

static void a_rectangle_that_is_too_small_is_found_out(void **state)
{
    (void)state;
    assert_in_range(views_found_out(FAULT_RECTANGLE, 0.1), 60, 200);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_sound_flow_is_never_accused),
        cmocka_unit_test(a_portal_that_is_not_crossed_is_found_out),
        cmocka_unit_test(a_zone_that_is_left_out_is_found_out),
        cmocka_unit_test(a_volume_that_is_left_out_is_found_out),
        cmocka_unit_test(a_plane_that_stands_two_millimetres_too_far_in_is_found_out),
        cmocka_unit_test(a_rectangle_that_is_too_small_is_found_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
