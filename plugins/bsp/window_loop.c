// See window_loop.h.
// SPDX-License-Identifier: MIT
#include "window_loop.h"

#include "pairs.h"

#include <portcullis/wide_integer.h>

#include <math.h>

double loop_area(const double *u, const double *v, uint32_t count)
{
    double twice = 0;
    for (uint32_t i = 2; i < count; i++) twice += (u[i - 1] - u[0]) * (v[i] - v[0]) - (v[i - 1] - v[0]) * (u[i] - u[0]);
    return twice / 2;
}

void loop_tidy(loop *l)
{
    uint32_t kept = 0, repeats = 0;
    for (uint32_t i = 0, before = l->count - 1; i < l->count; before = i++) repeats += l->u[i] == l->u[before] && l->v[i] == l->v[before];
    if (repeats == 0) return;
    const loop_point end = {l->u[l->count - 1], l->v[l->count - 1]};
    for (uint32_t i = 0; i < l->count; i++) {
        const loop_point last = kept ? (loop_point){l->u[kept - 1], l->v[kept - 1]} : end;
        if (l->u[i] == last.u && l->v[i] == last.v) continue;
        l->u[kept] = l->u[i];
        l->v[kept++] = l->v[i];
    }
    l->count = kept;
}

// ---- Turns, exactly ----

static int64_t steps_of(double x) // 2^-36 tangents; exact, below 2^50
{
    return (int64_t)(x * 68719476736.0);
}

static int turn_exactly(loop_point a, loop_point b, loop_point c)
{
    const int64_t bu = steps_of(b.u - a.u), bv = steps_of(b.v - a.v), cu = steps_of(c.u - a.u), cv = steps_of(c.v - a.v);
    return cull_wide_sign(cull_wide_subtract(cull_wide_product(bu, cv), cull_wide_product(bv, cu)));
}

// Differences are exact (multiples of 2^-36 below 2^14: 50 bits); each product is off by 2^-53 of itself and their difference by 2^-53
// of it: less than 2.01 * 2^-53 of both sizes, told as 4.5e-16.
static const double TURN_DOUBT = 4.5e-16;

int loop_turn(loop_point a, loop_point b, loop_point c)
{
    const double left = (b.u - a.u) * (c.v - a.v), right = (b.v - a.v) * (c.u - a.u), value = left - right;
    const double doubt = TURN_DOUBT * (fabs(left) + fabs(right));
    if (value > doubt) return 1;
    if (value < -doubt) return -1;
    return left == 0 && right == 0 ? 0 : turn_exactly(a, b, c);
}

// ---- Hulls, point by point ----

uint64_t loop_sides_out(const loop *l, loop_point p)
{
    const pair pu = pair_of(p.u), pv = pair_of(p.v), share = pair_of(TURN_DOUBT), zero = pair_of(0);
    const uint64_t all = pair_bits(l->count);
    uint64_t out = 0, doubts = 0;
    for (uint32_t i = 0; i < l->count; i += PAIR) {
        const pair u = pair_load(l->u + i), v = pair_load(l->v + i);
        const pair left = pair_mul(pair_subtract(pair_load(l->u + i + 1), u), pair_subtract(pv, v));
        const pair right = pair_mul(pair_subtract(pair_load(l->v + i + 1), v), pair_subtract(pu, u));
        const pair value = pair_subtract(left, right);
        out |= (uint64_t)pair_below(value, zero) << i;
        doubts |= (uint64_t)pair_at_most(pair_size(value), pair_mul(share, pair_add(pair_size(left), pair_size(right)))) << i;
    }
    for (doubts &= all; doubts; doubts &= doubts - 1) {
        const uint32_t i = pair_lowest(doubts);
        const uint64_t bit = (uint64_t)1 << i;
        out = loop_turn((loop_point){l->u[i], l->v[i]}, (loop_point){l->u[i + 1], l->v[i + 1]}, p) < 0 ? out | bit : out & ~bit;
    }
    return out & all;
}

static void corners_move(loop *l, uint32_t from, uint32_t count, uint32_t to)
{
    memmove(l->u + to, l->u + from, count * sizeof *l->u);
    memmove(l->v + to, l->v + from, count * sizeof *l->v);
}

// The corners between the edges that have the point outside, `first` up to before `end`, give way to it.
static void point_put(loop *l, uint32_t first, uint32_t end, loop_point p)
{
    uint32_t last = first, behind = 0; // corners up to `last` stay before it, `behind` more after it
    if (end > first) {
        behind = l->count - end;
        corners_move(l, end, behind, first + 2);
    } else if (end > 0) { // round the loop's seam
        last = first - end;
        corners_move(l, end, last + 1, 0);
    }
    l->u[last + 1] = p.u;
    l->v[last + 1] = p.v;
    l->count = last + 2 + behind;
    loop_close(l);
}

// ---- Hulls of sorted points ----

static int is_before(loop_point a, loop_point b)
{
    return a.u < b.u || (a.u == b.u && a.v < b.v);
}

static void points_add(const loop *l, loop_point *points, uint32_t *count)
{
    for (uint32_t i = 0; i < l->count; i++) {
        const loop_point p = {l->u[i], l->v[i]};
        uint32_t at = (*count)++;
        for (; at > 0 && is_before(p, points[at - 1]); at--) points[at] = points[at - 1];
        points[at] = p;
    }
}

// The corners that turn to `side` (1: left, the lower hull; -1: right, the upper hull); returns their count.
static uint32_t chain_bend(const loop_point *points, uint32_t count, int side, loop_point *out)
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < count; i++) {
        while (n >= 2 && loop_turn(out[n - 2], out[n - 1], points[i]) != side) n--;
        if (n == 1 && out[0].u == points[i].u && out[0].v == points[i].v) continue;
        out[n++] = points[i];
    }
    return n;
}

static void sorted_hull(loop *hull, const loop *more)
{
    loop_point points[2 * LOOP_MOST], lower[2 * LOOP_MOST], upper[2 * LOOP_MOST];
    uint32_t count = 0;
    points_add(hull, points, &count);
    points_add(more, points, &count);
    const uint32_t lower_count = chain_bend(points, count, 1, lower), upper_count = chain_bend(points, count, -1, upper);
    hull->count = 0;
    for (uint32_t i = 0; i < lower_count; i++) {
        hull->u[hull->count] = lower[i].u;
        hull->v[hull->count++] = lower[i].v;
    }
    for (uint32_t i = upper_count > 0 ? upper_count - 1 : 0; i-- > 1;) { // both ends stand in the lower one
        hull->u[hull->count] = upper[i].u;
        hull->v[hull->count++] = upper[i].v;
    }
}

int loop_hull(loop *hull, const loop *more)
{
    int changed = 0;
    for (uint32_t i = 0; i < more->count; i++) {
        const loop_point p = {more->u[i], more->v[i]};
        const int is_many = hull->count > 64;
        const uint64_t out = is_many ? 0 : loop_sides_out(hull, p);
        if (!out && !is_many) continue;
        const uint64_t before = is_many ? 0 : pair_turned(out, hull->count), enters = out & ~before;
        changed = 1;
        if (!enters || enters & (enters - 1)) { // one is bent by rounding
            sorted_hull(hull, more);
            loop_close(hull);
            return 1;
        }
        point_put(hull, pair_lowest(enters), pair_lowest(before & ~out), p);
    }
    return changed;
}
