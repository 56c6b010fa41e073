// Tests of zone data: the same geometry as the scene's, to the bit, whichever zone it is looked at from.
// SPDX-License-Identifier: MIT
#include "zone_scene.h"

#include "host/core/zone_data.h"
#include "tests/common/random.h"
#include "tests/common/test.h"
#include "tests/core/box_scene.h"

#include <portcullis/box.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

static zone_data open_zone(builder_fixture *f, uint32_t zone)
{
    const zone_data_request q = {f->scene, zone, 7};
    zone_data z;
    assert_int_equal(zone_data_open(&q, &f->memory.memory, &z), RESULT_OK);
    return z;
}

static void a_plain_scene_lends_its_own_arrays(void **state)
{
    builder_fixture *f = *state;
    const box_scene boxes = {.items = 20, .movers = 3, .seed = 4, .at = {1000, 0, 0}};
    assert_int_equal(box_scene_make(&boxes, &f->memory.memory, &f->lines.report, &f->scene), RESULT_OK);
    const scene *s = f->scene;
    zone_data z = open_zone(f, 0);
    assert_ptr_equal(z.zone.positions, s->positions);
    assert_ptr_equal(z.zone.indices, s->indices);
    assert_ptr_equal(z.zone.boxes.min_x, s->boxes.min_x);
    assert_ptr_equal(z.zone.walls, s->walls);
    assert_null(z.items);
    assert_int_equal(z.shared_count, 0);
    assert_int_equal(z.zone.item_count, 20);
    assert_int_equal(z.zone.mover_capacity, 7);
    assert_int_equal(z.zone.portal_count, 0);
    assert_int_equal(z.zone.position_count, s->position_count);
    assert_int_equal(z.zone.index_count, s->index_count);
    assert_true(z.zone.radius == s->whole.radius);
    assert_memory_equal(&z.zone.box, &s->whole.box, sizeof z.zone.box);
    for (uint32_t i = 0; i < 20; ++i) {
        assert_int_equal(z.zone.items[i].first_index, s->items[i].first_index);
        assert_int_equal(z.zone.items[i].flags, s->items[i].flags);
        assert_int_equal(z.zone.items[i].polygon_count, 6);
    }
    zone_data_close(&z);
}

static void assert_same_point(const scene *s, const zone_data *z, cull_vec3 here, cull_vec3 there)
{
    const double *origin = s->zones[z->index].origin, *whole = s->whole.origin;
    assert_true((double)here.x + (origin[0] - whole[0]) == (double)there.x);
    assert_true((double)here.y + (origin[1] - whole[1]) == (double)there.y);
    assert_true((double)here.z + (origin[2] - whole[2]) == (double)there.z);
}

static void assert_item_is_the_scene_s(const scene *s, const zone_data *z, uint32_t place)
{
    const cull_item *here = &z->zone.items[place];
    const scene_item *there = &s->items[z->items[place]];
    assert_int_equal(here->index_count, there->index_count);
    assert_int_equal(here->polygon_count, there->polygon_count);
    assert_int_equal(here->material, there->material);
    assert_int_equal(here->flags, there->flags);
    for (uint32_t k = 0; k < here->index_count; ++k) {
        const uint32_t vertex = z->zone.indices[here->first_index + k];
        assert_true(vertex < z->zone.position_count);
        assert_same_point(s, z, z->zone.positions[vertex], s->positions[s->indices[there->first_index + k]]);
    }
    const cull_box mine = cull_box_at(&z->zone.boxes, place), theirs = cull_box_at(&s->boxes, z->items[place]);
    assert_same_point(s, z, mine.min, theirs.min);
    assert_same_point(s, z, mine.max, theirs.max);
    assert_true(cull_box_contains(z->zone.box, mine));
}

static void assert_zone_is_sound(const scene *s, const zone_data *z)
{
    const scene_zone *zone = &s->zones[z->index];
    uint32_t shared = 0, indices = 0;
    assert_int_equal(z->zone.item_count, zone->item_count);
    for (int k = 0; k < 3; ++k) assert_true(zone->origin[k] == floor(zone->origin[k]));
    for (uint32_t i = 0; i < z->zone.item_count; ++i) {
        assert_int_equal(z->items[i], s->zone_items[zone->first_item + i]);
        assert_int_equal(z->zone.items[i].first_index, indices); // ascending, without gaps
        indices += z->zone.items[i].index_count;
        assert_item_is_the_scene_s(s, z, i);
        if (s->listings[z->items[i]] > 1) {
            assert_true(shared < z->shared_count);
            assert_int_equal(z->shared[shared++], i);
        }
    }
    assert_int_equal(shared, z->shared_count);
    assert_int_equal(indices, z->zone.index_count);
    assert_true(z->zone.radius == cull_box_radius(z->zone.box));
    const float *const axes[6] = {z->zone.boxes.min_x, z->zone.boxes.min_y, z->zone.boxes.min_z,
                                  z->zone.boxes.max_x, z->zone.boxes.max_y, z->zone.boxes.max_z};
    for (int k = 0; k < 6; ++k) {
        assert_int_equal((uintptr_t)axes[k] % 64, 0);
        for (uint32_t i = 0; i < CULL_PADDING; ++i) assert_true(isfinite(axes[k][z->zone.item_count + i]));
    }
}

static void every_zone_has_the_scene_s_points_to_the_bit(void **state)
{
    builder_fixture *f = *state;
    for (uint64_t seed = 0; seed < 12; ++seed) {
        builder_fixture_restart(f);
        const zone_scene made = {.zones = 20, .items = 150, .seed = seed, .outside = (zone_outside)(seed % 3), .at = {(double)seed * 777, 0, -5e6}};
        assert_int_equal(zone_scene_make(&made, &f->memory.memory, &f->lines.report, &f->scene), RESULT_OK);
        uint64_t vertices = 0;
        for (uint32_t i = 0; i < f->scene->zone_count; ++i) {
            zone_data z = open_zone(f, i);
            assert_zone_is_sound(f->scene, &z);
            assert_int_equal(z.zone.position_count, 8 * z.zone.item_count); // those of its items, each once
            vertices += z.zone.position_count;
            zone_data_close(&z);
        }
        assert_int_equal(vertices, 8 * f->scene->zone_item_count);
    }
}

static void a_vertex_of_two_zones_is_one_point_of_the_world(void **state)
{
    builder_fixture *f = *state;
    uint32_t west, east;
    assert_int_equal(add_box_zone(f->builder, "west", &(zone_box){{0, 0, 0}, {40, 4, 4}}, SCENE_NONE, &west), RESULT_OK);
    assert_int_equal(add_box_zone(f->builder, "east", &(zone_box){{40, 0, 0}, {80, 4, 4}}, SCENE_NONE, &east), RESULT_OK);
    const double shared[3] = {39.7, 1.0 / 3, 0.1}, in_west[3] = {1.1, 1, 1}, in_east[3] = {77.3, 1, 1};
    builder_fixture_triangle(f, in_west, 1);
    builder_fixture_triangle(f, shared, 0.7);
    builder_fixture_triangle(f, in_east, 1);
    assert_int_equal(builder_fixture_finish(f), RESULT_OK);
    zone_data z[2] = {open_zone(f, west), open_zone(f, east)};
    assert_true(f->scene->zones[west].origin[0] != f->scene->zones[east].origin[0]);
    assert_int_equal(z[0].shared_count, 1);
    assert_int_equal(z[1].shared_count, 1);
    for (uint32_t k = 0; k < 3; ++k) {
        double world[2][3];
        for (int side = 0; side < 2; ++side) {
            const cull_item *item = &z[side].zone.items[z[side].shared[0]];
            const cull_vec3 p = z[side].zone.positions[z[side].zone.indices[item->first_index + k]];
            const double *origin = f->scene->zones[z[side].index].origin;
            world[side][0] = (double)p.x + origin[0];
            world[side][1] = (double)p.y + origin[1];
            world[side][2] = (double)p.z + origin[2];
        }
        assert_memory_equal(world[0], world[1], sizeof world[0]);
    }
    zone_data_close(&z[0]);
    zone_data_close(&z[1]);
}

static void walls_keep_their_loops_and_lie_in_their_planes(void **state)
{
    builder_fixture *f = *state;
    uint64_t random = 8;
    uint32_t id;
    for (int i = 0; i < 8; ++i) {
        const char name[] = {'z', (char)('0' + i), 0};
        assert_int_equal(add_box_zone(f->builder, name, &(zone_box){{100 * i, 0, 0}, {100 * i + 100, 50, 50}}, SCENE_NONE, &id), RESULT_OK);
    }
    for (int i = 0; i < 200; ++i) {
        double c[4][3];
        for (int k = 0; k < 3; ++k) {
            const double low = random_between(&random, 0, k ? 45 : 795), u = random_between(&random, -3, 3), v = random_between(&random, -3, 3);
            c[0][k] = low;
            c[1][k] = low + u;
            c[2][k] = low + u + v;
            c[3][k] = low + v;
        }
        assert_int_equal(add_wall(f->builder, (const double(*)[3])c), RESULT_OK);
    }
    const double at[3] = {5, 5, 5}, far[3] = {700, 5, 5};
    builder_fixture_triangle(f, at, 1);
    builder_fixture_triangle(f, far, 1);
    assert_int_equal(builder_fixture_finish(f), RESULT_OK);
    const scene *s = f->scene;
    for (uint32_t n = 0; n < s->zone_count; ++n) {
        zone_data z = open_zone(f, n);
        assert_zone_is_sound(s, &z);
        for (uint32_t i = 0; i < z.zone.item_count; ++i) {
            const cull_wall *here = &z.zone.walls[i], *there = &s->walls[z.items[i]];
            assert_int_equal(here->vertex_count, there->vertex_count);
            for (uint32_t k = 0; k < here->vertex_count; ++k) {
                const cull_vec3 p = z.zone.positions[z.zone.wall_vertices[here->first_vertex + k]];
                assert_same_point(s, &z, p, s->positions[s->wall_vertices[there->first_vertex + k]]);
                assert_true(here->plane < z.zone.plane_count);
                const cull_plane q = z.zone.planes[here->plane];
                const double height =
                    (double)q.normal.x * (double)p.x + (double)q.normal.y * (double)p.y + (double)q.normal.z * (double)p.z + (double)q.offset;
                assert_true(fabs(height) <= (double)z.zone.radius * 3e-7 + s->step); // float's precision of the plane, and rounding
                assert_memory_equal(&q.normal, &s->planes[there->plane].normal, sizeof q.normal);
            }
        }
        zone_data_close(&z);
    }
}

static void both_sides_of_a_portal_have_the_same_points_the_other_way_round(void **state)
{
    builder_fixture *f = *state;
    uint32_t west, east, id;
    const char *fault;
    assert_int_equal(add_box_zone(f->builder, "west", &(zone_box){{0, 0, 0}, {40, 4, 4}}, SCENE_NONE, &west), RESULT_OK);
    assert_int_equal(add_box_zone(f->builder, "east", &(zone_box){{40, 0, 0}, {80, 4, 4}}, SCENE_NONE, &east), RESULT_OK);
    const door_hole hole = {40, {1.0 / 3, 0.1}, {3.3, 2.7}, {west, east}};
    assert_int_equal(add_hole(f->builder, &hole, &id, &fault), RESULT_OK);
    const double in_west[3] = {1.1, 1, 1};
    builder_fixture_triangle(f, in_west, 1);
    assert_int_equal(builder_fixture_finish(f), RESULT_OK);
    const scene *s = f->scene;
    zone_data z[2] = {open_zone(f, west), open_zone(f, east)};
    const cull_portal *p[2] = {&z[0].zone.portals[0], &z[1].zone.portals[0]};
    assert_int_equal(z[1].zone.item_count, 0);
    for (int side = 0; side < 2; ++side) {
        assert_int_equal(z[side].zone.portal_count, 1);
        assert_int_equal(p[side]->point_count, 4);
        assert_true(p[side]->plane.normal.x == (side ? 1.0f : -1.0f)); // into the zone
        assert_true((double)p[side]->plane.offset == (side ? -1 : 1) * (40 - s->zones[z[side].index].origin[0]));
        for (uint32_t i = 0; i < 4; ++i) {
            const cull_vec3 a = p[side]->points[i], b = p[side]->points[(i + 1) % 4], c = p[side]->points[(i + 2) % 4];
            const float turn = (b.y - a.y) * (c.z - b.z) - (b.z - a.z) * (c.y - b.y);
            assert_true(turn * p[side]->plane.normal.x > 0); // counterclockwise seen from inside
            assert_true(cull_box_contains_point(z[side].zone.box, a));
            const cull_vec3 other = p[1 - side]->points[3 - i];
            assert_true((double)a.x + s->zones[z[side].index].origin[0] == (double)other.x + s->zones[z[1 - side].index].origin[0]);
            assert_true((double)a.y + s->zones[z[side].index].origin[1] == (double)other.y + s->zones[z[1 - side].index].origin[1]);
            assert_true((double)a.z + s->zones[z[side].index].origin[2] == (double)other.z + s->zones[z[1 - side].index].origin[2]);
        }
    }
    zone_data_close(&z[0]);
    zone_data_close(&z[1]);
}

static void assert_same_array(const void *a, const void *b, size_t bytes)
{
    if (bytes) assert_memory_equal(a, b, bytes);
}

static void a_scene_moved_far_away_has_the_same_zones_to_the_bit(void **state)
{
    builder_fixture *f = *state;
    static const double moves[] = {1e3, 1e5, 1e7};
    for (int m = 0; m < 3; ++m) {
        scene *scenes[2];
        builder_fixture_restart(f);
        for (int i = 0; i < 2; ++i) {
            const double by = i ? moves[m] : 0;
            const zone_scene made = {.zones = 30, .items = 200, .seed = 5, .at = {by, -by, 2 * by}, .outside = OUTSIDE_LAST};
            assert_int_equal(zone_scene_make(&made, &f->memory.memory, &f->lines.report, &scenes[i]), RESULT_OK);
        }
        assert_int_equal(scenes[0]->zone_count, scenes[1]->zone_count);
        assert_true(scenes[0]->zone_count > 20);
        for (uint32_t n = 0; n < scenes[0]->zone_count; ++n) {
            zone_data z[2];
            for (int i = 0; i < 2; ++i) {
                f->scene = scenes[i];
                z[i] = open_zone(f, n);
            }
            assert_true(scenes[1]->zones[n].origin[1] - scenes[0]->zones[n].origin[1] == -moves[m]);
            assert_int_equal(z[0].zone.item_count, z[1].zone.item_count);
            assert_int_equal(z[0].zone.position_count, z[1].zone.position_count);
            assert_same_array(z[0].items, z[1].items, z[0].zone.item_count * sizeof(uint32_t));
            assert_same_array(z[0].zone.positions, z[1].zone.positions, z[0].zone.position_count * sizeof(cull_vec3));
            assert_same_array(z[0].zone.boxes.max_z, z[1].zone.boxes.max_z, z[0].zone.item_count * sizeof(float));
            for (int i = 0; i < 2; ++i) zone_data_close(&z[i]);
        }
        for (int i = 0; i < 2; ++i) scene_free(scenes[i], &f->memory.memory);
        f->scene = NULL;
    }
}

static void zones_of_one_item_do_not_cost_what_the_scene_costs(void **state)
{
    builder_fixture *f = *state;
    enum { ZONES = 2000 };
    char name[16];
    uint32_t id;
    for (int i = 0; i < ZONES; ++i) {
        snprintf(name, sizeof name, "z%d", i);
        const double at = 3 * i, middle[3] = {at + 1, 0, 0};
        assert_int_equal(add_box_zone(f->builder, name, &(zone_box){{at, -2, -2}, {at + 2, 2, 2}}, SCENE_NONE, &id), RESULT_OK);
        builder_fixture_triangle(f, middle, 0.5);
    }
    assert_int_equal(builder_fixture_finish(f), RESULT_OK);
    const uint64_t before = f->memory.live_bytes;
    static zone_data z[ZONES];
    for (uint32_t i = 0; i < ZONES; ++i) z[i] = open_zone(f, i);
    assert_true(f->memory.live_bytes - before < ZONES * 1024);
    for (uint32_t i = 0; i < ZONES; ++i) zone_data_close(&z[i]);
    assert_true(f->memory.live_bytes == before);
}

int main(void)
{
#define TEST(t) cmocka_unit_test_setup_teardown(t, builder_fixture_set_up, builder_fixture_tear_down)
    const struct CMUnitTest tests[] = {
        TEST(a_plain_scene_lends_its_own_arrays),
        TEST(every_zone_has_the_scene_s_points_to_the_bit),
        TEST(a_vertex_of_two_zones_is_one_point_of_the_world),
        TEST(walls_keep_their_loops_and_lie_in_their_planes),
        TEST(both_sides_of_a_portal_have_the_same_points_the_other_way_round),
        TEST(a_scene_moved_far_away_has_the_same_zones_to_the_bit),
        TEST(zones_of_one_item_do_not_cost_what_the_scene_costs),
    };
    return cmocka_run_group_tests_name("zones zone data", tests, NULL, NULL);
}
