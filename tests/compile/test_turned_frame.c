// The frame of a map that was turned as a whole: its planes come back exactly, and no other map is taken for one.
// SPDX-License-Identifier: MIT
#include "input_fixture.h"

#include "tests/common/failing_allocator.h"
#include "tests/common/random.h"
#include "weld_rooms.h"

#include "host/compile/turned_frame.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { BOXES = 60, FACES = 6 * BOXES, POINTS = 3 * FACES, GRID = 256 };

typedef struct drawn { // points of boxes, and of those three a face
    double whole[POINTS][3];
    int32_t steps[POINTS][3];
} drawn;

typedef double rotation[3][3];

static void draw_boxes(uint64_t seed, int fraction, drawn *out)
{
    static const int corners[6][3] = {{0, 4, 6}, {1, 3, 7}, {0, 1, 5}, {2, 6, 7}, {0, 2, 3}, {4, 5, 7}};
    for (int b = 0; b < BOXES; ++b) {
        double low[3], high[3];
        for (int k = 0; k < 3; ++k) {
            low[k] = ((int)random_below(&seed, 64) - 32) * 16 + (double)random_below(&seed, (uint32_t)fraction) / fraction;
            high[k] = low[k] + 16 * (1 + (int)random_below(&seed, 8));
        }
        for (int f = 0; f < 6; ++f)
            for (int i = 0; i < 3; ++i)
                for (int k = 0; k < 3; ++k) out->whole[18 * b + 3 * f + i][k] = corners[f][i] >> k & 1 ? high[k] : low[k];
    }
}

typedef struct turn_options { double q[4], move[3], jitter; } turn_options; // units

static void rotation_of(const double q[4], rotation out)
{
    const double w = q[0], *v = q + 1, size = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            const double turned = i == j ? w * w - size : (j == (i + 2) % 3 ? 1 : -1) * 2 * w * v[3 - i - j];
            out[i][j] = (2 * v[i] * v[j] + turned) / (w * w + size);
        }
}

static void write_turned(const turn_options *o, drawn *d)
{
    uint64_t seed = 5;
    rotation turn;
    rotation_of(o->q, turn);
    for (int i = 0; i < POINTS; ++i)
        for (int k = 0; k < 3; ++k) {
            double at = o->move[k] + o->jitter * ((double)random_below(&seed, 2001) / 1000 - 1);
            for (int j = 0; j < 3; ++j) at += turn[k][j] * d->whole[i][j];
            d->steps[i][k] = (int32_t)nearbyint(at * GRID);
        }
}

static frame_verdict find(const drawn *d, turned_frame *out)
{
    frame_verdict verdict;
    assert_int_equal(turned_frame_find((const int32_t(*)[3])d->steps, POINTS, GRID, allocator_heap(), out, &verdict), RESULT_OK);
    return verdict;
}

static cull_wide_plane plane_of(const turned_frame *f, const drawn *d, int face)
{
    cull_wide_plane p;
    double move;
    const int32_t(*at)[3] = (const int32_t(*)[3])d->steps + 3 * face;
    assert_true(turned_frame_plane(f, at[0], at[1], at[2], &p, &move));
    assert_true(move < 2);
    for (int i = 0; i < 3; ++i) {
        double height = cull_wide_to_double(p.offset), length = 0;
        for (int k = 0; k < 3; ++k) {
            height += (double)p.normal[k] * at[i][k];
            length += (double)p.normal[k] * (double)p.normal[k];
        }
        assert_true(fabs(height) / sqrt(length) < 1.5); // steps
    }
    return p;
}

// Of which faces have the same plane as drawn, looking the same way or not.
static int are_coplanar(const drawn *d, int a, int b)
{
    for (int k = 0; k < 3; ++k) {
        int same = 1;
        for (int i = 0; i < 3; ++i) same &= d->whole[3 * a + i][k] == d->whole[3 * a][k] && d->whole[3 * b + i][k] == d->whole[3 * a][k];
        if (same) return 1;
    }
    return 0;
}

static int is_same_plane(cull_wide_plane a, cull_wide_plane b)
{
    const cull_wide_plane other = cull_wide_plane_flipped(b);
    return cull_wide_plane_equal(&a, &b) || cull_wide_plane_equal(&a, &other);
}

static void assert_planes_are_one_where_they_were(const turned_frame *f, const drawn *d)
{
    static cull_wide_plane planes[FACES];
    for (int i = 0; i < FACES; ++i) planes[i] = plane_of(f, d, i);
    for (int i = 0; i < FACES; ++i)
        for (int j = 0; j < i; ++j) assert_int_equal(is_same_plane(planes[i], planes[j]), are_coplanar(d, i, j));
}

static drawn turned_boxes(uint64_t seed, int fraction, const turn_options *o)
{
    static drawn d;
    draw_boxes(seed, fraction, &d);
    write_turned(o, &d);
    return d;
}

static void a_turn_by_a_small_rational_rotation_comes_back_exactly(void **state)
{
    (void)state;
    static const turn_options o = {{1, 2, 2, 4}, {0, 0, 0}, 0};
    for (uint64_t seed = 1; seed <= 5; ++seed) {
        const drawn d = turned_boxes(seed, 1, &o);
        turned_frame f;
        assert_int_equal(find(&d, &f), FRAME_FOUND);
        assert_int_equal(f.scale, 25);
        assert_int_equal(f.points_explained, POINTS);
        for (int k = 0; k < 3; ++k) assert_int_equal(f.shift[k], 0);
        assert_planes_are_one_where_they_were(&f, &d);
    }
}

static void a_turn_by_any_angle_about_any_axis_and_a_move_by_any_length_come_back(void **state)
{
    (void)state;
    static const turn_options turns[] = {
        {{0.9659258, 0, 0, 0.2588190}, {0, 0, 0}, 0}, // 30 degrees
        {{0.98, 0.11, -0.07, 0.2}, {100.37, -5.2, 0.113}, 0},
        {{0.31, -0.62, 0.74, 0.05}, {0.5, 0.25, -700}, 0},
        {{1, 0.001, 0, 0}, {0, 0, 0}, 0},
    };
    for (size_t i = 0; i < sizeof turns / sizeof *turns; ++i) {
        const drawn d = turned_boxes(7 + i, 1, &turns[i]);
        turned_frame f;
        assert_int_equal(find(&d, &f), FRAME_FOUND);
        assert_int_equal(f.points_explained, POINTS);
        assert_planes_are_one_where_they_were(&f, &d);
    }
}

static void a_map_drawn_on_parts_of_a_unit_comes_back_too(void **state)
{
    (void)state;
    static const turn_options o = {{2, 0, 0, 1}, {0, 0, 0}, 0};
    for (int fraction = 2; fraction <= 8; fraction *= 2) {
        const drawn d = turned_boxes(3, fraction, &o);
        turned_frame f;
        assert_int_equal(find(&d, &f), FRAME_FOUND);
        assert_int_equal(f.parts, fraction);
        assert_planes_are_one_where_they_were(&f, &d);
    }
}

static void a_map_that_stands_as_drawn_has_no_frame(void **state)
{
    (void)state;
    static const turn_options still = {{1, 0, 0, 0}, {0, 0, 0}, 0}, moved = {{1, 0, 0, 0}, {0.4, 0.1, 0.7}, 0}, quarter = {{1, 0, 1, 0}, {0.5, 0, 0}, 0};
    const turn_options *const all[] = {&still, &moved, &quarter};
    for (int fraction = 1; fraction <= 16; fraction *= 4)
        for (size_t i = 0; i < 3; ++i) {
            const drawn d = turned_boxes(11, fraction, all[i]);
            turned_frame f;
            assert_int_equal(find(&d, &f), FRAME_NONE);
        }
}

static void points_off_by_more_than_their_decimals_have_no_frame(void **state)
{
    (void)state;
    static const turn_options o = {{1, 2, 2, 4}, {0, 0, 0}, 0.02};
    const drawn d = turned_boxes(13, 1, &o);
    turned_frame f;
    assert_int_equal(find(&d, &f), FRAME_NONE);
}

static void a_face_that_does_not_fit_the_frame_keeps_its_plane(void **state)
{
    (void)state;
    static const turn_options o = {{1, 2, 2, 4}, {0, 0, 0}, 0};
    drawn d = turned_boxes(17, 1, &o);
    d.steps[4][1] += 20;
    turned_frame f;
    cull_wide_plane p;
    double move;
    assert_int_equal(find(&d, &f), FRAME_FOUND);
    assert_int_equal(f.points_explained, POINTS - 1);
    assert_false(turned_frame_plane(&f, d.steps[3], d.steps[4], d.steps[5], &p, &move));
    assert_true(turned_frame_plane(&f, d.steps[0], d.steps[1], d.steps[2], &p, &move));
}

static void points_off_the_grid_in_the_middle_do_not_hide_the_frame(void **state)
{
    (void)state;
    static const turn_options o = {{1, 2, 2, 4}, {0, 0, 0}, 0};
    drawn d = turned_boxes(31, 1, &o);
    double middle[3] = {0, 0, 0};
    for (int i = 0; i < POINTS; ++i)
        for (int k = 0; k < 3; ++k) middle[k] += (double)d.steps[i][k] / POINTS;
    uint32_t spoilt = 0;
    for (int i = 0; i < POINTS; ++i) {
        double far = 0;
        for (int k = 0; k < 3; ++k) far += pow(d.steps[i][k] - middle[k], 2);
        if (far > pow(96 * GRID, 2)) continue;
        d.steps[i][0] += i % 2 ? 40 : 90;
        spoilt++;
    }
    assert_true(spoilt > 0 && spoilt < POINTS / 17);
    turned_frame f;
    assert_int_equal(find(&d, &f), FRAME_FOUND);
    assert_int_equal(f.points_explained, POINTS - spoilt);
}

static void the_order_of_faces_does_not_matter(void **state)
{
    (void)state;
    static const turn_options o = {{0.98, 0.11, -0.07, 0.2}, {100.37, -5.2, 0.113}, 0};
    const drawn d = turned_boxes(19, 1, &o);
    static drawn other;
    for (int i = 0; i < FACES; ++i) memcpy(other.steps[3 * i], d.steps[3 * (FACES - 1 - i)], sizeof(int32_t[3][3]));
    turned_frame f, g;
    assert_int_equal(find(&d, &f), FRAME_FOUND);
    assert_int_equal(find(&other, &g), FRAME_FOUND);
    for (int i = 0; i < FACES; ++i) {
        const cull_wide_plane a = plane_of(&f, &d, i), b = plane_of(&g, &other, FACES - 1 - i);
        assert_true(cull_wide_plane_equal(&a, &b));
    }
}

static void points_at_the_end_of_the_grid_are_no_fault(void **state)
{
    (void)state;
    uint64_t seed = 23;
    static drawn d;
    for (int i = 0; i < POINTS; ++i)
        for (int k = 0; k < 3; ++k) d.steps[i][k] = (random_below(&seed, 2) ? 1 : -1) * (CULL_GRID_MOST - (int32_t)random_below(&seed, 3));
    turned_frame f;
    assert_int_equal(find(&d, &f), FRAME_NONE);
    static const turn_options o = {{1, 2, 2, 4}, {60000, -20000, 0}, 0};
    const drawn far = turned_boxes(29, 1, &o);
    assert_int_equal(find(&far, &f), FRAME_FOUND);
    assert_planes_are_one_where_they_were(&f, &far);
}

// A room's worth of boxes as a file: listed, within the tolerance, and without a leak of memory wherever it runs out.
static void a_turned_file_lists_its_changes_and_every_allocation_may_fail(void **state)
{
    (void)state;
    const rooms_options o = {3, 30, 0};
    rooms_map m = rooms_write(&o);
    uint32_t turns = 0;
    result done = RESULT_NO_MEMORY;
    for (uint64_t k = 1; done != RESULT_OK; k += 1 + k / 16) {
        failing_allocator a;
        failing_allocator_init(&a, k);
        report_lines lines;
        report_lines_init(&lines);
        compile_input *in = NULL;
        done = compile_input_map("rooms.map", m.text, m.size, NULL, &a.memory, &lines.report, &in);
        assert_int_equal(done, a.failures ? RESULT_NO_MEMORY : RESULT_OK);
        for (uint32_t i = 0; in && i < in->weld_moves; ++i) {
            turns += in->changes[i].kind == WELD_TURN;
            assert_true(in->changes[i].move <= 1.0 / 64);
        }
        compile_input_free(in);
        assert_true(failing_allocator_is_clean(&a));
    }
    assert_true(turns > 100);
    free(m.text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_turn_by_a_small_rational_rotation_comes_back_exactly),
        cmocka_unit_test(a_turn_by_any_angle_about_any_axis_and_a_move_by_any_length_come_back),
        cmocka_unit_test(a_map_drawn_on_parts_of_a_unit_comes_back_too),
        cmocka_unit_test(a_map_that_stands_as_drawn_has_no_frame),
        cmocka_unit_test(points_off_by_more_than_their_decimals_have_no_frame),
        cmocka_unit_test(a_face_that_does_not_fit_the_frame_keeps_its_plane),
        cmocka_unit_test(points_off_the_grid_in_the_middle_do_not_hide_the_frame),
        cmocka_unit_test(the_order_of_faces_does_not_matter),
        cmocka_unit_test(points_at_the_end_of_the_grid_are_no_fault),
        cmocka_unit_test(a_turned_file_lists_its_changes_and_every_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
