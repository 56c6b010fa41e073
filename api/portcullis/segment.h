// segment.h: a segment against boxes (slabs: Kay and Kajiya, Ray Tracing Complex Scenes, 1986), and the nearest of those it touches, for an
// extension `cull.ray/1` (culler.h). Strict C11, reads as C++17.
// SPDX-License-Identifier: MIT
//
// Invariant: a part of the segment that runs through a box runs, by the same arithmetic, through every box around it: a tree over boxes
// finds what a loop over them finds. Differences of floats are exact enough in double to be monotone.
#ifndef PORTCULLIS_SEGMENT_H
#define PORTCULLIS_SEGMENT_H

#include "box.h"

typedef struct cull_segment { double from[3], along[3]; } cull_segment;

static inline cull_segment cull_segment_between(cull_vec3 start, cull_vec3 end)
{
    const cull_segment s = {{(double)start.x, (double)start.y, (double)start.z},
                            {(double)end.x - (double)start.x, (double)end.y - (double)start.y, (double)end.z - (double)start.z}};
    return s;
}

// Where the segment enters the box, 0 .. 1; above 1: it doesn't touch.
static inline double cull_segment_entry(const cull_segment *s, cull_box box)
{
    const double low[3] = {(double)box.min.x, (double)box.min.y, (double)box.min.z};
    const double high[3] = {(double)box.max.x, (double)box.max.y, (double)box.max.z};
    double in = 0, out = 1;
    for (int i = 0; i < 3; i++) {
        if (s->along[i] == 0) {
            if (s->from[i] < low[i] || s->from[i] > high[i]) return 2;
            continue;
        }
        const double a = (low[i] - s->from[i]) / s->along[i], b = (high[i] - s->from[i]) / s->along[i];
        const double first = a < b ? a : b, last = a < b ? b : a;
        if (first > in) in = first;
        if (last < out) out = last;
    }
    return in <= out ? in : 2;
}

// ---- Nearest first: items along a segment, in no memory but the caller's runs ----

typedef struct cull_nearest {
    const cull_boxes *boxes; // of the zone before the culler's order
    const uint32_t *order;   // order[place] = item
    const cull_segment *segment;
    cull_run *runs; // of one place each: a heap, the farthest on top, until cull_nearest_sort
    uint32_t count, most;
} cull_nearest;

// Equally far ones in the order of their places.
static inline bool cull_nearest_is_nearer(const cull_nearest *n, cull_run a, cull_run b)
{
    const double in_a = cull_segment_entry(n->segment, cull_box_at(n->boxes, n->order[a.first]));
    const double in_b = cull_segment_entry(n->segment, cull_box_at(n->boxes, n->order[b.first]));
    return in_a < in_b || (in_a == in_b && a.first < b.first);
}

static inline void cull_nearest_swap(cull_nearest *n, uint32_t a, uint32_t b)
{
    const cull_run spare = n->runs[a];
    n->runs[a] = n->runs[b];
    n->runs[b] = spare;
}

static inline void cull_nearest_sink(cull_nearest *n, uint32_t at, uint32_t count)
{
    for (;;) {
        uint32_t farthest = at;
        for (uint32_t child = 2 * at + 1; child <= 2 * at + 2 && child < count; child++)
            if (cull_nearest_is_nearer(n, n->runs[farthest], n->runs[child])) farthest = child;
        if (farthest == at) return;
        cull_nearest_swap(n, at, farthest);
        at = farthest;
    }
}

// A place whose box the segment touches. A list too short for all keeps the nearest.
static inline void cull_nearest_offer(cull_nearest *n, uint32_t place)
{
    const cull_run run = {place, 1};
    if (n->count < n->most) {
        uint32_t at = n->count++;
        n->runs[at] = run;
        for (; at && cull_nearest_is_nearer(n, n->runs[(at - 1) / 2], n->runs[at]); at = (at - 1) / 2) cull_nearest_swap(n, at, (at - 1) / 2);
    } else if (n->most && cull_nearest_is_nearer(n, run, n->runs[0])) {
        n->runs[0] = run;
        cull_nearest_sink(n, 0, n->count);
    }
}

// When all are offered.
static inline void cull_nearest_sort(cull_nearest *n)
{
    for (uint32_t count = n->count; count > 1;) {
        cull_nearest_swap(n, 0, --count);
        cull_nearest_sink(n, 0, count);
    }
}

#endif
