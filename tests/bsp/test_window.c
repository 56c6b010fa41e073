// Windows on the picture plane: cuts, hulls and joins lose no point, and turns are exact.
// SPDX-License-Identifier: MIT
#include "plugins/bsp/window.h"
#include "plugins/bsp/window_loop.h"

#include "tests/common/random.h"
#include "tests/common/test.h"

#include <math.h>
#include <string.h>

__extension__ typedef __int128 int128;

static const double STEP = 1 / 68719476736.0; // 2^-36

static void random_rectangle(uint64_t *random, window *w)
{
    const double u = random_between(random, -1, 1), v = random_between(random, -1, 1);
    const window_bounds b = {u, u + random_between(random, 0.001, 1), v, v + random_between(random, 0.001, 1)};
    window_set_rectangle(b, w);
}

static window_line random_line(uint64_t *random)
{
    const double angle = random_between(random, 0, 6.283185307179586);
    const window_line l = {cos(angle), sin(angle), random_between(random, -0.5, 1.5)};
    return l;
}

static void random_window(uint64_t *random, window *w)
{
    do {
        window_line lines[8];
        window whole;
        random_rectangle(random, &whole);
        const uint32_t count = random_below(random, 9);
        for (uint32_t i = 0; i < count; i++) {
            const double u = random_between(random, whole.bounds.u0, whole.bounds.u1), v = random_between(random, whole.bounds.v0, whole.bounds.v1);
            lines[i] = random_line(random);
            lines[i].c = 0.1 - (lines[i].a * u + lines[i].b * v);
        }
        const window_fate fate = window_cut(&whole, lines, count, w);
        if (fate == WINDOW_GONE) continue;
        if (fate == WINDOW_SAME) window_copy(&whole, w);
        return;
    } while (1);
}

static double line_at(window_line l, double u, double v)
{
    return l.a * u + l.b * v + l.c;
}

// In all edges, give or take.
static int holds(const window *w, double u, double v, double give)
{
    window_line lines[WINDOW_POINTS];
    window_edges(w, lines);
    for (uint32_t i = 0; i < w->count; i++)
        if (line_at(lines[i], u, v) < -give * hypot(lines[i].a, lines[i].b)) return 0;
    return 1;
}

static int is_on_grid(const window *w)
{
    for (uint32_t i = 0; i < w->count; i++)
        if (w->u[i] / STEP != rint(w->u[i] / STEP) || w->v[i] / STEP != rint(w->v[i] / STEP)) return 0;
    return 1;
}

static int bounds_fit(const window *w)
{
    double u0 = 1e9, u1 = -1e9, v0 = 1e9, v1 = -1e9;
    for (uint32_t i = 0; i < w->count; i++) u0 = fmin(u0, w->u[i]), u1 = fmax(u1, w->u[i]), v0 = fmin(v0, w->v[i]), v1 = fmax(v1, w->v[i]);
    return u0 == w->bounds.u0 && u1 == w->bounds.u1 && v0 == w->bounds.v0 && v1 == w->bounds.v1;
}

// ---- Tests ----

static void a_rectangle_is_rounded_outward(void **state)
{
    uint64_t random = 1;
    (void)state;
    for (int i = 0; i < 1000; i++) {
        const window_bounds b = {random_between(&random, -2, 0), random_between(&random, 0, 2), random_between(&random, -2, 0), random_between(&random, 0, 2)};
        window w;
        window_set_rectangle(b, &w);
        assert_true(window_bounds_contain(w.bounds, b) && is_on_grid(&w) && bounds_fit(&w));
        assert_true(window_area(&w) > 0 && window_area(&w) < (b.u1 - b.u0) * (b.v1 - b.v0) + 1e-9);
    }
}

static void a_cut_keeps_what_is_inside_and_drops_what_is_outside(void **state)
{
    uint64_t random = 2;
    uint32_t cut = 0, gone = 0;
    (void)state;
    for (int i = 0; i < 20000; i++) {
        window w, out;
        random_window(&random, &w);
        const window_line line = random_line(&random);
        const window_fate fate = window_cut(&w, &line, 1, &out);
        const window *left = fate == WINDOW_SAME ? &w : &out;
        cut += fate == WINDOW_FEWER;
        gone += fate == WINDOW_GONE;
        assert_int_not_equal(fate, WINDOW_GREW);
        if (fate == WINDOW_FEWER) assert_true(is_on_grid(&out) && bounds_fit(&out) && window_area(&out) > 0 && window_area(&out) <= window_area(&w));
        for (int k = 0; k < 20; k++) {
            const double u = random_between(&random, w.bounds.u0, w.bounds.u1), v = random_between(&random, w.bounds.v0, w.bounds.v1);
            const int in = holds(&w, u, v, -1e-9) && line_at(line, u, v) > 1e-9;
            const int out_of = !holds(&w, u, v, 1e-9) || line_at(line, u, v) < -1e-9;
            if (in) assert_true(fate != WINDOW_GONE && holds(left, u, v, 0));
            if (out_of && fate != WINDOW_GONE) assert_false(holds(left, u, v, 0));
        }
    }
    assert_true(cut > 2000 && gone > 1000);
}

static void a_line_that_is_no_number_cuts_nothing(void **state)
{
    const window_line lines[] = {{NAN, 0, 0}, {0, NAN, 1}, {1, 0, NAN}};
    window w, out;
    (void)state;
    window_set_rectangle((window_bounds){-1, 1, -1, 1}, &w);
    for (int i = 0; i < 3; i++) assert_int_equal(window_cut(&w, &lines[i], 1, &out), WINDOW_SAME);
}

static void triangle_set(window *w, const double u[3], const double v[3])
{
    window_bounds b = {1e9, -1e9, 1e9, -1e9};
    for (int i = 0; i < 3; i++) {
        w->u[i] = rint(u[i] / STEP) * STEP, w->v[i] = rint(v[i] / STEP) * STEP;
        b = window_bounds_union(b, (window_bounds){w->u[i], w->u[i], w->v[i], w->v[i]});
    }
    w->count = 3;
    w->bounds = b;
}

static void neighbours_cut_by_one_line_share_its_point_on_their_common_edge(void **state)
{
    uint64_t random = 3;
    uint32_t found = 0;
    (void)state;
    for (int i = 0; i < 5000; i++) {
        const double p = random_between(&random, -1, -0.1), q = random_between(&random, 0.1, 1); // their edge runs from (0, p) to (x, q)
        const double x = random_between(&random, -0.05, 0.05), u[2][3] = {{0, 0.7, x}, {x, -0.9, 0}}, v[2][3] = {{p, 0.1, q}, {q, 0.2, p}};
        const window_line line = {random_between(&random, -0.3, 0.3), i % 2 ? 1 : -1, random_between(&random, -0.05, 0.05)};
        window w[2], out[2];
        for (int k = 0; k < 2; k++) {
            triangle_set(&w[k], u[k], v[k]);
            if (window_cut(&w[k], &line, 1, &out[k]) != WINDOW_FEWER) out[k].count = 0;
        }
        uint32_t shared = 0;
        for (uint32_t a = 0; a < out[0].count; a++)
            for (uint32_t b = 0; b < out[1].count; b++) shared += out[0].u[a] == out[1].u[b] && out[0].v[a] == out[1].v[b];
        if (out[0].count && out[1].count) assert_true(shared == 2);
        found += shared == 2;
    }
    assert_true(found > 4000);
}

static void too_many_corners_become_the_rectangle(void **state)
{
    window w, out;
    window_line lines[48];
    (void)state;
    window_set_rectangle((window_bounds){-2, 2, -2, 2}, &w);
    for (int i = 0; i < 48; i++) lines[i] = (window_line){cos(i * 6.283185307179586 / 48), sin(i * 6.283185307179586 / 48), 1};
    assert_int_equal(window_cut(&w, lines, 48, &out), WINDOW_GREW);
    assert_int_equal(out.count, 4);
    for (int i = 0; i < 360; i++) assert_true(holds(&out, 0.999 * cos(i * 0.0174533), 0.999 * sin(i * 0.0174533), 0));
    for (uint32_t count = 20; count <= 32; count += 12) {
        for (uint32_t i = 0; i < count; i++) lines[i] = (window_line){cos(i * 6.283185307179586 / count), sin(i * 6.283185307179586 / count), 1};
        assert_int_equal(window_cut(&w, lines, count, &out), WINDOW_FEWER);
        assert_int_equal(out.count, count);
    }
}

static int turn_in_integers(loop_point a, loop_point b, loop_point c)
{
    const int64_t bu = (int64_t)((b.u - a.u) / STEP), bv = (int64_t)((b.v - a.v) / STEP), cu = (int64_t)((c.u - a.u) / STEP), cv = (int64_t)((c.v - a.v) / STEP);
    const int128 value = (int128)bu * cv - (int128)bv * cu;
    return (value > 0) - (value < 0);
}

static void turns_are_exact_on_points_all_but_on_one_line(void **state)
{
    uint64_t random = 4;
    uint32_t zeros = 0;
    (void)state;
    for (int i = 0; i < 200000; i++) {
        const double reach = i % 3 == 0 ? 4000 : 2;
        loop_point p[3];
        for (int k = 0; k < 2; k++) p[k] = (loop_point){rint(random_between(&random, -reach, reach) / STEP) * STEP, rint(random_between(&random, -reach, reach) / STEP) * STEP};
        if (i % 5 == 0) p[1].u = p[0].u;
        const double t = (double)random_below(&random, 9) / 4;
        p[2] = (loop_point){rint((p[0].u + t * (p[1].u - p[0].u)) / STEP) * STEP, rint((p[0].v + t * (p[1].v - p[0].v)) / STEP) * STEP};
        p[2].v += STEP * ((double)random_below(&random, 3) - 1);
        const int turn = loop_turn(p[0], p[1], p[2]);
        zeros += turn == 0;
        assert_int_equal(turn, turn_in_integers(p[0], p[1], p[2]));
    }
    assert_true(zeros > 5000);
}

static void check_hull(const window *a, const window *b, const window *hull)
{
    const window *parts[2] = {a, b};
    for (uint32_t i = 0; i < hull->count; i++) {
        const uint32_t k = i + 1 < hull->count ? i + 1 : 0;
        const loop_point p = {hull->u[i], hull->v[i]}, q = {hull->u[k], hull->v[k]};
        int is_corner = 0;
        for (int part = 0; part < 2; part++)
            for (uint32_t j = 0; j < parts[part]->count; j++) {
                const loop_point c = {parts[part]->u[j], parts[part]->v[j]};
                is_corner |= c.u == p.u && c.v == p.v;
                if (loop_turn(p, q, c) < 0) assert_true(holds(hull, c.u, c.v, 4 * STEP)); // the parts themselves are bent by rounding
            }
        assert_true(is_corner);
    }
    assert_true(bounds_fit(hull));
}

static void a_hull_holds_both_and_has_only_their_corners(void **state)
{
    uint64_t random = 5;
    uint32_t same = 0, grew = 0;
    (void)state;
    for (int i = 0; i < 20000; i++) {
        window a, b, hull;
        random_window(&random, &a);
        random_window(&random, &b);
        const window_fate fate = window_hull(&a, &b, &hull);
        same += fate == WINDOW_SAME;
        grew += fate == WINDOW_GREW;
        if (fate == WINDOW_SAME) assert_true(window_contains(&a, &b));
        if (fate == WINDOW_FEWER) check_hull(&a, &b, &hull);
    }
    assert_true(same > 50);
    assert_int_equal(grew, 0);
}

// A hull that took points as equal by a tolerance lost the picture's upper border to corners 2^-36 beside it.
static void corners_a_step_beside_an_upright_border_stay_in_the_hull(void **state)
{
    (void)state;
    for (int i = -2; i <= 2; i++)
        for (int k = -2; k <= 2; k++) {
            window a = {.count = 3}, b = {.count = 3}, hull;
            const double au[3] = {-1, 0, -1 + i * STEP}, av[3] = {-0.5, 0, 0.25}, bu[3] = {-1 + k * STEP, 0.25, -1}, bv[3] = {0.25, 0, 0.5};
            memcpy(a.u, au, sizeof au), memcpy(a.v, av, sizeof av), memcpy(b.u, bu, sizeof bu), memcpy(b.v, bv, sizeof bv);
            a.bounds = (window_bounds){fmin(-1, au[2]), 0, -0.5, 0.25};
            b.bounds = (window_bounds){fmin(-1, bu[0]), 0.25, 0, 0.5};
            assert_int_equal(window_hull(&a, &b, &hull), WINDOW_FEWER);
            check_hull(&a, &b, &hull);
            assert_true(hull.bounds.v0 == -0.5 && hull.bounds.v1 == 0.5);
        }
}

static void halves_join_and_windows_apart_do_not(void **state)
{
    uint64_t random = 6;
    uint32_t joined = 0;
    (void)state;
    for (int i = 0; i < 5000; i++) {
        window w, one, two, both, far_off;
        random_window(&random, &w);
        const double u = (w.bounds.u0 + w.bounds.u1) / 2, v = (w.bounds.v0 + w.bounds.v1) / 2;
        window_line line = random_line(&random);
        line.c = 1e-5 - (line.a * u + line.b * v); // both moved out, as openings are
        const window_line turned = {-line.a, -line.b, 2e-5 - line.c};
        if (window_cut(&w, &line, 1, &one) != WINDOW_FEWER || window_cut(&w, &turned, 1, &two) != WINDOW_FEWER) continue;
        assert_true(window_join(&one, &two, 1.0 / 2048, &both));
        joined++;
        assert_true(fabs(window_area(&both) - window_area(&w)) < 1e-3 * window_area(&w));
        const double aside = (w.bounds.u1 - w.bounds.u0) * 1.2;
        window_copy(&w, &far_off);
        for (uint32_t k = 0; k < w.count; k++) far_off.u[k] += rint(aside / STEP) * STEP;
        far_off.bounds.u0 += rint(aside / STEP) * STEP;
        far_off.bounds.u1 += rint(aside / STEP) * STEP;
        assert_false(window_join(&w, &far_off, 1.0 / 2048, &both));
    }
    assert_true(joined > 3000);
}

// Beside a square stands a lower rectangle: the hull wastes the triangle above it, (1 - h) / 2 of (3 + h) / 2.
static void windows_join_as_long_as_their_hull_wastes_no_more_than_is_to_spare(void **state)
{
    uint64_t random = 7;
    uint32_t joined = 0, apart = 0;
    (void)state;
    for (int i = 0; i < 5000; i++) {
        const double spare = random_between(&random, 0.001, 0.2), h = random_between(&random, 0.3, 1), over = random_between(&random, 0, 0.2);
        const double waste = (1 - h) / (3 + h);
        window square, low, both;
        window_set_rectangle((window_bounds){0, 1, 0, 1}, &square);
        window_set_rectangle((window_bounds){1 - over, 2, 0, h}, &low); // what overlaps is counted once
        if (fabs(waste - spare) < 1e-6) continue;
        const int is_joined = i % 2 ? window_join(&square, &low, spare, &both) : window_join(&low, &square, spare, &both);
        assert_int_equal(is_joined, waste < spare);
        if (is_joined) check_hull(&square, &low, &both);
        joined += is_joined != 0;
        apart += is_joined == 0;
    }
    assert_true(joined > 500 && apart > 500);
}

static void edges_that_have_a_point_outside_are_those_that_turn_away_from_it(void **state)
{
    uint64_t random = 8;
    uint32_t told = 0;
    (void)state;
    for (int i = 0; i < 20000; i++) {
        window w;
        loop l = {.count = 0};
        random_window(&random, &w);
        l.count = w.count;
        memcpy(l.u, w.u, w.count * sizeof *w.u), memcpy(l.v, w.v, w.count * sizeof *w.v);
        loop_close(&l);
        const uint32_t at = random_below(&random, w.count);
        const double along = i % 3 ? random_between(&random, -1, 2) : 0; // on an edge's line, give or take a step, or at a corner
        const loop_point p = {rint((l.u[at] + along * (l.u[at + 1] - l.u[at])) / STEP) * STEP, rint((l.v[at] + along * (l.v[at + 1] - l.v[at])) / STEP) * STEP};
        const uint64_t out = loop_sides_out(&l, p);
        for (uint32_t k = 0; k < l.count; k++) {
            const int turn = loop_turn((loop_point){l.u[k], l.v[k]}, (loop_point){l.u[k + 1], l.v[k + 1]}, p);
            assert_int_equal(out >> k & 1, turn < 0);
            told += turn < 0;
        }
        assert_int_equal(out >> l.count, 0);
    }
    assert_true(told > 5000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_rectangle_is_rounded_outward),
        cmocka_unit_test(a_cut_keeps_what_is_inside_and_drops_what_is_outside),
        cmocka_unit_test(a_line_that_is_no_number_cuts_nothing),
        cmocka_unit_test(neighbours_cut_by_one_line_share_its_point_on_their_common_edge),
        cmocka_unit_test(too_many_corners_become_the_rectangle),
        cmocka_unit_test(turns_are_exact_on_points_all_but_on_one_line),
        cmocka_unit_test(a_hull_holds_both_and_has_only_their_corners),
        cmocka_unit_test(corners_a_step_beside_an_upright_border_stay_in_the_hull),
        cmocka_unit_test(halves_join_and_windows_apart_do_not),
        cmocka_unit_test(windows_join_as_long_as_their_hull_wastes_no_more_than_is_to_spare),
        cmocka_unit_test(edges_that_have_a_point_outside_are_those_that_turn_away_from_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
