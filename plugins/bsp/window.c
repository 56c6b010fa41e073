// Windows: see window.h. Loops of few points, so counts and copies stand where branches would be guessed wrong.
// SPDX-License-Identifier: MIT
#include "window.h"

#include "window_loop.h"

#include <math.h>
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

static window_bounds bounds_of(const double *u, const double *v, uint32_t count)
{
    window_bounds b = {u[0], u[0], v[0], v[0]};
    for (uint32_t i = 1; i < count; i++) {
        b.u0 = u[i] < b.u0 ? u[i] : b.u0;
        b.u1 = u[i] > b.u1 ? u[i] : b.u1;
        b.v0 = v[i] < b.v0 ? v[i] : b.v0;
        b.v1 = v[i] > b.v1 ? v[i] : b.v1;
    }
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
}

typedef enum cut_fate { CUT_NOTHING, CUT_SOME, CUT_ALL } cut_fate;

static cut_fate loop_cut(const corners *in, window_line line, loop *out)
{
    double heights[LOOP_MOST];
    uint32_t outside = 0, entries = 0, start = 0;
    for (uint32_t i = 0; i < in->count; i++) heights[i] = (line.a * in->u[i] + line.b * in->v[i]) + line.c;
    for (uint32_t i = 0; i < in->count; i++) outside += heights[i] < 0; // none of a line that is no number
    if (outside == 0) return CUT_NOTHING;
    if (outside == in->count) return CUT_ALL;
    for (uint32_t i = 0, before = in->count - 1; i < in->count; before = i++) {
        const uint32_t enters = heights[before] < 0 && heights[i] >= 0;
        entries += enters;
        start += enters * i;
    }
    if (entries == 1) plain_cut(in, heights, start, in->count - outside, out);
    else bent_cut(in, heights, out);
    return CUT_SOME;
}

window_fate window_cut(const window *in, const window_line *lines, uint32_t line_count, window *out)
{
    loop loops[2];
    corners from = {in->u, in->v, in->count};
    uint32_t to = 0;
    for (uint32_t i = 0; i < line_count; i++) {
        if (!(window_line_least(lines[i], in->bounds) < 0)) continue; // nor does a line cut that is no number
        if (window_line_most(lines[i], in->bounds) < 0) return WINDOW_GONE;
        if (from.count > WINDOW_POINTS) break; // nothing is cut off any more: larger, never smaller
        const cut_fate fate = loop_cut(&from, lines[i], &loops[to]);
        if (fate == CUT_ALL) return WINDOW_GONE;
        if (fate == CUT_NOTHING) continue;
        loop_tidy(&loops[to]);
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
    if (!window_bounds_contain(outer->bounds, inner->bounds)) return 0;
    for (uint32_t i = 0; i < outer->count; i++) {
        const uint32_t k = i + 1 < outer->count ? i + 1 : 0;
        const loop_point a = {outer->u[i], outer->v[i]}, b = {outer->u[k], outer->v[k]};
        for (uint32_t j = 0; j < inner->count; j++)
            if (loop_turn(a, b, (loop_point){inner->u[j], inner->v[j]}) < 0) return 0;
    }
    return 1;
}

void window_edges(const window *w, window_line lines[WINDOW_POINTS])
{
    for (uint32_t i = 0; i < w->count; i++) {
        const uint32_t k = i + 1 < w->count ? i + 1 : 0;
        window_line l = {w->v[i] - w->v[k], w->u[k] - w->u[i], 0};
        double least = l.a * w->u[i] + l.b * w->v[i];
        for (uint32_t j = 0; j < w->count; j++) {
            const double at = l.a * w->u[j] + l.b * w->v[j];
            least = at < least ? at : least;
        }
        l.c = -least;
        lines[i] = l;
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

static double area_of_both(const window *a, const window *b)
{
    window_line lines[WINDOW_POINTS];
    window both;
    window_edges(b, lines);
    const window_fate fate = window_cut(a, lines, b->count, &both);
    return fate == WINDOW_GONE ? 0 : window_area(fate == WINDOW_SAME ? a : &both);
}

// The corner farthest along a direction.
static uint32_t farthest(const window *w, double du, double dv)
{
    uint32_t best = 0;
    double most = -1e300;
    for (uint32_t i = 0; i < w->count; i++) {
        const double at = du * w->u[i] + dv * w->v[i];
        best = at > most ? i : best;
        most = at > most ? at : most;
    }
    return best;
}

static int is_near_inside(const window *w, double u, double v, double give)
{
    for (uint32_t i = 0, before = w->count - 1; i < w->count; before = i++) {
        const double eu = w->u[i] - w->u[before], ev = w->v[i] - w->v[before];
        if (eu * (v - w->v[before]) - ev * (u - w->u[before]) < -give * (fabs(eu) + fabs(ev))) return 0;
    }
    return 1;
}

// The middle of the line that bridges both on one side of their middles lies in one of them, or near: else their hull is no union.
static int is_bridged(const window *a, const window *b, double du, double dv, double give)
{
    const uint32_t i = farthest(a, du, dv), k = farthest(b, du, dv);
    const double u = (a->u[i] + b->u[k]) / 2, v = (a->v[i] + b->v[k]) / 2;
    return is_near_inside(a, u, v, give) || is_near_inside(b, u, v, give);
}

static int may_join(const window *a, const window *b)
{
    const window_bounds around = window_bounds_union(a->bounds, b->bounds);
    const double give = ((around.u1 - around.u0) + (around.v1 - around.v0)) / 256; // well above what an area to spare lets through
    const double du = (b->bounds.u0 + b->bounds.u1) - (a->bounds.u0 + a->bounds.u1), dv = (b->bounds.v0 + b->bounds.v1) - (a->bounds.v0 + a->bounds.v1);
    return is_bridged(a, b, -dv, du, give) && is_bridged(a, b, dv, -du, give);
}

int window_join(const window *a, const window *b, double spare, window *out)
{
    loop hull, more;
    if (!window_bounds_touch(a->bounds, b->bounds) || !may_join(a, b)) return 0;
    loop_take(a, &hull);
    loop_take(b, &more);
    if (!loop_hull(&hull, &more) || hull.count < 3 || hull.count > WINDOW_POINTS) return 0;
    const double area = loop_area(hull.u, hull.v, hull.count), sum = window_area(a) + window_area(b);
    if (area - sum > spare * area) return 0;
    if (area - (sum - area_of_both(a, b)) > spare * area) return 0;
    loop_hand_over(&hull, out);
    return 1;
}
