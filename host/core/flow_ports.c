// Portals of zones that have many: a tree over their boxes passes over those that a volume cannot reach.
// SPDX-License-Identifier: MIT
// Invariant: what is passed over, flow_clip would have left nothing of: a box's farthest corner is measured by the same sum
// in the same order as the portal's points, and rounding never turns an order round.
#include "flow_internal.h"

enum { PORTALS_FEW = 16 }; // below, trying all costs no more

static result tree_open(flow *f, uint32_t zone, box_tree *out)
{
    const scene_zone *z = &f->scene->zones[zone];
    tree_box *boxes = arena_push(&f->blocks, z->portal_count, sizeof *boxes);
    if (!boxes) return RESULT_NO_MEMORY;
    for (uint32_t i = 0; i < z->portal_count; i++) {
        const flow_gate *g = &f->gates[f->scene->zone_portals[z->first_portal + i] / 2];
        for (int k = 0; k < 3; k++) {
            boxes[i].min[k] = g->low[k];
            boxes[i].max[k] = g->high[k];
        }
    }
    return box_tree_open(boxes, z->portal_count, f->memory, out);
}

result flow_ports_open(flow *f)
{
    const scene *s = f->scene;
    uint32_t trees = 0;
    for (uint32_t z = 0; z < s->zone_count; z++) trees += s->zones[z].portal_count > PORTALS_FEW;
    f->trees = arena_push(&f->blocks, trees, sizeof *f->trees);
    f->tree_of = arena_push(&f->blocks, s->zone_count, sizeof *f->tree_of);
    if (!f->trees || !f->tree_of) return RESULT_NO_MEMORY;
    for (uint32_t z = 0; z < s->zone_count; z++) {
        f->tree_of[z] = SCENE_NONE;
        if (s->zones[z].portal_count <= PORTALS_FEW) continue;
        if (tree_open(f, z, &f->trees[f->tree_count]) != RESULT_OK) return RESULT_NO_MEMORY;
        f->tree_of[z] = f->tree_count++;
    }
    return RESULT_OK;
}

void flow_ports_close(flow *f)
{
    for (uint32_t i = 0; i < f->tree_count; i++) box_tree_close(&f->trees[i], f->memory);
}

void flow_ports_start(const flow *f, const flow_node *from, flow_port_walk *out)
{
    const uint32_t tree = f->tree_of[from->zone];
    out->f = f;
    out->from = from;
    out->depth = out->at = 0;
    out->tree = NULL;
    out->has_cuts = 0;
    out->end = f->scene->zones[from->zone].portal_count;
    if (tree == SCENE_NONE) return;
    out->tree = &f->trees[tree];
    out->end = 0;
    out->stack[out->depth++] = 0;
    (void)flow_ports_cuts(out);
}

const cull_cut *flow_ports_cuts(flow_port_walk *w)
{
    if (!w->has_cuts) flow_cuts_make(w->f, w->from, w->cuts);
    w->has_cuts = 1;
    return w->cuts;
}

static int is_out_of_reach(const flow_port_walk *w, const tree_box *box)
{
    const flow *f = w->f;
    const double *eye = f->base.camera->eye;
    const cull_point low = {box->min[0] - eye[0], box->min[1] - eye[1], box->min[2] - eye[2]};
    const cull_point high = {box->max[0] - eye[0], box->max[1] - eye[1], box->max[2] - eye[2]};
    uint32_t i = 0;
    for (; i < w->from->plane_count; i++) {
        const cull_cut cut = w->cuts[i];
        const cull_point farthest = {cut.x > 0 ? high.x : low.x, cut.y > 0 ? high.y : low.y, cut.z > 0 ? high.z : low.z};
        if (cull_cut_height(cut, farthest) < 0) break;
    }
    if (i == w->from->plane_count) return 0;
    const double near_m = f->corner_m + (double)f->places[w->from->zone].radius / 65536 + f->most_bend;
    return flow_gate_distance(box->min, box->max, eye) > near_m; // else it may pass unclipped
}

int flow_ports_next(flow_port_walk *w, uint32_t *out)
{
    for (;;) {
        while (w->at < w->end) {
            const uint32_t at = w->at++;
            *out = w->tree ? w->tree->order[at] : at;
            if (!w->tree || !is_out_of_reach(w, &w->tree->boxes[*out])) return 1;
        }
        if (w->depth == 0) return 0;
        const uint32_t at = w->stack[--w->depth];
        const box_tree_node *node = &w->tree->nodes[at];
        if (is_out_of_reach(w, &node->box)) continue;
        w->at = node->first;
        w->end = node->first + node->count;
        if (node->count > 0) continue;
        w->at = w->end = 0;
        w->stack[w->depth++] = node->first;
        w->stack[w->depth++] = at + 1;
    }
}
