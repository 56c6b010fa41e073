// Items along a segment or in a box: see ray.h. Slabs: Kay and Kajiya, Ray Tracing Complex Scenes, 1986.
// SPDX-License-Identifier: MIT
// Invariant: an item is met once, at the node that it stands at, and its whole box lies in the boxes of all nodes on the way there. A part of
// the segment that runs through a box runs, by the same arithmetic, through every box around it.
#include "ray.h"

#include <portcullis/box.h>

typedef struct segment { double from[3], along[3]; } segment;

typedef struct nearest { // the runs as a heap, the farthest on top
    const ray_source *from;
    const segment *s;
    cull_run *runs;
    uint32_t count, most;
} nearest;

// Where the segment enters the box, 0 .. 1; > 1: it doesn't touch. Differences of floats are exact enough in double to be monotone.
static double entry(const segment *s, cull_box box)
{
    const double low[3] = {(double)box.min.x, (double)box.min.y, (double)box.min.z}, high[3] = {(double)box.max.x, (double)box.max.y, (double)box.max.z};
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

static cull_box item_box(const ray_source *from, uint32_t place)
{
    return cull_box_at(&from->zone->boxes, from->cells->order[place]);
}

// ---- Nearest first ----

static int is_nearer(const nearest *h, cull_run a, cull_run b)
{
    const double in_a = entry(h->s, item_box(h->from, a.first)), in_b = entry(h->s, item_box(h->from, b.first));
    return in_a < in_b || (in_a == in_b && a.first < b.first);
}

static void swap(nearest *h, uint32_t a, uint32_t b)
{
    const cull_run spare = h->runs[a];
    h->runs[a] = h->runs[b];
    h->runs[b] = spare;
}

static void sink(nearest *h, uint32_t at, uint32_t count)
{
    for (;;) {
        uint32_t farthest = at;
        for (uint32_t child = 2 * at + 1; child <= 2 * at + 2 && child < count; child++)
            if (is_nearer(h, h->runs[farthest], h->runs[child])) farthest = child;
        if (farthest == at) return;
        swap(h, at, farthest);
        at = farthest;
    }
}

static void offer(nearest *h, uint32_t item)
{
    const cull_run run = {item, 1};
    if (h->count < h->most) {
        uint32_t at = h->count++;
        h->runs[at] = run;
        for (; at && is_nearer(h, h->runs[(at - 1) / 2], h->runs[at]); at = (at - 1) / 2) swap(h, at, (at - 1) / 2);
    } else if (h->most && is_nearer(h, run, h->runs[0])) {
        h->runs[0] = run;
        sink(h, 0, h->count);
    }
}

// ---- The walk ----

typedef enum asked { ASKED_SEGMENT, ASKED_BOX } asked;

typedef struct ray_walk {
    const ray_source *from;
    asked asked;
    segment s;
    cull_box box;
    nearest near;             // of a segment
    cull_run last, *runs;     // of a box
    uint32_t count, max_runs; // found: items of a segment, runs of a box
} ray_walk;

static int touches(const ray_walk *w, cull_box box)
{
    return w->asked == ASKED_BOX ? cull_box_touches(box, w->box) : entry(&w->s, box) <= 1;
}

static void found(ray_walk *w, uint32_t place)
{
    if (w->asked == ASKED_SEGMENT) {
        w->count++;
        offer(&w->near, place);
        return;
    }
    if (w->count && place == w->last.first + w->last.count) {
        w->last.count++;
    } else {
        w->last = (cull_run){place, 1};
        w->count++;
    }
    if (w->count <= w->max_runs) w->runs[w->count - 1] = w->last;
}

// Deep first, so items are met as they stand. A node has fewer items than its parent, and the way down is a few frames' halvings long:
// a bounded depth, and no memory that could fail.
static void walk(ray_walk *w, uint32_t n)
{
    const cull_node *node = &w->from->cells->nodes[n];
    if (!touches(w, node->box)) return;
    for (uint32_t i = 0; i < node->item_count; i++)
        if (touches(w, item_box(w->from, node->first_item + i))) found(w, node->first_item + i);
    for (uint32_t c = 0; c < node->child_count; c++) walk(w, node->first_child + c);
}

uint32_t ray_segment(const ray_source *from, cull_vec3 start, cull_vec3 end, cull_run *runs, uint32_t max_runs)
{
    ray_walk w = {.from = from, .asked = ASKED_SEGMENT};
    w.s = (segment){{(double)start.x, (double)start.y, (double)start.z},
                    {(double)end.x - (double)start.x, (double)end.y - (double)start.y, (double)end.z - (double)start.z}};
    w.near = (nearest){from, &w.s, runs, 0, max_runs};
    if (from->zone->item_count) walk(&w, 0);
    for (uint32_t count = w.near.count; count > 1;) {
        swap(&w.near, 0, --count);
        sink(&w.near, 0, count);
    }
    return w.count;
}

uint32_t ray_box(const ray_source *from, const cull_box *box, cull_run *runs, uint32_t max_runs)
{
    ray_walk w = {.from = from, .asked = ASKED_BOX, .box = *box, .runs = runs, .max_runs = max_runs};
    if (from->zone->item_count) walk(&w, 0);
    return w.count;
}
