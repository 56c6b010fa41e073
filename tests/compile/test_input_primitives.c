// Primitives of JSON scenes as brushes: what is flat stays flat, what is parallel parallel, and no corner goes farther than
// the documents say, however the body is turned.
// SPDX-License-Identifier: MIT
#include "json_fixture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double DEGREE = 0.017453292519943295;

static uint64_t next_random(uint64_t *seed) // splitmix64
{
    uint64_t z = *seed += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}

static double between(uint64_t *seed, double low, double high)
{
    return low + (high - low) * (double)(next_random(seed) >> 11) / 9007199254740992.0;
}

static void random_vector(uint64_t *seed, double reach, double out[3])
{
    for (int k = 0; k < 3; ++k) out[k] = between(seed, -reach, reach);
}

static void turned(const double turn[3], const double at[3], const double p[3], double out[3]) // as documented: about x, then y, then z, then moved
{
    memcpy(out, p, 3 * sizeof *out);
    for (int axis = 0; axis < 3; ++axis) {
        const int i = (axis + 1) % 3, j = (axis + 2) % 3;
        const double c = cos(turn[axis] * DEGREE), s = sin(turn[axis] * DEGREE), a = out[i], b = out[j];
        out[i] = c * a - s * b;
        out[j] = s * a + c * b;
    }
    for (int k = 0; k < 3; ++k) out[k] += at[k];
}

static cull_wide_plane plane_of(const compile_input *in, uint32_t face)
{
    return plane_table_get(in->planes, in->faces[face].plane);
}

// ---- Boxes ----

static void a_box_is_the_six_planes_that_are_written(void **state)
{
    (void)state;
    compile_input *in = brush_of("{\"box\": {\"min\": [-1, 0.5, 2], \"max\": [3, 1.25, 4]}, \"material\": \"brick\"}");
    assert_int_equal(in->brushes[0].face_count, 6);
    const int32_t min[3] = {-8192, 4096, 16384}, max[3] = {24576, 10240, 32768};
    assert_memory_equal(in->brushes[0].min, min, sizeof min);
    assert_memory_equal(in->brushes[0].max, max, sizeof max);
    assert_int_equal(in->points_rounded, 0);
    assert_true(in->max_rounding == 0);
    assert_string_equal(in->materials[in->faces[0].material].name, "brick");
    compile_input_free(in);
}

static void quarter_turns_of_a_box_have_no_rounding(void **state)
{
    (void)state;
    compile_input *a = brush_of("{\"box\": {\"min\": [0, 0, 0], \"max\": [1, 2, 3]}, \"turn\": [90, 0, 0], \"at\": [5, 6, 7]}");
    compile_input *b = brush_of("{\"box\": {\"min\": [5, 3, 7], \"max\": [6, 6, 9]}}");
    assert_memory_equal(a->brushes[0].min, b->brushes[0].min, sizeof a->brushes[0].min);
    assert_memory_equal(a->brushes[0].max, b->brushes[0].max, sizeof a->brushes[0].max);
    assert_int_equal(a->points_rounded, 0);
    compile_input_free(a);
    compile_input_free(b);
}

static void a_turned_box_keeps_its_sides_parallel_and_moves_by_steps(void **state)
{
    (void)state;
    uint64_t seed = 7;
    double most = 0;
    for (int run = 0; run < 200; ++run) {
        const double size[3] = {20, 0.05, 3};
        double turn[3], at[3];
        random_vector(&seed, 180, turn);
        random_vector(&seed, 99, at);
        char entry[512];
        snprintf(entry, sizeof entry, "{\"box\": {\"min\": [0,0,0], \"max\": [20,0.05,3]}, \"turn\": [%.17g,%.17g,%.17g], \"at\": [%.17g,%.17g,%.17g]}", turn[0],
                 turn[1], turn[2], at[0], at[1], at[2]);
        compile_input *in = brush_of(entry);
        assert_int_equal(in->brushes[0].face_count, 6);
        for (uint32_t f = 0; f < 6; f += 2) {
            const cull_wide_plane low = plane_of(in, f), high = plane_of(in, f + 1);
            for (int k = 0; k < 3; ++k) assert_true(low.normal[k] == -high.normal[k]);
        }
        double ideal[8][3];
        for (int c = 0; c < 8; ++c) {
            const double p[3] = {c & 1 ? size[0] : 0, c & 2 ? size[1] : 0, c & 4 ? size[2] : 0};
            turned(turn, at, p, ideal[c]);
        }
        corner_list corners = corners_of(in, 0);
        assert_int_equal(corners.count, 8);
        const double apart = corners_apart(&corners, (const double(*)[3])ideal, 8);
        assert_true(fabs(apart / 256 - in->max_rounding * 1) < 1e-6); // told as it is, in units
        most = fmax(most, apart);
        free(corners.at);
        compile_input_free(in);
    }
    assert_true(most > 0 && most < 4.4); // steps: 2.5 in each coordinate
}

// ---- Cylinders and cones ----

static void an_upright_cylinder_has_two_rings_of_whole_points_one_above_the_other(void **state)
{
    (void)state;
    compile_input *in = brush_of("{\"cylinder\": {\"base\": [1, 0, 2], \"top\": [1, 3, 2], \"radius\": 0.7, \"segments\": 12}}");
    assert_int_equal(in->brushes[0].face_count, 14);
    corner_list corners = corners_of(in, 0);
    assert_int_equal(corners.count, 24);
    uint32_t above = 0;
    for (size_t i = 0; i < corners.count; ++i) {
        for (int k = 0; k < 3; ++k) assert_true(corners.at[i][k] * STEPS == nearbyint(corners.at[i][k] * STEPS));
        assert_true(corners.at[i][1] == 0 || corners.at[i][1] == 3);
        const double far = hypot(corners.at[i][0] - 1, corners.at[i][2] - 2) - 0.7;
        assert_true(fabs(far) * STEPS < 0.71);
        for (size_t j = 0; j < corners.count; ++j)
            above += corners.at[j][0] == corners.at[i][0] && corners.at[j][2] == corners.at[i][2] && corners.at[j][1] > corners.at[i][1];
    }
    assert_int_equal(above, 12);
    free(corners.at);
    compile_input_free(in);
}

static int64_t dot(const int64_t a[3], const int64_t b[3])
{
    __int128_t sum = 0;
    for (int k = 0; k < 3; ++k) sum += (__int128_t)a[k] * b[k];
    return sum == 0 ? 0 : sum > 0 ? 1 : -1;
}

// Corners of the ideal body: `segments` round the base, and round the top or only the apex. u as documented.
static size_t ideal_round(const double turn[3], const double at[3], const double axis[3], double radius, int segments, int is_cone, double (*out)[3])
{
    double a[3], u[3], v[3];
    int least = 0;
    const double length = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
    for (int k = 0; k < 3; ++k) a[k] = axis[k] / length;
    for (int k = 1; k < 3; ++k)
        if (fabs(a[k]) < fabs(a[least])) least = k;
    double width = 0;
    for (int k = 0; k < 3; ++k) {
        u[k] = (k == least) - a[least] * a[k];
        width += u[k] * u[k];
    }
    for (int k = 0; k < 3; ++k) u[k] /= sqrt(width);
    for (int k = 0; k < 3; ++k) v[k] = a[(k + 1) % 3] * u[(k + 2) % 3] - a[(k + 2) % 3] * u[(k + 1) % 3];
    size_t count = 0;
    for (int i = 0; i < segments; ++i) {
        const double angle = i * 360.0 / segments * DEGREE;
        for (int top = 0; top < (is_cone ? 1 : 2); ++top) {
            double p[3];
            for (int k = 0; k < 3; ++k) p[k] = radius * (cos(angle) * u[k] + sin(angle) * v[k]) + top * axis[k];
            turned(turn, at, p, out[count++]);
        }
    }
    if (is_cone) turned(turn, at, axis, out[count++]);
    return count;
}

static double round_body_checked(uint64_t *seed, int is_cone)
{
    double turn[3], at[3], axis[3];
    random_vector(seed, 180, turn);
    random_vector(seed, 99, at);
    random_vector(seed, 1, axis);
    axis[1] += 2;
    const double radius = between(seed, 0.3, 3);
    const int segments = 3 + (int)(next_random(seed) % 30);
    char entry[640];
    snprintf(entry, sizeof entry,
             "{\"%s\": {\"base\": [0,0,0], \"%s\": [%.17g,%.17g,%.17g], \"radius\": %.17g, \"segments\": %d}, \"turn\": [%.17g,%.17g,%.17g], \"at\": "
             "[%.17g,%.17g,%.17g]}",
             is_cone ? "cone" : "cylinder", is_cone ? "apex" : "top", axis[0], axis[1], axis[2], radius, segments, turn[0], turn[1], turn[2], at[0], at[1], at[2]);
    compile_input *in = brush_of(entry);
    assert_int_equal(in->brushes[0].face_count, segments + (is_cone ? 1 : 2));
    const cull_wide_plane base = plane_of(in, (uint32_t)segments);
    double apex[3];
    turned(turn, at, axis, apex);
    int32_t apex_steps[3];
    for (int k = 0; k < 3; ++k) apex_steps[k] = (int32_t)nearbyint(apex[k] * STEPS);
    for (uint32_t f = 0; f < (uint32_t)segments; ++f) {
        const cull_wide_plane side = plane_of(in, f);
        if (is_cone) assert_int_equal(cull_side_of_point(&side, apex_steps), 0);
        else assert_int_equal(dot(side.normal, base.normal), 0);
    }
    double ideal[80][3];
    const size_t count = ideal_round(turn, at, axis, radius, segments, is_cone, ideal);
    corner_list corners = corners_of(in, 0);
    assert_int_equal(corners.count, count);
    const double apart = corners_apart(&corners, (const double(*)[3])ideal, count);
    free(corners.at);
    compile_input_free(in);
    return apart;
}

static void tilted_cylinders_have_sides_along_their_axis_and_move_by_steps(void **state)
{
    (void)state;
    uint64_t seed = 3;
    double most = 0;
    for (int run = 0; run < 300; ++run) most = fmax(most, round_body_checked(&seed, 0));
    print_message("cylinders: corners move up to %.2f steps\n", most);
    assert_true(most < 3);
}

static void sides_of_tilted_cones_meet_in_their_apex_and_move_by_steps(void **state)
{
    (void)state;
    uint64_t seed = 4;
    double most = 0;
    for (int run = 0; run < 300; ++run) most = fmax(most, round_body_checked(&seed, 1));
    print_message("cones: corners move up to %.2f steps\n", most);
    assert_true(most < 6); // the base cuts slanting sides: a step aside is more along them
}

static void small_round_bodies_lose_corners_to_the_grid_but_not_their_shape(void **state)
{
    (void)state;
    for (int steps = 2; steps < 200; steps += 3) {
        char entry[256];
        snprintf(entry, sizeof entry, "{\"cylinder\": {\"base\": [0,0,0], \"top\": [0,1,0], \"radius\": %.17g, \"segments\": 128}}", steps / STEPS);
        compile_input *in = brush_of(entry);
        const uint32_t faces = in->brushes[0].face_count;
        assert_in_range(faces, 6, 130);
        corner_list corners = corners_of(in, 0); // every face keeps an area
        assert_int_equal(corners.count, 2 * (faces - 2));
        free(corners.at);
        compile_input_free(in);
    }
}

// ---- Hulls and half spaces ----

static void points_and_planes_of_one_body_make_the_same_brush(void **state)
{
    (void)state;
    compile_input *points = brush_of("{\"convex\": {\"points\": [[0,0,0],[1,0,0],[0,1,0],[0,0,1],[0.1,0.1,0.1],[0.5,0,0]]}}");
    compile_input *planes = brush_of("{\"convex\": {\"planes\": [{\"point\": [0,0,0], \"normal\": [-1,0,0]}, {\"point\": [0,0,0], \"normal\": [0,-2,0]},"
                                     " {\"point\": [5,0,0], \"normal\": [0,0,-0.5]}, {\"points\": [[1,0,0],[0,1,0],[0,0,1]]}]}}");
    assert_int_equal(points->brushes[0].face_count, 4);
    assert_int_equal(planes->brushes[0].face_count, 4);
    for (uint32_t f = 0; f < 4; ++f) {
        const cull_wide_plane a = plane_of(points, f);
        uint32_t same = 0;
        for (uint32_t g = 0; g < 4; ++g) {
            const cull_wide_plane b = plane_of(planes, g);
            same += cull_wide_plane_equal(&a, &b);
        }
        assert_int_equal(same, 1);
    }
    compile_input_free(points);
    compile_input_free(planes);
}

static void a_half_space_reaches_a_metre_beyond_all_other_brushes(void **state)
{
    (void)state;
    static const int32_t low[3] = {-8192, -8192 * 3, -8192}, high[3] = {8192 * 5, 8192, 8192 * 7};
    compile_input *in = brushes_of(HEAD "\"brushes\": [{\"plane\": {\"point\": [2, 1, 2], \"normal\": [0, 1, 0]}},\n"
                                        "{\"operation\": \"subtract\", \"box\": {\"min\": [0, -2, 0], \"max\": [4, 3, 6]}}]}", NULL);
    assert_int_equal(in->brush_count, 2);
    assert_memory_equal(in->brushes[0].min, low, sizeof low);
    assert_memory_equal(in->brushes[0].max, high, sizeof high);
    assert_int_equal(in->brushes[1].kind, BRUSH_SUBTRACT);
    compile_input_free(in);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_box_is_the_six_planes_that_are_written),
        cmocka_unit_test(quarter_turns_of_a_box_have_no_rounding),
        cmocka_unit_test(a_turned_box_keeps_its_sides_parallel_and_moves_by_steps),
        cmocka_unit_test(an_upright_cylinder_has_two_rings_of_whole_points_one_above_the_other),
        cmocka_unit_test(tilted_cylinders_have_sides_along_their_axis_and_move_by_steps),
        cmocka_unit_test(sides_of_tilted_cones_meet_in_their_apex_and_move_by_steps),
        cmocka_unit_test(small_round_bodies_lose_corners_to_the_grid_but_not_their_shape),
        cmocka_unit_test(points_and_planes_of_one_body_make_the_same_brush),
        cmocka_unit_test(a_half_space_reaches_a_metre_beyond_all_other_brushes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
