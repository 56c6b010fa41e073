// Merging: where the paths into a zone grow too many, its volumes give way to one screen rectangle around them.
// SPDX-License-Identifier: MIT
// Invariant: a rectangle only grows, in coarse steps, FLOW_GROWTHS times at most; then the zone is seen whole. So the work
// list ends, and the work of a zone that merged is bounded whatever the number of paths.
#include "flow_internal.h"

#include <math.h>

int flow_must_merge(const flow *f, const flow_state *s, uint32_t planes)
{
    return s->flags & STATE_MERGED || s->count == FLOW_ZONE_VOLUMES || f->pool_count == f->pool_capacity ||
           f->plane_count + planes > f->plane_capacity;
}

static int is_around(const flow_rectangle *outer, const flow_rectangle *inner)
{
    return outer->low[0] <= inner->low[0] && outer->low[1] <= inner->low[1] && outer->high[0] >= inner->high[0] &&
           outer->high[1] >= inner->high[1];
}

static void rectangle_grow(flow_rectangle *r, const flow_rectangle *by)
{
    for (int k = 0; k < 2; k++) {
        if (by->low[k] < r->low[k]) r->low[k] = by->low[k];
        if (by->high[k] > r->high[k]) r->high[k] = by->high[k];
    }
}

static void rectangle_coarsen(flow_rectangle *r)
{
    for (int k = 0; k < 2; k++) {
        r->low[k] = floor(r->low[k] * FLOW_RECTANGLE_STEPS) / FLOW_RECTANGLE_STEPS;
        r->high[k] = ceil(r->high[k] * FLOW_RECTANGLE_STEPS) / FLOW_RECTANGLE_STEPS;
    }
}

static int is_whole(const flow_rectangle *r)
{
    return r->low[0] <= -1 && r->low[1] <= -1 && r->high[0] >= 1 && r->high[1] >= 1;
}

typedef struct side { const double *axis; double sign, tangent; } side;

static void plane_add(const flow *f, flow_node *n, const cull_guard *guard, const double normal[3], double distance)
{
    const cull_plane plane = cull_guard_plane(guard, normal, distance);
    if (view_plane_height(&plane, &f->places[n->zone].box) >= 0) return; // the whole box is inside
    n->records[n->plane_count] = flow_record_of(f, plane, n->zone);
    n->planes[n->plane_count++] = plane;
}

// The rectangle's sides as view_volume_in_zone makes the picture's: where they are the picture's, bit for bit the same.
static void planes_make(flow *f, flow_node *n)
{
    const view_base *b = &f->base;
    const flow_rectangle *r = &n->rectangle;
    const cull_guard guard = flow_guard(f, n->zone);
    const side sides[4] = {{b->right, -1, r->high[0] * b->wide}, {b->up, -1, r->high[1] * b->tall},
                           {b->right, 1, -r->low[0] * b->wide}, {b->up, 1, -r->low[1] * b->tall}};
    n->plane_count = 0;
    for (int s = 0; s < 4; s++) {
        const double inverse = 1 / sqrt(1 + sides[s].tangent * sides[s].tangent);
        double normal[3];
        for (int i = 0; i < 3; i++) normal[i] = (sides[s].sign * sides[s].axis[i] + sides[s].tangent * guard.forward[i]) * inverse;
        plane_add(f, n, &guard, normal, 0);
    }
    if (isfinite(b->camera->far_m)) plane_add(f, n, &guard, b->back, b->camera->far_m);
}

static void all_give_way(flow *f, flow_state *s, flow_rectangle *around)
{
    for (uint32_t i = 0; i < s->count; i++) {
        flow_node *n = &f->nodes[s->nodes[i]];
        rectangle_grow(around, &n->rectangle);
        n->flags |= NODE_DEAD;
    }
    f->result.portal_merges += s->count;
    s->count = 0;
}

void flow_merge_add(flow *f, uint32_t zone, const flow_rectangle *r, double key)
{
    flow_state *s = flow_reach(f, zone, key);
    if (s->flags & STATE_ROOT) return;
    flow_node *n = merged_node(f, zone);
    flow_rectangle wanted = *r;
    f->result.portal_merges++;
    if (s->flags & STATE_MERGED) {
        flow_nearer(f, n, key);
        if (is_around(&n->rectangle, r)) return;
        rectangle_grow(&wanted, &n->rectangle);
        s->growths++;
    } else {
        if (s->count < FLOW_ZONE_VOLUMES) f->result.limits_hit += f->pool_count < f->pool_capacity; // room for planes
        all_give_way(f, s, &wanted);
    }
    rectangle_coarsen(&wanted);
    if (is_whole(&wanted) || s->growths > FLOW_GROWTHS) {
        flow_root_add(f, &(flow_arrival){zone, SCENE_NONE, SCENE_NONE, s->key});
        root_node(f, zone)->flags |= NODE_MERGED;
        return;
    }
    const uint32_t queued = s->flags & STATE_MERGED ? n->flags & NODE_QUEUED : 0;
    const size_t first = ((size_t)f->scene->zone_count + zone) * FLOW_ROOT_SIDES;
    *n = (flow_node){.planes = f->planes + first, .records = f->records + first, .zone = zone, .way = SCENE_NONE, .parent = SCENE_NONE,
                     .source = f->source_count++, .flags = queued | NODE_MERGED, .rectangle = wanted, .key = s->key};
    planes_make(f, n);
    s->flags |= STATE_MERGED;
    s->count = 1;
    s->nodes[0] = (uint32_t)(n - f->nodes);
    flow_queue(f, n);
}
