// The bridge: whatever meets at an edge or a point, no polygon is lost, turned or moved, and neighbours agree.
// SPDX-License-Identifier: MIT
#include "fixture.h"

#include "host/mesh/mesh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct subject {
    double positions[4096][3];
    uint32_t corners[16384], polygon_first[8192];
    mesh_input in;
    mesh_output out;
    arena memory;
} subject;

static uint32_t point(subject *s, double x, double y, double z)
{
    const double p[3] = {x, y, z};
    memcpy(s->positions[s->in.position_count], p, sizeof p);
    return s->in.position_count++;
}

static void polygon(subject *s, uint32_t count, const uint32_t *corners)
{
    const uint32_t first = s->polygon_first[s->in.polygon_count];
    memcpy(s->corners + first, corners, count * sizeof *corners);
    s->polygon_first[++s->in.polygon_count] = first + count;
}

static void triangle(subject *s, uint32_t a, uint32_t b, uint32_t c)
{
    const uint32_t corners[3] = {a, b, c};
    polygon(s, 3, corners);
}

static void cube(subject *s, double x, double y, double z)
{
    static const uint32_t sides[6][4] = {{3, 2, 1, 0}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
    uint32_t v[8];
    for (uint32_t i = 0; i < 8; ++i) v[i] = point(s, x + ((i + 1) / 2 % 2), y + (i / 2 % 2), z + (i / 4));
    for (int f = 0; f < 6; ++f) {
        const uint32_t loop[4] = {v[sides[f][0]], v[sides[f][1]], v[sides[f][2]], v[sides[f][3]]};
        polygon(s, 4, loop);
    }
}

static subject *subject_open(void)
{
    subject *s = calloc(1, sizeof *s);
    assert_non_null(s);
    s->memory = arena_make(allocator_heap());
    return s;
}

static void subject_close(subject *s)
{
    arena_free(&s->memory);
    free(s);
}

static const double *out_corner(const subject *s, uint32_t corner)
{
    assert_true(s->out.corners[corner] < s->out.position_count);
    return s->out.positions + 3 * (size_t)s->out.corners[corner];
}

// Does q have an edge from b to a that names p as its neighbour?
static int runs_back(const subject *s, uint32_t q, uint32_t p, const double *a, const double *b)
{
    const uint32_t first = s->polygon_first[q], end = s->polygon_first[q + 1];
    for (uint32_t c = first; c < end; ++c) {
        const uint32_t next = c + 1 < end ? c + 1 : first;
        if (s->out.corner_neighbours[c] == p && memcmp(out_corner(s, c), b, 3 * sizeof *b) == 0 && memcmp(out_corner(s, next), a, 3 * sizeof *a) == 0) return 1;
    }
    return 0;
}

// What must hold of any input.
static void repair(subject *s)
{
    s->in.positions = s->positions[0];
    s->in.corners = s->corners;
    s->in.polygon_first = s->polygon_first;
    assert_int_equal(mesh_repair(&s->in, &s->memory, &s->out), RESULT_OK);
    uint32_t boundary = 0;
    for (uint32_t p = 0; p < s->in.polygon_count; ++p) {
        const uint32_t first = s->polygon_first[p], end = s->polygon_first[p + 1];
        for (uint32_t c = first; c < end; ++c) {
            const double *at = out_corner(s, c), *next = out_corner(s, c + 1 < end ? c + 1 : first);
            for (int k = 0; k < 3; ++k) assert_true(at[k] == s->positions[s->corners[c]][k]);
            const uint32_t q = s->out.corner_neighbours[c];
            boundary += q == MESH_NO_NEIGHBOUR;
            if (q == MESH_NO_NEIGHBOUR) continue;
            assert_true(q < s->in.polygon_count);
            assert_true(runs_back(s, q, p, at, next));
        }
    }
    assert_int_equal(boundary, s->out.boundary_edges);
    for (uint32_t v = 0; v < s->out.position_count; ++v) {
        const float *n = s->out.normals + 3 * (size_t)v;
        const double length = sqrt((double)n[0] * n[0] + (double)n[1] * n[1] + (double)n[2] * n[2]);
        assert_true(length == 0 || fabs(length - 1) < 1e-6);
    }
}

static void a_cube_is_closed_and_its_creases_are_sharp(void **state)
{
    (void)state;
    if (!has_openmesh()) return;
    subject *s = subject_open();
    cube(s, 0, 0, 0);
    repair(s);
    assert_int_equal(s->out.boundary_edges, 0);
    assert_int_equal(s->out.cut_vertices, 0);
    assert_int_equal(s->out.position_count, 24);
    for (uint32_t c = 0; c < 24; ++c) { // outward, along the axis of its side
        const double *at = out_corner(s, c);
        const float *n = s->out.normals + 3 * (size_t)s->out.corners[c];
        double out = 0;
        for (int k = 0; k < 3; ++k) out += (double)n[k] * (at[k] - 0.5);
        assert_true(fabs(out - 0.5) < 1e-6);
    }
    subject_close(s);
}

static void equal_positions_are_welded(void **state)
{
    (void)state;
    if (!has_openmesh()) return;
    subject *s = subject_open();
    for (uint32_t i = 0; i < 4; ++i) { // four triangles of a flat square, all corners written anew, with both zeros
        const double x = i == 0 || i == 3 ? 1 : -1, y = i < 2 ? 1 : -1, x2 = i < 2 ? -1 : 1, y2 = i == 0 || i == 3 ? 1 : -1;
        const uint32_t centre = point(s, i % 2 ? -0.0 : 0.0, i > 1 ? -0.0 : 0.0, 0), a = point(s, x, y, -0.0), b = point(s, x2, y2, 0);
        triangle(s, centre, a, b);
    }
    repair(s);
    assert_int_equal(s->out.position_count, 5);
    assert_int_equal(s->out.boundary_edges, 4);
    subject_close(s);
}

static void a_sphere_is_smooth(void **state)
{
    enum { RINGS = 24, SIDES = 48 };
    (void)state;
    if (!has_openmesh()) return;
    subject *s = subject_open();
    const double half_turn = 3.141592653589793;
    for (int i = 0; i <= RINGS; ++i)
        for (int k = 0; k < (i == 0 || i == RINGS ? 1 : SIDES); ++k) {
            const double a = half_turn * i / RINGS, b = 2 * half_turn * k / SIDES;
            point(s, sin(a) * cos(b), cos(a), sin(a) * sin(b));
        }
    const uint32_t last = s->in.position_count - 1;
    for (uint32_t k = 0; k < SIDES; ++k) {
        const uint32_t k1 = (k + 1) % SIDES;
        triangle(s, 0, 1 + k1, 1 + k);
        for (uint32_t i = 0; i + 2 < RINGS; ++i) {
            const uint32_t loop[4] = {1 + i * SIDES + k, 1 + i * SIDES + k1, 1 + (i + 1) * SIDES + k1, 1 + (i + 1) * SIDES + k};
            polygon(s, 4, loop);
        }
        triangle(s, last, last - SIDES + k, last - SIDES + k1);
    }
    repair(s);
    assert_int_equal(s->out.boundary_edges, 0);
    assert_int_equal(s->out.position_count, s->in.position_count);
    for (uint32_t v = 0; v < s->out.position_count; ++v) {
        double along = 0;
        for (int k = 0; k < 3; ++k) along += s->out.positions[3 * (size_t)v + (size_t)k] * (double)s->out.normals[3 * (size_t)v + (size_t)k];
        assert_true(along > 0.999);
    }
    subject_close(s);
}

static void three_faces_on_an_edge_are_all_kept(void **state)
{
    subject *s = subject_open();
    (void)state;
    const uint32_t a = point(s, 0, 0, 0), b = point(s, 0, 1, 0);
    triangle(s, a, b, point(s, 1, 0, 0));
    triangle(s, b, a, point(s, -1, 0, 1));
    triangle(s, a, b, point(s, -1, 0, -1));
    repair(s);
    subject_close(s);
}

static void cubes_that_touch_along_an_edge_or_at_a_point_stay_closed(void **state)
{
    (void)state;
    if (!has_openmesh()) return;
    subject *s = subject_open();
    cube(s, 0, 0, 0);
    cube(s, 1, 1, 0); // an edge
    cube(s, -1, -1, -1); // a point
    repair(s);
    assert_int_equal(s->out.boundary_edges, 0);
    assert_int_equal(s->out.apart_polygons, 0);
    assert_int_equal(s->out.cut_vertices, 3);
    subject_close(s);
}

static void a_bow_tie_point_gets_a_vertex_for_each_fan(void **state)
{
    (void)state;
    if (!has_openmesh()) return;
    subject *s = subject_open();
    const uint32_t middle = point(s, 0, 0, 0);
    triangle(s, middle, point(s, 1, 0, 0), point(s, 1, 1, 0));
    triangle(s, middle, point(s, -1, 0, 0), point(s, -1, -1, 0));
    repair(s);
    assert_int_equal(s->out.cut_vertices, 1);
    assert_int_equal(s->out.position_count, 6);
    subject_close(s);
}

static void faces_turned_against_each_other_are_all_kept(void **state)
{
    subject *s = subject_open();
    (void)state;
    const uint32_t a = point(s, 0, 0, 0), b = point(s, 1, 0, 0), c = point(s, 1, 1, 0), d = point(s, 0, 1, 0);
    triangle(s, a, b, c);
    triangle(s, a, d, c); // runs along a-c the same way
    repair(s);
    assert_int_equal(s->out.boundary_edges, 6);
    subject_close(s);
}

static void faces_written_twice_or_turned_over_are_all_kept(void **state)
{
    subject *s = subject_open();
    (void)state;
    const uint32_t a = point(s, 0, 0, 0), b = point(s, 1, 0, 0), c = point(s, 1, 1, 0), d = point(s, 0, 1, 0);
    const uint32_t square[4] = {a, b, c, d}, back[4] = {d, c, b, a};
    for (int i = 0; i < 3; ++i) polygon(s, 4, square);
    for (int i = 0; i < 2; ++i) polygon(s, 4, back);
    repair(s);
    subject_close(s);
}

static void a_polygon_that_touches_itself_is_set_apart(void **state)
{
    (void)state;
    if (!has_openmesh()) return;
    subject *s = subject_open();
    const uint32_t a = point(s, 0, 0, 0), b = point(s, 4, 0, 0), c = point(s, 4, 4, 0), d = point(s, 1, 1, 0), e = point(s, 2, 1, 0), f = point(s, 2, 2, 0);
    const uint32_t slit[9] = {a, b, c, a, d, f, e, d, a}, spike[5] = {a, b, b, c, b};
    polygon(s, 9, slit);
    polygon(s, 5, spike);
    triangle(s, b, a, c);
    repair(s);
    assert_int_equal(s->out.apart_polygons, 2);
    subject_close(s);
}

static void a_point_of_thousands_of_faces_keeps_them_all(void **state)
{
    enum { BLADES = 4000 };
    subject *s = subject_open();
    (void)state;
    const uint32_t middle = point(s, 0, 0, 0);
    for (uint32_t i = 0; i < BLADES; ++i) point(s, cos(6.283185307179586 * i / BLADES), sin(6.283185307179586 * i / BLADES), 0);
    for (uint32_t i = 0; i < BLADES; ++i) triangle(s, middle, 1 + i, 1 + (i + 1) % BLADES);
    repair(s);
    subject_close(s);
}

// Soups of faces between a few points: every kind of edge and point at once.
static void random_soups_keep_every_face(void **state)
{
    uint64_t random = 4;
    (void)state;
    for (uint32_t round = 0; round < 400; ++round) {
        subject *s = subject_open();
        const uint32_t points = 4 + (uint32_t)(random_bits(&random) % 12), faces = 1 + (uint32_t)(random_bits(&random) % 120);
        for (uint32_t i = 0; i < points; ++i) {
            const double x = (double)(random_bits(&random) % 3), y = (double)(random_bits(&random) % 3), z = (double)(random_bits(&random) % 3);
            point(s, x, y, z);
        }
        for (uint32_t f = 0; f < faces; ++f) {
            uint32_t loop[6];
            const uint32_t count = 3 + (uint32_t)(random_bits(&random) % 4);
            for (uint32_t c = 0; c < count; ++c) loop[c] = (uint32_t)(random_bits(&random) % points);
            polygon(s, count, loop);
        }
        repair(s);
        subject_close(s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_cube_is_closed_and_its_creases_are_sharp),
        cmocka_unit_test(equal_positions_are_welded),
        cmocka_unit_test(a_sphere_is_smooth),
        cmocka_unit_test(three_faces_on_an_edge_are_all_kept),
        cmocka_unit_test(cubes_that_touch_along_an_edge_or_at_a_point_stay_closed),
        cmocka_unit_test(a_bow_tie_point_gets_a_vertex_for_each_fan),
        cmocka_unit_test(faces_turned_against_each_other_are_all_kept),
        cmocka_unit_test(faces_written_twice_or_turned_over_are_all_kept),
        cmocka_unit_test(a_polygon_that_touches_itself_is_set_apart),
        cmocka_unit_test(a_point_of_thousands_of_faces_keeps_them_all),
        cmocka_unit_test(random_soups_keep_every_face),
    };
    return cmocka_run_group_tests_name("repair", tests, NULL, NULL);
}
