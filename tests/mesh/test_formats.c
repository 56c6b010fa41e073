// .ply, .off and .stl: every form of one mesh gives one scene, and every refusal names its place.
// SPDX-License-Identifier: MIT
#include "fixture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// A torus of quads with a hexagonal lid beside it; all coordinates are multiples of 1/64 m, exact in float too.
enum { RING = 24, TUBE = 12, POINTS = RING * TUBE + 6, FACES = RING * TUBE + 1 };

typedef struct model {
    double points[POINTS][3];
    int sizes[FACES];
    uint32_t corners[FACES][6];
} model;

static double on_grid(double x)
{
    return nearbyint(x * 64) / 64;
}

static void make_model(model *m)
{
    const double turn = 6.283185307179586;
    for (int i = 0; i < RING; ++i)
        for (int k = 0; k < TUBE; ++k) {
            const double a = turn * i / RING, b = turn * k / TUBE, radius = 5 + 2 * cos(b);
            double *p = m->points[i * TUBE + k];
            p[0] = on_grid(radius * cos(a));
            p[1] = on_grid(2 * sin(b));
            p[2] = on_grid(radius * sin(a));
            const int face = i * TUBE + k, i1 = (i + 1) % RING, k1 = (k + 1) % TUBE;
            const int loop[4] = {i * TUBE + k, i * TUBE + k1, i1 * TUBE + k1, i1 * TUBE + k};
            m->sizes[face] = 4;
            for (int c = 0; c < 4; ++c) m->corners[face][c] = (uint32_t)loop[c];
        }
    m->sizes[FACES - 1] = 6;
    for (int c = 0; c < 6; ++c) {
        double *p = m->points[RING * TUBE + c];
        p[0] = on_grid(12 + cos(turn * c / 6));
        p[1] = 0;
        p[2] = on_grid(sin(turn * c / 6));
        m->corners[FACES - 1][c] = (uint32_t)(RING * TUBE + c);
    }
}

typedef struct writer {
    char bytes[1 << 17];
    size_t used;
} writer;

__attribute__((format(printf, 2, 3))) static void write_text(writer *w, const char *format, ...)
{
    va_list values;
    va_start(values, format);
    w->used += (size_t)vsnprintf(w->bytes + w->used, sizeof w->bytes - w->used, format, values);
    va_end(values);
    assert_true(w->used < sizeof w->bytes);
}

typedef enum byte_order { LITTLE, BIG } byte_order;

static void write_bits(writer *w, uint64_t bits, size_t size, byte_order order)
{
    for (size_t i = 0; i < size; ++i) w->bytes[w->used++] = (char)(bits >> (8 * (order == LITTLE ? i : size - 1 - i)));
}

static void write_double(writer *w, double value, byte_order order)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    write_bits(w, bits, 8, order);
}

static void write_float(writer *w, double value, byte_order order)
{
    const float single = (float)value;
    uint32_t bits;
    memcpy(&bits, &single, sizeof bits);
    write_bits(w, bits, 4, order);
}

static void write_obj(writer *w, const model *m)
{
    for (int i = 0; i < POINTS; ++i) write_text(w, "v %.17g %.17g %.17g\n", m->points[i][0], m->points[i][1], m->points[i][2]);
    for (int f = 0; f < FACES; ++f) {
        write_text(w, "f");
        for (int c = 0; c < m->sizes[f]; ++c) write_text(w, " %u", m->corners[f][c] + 1);
        write_text(w, "\n");
    }
}

static void write_off(writer *w, const model *m, const char *head, const char *vertex_tail, const char *face_tail)
{
    write_text(w, "%s", head);
    for (int i = 0; i < POINTS; ++i) write_text(w, "%.17g  %.17g\t%.17g%s\n", m->points[i][0], m->points[i][1], m->points[i][2], vertex_tail);
    for (int f = 0; f < FACES; ++f) {
        write_text(w, "%d", m->sizes[f]);
        for (int c = 0; c < m->sizes[f]; ++c) write_text(w, " %u", m->corners[f][c]);
        write_text(w, "%s\n", face_tail);
    }
}

static void write_ply_ascii(writer *w, const model *m)
{
    write_text(w, "ply\nformat ascii 1.0\ncomment C:\\made\\by\\\nelement vertex %d\nproperty float x\nproperty double y\nproperty float32 z\nproperty uchar red\n", POINTS);
    write_text(w, "element face %d\nproperty list uchar int vertex_index\nproperty list int float weights\nelement edge 1\nproperty int a\nend_header\n", FACES);
    for (int i = 0; i < POINTS; ++i) write_text(w, "%.17g %.17g %.17g 255\n", m->points[i][0], m->points[i][1], m->points[i][2]);
    for (int f = 0; f < FACES; ++f) {
        write_text(w, "%d", m->sizes[f]);
        for (int c = 0; c < m->sizes[f]; ++c) write_text(w, " %u", m->corners[f][c]);
        write_text(w, " 2 0.5 1e3\n");
    }
    write_text(w, "7\n");
}

// Faces first, types of every size, values to skip between those that count.
static void write_ply_binary(writer *w, const model *m, byte_order order)
{
    write_text(w, "ply\r\nformat binary_%s_endian 1.0\r\nobj_info none\r\n", order == LITTLE ? "little" : "big");
    write_text(w, "element face %d\r\nproperty short mark\r\nproperty list ushort uint vertex_indices\r\n", FACES);
    write_text(w, "element nothing 4000000000\r\nelement stamp 2\r\nproperty list char double times\r\n");
    write_text(w, "element vertex %d\r\nproperty double z\r\nproperty int8 c\r\nproperty float x\r\nproperty float64 y\r\nend_header\n", POINTS);
    for (int f = 0; f < FACES; ++f) {
        write_bits(w, 0xffff, 2, order);
        write_bits(w, (uint64_t)m->sizes[f], 2, order);
        for (int c = 0; c < m->sizes[f]; ++c) write_bits(w, m->corners[f][c], 4, order);
    }
    for (uint64_t i = 0; i < 2; ++i) {
        write_bits(w, i, 1, order);
        for (uint64_t k = 0; k < i; ++k) write_double(w, NAN, order); // skipped, so it may be anything
    }
    for (int i = 0; i < POINTS; ++i) {
        write_double(w, m->points[i][2], order);
        write_bits(w, 0x80, 1, order);
        write_float(w, m->points[i][0], order);
        write_double(w, m->points[i][1], order);
    }
}

static scene *import_written(const char *path, const writer *w)
{
    captured c;
    scene *s = NULL;
    captured_open(&c);
    const result done = import_bytes(path, w->bytes, w->used, allocator_heap(), &c.report, &s);
    assert_string_equal(c.text, "");
    assert_int_equal(done, RESULT_OK);
    assert_clusters_are_sound(s);
    return s;
}

static void assert_written_same(const char *path, const writer *w, const scene *expected)
{
    scene *s = import_written(path, w);
    assert_same_geometry(expected, s);
    remove_scene(s);
}

static void every_format_of_one_mesh_gives_one_scene(void **state)
{
    static model m;
    static writer w;
    (void)state;
    make_model(&m);
    w.used = 0;
    write_obj(&w, &m);
    scene *obj = import_written("a.obj", &w);
    assert_int_equal(obj->polygon_count, FACES);
    assert_int_equal(obj->index_count, 3 * (2 * RING * TUBE + 4));
    assert_true(obj->item_count > 1);
    w.used = 0;
    write_ply_ascii(&w, &m);
    assert_written_same("a.ply", &w, obj);
    for (int order = LITTLE; order <= BIG; ++order) {
        w.used = 0;
        write_ply_binary(&w, &m, (byte_order)order);
        assert_written_same("a.ply", &w, obj);
    }
    static const char *const heads[][3] = {{"OFF\n%d %d 0\n", "", ""},
                                           {"OFF %d %d 0\n", " ", " 255 0 0"},
                                           {"# first\nCOFF # second\n# third\n%d %d # no edges\n", " 1 0 0 1", " # red"},
                                           {"STCNOFF\r\n%d %d 5\r\n\r\n", " 0 0 1 1 0 0 1 0 0\r", " 0.5 0.5 0.5 1\r"}};
    for (size_t i = 0; i < sizeof heads / sizeof *heads; ++i) {
        char head[128];
        w.used = 0;
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wformat-nonliteral"
        snprintf(head, sizeof head, heads[i][0], POINTS, FACES);
#pragma GCC diagnostic pop
        write_off(&w, &m, head, heads[i][1], heads[i][2]);
        assert_written_same("a.off", &w, obj);
    }
    remove_scene(obj);
}

// Two tetrahedra's worth of triangles: positions float-exact, so .stl loses nothing.
static const double TETRA[4][3] = {{0, 0, 0}, {2, 0, 0}, {0, 2.5, 0}, {0.25, 0, 2}};
static const int SIDES[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};

static void write_stl_ascii(writer *w)
{
    write_text(w, "solid tetra\n");
    for (int f = 0; f < 4; ++f) {
        write_text(w, " facet normal 0 0 0\n  outer loop\n");
        for (int c = 0; c < 3; ++c) write_text(w, "   vertex %g %g %g\n", TETRA[SIDES[f][c]][0], TETRA[SIDES[f][c]][1], TETRA[SIDES[f][c]][2]);
        write_text(w, "  endloop\n endfacet\n");
    }
    write_text(w, "endsolid tetra\n");
}

static void write_stl_binary(writer *w)
{
    memset(w->bytes, 's', 80);
    w->used = 80;
    write_bits(w, 4, 4, LITTLE);
    for (int f = 0; f < 4; ++f) {
        write_bits(w, 0, 8, LITTLE);
        write_bits(w, 0, 4, LITTLE);
        for (int c = 0; c < 9; ++c) write_float(w, TETRA[SIDES[f][c / 3]][c % 3], LITTLE);
        write_bits(w, 0, 2, LITTLE);
    }
}

static void both_kinds_of_stl_give_the_scene_of_the_obj(void **state)
{
    static writer w;
    (void)state;
    if (!has_openmesh()) return;
    scene *obj = import_good("a.obj", "v 0 0 0\nv 2 0 0\nv 0 2.5 0\nv 0.25 0 2\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
    assert_int_equal(obj->items[0].flags, 0); // welded: closed
    w.used = 0;
    write_stl_ascii(&w);
    assert_written_same("a.stl", &w, obj);
    w.used = 0;
    write_stl_binary(&w);
    assert_written_same("a.stl", &w, obj);
    remove_scene(obj);
}

static void an_ascii_stl_in_capitals_is_read(void **state)
{
    static writer w;
    (void)state;
    if (!has_openmesh()) return;
    write_stl_ascii(&w);
    scene *small = import_written("a.stl", &w);
    for (size_t i = 0; i < w.used; ++i)
        if (w.bytes[i] >= 'a' && w.bytes[i] <= 'z') w.bytes[i] = (char)(w.bytes[i] - 'a' + 'A');
    assert_non_null(strstr(w.bytes, "OUTER LOOP"));
    assert_written_same("a.stl", &w, small);
    remove_scene(small);
}

static void bytes_behind_a_binary_stl_are_left_out_with_a_warning(void **state)
{
    static writer w;
    captured c;
    scene *s = NULL;
    (void)state;
    if (!has_openmesh()) return;
    write_stl_binary(&w);
    scene *exact = import_written("a.stl", &w);
    captured_open(&c);
    assert_int_equal(import_bytes("a.stl", w.bytes, w.used + 7, allocator_heap(), &c.report, &s), RESULT_OK);
    assert_string_equal(c.text, "a.stl: warning: 7 bytes behind the last triangle that it counts are left out\n");
    assert_same_geometry(exact, s);
    remove_scene(exact);
    remove_scene(s);
}

static void stl_faults_are_told_with_their_place(void **state)
{
    static writer w;
    captured c;
    scene *s = NULL;
    (void)state;
    if (!has_openmesh()) return;
    assert_refused("a.stl", "", "a.stl:1: error: neither begins with solid");
    assert_refused("a.stl", "solid a\nendsolid a\n", "a.stl: error: no facets");
    assert_refused("a.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 nan\n", "a.stl:5: error: vertex: a coordinate is not a finite");
    assert_refused("a.stl", "solid a\nouter loop\nvertex 0 0 0\nvertex 1 0\n", "a.stl:4: error: vertex has 2 of 3");
    assert_refused("a.stl", "solid a\nouter loop\nvertex 0 0 0\n", "a.stl:4: error: not the vertex");
    w.used = 0;
    write_stl_binary(&w);
    const size_t size = w.used;
    w.used = 84 + 12 + 16;
    write_float(&w, INFINITY, LITTLE);
    captured_open(&c);
    assert_int_equal(import_bytes("a.stl", w.bytes, size, allocator_heap(), &c.report, &s), RESULT_BAD_INPUT);
    assert_string_equal(c.text, "a.stl: error: at byte 112: a coordinate is not a finite number; write three finite numbers\n");
    captured_open(&c);
    assert_int_equal(import_bytes("a.stl", w.bytes, size - 1, allocator_heap(), &c.report, &s), RESULT_BAD_INPUT);
    assert_non_null(strstr(c.text, "is the file whole?"));
    assert_null(s);
}

static void off_faults_are_told_with_their_line(void **state)
{
#define TRIANGLE "0 0 0\n1 0 0\n0 1 0\n"
    static const struct { const char *text, *line; } faults[] = {
        {"", "a.off:1: error: does not begin with OFF"},
        {"ply\n", "a.off:1: error: does not begin with OFF"},
        {"4OFF\n", "a.off:1: error: a mesh of other than 3 dimensions"},
        {"OFF BINARY\n", "a.off:1: error: a binary .off"},
        {"OFF\nthree 1 0\n", "a.off:2: error: no counts"},
        {"OFF\n-3 1 0\n", "a.off:2: error: no counts"},
        {"OFF\n3 0 0\n" TRIANGLE, "a.off:2: error: no faces"},
        {"OFF\n4000000000 1 0\n" TRIANGLE, "a.off:2: error: counts that a file of this size cannot hold"},
        {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 nan\n3 0 1 2\n", "a.off:5: error: vertex: a coordinate is not a finite number"},
        {"OFF\n3 1 0\n0 0 0\n1 0\n0 1 0\n3 0 1 2\n", "a.off:4: error: vertex has 2 of 3"},
        {"OFF\n3 1 0\n" TRIANGLE "3 0 1 3\n", "a.off:6: error: a vertex index is out of range"},
        {"OFF\n3 1 0\n" TRIANGLE "3 0 1 -1\n", "a.off:6: error: a vertex index is out of range"},
        {"OFF\n3 1 0\n" TRIANGLE "2 0 1\n", "a.off:6: error: a face of fewer than 3 corners"},
        {"OFF\n3 1 0\n" TRIANGLE "3 0 1\n", "a.off:6: error: a face has fewer corners than it says"},
        {"OFF\n3 1 0\n" TRIANGLE "70000 0 1\n", "a.off:6: error: a face of over 65535 corners"},
        {"OFF\n3 2 0\n" TRIANGLE "3 0 1 2\n", "a.off:7: error: the file ends before its last face"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof faults / sizeof *faults; ++i) assert_refused("a.off", faults[i].text, faults[i].line);
}

static void ply_faults_are_told_with_their_line(void **state)
{
#define HEAD "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
    static const struct { const char *text, *line; } faults[] = {
        {"", "a.ply:1: error: does not begin with ply"},
        {"ply\n", "a.ply:2: error: the header has no end_header"},
        {"ply\nend_header\n", "a.ply:2: error: no format line"},
        {"ply\nformat ebcdic 1.0\n", "a.ply:2: error: format: not ascii"},
        {"ply\nelement vertex\n", "a.ply:2: error: element: no count"},
        {"ply\nelement vertex 99999999999\n", "a.ply:2: error: element: no count"},
        {"ply\nproperty float x\n", "a.ply:2: error: property before any element"},
        {"ply\nelement vertex 3\nproperty real x\n", "a.ply:3: error: property: not a type"},
        {"ply\nelement vertex 3\nproperty float\n", "a.ply:3: error: property without a name"},
        {"ply\nelement face 3\nproperty list float int vertex_indices\n", "a.ply:3: error: property list: its count"},
        {"ply\nelement face 3\nproperty list uchar float vertex_indices\n", "a.ply:3: error: vertex_indices are no integers"},
        {"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nend_header\n", "a.ply:6: error: the vertex element has not"},
        {"ply\nformat ascii 1.0\nelement face 3\nproperty int i\nend_header\n", "a.ply:6: error: the face element has not"},
        {"ply\nwhatever\n", "a.ply:2: error: not a word of a .ply header"},
        {HEAD TRIANGLE, "a.ply:13: error: the file ends before its last element"},
        {HEAD "0 0 0\n1 0 inf\n0 1 0\n3 0 1 2\n", "a.ply:11: error: not a finite number"},
        {HEAD "0 0 0\n1 0 1e10\n0 1 0\n3 0 1 2\n", "a.ply:11: error: a coordinate lies beyond 1e9 m"},
        {HEAD "0 0 0\n1 0 one\n0 1 0\n3 0 1 2\n", "a.ply:11: error: not a number"},
        {HEAD TRIANGLE "3 0 1 3\n", "a.ply:13: error: a vertex index is out of range"},
        {HEAD TRIANGLE "3 0 1 -1\n", "a.ply:13: error: a vertex index is out of range"},
        {HEAD TRIANGLE "3 0 1 1.5\n", "a.ply:13: error: a vertex index is out of range"},
        {HEAD TRIANGLE "2 0 1\n", "a.ply:13: error: a face of fewer than 3 corners"},
        {HEAD TRIANGLE "4e53 0 1\n", "a.ply:13: error: a list's length is no integer"},
        {HEAD TRIANGLE "-3 0 1\n", "a.ply:13: error: a list's length is no integer"},
        {HEAD TRIANGLE "3.5 0 1\n", "a.ply:13: error: a list's length is no integer"},
        {HEAD TRIANGLE "70000 0 1\n", "a.ply:13: error: a face of over 65535 corners"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof faults / sizeof *faults; ++i) assert_refused("a.ply", faults[i].text, faults[i].line);
}

static void binary_ply_faults_are_told_with_their_byte(void **state)
{
    static model m;
    static writer w;
    captured c;
    scene *s = NULL;
    (void)state;
    make_model(&m);
    write_ply_binary(&w, &m, LITTLE);
    const size_t head = (size_t)(strstr(w.bytes, "end_header\n") - w.bytes) + 11;
    for (size_t cut = w.used - 1; cut > head; cut -= cut > head + 97 ? 97 : 1) {
        captured_open(&c);
        assert_int_equal(import_bytes("a.ply", w.bytes, cut, allocator_heap(), &c.report, &s), RESULT_BAD_INPUT);
        assert_memory_equal(c.text, "a.ply: error: at byte ", 22);
        assert_null(s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_format_of_one_mesh_gives_one_scene),
        cmocka_unit_test(both_kinds_of_stl_give_the_scene_of_the_obj),
        cmocka_unit_test(an_ascii_stl_in_capitals_is_read),
        cmocka_unit_test(bytes_behind_a_binary_stl_are_left_out_with_a_warning),
        cmocka_unit_test(stl_faults_are_told_with_their_place),
        cmocka_unit_test(off_faults_are_told_with_their_line),
        cmocka_unit_test(ply_faults_are_told_with_their_line),
        cmocka_unit_test(binary_ply_faults_are_told_with_their_byte),
    };
    return cmocka_run_group_tests_name("formats", tests, NULL, NULL);
}
