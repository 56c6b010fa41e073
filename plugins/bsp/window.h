// Convex windows on the picture plane at distance 1: what of the picture a cell is seen through.
// Hulls: point by point, as both are convex already; where rounding has bent one, of sorted points (Andrew, Another Efficient Algorithm
// for Convex Hulls in Two Dimensions, 1979).
// SPDX-License-Identifier: MIT
//
// Invariant: points run counterclockwise (u to the right, v up), are whole multiples of 2^-36 tangents, and the turn of three of them
// is never wrong (no tolerance drops an extreme point). A window only shrinks by a cut: where it has too many corners it becomes
// its rectangle.
#ifndef PORTCULLIS_BSP_WINDOW_H
#define PORTCULLIS_BSP_WINDOW_H

#include <stdint.h>

enum { WINDOW_POINTS = 32 };
#define WINDOW_NONE 0xffffffffu
#define WINDOW_REACH_MOST 4096.0 // tangents: |u| and |v| stay below it, so that products of differences fit in 98 bits

typedef struct window_line { double a, b, c; } window_line; // inside: a u + b v + c >= 0
typedef struct window_bounds { double u0, u1, v0, v1; } window_bounds;

typedef struct window {
    window_bounds bounds;
    uint32_t count, next; // next: of a list, or WINDOW_NONE
    double u[WINDOW_POINTS + 4], v[WINDOW_POINTS + 4]; // copies and pairs run over, see loop_copy
} window;

typedef enum window_fate {
    WINDOW_GONE,  // nothing is left
    WINDOW_SAME,  // the lines cut nothing; the output is not written
    WINDOW_FEWER, // the output is what is left
    WINDOW_GREW   // it had too many corners: the output is the rectangle around what is left
} window_fate;

void window_set_rectangle(window_bounds bounds, window *out); // rounded outward to 2^-36
// What of `in` lies inside all lines. Where a line cuts, the new corners are rounded to 2^-36.
window_fate window_cut(const window *in, const window_line *lines, uint32_t line_count, window *out);
// The hull of both, SAME where b lies inside a (and then nothing is written), FEWER or GREW. out may be neither.
void window_copy(const window *from, window *to); // all but next
window_fate window_hull(const window *a, const window *b, window *out);
// 1: the union of both fills its hull but for `spare` of the hull's area, and *out is the hull. out may be neither.
int window_join(const window *a, const window *b, double spare, window *out);
int window_contains(const window *outer, const window *inner); // every corner of inner lies in outer, exactly
int window_is_outside(const window *w, window_line line); // no corner's value is above 0
double window_area(const window *w);
// Lines through the edges, moved out until no corner is outside; as many as corners.
void window_edges(const window *w, window_line lines[WINDOW_POINTS]);

static inline window_bounds window_bounds_union(window_bounds a, window_bounds b)
{
    const window_bounds out = {b.u0 < a.u0 ? b.u0 : a.u0, b.u1 > a.u1 ? b.u1 : a.u1, b.v0 < a.v0 ? b.v0 : a.v0, b.v1 > a.v1 ? b.v1 : a.v1};
    return out;
}

static inline int window_bounds_contain(window_bounds outer, window_bounds inner)
{
    return inner.u0 >= outer.u0 && inner.u1 <= outer.u1 && inner.v0 >= outer.v0 && inner.v1 <= outer.v1;
}

static inline int window_bounds_touch(window_bounds a, window_bounds b)
{
    return a.u0 <= b.u1 && b.u0 <= a.u1 && a.v0 <= b.v1 && b.v0 <= a.v1;
}

// The least and the most of the line's value in the rectangle.
static inline double window_line_least(window_line l, window_bounds b)
{
    return (l.a * (l.a >= 0 ? b.u0 : b.u1) + l.b * (l.b >= 0 ? b.v0 : b.v1)) + l.c;
}

static inline double window_line_most(window_line l, window_bounds b)
{
    return (l.a * (l.a >= 0 ? b.u1 : b.u0) + l.b * (l.b >= 0 ? b.v1 : b.v0)) + l.c;
}

#endif
