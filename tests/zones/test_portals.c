// Tests of portals: what is refused and how it is called, and which side is which.
// SPDX-License-Identifier: MIT
#include "zone_scene.h"

#include "tests/common/random.h"
#include "tests/common/test.h"

#include <math.h>
#include <string.h>

static void put_triangle(builder_fixture *f, double size)
{
    const double at[3] = {0, 0, 0};
    builder_fixture_triangle(f, at, size);
}

// west: x 0 .. 4, east: x 4 .. 8, and the open about them; inner lies in east.
typedef struct rooms { uint32_t west, east, inner, open; } rooms;
static rooms add_rooms(builder_fixture *f)
{
    rooms r;
    assert_int_equal(add_box_zone(f->builder, "west", &(zone_box){{0, 0, 0}, {4, 4, 4}}, SCENE_NONE, &r.west), RESULT_OK);
    assert_int_equal(add_box_zone(f->builder, "east", &(zone_box){{4, 0, 0}, {8, 4, 4}}, SCENE_NONE, &r.east), RESULT_OK);
    assert_int_equal(add_box_zone(f->builder, "inner", &(zone_box){{5, 0, 1}, {7, 3, 3}}, r.east, &r.inner), RESULT_OK);
    assert_int_equal(add_everywhere(f->builder, "open", &r.open), RESULT_OK);
    return r;
}

typedef struct bad_portal {
    const double (*points)[3];
    uint32_t point_count, zones[2], door;
    const double *normal;
    const char *fault;
} bad_portal;

static void each_bad_portal_is_refused_with_its_fault(void **state)
{
    builder_fixture *f = *state;
    const rooms r = add_rooms(f);
    static const double good[4][3] = {{4, 1, 1}, {4, 2, 1}, {4, 2, 2}, {4, 1, 2}};
    static const double bent[4][3] = {{4, 1, 1}, {4.01, 2, 1}, {4, 2, 2}, {4.01, 1, 2}};
    static const double dent[5][3] = {{4, 1, 1}, {4, 2, 1}, {4, 1.2, 1.2}, {4, 2, 2}, {4, 1, 2}};
    static const double star[5][3] = {{4, 2, 1}, {4, 1.19, 1.59}, {4, 2.81, 1.59}, {4, 1.5, 0.6}, {4, 2.3, 2.5}};
    static const double line[3][3] = {{4, 1, 1}, {4, 2, 2}, {4, 3, 3}};
    static const double point[3][3] = {{4, 1, 1}, {4, 1, 1}, {4, 1, 1}};
    static const double twice[5][3] = {{4, 1, 1}, {4, 2, 1}, {4, 2, 2}, {4, 2, 2}, {4, 1, 2}};
    static const double round_twice[8][3] = {{4, 1, 1}, {4, 2, 1}, {4, 2, 2}, {4, 1, 2}, {4, 1, 1}, {4, 2, 1}, {4, 2, 2}, {4, 1, 2}};
    static const double nan[3][3] = {{4, 1, 1}, {4, NAN, 1}, {4, 2, 2}};
    static const double infinite[3][3] = {{4, 1, 1}, {4, INFINITY, 1}, {4, 2, 2}};
    static const double far[3][3] = {{4, 1, 1}, {4, 2e9, 1}, {4, 2, 2}};
    static const double in_west[4][3] = {{3.9, 1, 1}, {3.9, 2, 1}, {3.9, 2, 2}, {3.9, 1, 2}};
    static const double above[4][3] = {{4, 1, 1}, {4, 5, 1}, {4, 5, 2}, {4, 1, 2}};
    static const double across[4][3] = {{3.99, 1, 1}, {4.01, 1, 1}, {4.01, 1, 2}, {3.99, 1, 2}};
    static const double many[65][3] = {{0}};
    static const double along[3] = {0, 1, 1}, none[3] = {0, 0, 0}, wild[3] = {NAN, 1, 0};
    const uint32_t w = r.west, e = r.east;
    const bad_portal bad[] = {
        {good, 4, {w, 9}, SCENE_NONE, NULL, "joins a zone that is not there"},
        {good, 4, {w, w}, SCENE_NONE, NULL, "joins a zone to itself"},
        {good, 4, {w, e}, 0, NULL, "has a door that is not there"},
        {good, 2, {w, e}, SCENE_NONE, NULL, "has under 3 points"},
        {many, 65, {w, e}, SCENE_NONE, NULL, "has over 64 points"},
        {nan, 3, {w, e}, SCENE_NONE, NULL, "has a number that is not finite"},
        {infinite, 3, {w, e}, SCENE_NONE, NULL, "has a number that is not finite"},
        {far, 3, {w, e}, SCENE_NONE, NULL, "has a coordinate beyond 1e9 m"},
        {line, 3, {w, e}, SCENE_NONE, NULL, "has no area: its points lie on a line, or its edges cross"},
        {point, 3, {w, e}, SCENE_NONE, NULL, "has no area: its points lie on a line, or its edges cross"},
        {bent, 4, {w, e}, SCENE_NONE, NULL, "is not flat: a point lies over 1/2000 of its width off the plane of the others"},
        {dent, 5, {w, e}, SCENE_NONE, NULL, "is not convex"},
        {star, 5, {w, e}, SCENE_NONE, NULL, "is not convex"},
        {twice, 5, {w, e}, SCENE_NONE, NULL, "has a point twice"},
        {round_twice, 8, {w, e}, SCENE_NONE, NULL, "has a point twice"},
        {in_west, 4, {w, e}, SCENE_NONE, NULL, "has a point outside of its second zone, by over 1/64 of its width"},
        {in_west, 4, {e, r.open}, SCENE_NONE, NULL, "has a point outside of its first zone, by over 1/64 of its width"},
        {above, 4, {r.open, w}, SCENE_NONE, NULL, "has a point outside of its second zone, by over 1/64 of its width"},
        {across, 4, {w, e}, SCENE_NONE, NULL, "lies so that its sides cannot be told apart; give it a normal towards its first zone"},
        {good, 4, {w, e}, SCENE_NONE, along, "has a normal that lies in its plane"},
        {good, 4, {w, e}, SCENE_NONE, none, "has a normal that lies in its plane"},
        {good, 4, {w, e}, SCENE_NONE, wild, "has a normal that lies in its plane"},
    };
    uint32_t id;
    const char *fault;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i) {
        const builder_portal p = {"bad", bad[i].points, bad[i].point_count, {bad[i].zones[0], bad[i].zones[1]}, bad[i].door, bad[i].normal};
        assert_int_equal(scene_builder_portal(f->builder, &p, &id, &fault), RESULT_BAD_INPUT);
        assert_string_equal(fault, bad[i].fault);
    }
    put_triangle(f, 1);
    assert_int_equal(builder_fixture_finish(f), RESULT_OK);
    assert_int_equal(f->scene->portal_count, 0);
    assert_int_equal(f->scene->portal_point_count, 0);
}

static void a_portal_that_is_a_little_off_is_taken(void **state)
{
    builder_fixture *f = *state;
    const rooms r = add_rooms(f);
    static const double bent[4][3] = {{4, 1, 1}, {4.0005, 2, 1}, {4, 2, 2}, {4.0005, 1, 2}};            // under 1 mm
    static const double straight[5][3] = {{4, 1, 1}, {4, 1.5, 1.0005}, {4, 2, 1}, {4, 2, 2}, {4, 1, 2}}; // a dent of under 1 mm
    static const double beside[4][3] = {{4.015, 1, 1}, {4.015, 2, 1}, {4.015, 2, 2}, {4.015, 1, 2}};     // under 1/64 m
    static const struct { const double (*points)[3]; uint32_t count; } portals[] = {{bent, 4}, {straight, 5}, {beside, 4}};
    uint32_t id;
    const char *fault;
    for (uint32_t i = 0; i < 3; ++i) {
        const builder_portal p = {
            .name = "off", .points = portals[i].points, .point_count = portals[i].count, .zones = {r.west, r.east}, .door = SCENE_NONE};
        if (scene_builder_portal(f->builder, &p, &id, &fault) != RESULT_OK) fail_msg("portal %u %s", i, fault);
        assert_int_equal(id, i);
    }
    put_triangle(f, 1);
    assert_int_equal(builder_fixture_finish(f), RESULT_OK);
    assert_int_equal(f->scene->portal_count, 3);
    assert_int_equal(f->scene->zones[r.east].portal_count, 3);
    assert_int_equal(f->scene->zones[r.inner].portal_count, 0);
}

// A house x 0 .. 8 in the open or in a hall; the hole in its face x = 0 lies `depth` deep.
typedef enum hole_size { HOLE_SMALL, HOLE_WHOLE_FACE } hole_size;
static result sunk_hole(builder_fixture *f, uint32_t in_a_hall, double depth, hole_size size, const char **fault)
{
    uint32_t outer, house, id;
    builder_fixture_restart(f);
    if (in_a_hall) assert_int_equal(add_box_zone(f->builder, "hall", &(zone_box){{-9, -9, -9}, {20, 9, 9}}, SCENE_NONE, &outer), RESULT_OK);
    else assert_int_equal(add_everywhere(f->builder, "open", &outer), RESULT_OK);
    assert_int_equal(add_box_zone(f->builder, "house", &(zone_box){{0, 0, 0}, {8, 3, 4}}, in_a_hall ? outer : SCENE_NONE, &house), RESULT_OK);
    door_hole hole = {depth, {0.5, 1}, {2.5, 3}, {house, outer}};
    if (size == HOLE_WHOLE_FACE) hole = (door_hole){depth, {0, 0}, {3, 4}, {outer, house}};
    return add_hole(f->builder, &hole, &id, fault);
}

static void a_portal_that_lies_deep_in_a_zone_which_the_other_is_about_is_refused(void **state)
{
    builder_fixture *f = *state;
    const char *fault;
    for (uint32_t in_a_hall = 0; in_a_hall < 2; ++in_a_hall) {
        assert_int_equal(sunk_hole(f, in_a_hall, 0.25, HOLE_SMALL, &fault), RESULT_BAD_INPUT);
        assert_string_equal(fault, "lies inside its first zone, by over 1/64 of its width");
        assert_int_equal(sunk_hole(f, in_a_hall, 0.25, HOLE_WHOLE_FACE, &fault), RESULT_BAD_INPUT); // all its points lie on faces
        assert_string_equal(fault, "lies inside its second zone, by over 1/64 of its width");
        assert_int_equal(sunk_hole(f, in_a_hall, 0.03, HOLE_SMALL, &fault), RESULT_OK);
        assert_int_equal(sunk_hole(f, in_a_hall, 0, HOLE_WHOLE_FACE, &fault), RESULT_OK);
        assert_int_equal(sunk_hole(f, in_a_hall, -0.03, HOLE_SMALL, &fault), RESULT_OK);
    }
}

static void a_portal_between_two_hulls_of_a_zone_leads_nowhere_outside_and_is_refused(void **state)
{
    builder_fixture *f = *state;
    uint32_t open, house, id;
    const char *fault;
    scene_solid_plane planes[2][6];
    box_planes(&(zone_box){{0, 0, 0}, {4, 3, 4}}, planes[0]);
    box_planes(&(zone_box){{4, 0, 0}, {8, 3, 4}}, planes[1]);
    const builder_hull hulls[2] = {{planes[0], 6}, {planes[1], 6}};
    const builder_zone zone = {.name = "house", .hulls = hulls, .hull_count = 2, .parent = SCENE_NONE};
    assert_int_equal(add_everywhere(f->builder, "open", &open), RESULT_OK);
    assert_int_equal(scene_builder_zone(f->builder, &zone, &house, &fault), RESULT_OK);
    static const double seam[4][3] = {{4, 1, 1}, {4, 2, 1}, {4, 2, 2}, {4, 1, 2}}, normal[3] = {1, 0, 0};
    const builder_portal p = {.name = "seam", .points = seam, .point_count = 4, .zones = {house, open}, .door = SCENE_NONE, .normal = normal};
    assert_int_equal(scene_builder_portal(f->builder, &p, &id, &fault), RESULT_BAD_INPUT);
    assert_string_equal(fault, "lies inside its first zone, by over 1/64 of its width");
}

static void a_portal_in_what_two_zones_side_by_side_have_in_common_is_taken(void **state)
{
    builder_fixture *f = *state;
    uint32_t a, b, id;
    const char *fault;
    assert_int_equal(add_box_zone(f->builder, "a", &(zone_box){{0, 0, 0}, {5, 4, 4}}, SCENE_NONE, &a), RESULT_OK);
    assert_int_equal(add_box_zone(f->builder, "b", &(zone_box){{3, 0, 0}, {8, 4, 4}}, SCENE_NONE, &b), RESULT_OK);
    assert_int_equal(add_hole(f->builder, &(door_hole){4, {0, 0}, {4, 4}, {a, b}}, &id, &fault), RESULT_OK);
}

// Of rooms of all sizes: what is off by a share of a portal's width is taken, or refused, at every scale.
static void portals_are_judged_the_same_at_every_scale(void **state)
{
    builder_fixture *f = *state;
    const double offsets[4] = {0, 0.01, -0.01, 0.1}; // of the rooms' 4 m
    for (double scale = 1e-4; scale < 2e4; scale *= 10)
        for (int far = 0; far < 2; ++far)
            for (int i = 0; i < 4; ++i) {
                builder_fixture_restart(f);
                const builder_transform t = {{{scale, 0, 0, far * 1e6}, {0, scale, 0, 0}, {0, 0, scale, 0}}};
                assert_int_equal(scene_builder_transform(f->builder, &t), RESULT_OK);
                const rooms r = add_rooms(f);
                uint32_t id;
                const char *fault;
                const result expected = offsets[i] == 0.1 ? RESULT_BAD_INPUT : RESULT_OK;
                assert_int_equal(add_hole(f->builder, &(door_hole){4 + offsets[i], {1, 1}, {2, 2}, {r.west, r.east}}, &id, &fault), expected);
                assert_int_equal(add_hole(f->builder, &(door_hole){7 + offsets[i], {1, 1}, {2, 2}, {r.inner, r.east}}, &id, &fault), expected);
                static const double bent[4][3] = {{4, 1, 1}, {4.001, 2, 1}, {4, 2, 2}, {4.001, 1, 2}}, wrong[4][3] = {{4, 1, 1}, {4.004, 2, 1}, {4, 2, 2}, {4.004, 1, 2}};
                builder_portal p = {.name = "bent", .points = bent, .point_count = 4, .zones = {r.west, r.east}, .door = SCENE_NONE};
                assert_int_equal(scene_builder_portal(f->builder, &p, &id, &fault), RESULT_OK);
                p.points = wrong;
                assert_int_equal(scene_builder_portal(f->builder, &p, &id, &fault), RESULT_BAD_INPUT);
            }
}

static double plane_at(const scene_portal *p, const double at[3])
{
    return p->plane[0] * at[0] + p->plane[1] * at[1] + p->plane[2] * at[2] + p->plane[3];
}

// Unit normal into zones[0], points in the plane and counterclockwise about it.
static void assert_portal_is_sound(const scene *s, const scene_portal *p)
{
    const double(*q)[3] = (const double(*)[3])s->portal_points + p->first_point;
    const double *n = p->plane;
    assert_true(fabs(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] - 1) < 1e-14);
    for (uint32_t i = 0; i < p->point_count; ++i) {
        const double *a = q[i], *b = q[(i + 1) % p->point_count], *c = q[(i + 2) % p->point_count];
        const double u[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, v[3] = {c[0] - b[0], c[1] - b[1], c[2] - b[2]};
        assert_true(fabs(plane_at(p, a)) <= 1e-3);
        assert_true(n[0] * (u[1] * v[2] - u[2] * v[1]) + n[1] * (u[2] * v[0] - u[0] * v[2]) + n[2] * (u[0] * v[1] - u[1] * v[0]) > 0);
    }
}

static void the_sides_are_found_whatever_order_points_and_zones_come_in(void **state)
{
    builder_fixture *f = *state;
    static const double west[3] = {2, 2, 2}, east[3] = {4.5, 2, 2}, inner[3] = {6, 1, 2}, open[3] = {2, 2, -3};
    static const double to_east[4][3] = {{4, 1, 1}, {4, 2, 1}, {4, 2, 2}, {4, 1, 2}};
    static const double to_inner[4][3] = {{5, 0, 1.5}, {5, 2, 1.5}, {5, 2, 2.5}, {5, 0, 2.5}};
    static const double to_open[4][3] = {{1, 1, 0}, {2, 1, 0}, {2, 2, 0}, {1, 2, 0}};
    for (uint32_t way = 0; way < 16; ++way) {
        builder_fixture_restart(f);
        const rooms r = add_rooms(f);
        const struct { const double (*points)[3]; uint32_t zones[2]; const double *inside[2]; } portals[3] = {
            {to_east, {r.west, r.east}, {west, east}}, {to_inner, {r.east, r.inner}, {east, inner}}, {to_open, {r.west, r.open}, {west, open}}};
        for (int i = 0; i < 3; ++i) {
            double points[4][3];
            for (uint32_t c = 0; c < 4; ++c) {
                const uint32_t from = (way & 1 ? 3 - c : c) + way / 4;
                memcpy(points[c], portals[i].points[from % 4], sizeof points[c]);
            }
            const uint32_t swap = way >> 1 & 1;
            const builder_portal p = {.name = "p", .points = (const double(*)[3])points, .point_count = 4, .door = SCENE_NONE,
                                      .zones = {portals[i].zones[swap], portals[i].zones[1 - swap]}};
            uint32_t id;
            const char *fault;
            assert_int_equal(scene_builder_portal(f->builder, &p, &id, &fault), RESULT_OK);
        }
        put_triangle(f, 1);
        assert_int_equal(builder_fixture_finish(f), RESULT_OK);
        for (int i = 0; i < 3; ++i) {
            const scene_portal *p = &f->scene->portals[i];
            const uint32_t swap = way >> 1 & 1;
            assert_portal_is_sound(f->scene, p);
            assert_true(plane_at(p, portals[i].inside[swap]) > 0);
            assert_true(plane_at(p, portals[i].inside[1 - swap]) < 0);
        }
    }
}

static void the_sides_are_found_in_a_turned_and_scaled_scene_too(void **state)
{
    builder_fixture *f = *state;
    uint64_t random = 3;
    for (int i = 0; i < 50; ++i) {
        builder_fixture_restart(f);
        const double yaw = random_between(&random, -3, 3), pitch = random_between(&random, -1.5, 1.5), scale = exp(random_between(&random, -3, 3));
        const double cy = cos(yaw), sy = sin(yaw), cp = cos(pitch), sp = sin(pitch);
        const double turn[3][3] = {{cy, sy * sp, sy * cp}, {0, cp, -sp}, {-sy, cy * sp, cy * cp}};
        builder_transform t;
        for (int a = 0; a < 3; ++a) {
            for (int c = 0; c < 3; ++c) t.rows[a][c] = scale * turn[a][c];
            t.rows[a][3] = random_between(&random, -1000, 1000);
        }
        assert_int_equal(scene_builder_transform(f->builder, &t), RESULT_OK);
        const rooms r = add_rooms(f);
        uint32_t id;
        const char *fault;
        const door_hole hole = {4, {1, 1}, {3, 2}, {r.east, r.west}};
        assert_int_equal(add_hole(f->builder, &hole, &id, &fault), RESULT_OK);
        put_triangle(f, 1);
        assert_int_equal(builder_fixture_finish(f), RESULT_OK);
        const scene_portal *p = &f->scene->portals[0];
        assert_portal_is_sound(f->scene, p);
        for (int k = 0; k < 3; ++k) assert_true(fabs(p->plane[k] - turn[k][0]) < 1e-4); // x, turned: into the east
    }
}

static void whatever_points_come_a_portal_is_refused_or_sound(void **state)
{
    builder_fixture *f = *state;
    uint64_t random = 12;
    uint32_t taken = 0, id;
    const rooms r = add_rooms(f);
    for (int i = 0; i < 20000; ++i) {
        double points[8][3];
        const uint32_t count = 3 + random_below(&random, 6), coarse = random_below(&random, 3);
        for (uint32_t c = 0; c < count; ++c) {
            const double angle = 6.283185307179586 * c / count, wobble = random_between(&random, -0.002, 0.002) * random_below(&random, 2);
            points[c][0] = 4 + wobble;
            points[c][1] = coarse == 2 ? 1 + random_below(&random, 3) : 2 + cos(angle) + wobble;
            points[c][2] = coarse == 2 ? 1 + random_below(&random, 3) : 2 + sin(angle) + wobble;
        }
        const builder_portal p = {
            .name = "any", .points = (const double(*)[3])points, .point_count = count, .zones = {r.west, r.east}, .door = SCENE_NONE};
        const char *fault = NULL;
        const result done = scene_builder_portal(f->builder, &p, &id, &fault);
        assert_true(done == RESULT_OK ? !fault : done == RESULT_BAD_INPUT && fault);
        taken += done == RESULT_OK;
    }
    put_triangle(f, 1);
    assert_int_equal(builder_fixture_finish(f), RESULT_OK);
    assert_int_equal(f->scene->portal_count, taken);
    assert_true(taken > 2000 && taken < 18000);
    static const double west[3] = {2, 2, 2};
    for (uint32_t i = 0; i < taken; ++i) {
        const scene_portal *p = &f->scene->portals[i];
        assert_true(plane_at(p, west) > 1.9);
        for (uint32_t c = 0; c < p->point_count; ++c) assert_true(fabs(plane_at(p, f->scene->portal_points[p->first_point + c])) <= 2e-3); // of a size of under 2 m
    }
}

static void a_given_normal_decides_where_hulls_cannot(void **state)
{
    builder_fixture *f = *state;
    static const double across[4][3] = {{3.99, 1, 1}, {4.01, 1, 1}, {4.01, 1, 2}, {3.99, 1, 2}};
    for (int sign = -1; sign <= 1; sign += 2) {
        builder_fixture_restart(f);
        const rooms r = add_rooms(f);
        const double up[3] = {0, sign * 0.25, 0};
        const builder_portal p = {.name = "across", .points = across, .point_count = 4, .zones = {r.west, r.east}, .door = SCENE_NONE, .normal = up};
        uint32_t id;
        const char *fault;
        assert_int_equal(scene_builder_portal(f->builder, &p, &id, &fault), RESULT_OK);
        put_triangle(f, 1);
        assert_int_equal(builder_fixture_finish(f), RESULT_OK);
        assert_portal_is_sound(f->scene, &f->scene->portals[0]);
        assert_true(f->scene->portals[0].plane[1] * sign > 0.99);
    }
}

static void points_lie_on_the_scene_s_step_and_far_portals_count_for_it(void **state)
{
    builder_fixture *f = *state;
    uint32_t near_zone, far_zone, id;
    const char *fault;
    assert_int_equal(add_box_zone(f->builder, "near", &(zone_box){{0, 0, 0}, {900, 4, 4}}, SCENE_NONE, &near_zone), RESULT_OK);
    assert_int_equal(add_box_zone(f->builder, "far", &(zone_box){{900, 0, 0}, {904, 4, 4}}, SCENE_NONE, &far_zone), RESULT_OK);
    const door_hole hole = {900, {1.0 / 3, 1.1}, {2.7, 3.3}, {near_zone, far_zone}};
    assert_int_equal(add_hole(f->builder, &hole, &id, &fault), RESULT_OK);
    put_triangle(f, 0.1);
    assert_int_equal(builder_fixture_finish(f), RESULT_OK);
    const scene *s = f->scene;
    for (uint32_t i = 0; i < 4; ++i)
        for (int k = 0; k < 3; ++k) {
            const double at = s->portal_points[i][k] - s->whole.origin[k];
            assert_true(at / s->step == nearbyint(at / s->step));
            assert_true(fabs(at) <= (double)s->whole.radius);
            assert_true((double)(float)at == at);
        }
    assert_true(s->whole.radius >= 450);
    assert_true(s->whole.box.max.x - s->whole.box.min.x < 1); // of geometry alone
}

static void a_portal_below_the_scene_s_precision_is_refused_by_name(void **state)
{
    builder_fixture *f = *state;
    uint32_t a, b, id;
    const char *fault;
    assert_int_equal(add_box_zone(f->builder, "a", &(zone_box){{0, 0, 0}, {1, 1, 1}}, SCENE_NONE, &a), RESULT_OK);
    assert_int_equal(add_box_zone(f->builder, "b", &(zone_box){{1, 0, 0}, {2, 1, 1}}, SCENE_NONE, &b), RESULT_OK);
    const door_hole hole = {1, {0.5, 0.5}, {0.50001, 0.50001}, {a, b}};
    assert_int_equal(add_hole(f->builder, &hole, &id, &fault), RESULT_OK);
    put_triangle(f, 16000);
    assert_int_equal(builder_fixture_finish(f), RESULT_BAD_INPUT);
    assert_true(report_lines_is_one_with(&f->lines, "test.scene: error: the portal \"hole\" has no area at this scene's precision"));
}

static void each_zone_lists_its_portals_in_file_order(void **state)
{
    builder_fixture *f = *state;
    const rooms r = add_rooms(f);
    uint32_t id;
    const char *fault;
    const door_hole holes[3] = {
        {4, {1, 1}, {2, 2}, {r.west, r.east}}, {5, {1, 1.5}, {2, 2}, {r.inner, r.east}}, {4, {2.5, 1}, {3, 2}, {r.east, r.west}}};
    for (int i = 0; i < 3; ++i) assert_int_equal(add_hole(f->builder, &holes[i], &id, &fault), RESULT_OK);
    put_triangle(f, 1);
    assert_int_equal(builder_fixture_finish(f), RESULT_OK);
    const scene *s = f->scene;
    static const uint32_t expected[4][3] = {{0, 5}, {1, 3, 4}, {2}, {0}};
    static const uint32_t counts[4] = {2, 3, 1, 0};
    for (uint32_t z = 0; z < 4; ++z) {
        assert_int_equal(s->zones[z].portal_count, counts[z]);
        for (uint32_t i = 0; i < counts[z]; ++i) assert_int_equal(s->zone_portals[s->zones[z].first_portal + i], expected[z][i]);
    }
}

static void portals_doors_and_zones_change_the_hash(void **state)
{
    builder_fixture *f = *state;
    uint64_t hashes[5];
    for (int i = 0; i < 5; ++i) {
        builder_fixture_restart(f);
        rooms r = {0};
        uint32_t id;
        const char *fault;
        if (i > 1) r = add_rooms(f);
        if (i > 3) assert_int_equal(scene_builder_door(f->builder, "door", DOORS_OPEN, SCENE_NONE, &id), RESULT_OK);
        const door_hole hole = {4, {1, 1}, {2, 2}, {r.west, r.east}};
        if (i > 2) assert_int_equal(add_hole(f->builder, &hole, &id, &fault), RESULT_OK);
        if (i == 1)
            assert_int_equal(scene_builder_door(f->builder, "door", DOORS_OPEN, SCENE_NONE, &id), RESULT_OK); // of a scene without zones: the same
        const double at[3] = {0, 0, 0};
        builder_fixture_triangle(f, at, 5); // the bounds, and so the step, are the same with and without the portal
        assert_int_equal(builder_fixture_finish(f), RESULT_OK);
        hashes[i] = f->scene->hash;
    }
    assert_true(hashes[0] == hashes[1]);
    for (int i = 1; i < 5; ++i)
        for (int j = i + 1; j < 5; ++j) assert_true(hashes[i] != hashes[j]);
}

static void the_hash_of_a_scene_with_zones_is_the_same_everywhere(void **state)
{
    builder_fixture *f = *state;
    const rooms r = add_rooms(f);
    uint32_t door, id;
    const char *fault;
    assert_int_equal(scene_builder_door(f->builder, "door", DOORS_OPEN, SCENE_NONE, &door), RESULT_OK);
    const door_hole hole = {4, {1.0 / 3, 0.1}, {2.7, 3.3}, {r.west, r.east}};
    assert_int_equal(add_hole(f->builder, &hole, &id, &fault), RESULT_OK);
    put_triangle(f, 5);
    assert_int_equal(builder_fixture_finish(f), RESULT_OK);
    assert_int_equal(f->scene->hash, UINT64_C(0x28b819d9af906758));
}

int main(void)
{
#define TEST(t) cmocka_unit_test_setup_teardown(t, builder_fixture_set_up, builder_fixture_tear_down)
    const struct CMUnitTest tests[] = {
        TEST(each_bad_portal_is_refused_with_its_fault),
        TEST(a_portal_that_is_a_little_off_is_taken),
        TEST(a_portal_that_lies_deep_in_a_zone_which_the_other_is_about_is_refused),
        TEST(a_portal_between_two_hulls_of_a_zone_leads_nowhere_outside_and_is_refused),
        TEST(a_portal_in_what_two_zones_side_by_side_have_in_common_is_taken),
        TEST(portals_are_judged_the_same_at_every_scale),
        TEST(the_sides_are_found_whatever_order_points_and_zones_come_in),
        TEST(the_sides_are_found_in_a_turned_and_scaled_scene_too),
        TEST(whatever_points_come_a_portal_is_refused_or_sound),
        TEST(a_given_normal_decides_where_hulls_cannot),
        TEST(points_lie_on_the_scene_s_step_and_far_portals_count_for_it),
        TEST(a_portal_below_the_scene_s_precision_is_refused_by_name),
        TEST(each_zone_lists_its_portals_in_file_order),
        TEST(portals_doors_and_zones_change_the_hash),
        TEST(the_hash_of_a_scene_with_zones_is_the_same_everywhere),
    };
    return cmocka_run_group_tests_name("zones portals", tests, NULL, NULL);
}
