// The views auto:edges:N: on portals and in planes of walls to the last bit, beside them by ulps, in no solid, the same each time.
// SPDX-License-Identifier: MIT
#include "maps.h"

#include "tests/common/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { VIEWS = 120 };
static const double EXACT_M = 1e-12;   // double's rounding of a height over a plane that is at no right angle, some 10 m from the origin
static const double ULPS_M = 1e-4;     // 4 steps of float a coordinate, some 100 m from the origin
static const double IN_PLACE_M = 1e-4; // from a hull that ends at the portal

static camera_path edges_of(stage *s, uint32_t count)
{
    char what[64];
    camera_path path;
    snprintf(what, sizeof what, "auto:edges:%u", count);
    if (camera_path_load(what, s->scene, 16.0 / 9, allocator_heap(), &s->lines.report, &path) != RESULT_OK)
        fail_msg("%s", report_lines_only(&s->lines));
    assert_int_equal(path.count, count);
    return path;
}

static double portal_height(const scene *s, const double eye[3]) // over the nearest portal's plane
{
    double least = INFINITY;
    for (uint32_t p = 0; p < s->portal_count; p++) {
        const double *plane = s->portals[p].plane, *at = s->portal_points[s->portals[p].first_point];
        double height = 0;
        for (int k = 0; k < 3; k++) height += plane[k] * (eye[k] - at[k]);
        least = fmin(least, fabs(height));
    }
    return least;
}

static double wall_height(const scene *s, const double eye[3]) // over the nearest plane of a triangle
{
    double least = INFINITY;
    for (uint32_t i = 0; i < s->index_count; i += 3) {
        double corner[3][3], normal[3], height = 0, length = 0;
        for (int c = 0; c < 3; c++) {
            const cull_vec3 p = s->positions[s->indices[i + (uint32_t)c]];
            const double at[3] = {(double)p.x, (double)p.y, (double)p.z};
            for (int k = 0; k < 3; k++) corner[c][k] = at[k] + s->whole.origin[k];
        }
        for (int k = 0; k < 3; k++) {
            const int u = (k + 1) % 3, v = (k + 2) % 3;
            normal[k] = (corner[1][u] - corner[0][u]) * (corner[2][v] - corner[0][v]) - (corner[1][v] - corner[0][v]) * (corner[2][u] - corner[0][u]);
            height += normal[k] * (eye[k] - corner[0][k]);
            length += normal[k] * normal[k];
        }
        if (length > 0) least = fmin(least, fabs(height) / sqrt(length));
    }
    return least;
}

static void expect_no_solid(const scene *s, const double eye[3])
{
    for (uint32_t i = 0; i < s->solid_count; i++) {
        const scene_solid *solid = &s->solids[i];
        double most = -INFINITY;
        if (solid->kind == SOLID_LIQUID) continue;
        for (uint32_t k = solid->first_plane; k < solid->first_plane + solid->plane_count; k++) {
            const double *n = s->solid_planes[k].normal;
            most = fmax(most, n[0] * eye[0] + n[1] * eye[1] + n[2] * eye[2] - s->solid_planes[k].distance);
        }
        assert_true(most > 0);
    }
}

static void expect_zone(const scene *s, const double eye[3])
{
    double least = INFINITY;
    for (uint32_t h = 0; h < s->hull_count; h++) least = fmin(least, scene_hull_height(s, h, eye));
    assert_true(least <= IN_PLACE_M);
}

static void check(stage *s)
{
    camera_path path = edges_of(s, VIEWS), again = edges_of(s, VIEWS);
    uint32_t on_portals = 0, exact = 0;
    assert_memory_equal(path.cameras, again.cameras, VIEWS * sizeof *path.cameras);
    for (uint32_t i = 0; i < VIEWS; i++) {
        const camera *c = &path.cameras[i];
        assert_null(camera_fault(c));
        const double over_portal = portal_height(s->scene, c->eye), over_wall = wall_height(s->scene, c->eye), over = fmin(over_portal, over_wall);
        assert_true(over <= ULPS_M);
        on_portals += over_portal <= ULPS_M;
        exact += over <= EXACT_M;
        expect_no_solid(s->scene, c->eye);
        expect_zone(s->scene, c->eye);
    }
    assert_true(on_portals >= VIEWS / 4);
    assert_true(exact >= VIEWS / 2);
    camera_path_free(&path, allocator_heap());
    camera_path_free(&again, allocator_heap());
}

static void in_a_maze_eyes_lie_on_portals_and_in_planes_of_walls(void **state)
{
    (void)state;
    static stage s;
    stage_make(&s, "maze", 10);
    check(&s);
    stage_free(&s);
}

static void in_a_compiled_cellar_eyes_lie_on_portals_and_in_planes_of_walls_and_in_no_solid(void **state)
{
    (void)state;
    static stage s;
    map_load_file(&s, CELLAR);
    assert_true(s.scene->solid_count > 0 && s.scene->portal_count > 0);
    check(&s);
    stage_free(&s);
}

static void counts_that_make_no_path_are_refused(void **state)
{
    (void)state;
    static const char *const wrong[] = {"auto:edges:", "auto:edges:0", "auto:edges:x", "auto:edges:100001", "auto:edges"};
    static stage s;
    stage_make(&s, "maze", 10);
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        camera_path path = {0};
        report_lines_init(&s.lines);
        assert_int_equal(camera_path_load(wrong[i], s.scene, 1, allocator_heap(), &s.lines.report, &path), RESULT_BAD_INPUT);
        assert_true(report_lines_is_one_with(&s.lines, "auto:edges:N"));
        assert_null(path.cameras);
    }
    stage_free(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(in_a_maze_eyes_lie_on_portals_and_in_planes_of_walls),
        cmocka_unit_test(in_a_compiled_cellar_eyes_lie_on_portals_and_in_planes_of_walls_and_in_no_solid),
        cmocka_unit_test(counts_that_make_no_path_are_refused),
    };
    return cmocka_run_group_tests_name("claims eyes", tests, NULL, NULL);
}
