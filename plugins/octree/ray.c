// Items along a segment or in a box: see ray.h.
// SPDX-License-Identifier: MIT
// Invariant: an item is met once, at the node that it stands at, and its whole box lies in the boxes of all nodes on the way there.
#include "ray.h"

#include <portcullis/runs.h>
#include <portcullis/segment.h>

static cull_box item_box(const ray_source *from, uint32_t place)
{
    return cull_box_at(&from->zone->boxes, from->cells->order[place]);
}

typedef enum asked { ASKED_SEGMENT, ASKED_BOX } asked;

typedef struct ray_walk {
    const ray_source *from;
    asked asked;
    cull_segment segment;
    cull_box box;
    cull_nearest near;       // of a segment
    cull_run_writer in_box;
    uint32_t count;          // items along the segment
} ray_walk;

static int touches(const ray_walk *w, cull_box box)
{
    return w->asked == ASKED_BOX ? cull_box_touches(box, w->box) : cull_segment_entry(&w->segment, box) <= 1;
}

static void found(ray_walk *w, uint32_t place)
{
    if (w->asked == ASKED_BOX) {
        cull_run_put(&w->in_box, place);
        return;
    }
    w->count++;
    cull_nearest_offer(&w->near, place);
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
    ray_walk w = {.from = from, .asked = ASKED_SEGMENT, .segment = cull_segment_between(start, end)};
    w.near = (cull_nearest){&from->zone->boxes, from->cells->order, &w.segment, runs, 0, max_runs};
    if (from->zone->item_count) walk(&w, 0);
    cull_nearest_sort(&w.near);
    return w.count;
}

uint32_t ray_box(const ray_source *from, const cull_box *box, cull_run *runs, uint32_t max_runs)
{
    ray_walk w = {.from = from, .asked = ASKED_BOX, .box = *box, .in_box = {.runs = runs, .most = max_runs}};
    if (from->zone->item_count) walk(&w, 0);
    return w.in_box.count;
}
