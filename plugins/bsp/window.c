// Windows: see window.h. Loops of few points, so counts and copies stand where branches would be guessed wrong.
// SPDX-License-Identifier: MIT
#include "window.h"

#include "pairs.h"
#include "window_loop.h"

#include <string.h>

static const double SNAP = 98304; // 1.5 * 2^16: adding it leaves 2^-36 as the last bit of |x| < 2^15

static double snapped(double x)
{
    const double shifted = x + SNAP;
    return shifted - SNAP;
}

void window_set_rectangle(window_bounds b, window *out)
{
    const double step = 1 / 68719476736.0; // 2^-36: snapped() is off by half of it
    const window_bounds o = {snapped(b.u0 - step), snapped(b.u1 + step), snapped(b.v0 - step), snapped(b.v1 + step)};
    const double u[4] = {o.u0, o.u1, o.u1, o.u0}, v[4] = {o.v0, o.v0, o.v1, o.v1};
    out->bounds = o;
    out->count = 4;
    out->next = WINDOW_NONE;
    memcpy(out->u, u, sizeof u);
    memcpy(out->v, v, sizeof v);
}

void window_copy(const window *from, window *to)
{
    to->bounds = from->bounds;
    to->count = from->count;
    loop_copy(from->u, from->v, from->count, to->u, to->v);
}

double window_area(const window *w)
{
    return loop_area(w->u, w->v, w->count);
}

static double lesser(pair a)
{
    const double x = pair_first(a), y = pair_second(a);
    return x < y ? x : y;
}

static double greater(pair a)
{
    const double x = pair_first(a), y = pair_second(a);
    return x > y ? x : y;
}

// Of 2 or more.
static window_bounds bounds_of(const double *u, const double *v, uint32_t count)
{
    const uint32_t last = count - PAIR;
    pair low_u = pair_load(u + last), low_v = pair_load(v + last), high_u = low_u, high_v = low_v;
    for (uint32_t i = 0; i < last; i += PAIR) {
        const pair at_u = pair_load(u + i), at_v = pair_load(v + i);
        low_u = pair_min(at_u, low_u), high_u = pair_max(at_u, high_u);
        low_v = pair_min(at_v, low_v), high_v = pair_max(at_v, high_v);
    }
    const window_bounds b = {lesser(low_u), greater(high_u), lesser(low_v), greater(high_v)};
    return b;
}

// A loop as a window; where it has too many corners, its rectangle.
static window_fate loop_hand_over(const loop *l, window *out)
{
    out->bounds = bounds_of(l->u, l->v, l->count);
    out->next = WINDOW_NONE;
    if (l->count > WINDOW_POINTS) {
        window_set_rectangle(out->bounds, out);
        return WINDOW_GREW;
    }
    out->count = l->count;
    loop_copy(l->u, l->v, l->count, out->u, out->v);
    return WINDOW_FEWER;
}

static void loop_take(const window *w, loop *out)
{
    out->count = w->count;
    loop_copy(w->u, w->v, w->count, out->u, out->v);
    loop_close(out);
}

// ---- Cuts ----

typedef struct corners { const double *u, *v; uint32_t count; } corners; // of a window or a loop

// From the inside end, whatever way the loop runs: neighbours that share an edge get the same point.
static void between_add(const corners *in, const double *heights, uint32_t inside, uint32_t outside, loop *out)
{
    const double t = heights[inside] / (heights[inside] - heights[outside]);
    out->u[out->count] = snapped(in->u[inside] + t * (in->u[outside] - in->u[inside]));
    out->v[out->count++] = snapped(in->v[inside] + t * (in->v[outside] - in->v[inside]));
}

// A loop that rounding has bent may cross the line more than twice.
static void bent_cut(const corners *in, const double *heights, loop *out)
{
    out->count = 0;
    for (uint32_t i = in->count - 1, k = 0; k < in->count; i = k++) {
        if (out->count + 2 > LOOP_MOST) return;
        if (heights[i] > 0 && heights[k] < 0) between_add(in, heights, i, k, out);
        if (heights[i] < 0 && heights[k] > 0) between_add(in, heights, k, i, out);
        if (heights[k] >= 0) {
            out->u[out->count] = in->u[k];
            out->v[out->count++] = in->v[k];
        }
    }
}

// `inside` corners from `start` on lie inside, the others outside.
static void plain_cut(const corners *in, const double *heights, uint32_t start, uint32_t inside, loop *out)
{
    const uint32_t count = in->count, tail = start + inside <= count ? inside : count - start;
    const uint32_t last = start + inside - 1 < count ? start + inside - 1 : start + inside - 1 - count;
    loop_copy(in->u + start, in->v + start, tail, out->u, out->v);
    loop_copy(in->u, in->v, inside - tail, out->u + tail, out->v + tail);
    out->count = inside;
    if (heights[last] > 0) between_add(in, heights, last, last + 1 < count ? last + 1 : 0, out);
    if (heights[start] > 0) between_add(in, heights, start, start > 0 ? start - 1 : count - 1, out);
    int repeats = 0; // corners of a window differ from their neighbours: only the new ones may not
    for (uint32_t i = inside - 1, k = inside; k <= out->count; i++, k++) {
        const uint32_t at = k < out->count ? k : 0;
        repeats |= (out->u[i] == out->u[at]) & (out->v[i] == out->v[at]);
    }
    if (repeats) loop_tidy(out);
}

// A bit for each corner that lies outside the line, of at most 32; none of a line that is no number. heights: room for one more.
static uint64_t heights_find(const corners *in, window_line line, double *heights)
{
    const pair a = pair_of(line.a), b = pair_of(line.b), c = pair_of(line.c), zero = pair_of(0);
    uint64_t outside = 0;
    for (uint32_t i = 0; i < in->count; i += PAIR) {
        const pair at = pair_add(pair_add(pair_mul(a, pair_load(in->u + i)), pair_mul(b, pair_load(in->v + i))), c);
        pair_store(heights + i, at);
        outside |= (uint64_t)pair_below(at, zero) << i;
    }
    return outside & pair_bits(in->count);
}

typedef enum cut_fate { CUT_NOTHING, CUT_SOME, CUT_ALL } cut_fate;

static cut_fate loop_cut(const corners *in, window_line line, loop *out)
{
    double heights[WINDOW_POINTS + PAIR];
    const uint64_t outside = heights_find(in, line, heights), all = pair_bits(in->count), before = pair_turned(outside, in->count);
    const uint64_t enters = before & ~outside, leaves = outside & ~before;
    if (outside == 0) return CUT_NOTHING;
    if (outside == all) return CUT_ALL;
    if (enters & (enters - 1)) {
        bent_cut(in, heights, out);
        loop_tidy(out);
        return CUT_SOME;
    }
    const uint32_t start = pair_lowest(enters), end = pair_lowest(leaves);
    plain_cut(in, heights, start, end > start ? end - start : end + in->count - start, out);
    return CUT_SOME;
}

window_fate window_cut(const window *in, const window_line *lines, uint32_t line_count, window *out)
{
    loop loops[2];
    corners from = {in->u, in->v, in->count};
    uint32_t to = 0;
    for (uint32_t i = 0; i < line_count; i++)
        if (window_line_most(lines[i], in->bounds) < 0) return WINDOW_GONE; // before any work
    for (uint32_t i = 0; i < line_count; i++) {
        if (!(window_line_least(lines[i], in->bounds) < 0)) continue; // nor does a line cut that is no number
        if (from.count > WINDOW_POINTS) break; // nothing is cut off any more: larger, never smaller
        const cut_fate fate = loop_cut(&from, lines[i], &loops[to]);
        if (fate == CUT_ALL) return WINDOW_GONE;
        if (fate == CUT_NOTHING) continue;
        if (loops[to].count < 3) return WINDOW_GONE;
        from = (corners){loops[to].u, loops[to].v, loops[to].count};
        to = 1 - to;
    }
    if (from.u == in->u) return WINDOW_SAME;
    if (!(loop_area(from.u, from.v, from.count) > 0)) return WINDOW_GONE;
    return loop_hand_over(&loops[1 - to], out);
}

// ---- Containment, edges ----

int window_contains(const window *outer, const window *inner)
{
    loop closed;
    if (!window_bounds_contain(outer->bounds, inner->bounds)) return 0;
    loop_take(outer, &closed);
    for (uint32_t i = 0; i < inner->count; i++)
        if (loop_sides_out(&closed, (loop_point){inner->u[i], inner->v[i]})) return 0;
    return 1;
}

int window_is_outside(const window *w, window_line line)
{
    const pair a = pair_of(line.a), b = pair_of(line.b), c = pair_of(line.c), zero = pair_of(0);
    uint64_t inside = 0;
    for (uint32_t i = 0; i < w->count; i += PAIR) {
        const pair at = pair_add(pair_add(pair_mul(a, pair_load(w->u + i)), pair_mul(b, pair_load(w->v + i))), c);
        inside |= (uint64_t)pair_below(zero, at) << i;
    }
    return !(inside & pair_bits(w->count));
}

void window_edges(const window *w, window_line lines[WINDOW_POINTS])
{
    const uint32_t last = w->count - PAIR;
    for (uint32_t i = 0; i < w->count; i++) {
        const uint32_t k = i + 1 < w->count ? i + 1 : 0;
        const window_line l = {w->v[i] - w->v[k], w->u[k] - w->u[i], 0};
        const pair a = pair_of(l.a), b = pair_of(l.b);
        pair least = pair_add(pair_mul(a, pair_load(w->u + last)), pair_mul(b, pair_load(w->v + last)));
        for (uint32_t j = 0; j < last; j += PAIR)
            least = pair_min(pair_add(pair_mul(a, pair_load(w->u + j)), pair_mul(b, pair_load(w->v + j))), least);
        lines[i] = (window_line){l.a, l.b, -lesser(least)};
    }
}

// ---- Hulls ----

window_fate window_hull(const window *a, const window *b, window *out)
{
    loop hull, more;
    loop_take(a, &hull);
    loop_take(b, &more);
    if (!loop_hull(&hull, &more)) return WINDOW_SAME;
    if (hull.count < 3) { // of no area: cannot be, but nothing may be lost
        window_set_rectangle(window_bounds_union(a->bounds, b->bounds), out);
        return WINDOW_GREW;
    }
    return loop_hand_over(&hull, out);
}

// What both share, where `b` is convex.
static double area_of_both(const window *a, const loop *b)
{
    window_line lines[WINDOW_POINTS];
    window both;
    for (uint32_t i = 0; i < b->count; i++) {
        const double du = b->u[i + 1] - b->u[i], dv = b->v[i + 1] - b->v[i];
        lines[i] = (window_line){-dv, du, dv * b->u[i] - du * b->v[i]};
    }
    const window_fate fate = window_cut(a, lines, b->count, &both);
    return fate == WINDOW_GONE ? 0 : window_area(fate == WINDOW_SAME ? a : &both);
}

// At least that.
static double bounds_area_of_both(window_bounds a, window_bounds b)
{
    const double u0 = a.u0 > b.u0 ? a.u0 : b.u0, u1 = a.u1 < b.u1 ? a.u1 : b.u1, v0 = a.v0 > b.v0 ? a.v0 : b.v0, v1 = a.v1 < b.v1 ? a.v1 : b.v1;
    return (u1 - u0) * (v1 - v0); // they touch
}

typedef struct ends { uint32_t far, near; } ends; // corners farthest along a direction, and against it

static ends ends_of(const loop *l, double du, double dv)
{
    ends e = {0, 0};
    double most = -1e300, least = 1e300;
    for (uint32_t i = 0; i < l->count; i++) {
        const double at = du * l->u[i] + dv * l->v[i];
        e.far = at > most ? i : e.far;
        e.near = at < least ? i : e.near;
        most = at > most ? at : most;
        least = at < least ? at : least;
    }
    return e;
}

static int is_near_inside(const loop *l, double u, double v, double give)
{
    const pair pu = pair_of(u), pv = pair_of(v), share = pair_of(-give);
    uint64_t out = 0;
    for (uint32_t i = 0; i < l->count; i += PAIR) {
        const pair at_u = pair_load(l->u + i), at_v = pair_load(l->v + i);
        const pair eu = pair_subtract(pair_load(l->u + i + 1), at_u), ev = pair_subtract(pair_load(l->v + i + 1), at_v);
        const pair turn = pair_subtract(pair_mul(eu, pair_subtract(pv, at_v)), pair_mul(ev, pair_subtract(pu, at_u)));
        out |= (uint64_t)pair_below(turn, pair_mul(share, pair_add(pair_size(eu), pair_size(ev)))) << i;
    }
    return !(out & pair_bits(l->count));
}

// The middle of the line that bridges both on one side of their middles lies in one of them, or near: else their hull is no union.
static int is_bridged(const loop *a, const loop *b, uint32_t i, uint32_t k, double give)
{
    const double u = (a->u[i] + b->u[k]) / 2, v = (a->v[i] + b->v[k]) / 2;
    return is_near_inside(a, u, v, give) || is_near_inside(b, u, v, give);
}

typedef struct two_windows { const window *a, *b; loop la, lb; } two_windows; // and their closed loops

static int may_join(const two_windows *t, double spare)
{
    const window_bounds p = t->a->bounds, q = t->b->bounds, around = window_bounds_union(p, q);
    const double give = ((around.u1 - around.u0) + (around.v1 - around.v0)) * (1.0 / 256 + spare); // above what an area to spare lets through
    const double du = (q.u0 + q.u1) - (p.u0 + p.u1), dv = (q.v0 + q.v1) - (p.v0 + p.v1);
    const ends a = ends_of(&t->la, -dv, du), b = ends_of(&t->lb, -dv, du);
    return is_bridged(&t->la, &t->lb, a.far, b.far, give) && is_bridged(&t->la, &t->lb, a.near, b.near, give);
}

int window_join(const window *a, const window *b, double spare, window *out)
{
    if (!window_bounds_touch(a->bounds, b->bounds)) return 0;
    two_windows t;
    t.a = a;
    t.b = b;
    loop_take(a, &t.la);
    loop_take(b, &t.lb);
    if (!may_join(&t, spare)) return 0;
    loop *hull = &t.la;
    const double sum = window_area(a) + window_area(b);
    if (!loop_hull(hull, &t.lb) || hull->count < 3 || hull->count > WINDOW_POINTS) return 0;
    const double area = loop_area(hull->u, hull->v, hull->count);
    if (area - sum > spare * area) return 0;
    if (area - (sum - bounds_area_of_both(a->bounds, b->bounds)) > spare * area && area - (sum - area_of_both(a, &t.lb)) > spare * area) return 0;
    loop_hand_over(hull, out);
    return 1;
}
