// Places in JSON text, and shapes by points: against texts whose writer kept count, and against brute force.
// SPDX-License-Identifier: MIT
#include "json_support.h"

#include "host/import/json_place.h"
#include "host/import/json_polygon.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { TEXT_BYTES = 1 << 16, DEPTH = 6, ROUNDS = 300, VALUES_MOST = 4000 };

static uint32_t next(uint32_t *state, uint32_t below)
{
    *state = *state * 1664525u + 1013904223u;
    return (*state >> 8) % below;
}

// ---- Places ----

typedef struct written { json_step steps[DEPTH]; size_t count, offset; } written; // a value and where it was written

typedef struct writer {
    char text[TEXT_BYTES];
    size_t size;
    uint32_t state;
    json_step way[DEPTH];
    written values[VALUES_MOST];
    size_t value_count;
} writer;

static void put(writer *w, const char *text)
{
    const size_t length = strlen(text);
    memcpy(w->text + w->size, text, length + 1);
    w->size += length;
}

static void put_space(writer *w)
{
    static const char *const spaces[] = {"", "", " ", "\n", "\r\n", "\t", " \n  "};
    put(w, spaces[next(&w->state, sizeof spaces / sizeof *spaces)]);
}

static const char *const keys[] = {"a", "b\xc3\xbc", "c\"d", "e\\", "\xf0\x9f\x98\x80", "tab\there"}; // what they are
static const char *const written_keys[][2] = {{"\"a\"", "\"\\u0061\""}, {"\"b\xc3\xbc\"", "\"b\\u00FC\""}, {"\"c\\\"d\"", "\"c\\u0022d\""},
                                              {"\"e\\\\\"", "\"e\\u005c\""}, {"\"\xf0\x9f\x98\x80\"", "\"\\ud83d\\uDE00\""}, {"\"tab\\there\"", "\"tab\\u0009here\""}};

static void put_value(writer *w, size_t depth)
{
    static const char *const plain[] = {"1.5e3", "true", "null", "\"]}, \\\" \xc3\xa4\"", "\"\"", "-0"};
    if (w->value_count < VALUES_MOST) {
        written *v = &w->values[w->value_count++];
        memcpy(v->steps, w->way, sizeof v->steps);
        v->count = depth;
        v->offset = w->size;
    }
    const uint32_t kind = depth == DEPTH || w->size > TEXT_BYTES / 2 ? 0 : next(&w->state, 3) + (depth == 0);
    const uint32_t count = next(&w->state, 5);
    if (kind == 0) put(w, plain[next(&w->state, 6)]);
    else put(w, kind == 1 ? "{" : "[");
    for (uint32_t i = 0; kind && i < count; ++i) {
        if (i) put(w, ",");
        put_space(w);
        w->way[depth] = (json_step){kind == 1 ? keys[i] : NULL, i};
        if (kind == 1) {
            put(w, written_keys[i][next(&w->state, 2)]);
            put_space(w);
            put(w, ":");
            put_space(w);
        }
        put_value(w, depth + 1);
        put_space(w);
    }
    if (kind) put(w, kind == 1 ? "}" : "]");
}

static void every_value_is_found_where_it_was_written(void **state)
{
    (void)state;
    static writer w;
    size_t found = 0;
    for (uint32_t round = 0; round < ROUNDS; ++round) {
        w.size = w.value_count = 0;
        w.state = round;
        put_space(&w);
        put_value(&w, 0);
        for (size_t i = 0; i < w.value_count; ++i) {
            const json_place got = json_place_find(w.text, w.size, w.values[i].steps, w.values[i].count, PLACE_OF_VALUE);
            size_t line = 1, column = 1;
            for (size_t c = 0; c < w.values[i].offset; ++c) {
                column += (w.text[c] & 0xc0) != 0x80;
                if (w.text[c] == '\n') line++, column = 1;
            }
            assert_int_equal(got.line, line);
            assert_int_equal(got.column, column);
            found++;
        }
    }
    assert_true(found > 3000);
}

static void a_key_is_found_before_its_value(void **state)
{
    (void)state;
    static const char text[] = "{\"x\": {\n  \"y\" : 3}}";
    const json_step way[2] = {{"x", 0}, {"y", 0}};
    const json_place key = json_place_find(text, sizeof text - 1, way, 2, PLACE_OF_KEY), value = json_place_find(text, sizeof text - 1, way, 2, PLACE_OF_VALUE);
    assert_true(key.line == 2 && key.column == 3 && value.line == 2 && value.column == 9);
}

static void a_way_that_leads_nowhere_ends_at_what_is_there(void **state)
{
    (void)state;
    static const char text[] = "{\"x\": [1, 2]}";
    const json_step way[2] = {{"x", 0}, {NULL, 7}};
    const json_place p = json_place_find(text, sizeof text - 1, way, 2, PLACE_OF_VALUE);
    assert_true(p.line == 1 && p.column == 7);
    for (size_t size = 0; size < sizeof text; ++size) (void)json_place_find(text, size, way, 2, PLACE_OF_VALUE); // cut text is no trap
}

// ---- Shapes ----

static double height(const scene_solid_plane *p, const double *at)
{
    return p->normal[0] * at[0] + p->normal[1] * at[1] + p->normal[2] * at[2] - p->distance;
}

static void a_hull_holds_its_points_tightly(void **state)
{
    (void)state;
    uint32_t seed = 7;
    for (int round = 0; round < 60; ++round) {
        double points[24][3];
        const size_t count = 4 + next(&seed, 21);
        for (size_t i = 0; i < count; ++i)
            for (int k = 0; k < 3; ++k) points[i][k] = next(&seed, round % 2 ? 5 : 10000) / 8.0; // coarse ones have many flat quads
        scene_solid_plane planes[HULL_POINT_PLANES_MOST];
        uint32_t plane_count = 0;
        if (hull_planes_of_points((const double(*)[3])points, count, planes, &plane_count)) continue;
        for (uint32_t p = 0; p < plane_count; ++p) {
            int on = 0;
            for (size_t i = 0; i < count; ++i) {
                assert_true(height(&planes[p], points[i]) <= 1e-9);
                on += fabs(height(&planes[p], points[i])) < 1e-3;
            }
            assert_true(on >= 3);
            for (uint32_t q = 0; q < p; ++q) assert_true(fabs(planes[p].normal[0] - planes[q].normal[0]) + fabs(planes[p].normal[1] - planes[q].normal[1]) +
                                                             fabs(planes[p].normal[2] - planes[q].normal[2]) > 1e-7);
        }
        // Nothing outside of the points' box is inside, and each point lies on the surface or within.
        for (int probe = 0; probe < 100; ++probe) {
            double at[3], most = -INFINITY;
            for (int k = 0; k < 3; ++k) at[k] = (next(&seed, 4000) - 1000.0);
            int outside = 0;
            for (int k = 0; k < 3; ++k) {
                double low = INFINITY, high = -INFINITY;
                for (size_t i = 0; i < count; ++i) {
                    low = fmin(low, points[i][k]);
                    high = fmax(high, points[i][k]);
                }
                outside |= at[k] < low - 1 || at[k] > high + 1;
            }
            for (uint32_t p = 0; p < plane_count; ++p) most = fmax(most, height(&planes[p], at));
            if (outside) assert_true(most > 0);
        }
    }
}

static void a_cube_has_six_sides_also_with_points_on_its_faces(void **state)
{
    (void)state;
    const double points[11][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}, {0.5, 0.5, 1}, {0.5, 0, 0}, {0.5, 0.5, 0.5}};
    scene_solid_plane planes[HULL_POINT_PLANES_MOST];
    uint32_t count = 0;
    assert_null(hull_planes_of_points(points, 11, planes, &count));
    assert_int_equal(count, 6);
}

static void a_ball_of_64_points_is_a_hull_of_its_triangles(void **state)
{
    (void)state;
    double points[HULL_POINTS_MOST][3];
    for (int i = 0; i < HULL_POINTS_MOST; ++i) { // along a spiral, evenly spread
        const double y = 1 - (2 * i + 1.0) / HULL_POINTS_MOST, around = 2.399963229728653 * i, wide = sqrt(1 - y * y);
        points[i][0] = 5 * wide * cos(around);
        points[i][1] = 5 * y;
        points[i][2] = 5 * wide * sin(around);
    }
    scene_solid_plane planes[HULL_POINT_PLANES_MOST];
    uint32_t count = 0;
    assert_null(hull_planes_of_points((const double(*)[3])points, HULL_POINTS_MOST, planes, &count));
    assert_int_equal(count, 2 * HULL_POINTS_MOST - 4); // Euler
}

static void a_whole_move_of_points_keeps_their_normals(void **state)
{
    (void)state;
    const double points[5][3] = {{0, 0, 0}, {4, 0.5, 0}, {4, 0, 4}, {0, 0.25, 4}, {2, 3, 2}};
    double far[5][3];
    scene_solid_plane here[HULL_POINT_PLANES_MOST], there[HULL_POINT_PLANES_MOST];
    uint32_t count = 0, far_count = 0;
    for (int i = 0; i < 5; ++i)
        for (int k = 0; k < 3; ++k) far[i][k] = points[i][k] + 1e7;
    assert_null(hull_planes_of_points(points, 5, here, &count));
    assert_null(hull_planes_of_points((const double(*)[3])far, 5, there, &far_count));
    assert_int_equal(count, far_count);
    for (uint32_t p = 0; p < count; ++p) assert_memory_equal(here[p].normal, there[p].normal, sizeof here[p].normal);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_value_is_found_where_it_was_written),
        cmocka_unit_test(a_key_is_found_before_its_value),
        cmocka_unit_test(a_way_that_leads_nowhere_ends_at_what_is_there),
        cmocka_unit_test(a_hull_holds_its_points_tightly),
        cmocka_unit_test(a_cube_has_six_sides_also_with_points_on_its_faces),
        cmocka_unit_test(a_ball_of_64_points_is_a_hull_of_its_triangles),
        cmocka_unit_test(a_whole_move_of_points_keeps_their_normals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
