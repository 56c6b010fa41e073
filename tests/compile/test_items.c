// The last stage of the compiler: triangles, walls, zones by hulls, doors, and the checks that watch over it all.
// SPDX-License-Identifier: MIT
#include "items_fixture.h"
#include "tests/common/failing_allocator.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void two_rooms_become_two_zones_joined_by_the_doors_portal(void **state)
{
    (void)state;
    static map_writer w;
    write_two_rooms(&w);
    compiled c;
    take_zones(&c, input_of(w.text, NULL), PORTALS_DOORS);
    take_items(&c);
    expect_sound(&c);
    assert_int_equal(c.scene->zone_count, 2);
    assert_int_equal(c.scene->portal_count, 1);
    assert_int_equal(c.scene->mover_count, 1);
    assert_int_equal(c.scene->door_count, 1);
    assert_int_equal(c.scene->portals[0].door, 0);
    assert_int_equal(c.scene->doors[0].mover, 0);
    assert_true(c.scene->movers[0].open_offset[1] == 88.0 / 32); // its height less the lip of 8
    assert_int_equal(c.scene->light_count, 1);
    assert_true(c.scene->lights[0].reach == 5);
    assert_int_equal(c.scene->place_count, 2);
    release(&c);
}

static void walls_keep_their_exact_planes(void **state)
{
    (void)state;
    static map_writer w;
    write_two_rooms(&w);
    compiled c;
    take_zones(&c, input_of(w.text, NULL), PORTALS_NONE);
    take_items(&c);
    const scene *s = c.scene;
    assert_non_null(s->exact_planes);
    assert_true(s->grid_steps_per_metre == 8192);
    for (uint32_t i = 0; i < s->item_count; ++i) {
        const cull_exact_plane *p = &s->exact_planes[s->walls[i].plane];
        for (uint32_t v = 0; v < s->walls[i].vertex_count; ++v) {
            const cull_vec3 at = s->positions[s->wall_vertices[s->walls[i].first_vertex + v]];
            const double parts[3] = {(double)at.x, (double)at.y, (double)at.z};
            double height = (double)p->offset;
            for (int k = 0; k < 3; ++k) height += (double)p->normal[k] * parts[k] * s->grid_steps_per_metre;
            assert_true(height == 0); // all of it is on the grid
        }
    }
    release(&c);
}

static void starts_are_places_and_the_views_of_a_path(void **state)
{
    (void)state;
    static map_writer w;
    write_two_rooms(&w);
    open_entity(&w, "info_player_deathmatch");
    write_text(&w, "\"origin\" \"400 96 40\"\n\"angle\" \"90\"\n");
    close_entity(&w);
    compiled c;
    take_zones(&c, input_of(w.text, NULL), PORTALS_DOORS);
    take_items(&c);
    const scene *s = c.scene;
    assert_int_equal(s->path_count, 1);
    assert_string_equal(s->paths[0].name, "starts");
    assert_int_equal(s->paths[0].camera_count, 2);
    static const double eyes[2][3] = {{2, 1 + 0.7, -2}, {12.5, 1.25 + 0.7, -3}}, ways[2][3] = {{1, 0, 0}, {0, 0, -1}};
    for (int i = 0; i < 2; ++i) {
        const camera *at = &s->cameras[s->paths[0].first_camera + (uint32_t)i];
        assert_null(camera_fault(at));
        for (int k = 0; k < 3; ++k) assert_true(at->eye[k] == eyes[i][k] && at->forward[k] == ways[i][k]);
    }
    assert_int_equal(s->places[0].kind, PLACE_PLAYER);
    assert_int_equal(s->places[1].kind, PLACE_OTHER); // the light
    assert_int_equal(s->places[2].kind, PLACE_PLAYER);
    release(&c);
}

static void lights_have_their_place_reach_and_colour(void **state)
{
    (void)state;
    static map_writer w;
    write_two_rooms(&w);
    open_entity(&w, "light_torch_small_walltorch");
    write_text(&w, "\"origin\" \"64 96 64\"\n\"_color\" \"255 0 51\"\n\"targetname\" \"torch\"\n");
    close_entity(&w);
    compiled c;
    take_zones(&c, input_of(w.text, NULL), PORTALS_DOORS);
    take_items(&c);
    const scene *s = c.scene;
    assert_int_equal(s->light_count, 2);
    assert_string_equal(s->lights[0].name, "light");
    assert_true(s->lights[0].reach == 5 && s->lights[0].colour[0] == 1);
    assert_true(s->lights[0].position[0] == 12.5 && s->lights[0].position[1] == 2 && s->lights[0].position[2] == -2);
    assert_string_equal(s->lights[1].name, "torch");
    assert_int_equal(s->lights[1].kind, LIGHT_POINT);
    assert_true(s->lights[1].reach == 300.0 / 32);
    assert_true(s->lights[1].colour[0] == 1 && s->lights[1].colour[1] == 0 && fabsf(s->lights[1].colour[2] - 0.2f) < 1e-6f);
    release(&c);
}

// ---- The checks see what is wrong ----

static void a_missing_polygon_is_seen_as_open_edges(void **state)
{
    (void)state;
    static map_writer w;
    write_two_rooms(&w);
    compiled c;
    take_zones(&c, input_of(w.text, NULL), PORTALS_NONE);
    c.zones->mesh->polygon_count--;
    take_items(&c);
    assert_true(c.checks.open_edges >= 3);
    release(&c);
}

// A vertex inside of a side taken out of one loop: 1 when there was one.
static int remove_straight_vertex(compile_mesh *m)
{
    for (uint32_t i = 0; i < m->polygon_count; ++i) {
        compile_polygon *p = &m->polygons[i];
        for (uint32_t k = 1; k < p->vertex_count; ++k) {
            if (m->edge_planes[p->first_vertex + k] != m->edge_planes[p->first_vertex + k - 1]) continue;
            for (uint32_t n = p->first_vertex + k; n + 1 < p->first_vertex + p->vertex_count; ++n) {
                m->loop[n] = m->loop[n + 1];
                m->edge_planes[n] = m->edge_planes[n + 1];
            }
            p->vertex_count--;
            return 1;
        }
    }
    return 0;
}

static void a_t_junction_left_is_counted_and_opens_edges(void **state)
{
    (void)state;
    static map_writer w;
    write_two_rooms(&w);
    compiled c;
    take_zones(&c, input_of(w.text, NULL), PORTALS_NONE);
    assert_true(remove_straight_vertex(c.zones->mesh));
    take_items(&c);
    assert_true(c.checks.t_junctions_left >= 1);
    assert_int_equal(c.checks.open_edges, 3); // the long edge, and the two parts of it
    release(&c);
}

// ---- Real maps ----

// A point a hundredth of a millimetre before the middle of each wall lies in a hull of its own zone, and in no other's.
static void expect_walls_in_their_zones(const compiled *c)
{
    const compile_mesh *m = c->zones->mesh;
    for (uint32_t i = 0; i < m->polygon_count; ++i) {
        const compile_polygon *p = &m->polygons[i];
        const uint32_t zone = c->zones->polygon_zone[i];
        if (zone == UINT32_MAX || c->in->brushes[p->brush].role == BRUSH_LIQUID) continue;
        const cull_wide_plane plane = plane_table_get(c->in->planes, p->plane);
        double at[3] = {0}, n[3], length = 0;
        for (int k = 0; k < 3; ++k) {
            n[k] = (double)plane.normal[k];
            length += n[k] * n[k];
            for (uint32_t v = 0; v < p->vertex_count; ++v) at[k] += m->vertices[m->loop[p->first_vertex + v]].position[k] / c->in->steps_per_metre / p->vertex_count;
        }
        for (int k = 0; k < 3; ++k) at[k] += n[k] / sqrt(length) * 1e-5;
        int own = 0, other = 0;
        for (uint32_t h = 0; h < c->scene->hull_count; ++h) {
            const double height = scene_hull_height(c->scene, h, at);
            if (c->scene->hulls[h].zone == zone) own |= height < 1e-9; // on the border of two hulls of the zone, too
            else other |= height < -1e-6;
        }
        assert_true(own);
        assert_false(other);
    }
}

static void real_maps_are_watertight_and_walls_lie_in_their_zones(void **state)
{
    (void)state;
    int seen = 0;
    for (int i = 0; i < REAL_MAPS; ++i) {
        size_t size;
        char *text = real_map(real_map_names[i], &size);
        if (!text) continue;
        compile_input *in = NULL;
        report_lines lines;
        report_lines_init(&lines);
        assert_int_equal(compile_input_map(real_map_names[i], text, size, NULL, allocator_heap(), &lines.report, &in), RESULT_OK);
        free(text);
        compiled c;
        take_zones(&c, in, PORTALS_DOORS);
        take_items(&c);
        expect_sound(&c);
        if (c.zones->zone_count > 1) expect_walls_in_their_zones(&c);
        release(&c);
        ++seen;
    }
    if (!seen) skip();
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    static map_writer w;
    write_two_rooms(&w);
    compiled c;
    take_zones(&c, input_of(w.text, NULL), PORTALS_DOORS);
    result done = RESULT_NO_MEMORY;
    for (uint64_t k = 1; done != RESULT_OK; ++k) {
        failing_allocator a;
        failing_allocator_init(&a, k);
        report_lines lines;
        report_lines_init(&lines);
        scene *made = NULL;
        compile_checks checks;
        done = compile_items(c.in, c.zones, &lines.report, &a.memory, &made, &checks);
        assert_int_equal(done, a.failures ? RESULT_NO_MEMORY : RESULT_OK);
        assert_int_equal(lines.count, a.failures ? 1 : 0);
        scene_free(made, &a.memory);
        assert_true(failing_allocator_is_clean(&a));
    }
    release(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_rooms_become_two_zones_joined_by_the_doors_portal),
        cmocka_unit_test(walls_keep_their_exact_planes),
        cmocka_unit_test(starts_are_places_and_the_views_of_a_path),
        cmocka_unit_test(lights_have_their_place_reach_and_colour),
        cmocka_unit_test(a_missing_polygon_is_seen_as_open_edges),
        cmocka_unit_test(a_t_junction_left_is_counted_and_opens_edges),
        cmocka_unit_test(real_maps_are_watertight_and_walls_lie_in_their_zones),
        cmocka_unit_test(every_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
