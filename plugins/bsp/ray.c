// Items along a segment or in a box: see ray.h.
// SPDX-License-Identifier: MIT
// Invariant: an item is met once, at the node that it stands at, and its whole box lies in the boxes of all nodes on the way there.
#include "ray.h"

#include <portcullis/runs.h>
#include <portcullis/segment.h>

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

uint32_t ray_segment(const ray_source *from, cull_vec3 start, cull_vec3 end, cull_run *runs, uint32_t max_runs)
{
    const cull_segment s = cull_segment_between(start, end);
    const bsp_walk *walk = from->walk;
    cull_nearest near = {&from->zone->boxes, from->order, &s, runs, 0, max_runs};
    uint32_t found = 0;
    for (uint32_t n = 0; n < walk->node_count;) {
        const bsp_walk_node *node = &walk->nodes[n];
        const int touches = cull_segment_entry(&s, node_box(node)) <= 1;
        for (uint32_t i = 0; touches && i < node->count; i++) {
            const uint32_t item = item_of(walk, node, i);
            if (!(cull_segment_entry(&s, item_box(from, item)) <= 1)) continue;
            found++;
            cull_nearest_offer(&near, item);
        }
        n = touches ? n + 1 : node->end;
    }
    cull_nearest_sort(&near);
    return found;
}

uint32_t ray_box(const ray_source *from, const cull_box *box, cull_run *runs, uint32_t max_runs)
{
    const bsp_walk *walk = from->walk;
    cull_run_writer found = {.runs = runs, .most = max_runs};
    for (uint32_t n = 0; n < walk->node_count;) {
        const bsp_walk_node *node = &walk->nodes[n];
        const int touches = cull_box_touches(node_box(node), *box);
        for (uint32_t i = 0; touches && i < node->count; i++) {
            const uint32_t item = item_of(walk, node, i);
            if (cull_box_touches(item_box(from, item), *box)) cull_run_put(&found, item);
        }
        n = touches ? n + 1 : node->end;
    }
    return found.count;
}
