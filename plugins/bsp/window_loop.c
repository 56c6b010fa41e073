// See window_loop.h.
// SPDX-License-Identifier: MIT
#include "window_loop.h"

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

typedef struct sides { uint8_t out[LOOP_MOST]; uint32_t count, entries, first; } sides; // of a point: edges that have it outside

// entries: how often, round the loop, an edge that has it outside follows one that has not.
static void sides_find(const loop *l, loop_point p, sides *s)
{
    uint32_t doubts = 0;
    s->count = s->entries = s->first = 0;
    for (uint32_t i = 0; i < l->count; i++) {
        const uint32_t k = i + 1 < l->count ? i + 1 : 0;
        const double left = (l->u[k] - l->u[i]) * (p.v - l->v[i]), right = (l->v[k] - l->v[i]) * (p.u - l->u[i]), value = left - right;
        const double doubt = TURN_DOUBT * (fabs(left) + fabs(right));
        s->out[i] = value < 0;
        doubts += fabs(value) <= doubt;
    }
    for (uint32_t i = 0; i < l->count && doubts; i++) {
        const uint32_t k = i + 1 < l->count ? i + 1 : 0;
        s->out[i] = loop_turn((loop_point){l->u[i], l->v[i]}, (loop_point){l->u[k], l->v[k]}, p) < 0;
    }
    for (uint32_t i = 0, before = l->count - 1; i < l->count; before = i++) {
        const uint32_t enters = s->out[i] & ~s->out[before] & 1u;
        s->count += s->out[i];
        s->entries += enters;
        s->first += enters * i;
    }
}

// The corners between the edges that have the point outside give way to it.
static void point_put(loop *l, const sides *s, loop_point p)
{
    loop out;
    const uint32_t count = l->count, kept = count - s->count + 1; // corners from the end of the last such edge to the start of the first
    const uint32_t start = s->first + s->count < count ? s->first + s->count : s->first + s->count - count;
    const uint32_t tail = start + kept <= count ? kept : count - start;
    loop_copy(l->u + start, l->v + start, tail, out.u, out.v);
    loop_copy(l->u, l->v, kept - tail, out.u + tail, out.v + tail);
    out.u[kept] = p.u;
    out.v[kept] = p.v;
    loop_copy(out.u, out.v, kept + 1, l->u, l->v);
    l->count = kept + 1;
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
        sides s;
        sides_find(hull, p, &s);
        if (s.count == 0) continue;
        changed = 1;
        if (s.entries != 1) { // one is bent by rounding
            sorted_hull(hull, more);
            return 1;
        }
        point_put(hull, &s, p);
    }
    return changed;
}
