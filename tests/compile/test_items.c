// The last stage of the compiler: triangles, walls, zones by hulls, doors, and the checks that watch over it all.
// SPDX-License-Identifier: MIT
#include "input_fixture.h"
#include "tests/common/failing_allocator.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct compiled { // of one map
    compile_input *in;
    compiled_zones *zones;
    scene *scene;
    compile_checks checks;
    report_lines lines;
} compiled;

static void take_zones(compiled *c, compile_input *in, portal_choice portals)
{
    compile_mesh *mesh = NULL;
    csg_counts counts;
    *c = (compiled){.in = in};
    report_lines_init(&c->lines);
    assert_int_equal(compile_csg(in, &c->lines.report, allocator_heap(), &mesh, &counts), RESULT_OK);
    assert_int_equal(compile_zones(in, mesh, portals, &c->lines.report, allocator_heap(), &c->zones), RESULT_OK);
}

static void take_items(compiled *c)
{
    assert_int_equal(compile_items(c->in, c->zones, &c->lines.report, allocator_heap(), &c->scene, &c->checks), RESULT_OK);
}

static void release(compiled *c)
{
    scene_free(c->scene, allocator_heap());
    compiled_zones_free(c->zones);
    compile_input_free(c->in);
}

// Two rooms of 8 m x 8 m x 4 m side by side, a door of 2 m x 3 m in the wall between them that opens upwards.
static void write_two_rooms(map_writer *w)
{
    static const double boxes[][2][3] = {{{-16, -16, -16}, {544, 272, 0}}, {{-16, -16, 128}, {544, 272, 144}}, {{-16, -16, 0}, {544, 0, 128}},
                                         {{-16, 256, 0}, {544, 272, 128}}, {{-16, 0, 0}, {0, 256, 128}},       {{528, 0, 0}, {544, 256, 128}},
                                         {{256, 0, 0}, {272, 96, 128}},    {{256, 160, 0}, {272, 256, 128}},   {{256, 96, 96}, {272, 160, 128}}};
    static const double door[2][3] = {{256, 96, 0}, {272, 160, 96}};
    w->size = 0;
    open_entity(w, "worldspawn");
    for (size_t i = 0; i < sizeof boxes / sizeof *boxes; ++i) write_box(w, boxes[i][0], boxes[i][1], "wall");
    close_entity(w);
    open_entity(w, "func_door");
    write_text(w, "\"angle\" \"-1\"\n");
    write_box(w, door[0], door[1], "gate");
    close_entity(w);
    open_entity(w, "info_player_start");
    write_text(w, "\"origin\" \"64 64 32\"\n");
    close_entity(w);
    open_entity(w, "light");
    write_text(w, "\"origin\" \"400 64 64\"\n\"light\" \"160\"\n");
    close_entity(w);
}

static void expect_sound(const compiled *c)
{
    assert_int_equal(c->checks.open_edges, 0);
    assert_int_equal(c->checks.t_junctions_left, 0);
    assert_int_equal(c->checks.degenerate_triangles, 0);
    assert_int_equal(c->scene->item_count + c->scene->mover_count, c->checks.items);
    assert_int_equal(c->scene->stray_items, 0);
}

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
        cmocka_unit_test(a_missing_polygon_is_seen_as_open_edges),
        cmocka_unit_test(a_t_junction_left_is_counted_and_opens_edges),
        cmocka_unit_test(real_maps_are_watertight_and_walls_lie_in_their_zones),
        cmocka_unit_test(every_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
