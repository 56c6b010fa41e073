// Items along a segment or in a box: see ray.h. Slabs: Kay and Kajiya, Ray Tracing Complex Scenes, 1986.
// SPDX-License-Identifier: MIT
// Invariant: an item is met once, at the node that it stands at, and its whole box lies in the boxes of all nodes on the way there. A part of
// the segment that runs through a box runs, by the same arithmetic, through every box around it.
#include "ray.h"

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
    return cull_box_at(&from->zone->boxes, from->order[place]);
}

static cull_box node_box(const bsp_walk_node *n)
{
    const cull_box box = {{n->min[0], n->min[1], n->min[2]}, {n->max[0], n->max[1], n->max[2]}};
    return box;
}

static uint32_t item_of(const bsp_walk *walk, const bsp_walk_node *node, uint32_t i)
{
    return walk->blocks[node->first + i / WALK_WIDTH].place[i % WALK_WIDTH];
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

uint32_t ray_segment(const ray_source *from, cull_vec3 start, cull_vec3 end, cull_run *runs, uint32_t max_runs)
{
    const segment s = {{(double)start.x, (double)start.y, (double)start.z},
                       {(double)end.x - (double)start.x, (double)end.y - (double)start.y, (double)end.z - (double)start.z}};
    nearest h = {from, &s, runs, 0, max_runs};
    const bsp_walk *walk = from->walk;
    uint32_t found = 0;
    for (uint32_t n = 0; n < walk->node_count;) {
        const bsp_walk_node *node = &walk->nodes[n];
        const int touches = entry(&s, node_box(node)) <= 1;
        for (uint32_t i = 0; touches && i < node->count; i++) {
            const uint32_t item = item_of(walk, node, i);
            if (!(entry(&s, item_box(from, item)) <= 1)) continue;
            found++;
            offer(&h, item);
        }
        n = touches ? n + 1 : node->end;
    }
    for (uint32_t count = h.count; count > 1;) {
        swap(&h, 0, --count);
        sink(&h, 0, count);
    }
    return found;
}

// ---- In a box ----

uint32_t ray_box(const ray_source *from, const cull_box *box, cull_run *runs, uint32_t max_runs)
{
    const bsp_walk *walk = from->walk;
    uint32_t count = 0;
    cull_run last = {0, 0};
    for (uint32_t n = 0; n < walk->node_count;) {
        const bsp_walk_node *node = &walk->nodes[n];
        const int touches = cull_box_touches(node_box(node), *box);
        for (uint32_t i = 0; touches && i < node->count; i++) {
            const uint32_t item = item_of(walk, node, i);
            if (!cull_box_touches(item_box(from, item), *box)) continue;
            if (count && item == last.first + last.count) last.count++;
            else {
                last = (cull_run){item, 1};
                count++;
            }
            if (count <= max_runs) runs[count - 1] = last;
        }
        n = touches ? n + 1 : node->end;
    }
    return count;
}
