// Limits of the flow: merges, bad crossers, memory, long paths, and planes that are carried from zone to zone.
// SPDX-License-Identifier: MIT
#include "tests/flow/fixture.h"
#include "tests/flow/oracle.h"

#include "host/core/flow_internal.h"
#include "tests/common/random.h"
#include "tests/common/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void expect_seen(maze *m, const camera *c, const flow_result *r, uint32_t rays)
{
    const oracle_answer a = oracle_ask(&(oracle_request){m->scene, m->open, c, r, rays, 78});
    if (a.missed > 0) fail_msg("%llu points missed, first in zone %u", (unsigned long long)a.missed, a.zone);
    assert_true(a.points > 0);
}

// ---- Merging ----

static void an_open_grid_of_1024_rooms_ends_soon_and_counts_its_merges(void **state)
{
    (void)state;
    maze m;
    maze_grid(&m, &(grid_recipe){.wide = 32, .deep = 32, .doors = DOORS_WHOLE_FACE, .seed = 1, .pose = POSE_NONE});
    const double eyes[3][3] = {{0.25, 1.5, 0.25}, {65.9, 1.5, 65.7}, {64, 1, 64}}, along[3][3] = {{1, 0, 0.8}, {1, 0, 0.8}, {-1, 0, 0.9}};
    for (int i = 0; i < 3; i++) {
        const camera c = maze_camera(&m, eyes[i], along[i], 75);
        for (crosser_kind kind = CROSSER_NARROW; kind <= CROSSER_MIXED; kind++) {
            flow_result r;
            maze_run(&m, &c, kind, &r);
            // Work of every zone: its own volumes, its rectangle in all its sizes, the whole picture; four portals each.
            assert_true(r.crossings <= 4 * (FLOW_CROSSINGS + 1024 * (FLOW_GROWTHS + 3)));
            assert_true(r.volume_count <= FLOW_CROSSINGS + 2 * 1024);
            if (i == 0) assert_true(r.portal_merges > 100);
            for (uint32_t k = 0; k < r.zone_count; k++) assert_in_range(r.zones[k].count, 1, FLOW_ZONE_VOLUMES);
            expect_seen(&m, &c, &r, 400);
        }
    }
    maze_close(&m);
}

// One room, then a second behind slits, then a third behind a door.
static void slits(maze *m, uint32_t count)
{
    maze_begin(m, &POSE_NONE);
    (void)maze_box(m, (const double[3]){0, 0, 0}, (const double[3]){4, 3, 24}, SCENE_NONE);
    (void)maze_box(m, (const double[3]){4, 0, 0}, (const double[3]){8, 3, 24}, SCENE_NONE);
    (void)maze_box(m, (const double[3]){8, 0, 0}, (const double[3]){12, 3, 24}, SCENE_NONE);
    for (uint32_t i = 0; i < count; i++) (void)maze_opening(m, 0, 1, &(opening){0, 4, {0.5, 7 + 0.25 * i}, {2.5, 7.125 + 0.25 * i}});
    (void)maze_opening(m, 1, 2, &(opening){0, 8, {0.5, 2}, {2.5, 22}});
    maze_end(m);
}

static void the_seventeenth_volume_of_a_zone_merges_them_and_the_zone_behind_sees_it(void **state)
{
    (void)state;
    for (uint32_t count = 15; count <= 40; count += count == 17 ? 23 : 1) {
        maze m;
        slits(&m, count);
        const camera c = maze_camera(&m, (const double[3]){0.5, 1.5, 12}, (const double[3]){1, 0, 0}, 100);
        flow_result r;
        maze_run(&m, &c, CROSSER_NARROW, &r);
        const flow_zone *second = maze_find(&r, 1);
        if (count <= FLOW_ZONE_VOLUMES) {
            assert_int_equal(r.portal_merges, 0);
            assert_int_equal(second->count, count);
        } else {
            assert_true(r.portal_merges > FLOW_ZONE_VOLUMES); // all gave way
            assert_int_equal(second->count, 1);
            const flow_volume *v = &r.volumes[r.by_zone[second->first]];
            assert_int_equal(v->way, SCENE_NONE);
            assert_int_equal(v->parent, SCENE_NONE);
        }
        for (uint32_t i = 0; i < r.volume_count; i++) assert_int_equal(r.volumes[i].is_merged, r.volumes[i].zone == 1 && count > FLOW_ZONE_VOLUMES);
        assert_non_null(maze_find(&r, 2));
        expect_seen(&m, &c, &r, 2000);
        maze_close(&m);
    }
}

// ---- Crossers that cannot be trusted ----

typedef enum lie { LIE_MANY, LIE_NAN, LIE_LONG, LIE_CODE, LIE_NONE, LIE_PADDED } lie;
typedef struct liar { maze *m; lie lie; } liar;

static cull_crossing lies(void *user, uint32_t zone, const cull_view *view, const cull_volume *in, uint32_t portal, cull_plane *planes, uint32_t *count)
{
    const liar *l = user;
    const flow_crosser honest = maze_crosser(l->m, CROSSER_NARROW);
    const cull_crossing answer = honest.cross(honest.user, zone, view, in, portal, planes, count);
    if (answer != CULL_CROSS_NARROW) return answer;
    switch (l->lie) {
    case LIE_MANY: *count = CULL_MAX_PLANES + 1; break;
    case LIE_NAN: planes[0].offset = NAN; break;
    case LIE_LONG: planes[0].normal.x = 2; break;
    case LIE_CODE: return 17;
    case LIE_NONE: return CULL_CROSS_NONE;
    case LIE_PADDED:
        while (*count < CULL_MAX_PLANES) planes[(*count)++] = planes[0];
        break;
    }
    return answer;
}

static void a_crosser_that_writes_nonsense_does_not_narrow_and_is_counted(void **state)
{
    (void)state;
    maze m;
    maze_grid(&m, &(grid_recipe){.wide = 5, .deep = 1, .doors = DOORS_NARROW, .seed = 1, .pose = POSE_NONE});
    const camera c = maze_camera(&m, (const double[3]){1, 1, 2}, (const double[3]){1, 0, 0}, 60);
    for (lie lie = LIE_MANY; lie <= LIE_NONE; lie++) {
        liar l = {&m, lie};
        const flow_request q = {.camera = &c, .frame = {320, 240, 0, 0, CULL_VIEW_MAIN}, .open = m.open, .crosser = {&l, lies, NULL, NULL}};
        flow_result r;
        flow_run(m.flow, &q, &r);
        if (lie == LIE_NONE) {
            assert_int_equal(r.zone_count, 1);
            assert_int_equal(flow_fate_of(m.flow, &q, 0), FLOW_OUTSIDE);
        } else {
            assert_int_equal(r.zone_count, 5);
            assert_int_equal(r.limits_hit, 4);
            expect_seen(&m, &c, &r, 200);
        }
    }
    maze_close(&m);
}

static void where_the_room_for_planes_runs_out_volumes_merge_and_it_is_counted(void **state)
{
    (void)state;
    maze m;
    maze_grid(&m, &(grid_recipe){.wide = 20, .deep = 20, .doors = DOORS_WHOLE_FACE, .seed = 1, .pose = POSE_NONE});
    const camera c = maze_camera(&m, (const double[3]){0.5, 1, 0.5}, (const double[3]){1, 0, 1}, 90);
    liar l = {&m, LIE_PADDED};
    const flow_request q = {.camera = &c, .frame = {320, 240, 0, 0, CULL_VIEW_MAIN}, .open = m.open, .crosser = {&l, lies, NULL, NULL}};
    flow_result r;
    flow_run(m.flow, &q, &r);
    assert_true(r.limits_hit > 0);
    assert_true(r.portal_merges > 0);
    expect_seen(&m, &c, &r, 1000);
    maze_close(&m);
}

// ---- Long paths, memory ----

static void a_row_of_3000_rooms_is_walked_without_recursion(void **state)
{
    (void)state;
    maze m;
    maze_grid(&m, &(grid_recipe){.wide = 3000, .deep = 1, .doors = DOORS_NARROW, .seed = 1, .pose = POSE_NONE});
    const camera c = maze_camera(&m, (const double[3]){0.5, 1, 2}, (const double[3]){1, 0, 0}, 60);
    for (crosser_kind kind = CROSSER_FLOOD; kind <= CROSSER_MIXED; kind++) {
        flow_result r;
        maze_run(&m, &c, kind, &r);
        assert_int_equal(r.zone_count, 3000);
        for (uint32_t i = 0; i < 3000; i++) assert_int_equal(r.zones[i].zone, i);
    }
    maze_close(&m);
}

static void opening_survives_every_allocation_that_fails(void **state)
{
    (void)state;
    maze m;
    maze_grid(&m, &(grid_recipe){.wide = 12, .deep = 12, .doors = DOORS_NARROW, .seed = 1, .pose = POSE_NONE});
    failing_allocator a;
    for (uint64_t k = 1;; k++) {
        assert_true(k < 100);
        flow *f = NULL;
        failing_allocator_init(&a, k);
        const result done = flow_open(&(flow_open_request){m.scene, m.graph, m.zones}, &a.memory, &f);
        if (done == RESULT_OK) {
            assert_int_equal(a.failures, 0);
            assert_true(k > 2);
            flow_close(f);
            assert_true(failing_allocator_is_clean(&a));
            break;
        }
        assert_int_equal(done, RESULT_NO_MEMORY);
        assert_null(f);
        assert_true(failing_allocator_is_clean(&a));
    }
    flow_close(NULL);
    maze_close(&m);
}

static void a_run_allocates_nothing_and_gives_the_same_bits_again(void **state)
{
    (void)state;
    maze m;
    maze_grid(&m, &(grid_recipe){.wide = 12, .deep = 12, .doors = DOORS_WHOLE_FACE, .seed = 1, .pose = POSE_NONE});
    const camera one = maze_camera(&m, (const double[3]){0.5, 1, 0.5}, (const double[3]){1, 0, 1}, 90);
    const camera other = maze_camera(&m, (const double[3]){30.5, 1, 20.5}, (const double[3]){-1, 0, 0.3}, 60);
    flow_result r;
    maze_run(&m, &one, CROSSER_NARROW, &r);
    flow_volume *volumes = malloc(r.volume_count * sizeof *volumes);
    cull_plane(*planes)[CULL_MAX_PLANES] = calloc(r.volume_count, sizeof *planes);
    assert_non_null(volumes);
    assert_non_null(planes);
    memcpy(volumes, r.volumes, r.volume_count * sizeof *volumes);
    for (uint32_t i = 0; i < r.volume_count; i++) memcpy(planes[i], volumes[i].volume.planes, volumes[i].volume.plane_count * sizeof planes[i][0]);
    const uint32_t count = r.volume_count;
    const uint64_t calls = m.memory.calls;
    maze_run(&m, &other, CROSSER_MIXED, &r);
    maze_run(&m, &one, CROSSER_NARROW, &r);
    assert_int_equal(m.memory.calls, calls);
    assert_int_equal(r.volume_count, count);
    assert_memory_equal(r.volumes, volumes, count * sizeof *volumes);
    for (uint32_t i = 0; i < count; i++) assert_memory_equal(r.volumes[i].volume.planes, planes[i], volumes[i].volume.plane_count * sizeof planes[i][0]);
    free(planes);
    free(volumes);
    maze_close(&m);
}

// ---- Planes from zone to zone ----

// Points of a zone as floats, just inside a plane that was made for another zone, in double; then the plane in float.
static void a_plane_carried_to_another_zone_keeps_every_point_that_the_exact_one_has(void **state)
{
    (void)state;
    uint64_t seed = 41, inside = 0, close_by = 0;
    maze m;
    const pose p = pose_random(&seed, 3000);
    maze_grid(&m, &(grid_recipe){.wide = 40, .deep = 3, .doors = DOORS_NARROW, .seed = 1, .pose = p});
    for (uint32_t i = 0; i < 200000; i++) {
        const uint32_t from = random_below(&seed, 120), to = random_below(&seed, 120);
        const double *a = m.scene->zones[from].origin, *b = m.scene->zones[to].origin;
        const float radius = m.zones[to].zone.radius;
        double normal[3], at[3], offset = 0, exact = 0;
        float q[3];
        random_direction(&seed, normal);
        for (int k = 0; k < 3; k++) {
            q[k] = (float)random_between(&seed, (double)-radius, (double)radius);
            at[k] = (double)q[k] + (b[k] - a[k]); // relative to `from`, exact: whole metres and floats of few bits more
            offset -= normal[k] * at[k];
        }
        offset += random_between(&seed, 0, 1e-12);
        for (int k = 0; k < 3; k++) exact += normal[k] * at[k];
        if (exact + offset < 0) continue;
        const flow_record r = {cull_plane_outward(normal, offset, (double)m.zones[from].zone.radius), from};
        cull_plane moved;
        flow_planes_in(m.flow, to, &r, 1, &moved);
        const cull_vec3 point = {q[0], q[1], q[2]};
        assert_true(cull_plane_height(moved, point) >= 0);
        inside++;
        // And no more slack than the two zones' rounding and that of the way between them.
        const double way = fabs(b[0] - a[0]) + fabs(b[1] - a[1]) + fabs(b[2] - a[2]);
        close_by += (double)cull_plane_height(moved, point) < (12 * ((double)radius + (double)m.zones[from].zone.radius) + 4 * way) / 16777216;
        if (from == to) assert_memory_equal(&moved, &r.plane, sizeof moved);
    }
    assert_true(inside > 100000);
    assert_int_equal(close_by, inside);
    maze_close(&m);
}

// Looking down a row of rooms, the picture's sides pass through all of them: made anew in each, not carried.
static void slack_does_not_pile_up_along_a_path(void **state)
{
    (void)state;
    maze m;
    maze_grid(&m, &(grid_recipe){.wide = 200, .deep = 1, .doors = DOORS_NARROW, .seed = 1, .pose = POSE_NONE});
    const double eye[3] = {1, 1, 2};
    const camera c = maze_camera(&m, eye, (const double[3]){1, 0, 0}, 60);
    flow_result r;
    maze_run(&m, &c, CROSSER_NARROW, &r);
    const flow_zone *last = maze_find(&r, 199);
    assert_int_equal(last->count, 1);
    assert_true(m.scene->zones[199].origin[0] > m.scene->zones[0].origin[0] + 700); // each zone has its own
    const flow_volume *v = &r.volumes[r.by_zone[last->first]];
    const double *origin = m.scene->zones[199].origin;
    uint32_t through_eye = 0;
    for (uint32_t i = 0; i < v->volume.plane_count; i++) {
        const cull_plane p = v->volume.planes[i];
        const double height = (double)p.normal.x * (eye[0] - origin[0]) + (double)p.normal.y * (eye[1] - origin[1]) +
                              (double)p.normal.z * (eye[2] - origin[2]) + (double)p.offset;
        if (height < 0) continue; // the portal's own
        through_eye++;
        assert_true(height <= 3 * 800.0 * 8 / 16777216); // one carrying over 800 m
    }
    assert_true(through_eye >= 4);
    maze_close(&m);
}

static void a_side_of_the_picture_that_still_bounds_a_volume_far_along_is_the_cameras_own_bit_for_bit(void **state)
{
    (void)state;
    maze m;
    maze_grid(&m, &(grid_recipe){.wide = 25, .deep = 1, .doors = DOORS_WHOLE_FACE, .seed = 1, .pose = POSE_NONE});
    const camera c = maze_camera(&m, (const double[3]){1, 1.5, 2}, (const double[3]){1, 0, 0}, 1);
    flow_result r;
    maze_run(&m, &c, CROSSER_NARROW, &r);
    for (uint32_t z = 1; z < 25; z++) {
        const flow_zone *found = maze_find(&r, z);
        assert_non_null(found);
        assert_int_equal(found->count, 1);
        const cull_volume *v = &r.volumes[r.by_zone[found->first]].volume;
        view_volume whole;
        cull_view view;
        view_derive(&c, &(view_frame){320, 240, 0, 0, CULL_VIEW_MAIN}, m.scene->zones[z].origin, &m.zones[z].zone.box, &view, &whole);
        uint32_t same = 0;
        for (uint32_t i = 0; i < whole.plane_count; i++)
            for (uint32_t k = 0; k < v->plane_count; k++) same += memcmp(&whole.planes[i], &v->planes[k], sizeof whole.planes[0]) == 0;
        assert_int_equal(whole.plane_count, 4);
        assert_int_equal(same, 4);
    }
    maze_close(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_open_grid_of_1024_rooms_ends_soon_and_counts_its_merges),
        cmocka_unit_test(the_seventeenth_volume_of_a_zone_merges_them_and_the_zone_behind_sees_it),
        cmocka_unit_test(a_crosser_that_writes_nonsense_does_not_narrow_and_is_counted),
        cmocka_unit_test(where_the_room_for_planes_runs_out_volumes_merge_and_it_is_counted),
        cmocka_unit_test(a_row_of_3000_rooms_is_walked_without_recursion),
        cmocka_unit_test(opening_survives_every_allocation_that_fails),
        cmocka_unit_test(a_run_allocates_nothing_and_gives_the_same_bits_again),
        cmocka_unit_test(a_plane_carried_to_another_zone_keeps_every_point_that_the_exact_one_has),
        cmocka_unit_test(a_side_of_the_picture_that_still_bounds_a_volume_far_along_is_the_cameras_own_bit_for_bit),
        cmocka_unit_test(slack_does_not_pile_up_along_a_path),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
