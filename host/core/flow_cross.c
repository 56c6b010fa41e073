// Through a portal: whether a volume gets through, who narrows it, and what the zone behind takes of it.
// SPDX-License-Identifier: MIT
// Invariant: a portal is passed over only if no straight line from the eye, inside the volume, goes through it.
#include "flow_internal.h"

#include <math.h>
#include <string.h>

// One volume at one portal.
typedef struct crossing {
    const flow_request *request;
    flow_node *from;
    uint32_t way, local; // local: in the zone's own order
    uint32_t target;
    int is_near;
    flow_polygon polygon; // what the volume leaves of the portal; all of it when near
    double key;
} crossing;

double flow_near_m(const flow *f, uint32_t zone, uint32_t portal)
{
    return f->corner_m + (double)f->places[zone].radius / 65536 + f->gates[portal].bend;
}

double flow_eye_height(const flow *f, uint32_t way)
{
    const scene_portal *p = &f->scene->portals[way / 2];
    const double *at = f->scene->portal_points[p->first_point], *eye = f->base.camera->eye;
    const double above = (p->plane[0] * (eye[0] - at[0]) + p->plane[1] * (eye[1] - at[1])) + p->plane[2] * (eye[2] - at[2]);
    return way % 2 == 0 ? above : -above;
}

double flow_gate_distance(const double low[3], const double high[3], const double eye[3])
{
    double sum = 0;
    for (int i = 0; i < 3; i++) {
        const double off = eye[i] < low[i] ? low[i] - eye[i] : eye[i] > high[i] ? eye[i] - high[i] : 0;
        sum += off * off;
    }
    return sqrt(sum);
}

static double gate_distance(const flow_gate *g, const double eye[3])
{
    return flow_gate_distance(g->low, g->high, eye);
}

static int is_near(const flow *f, uint32_t zone, uint32_t way, double height)
{
    const double near_m = flow_near_m(f, zone, way / 2);
    return fabs(height) <= near_m && gate_distance(&f->gates[way / 2], f->base.camera->eye) <= near_m;
}

// Heights of a polygon behind the plane of the portal that a node came in through.
typedef struct entry_heights {
    double least, most, bend, flat; // bend: that the entry's points lie off its plane; flat: what rounding alone may do
} entry_heights;

static entry_heights heights_behind_entry(const flow *f, const flow_node *n, const flow_polygon *p)
{
    const scene_portal *entry = &f->scene->portals[n->way / 2];
    const double *at = f->scene->portal_points[entry->first_point], *eye = f->base.camera->eye;
    const double sign = n->way % 2 == 0 ? -1 : 1, base[3] = {at[0] - eye[0], at[1] - eye[1], at[2] - eye[2]};
    const double bend = f->gates[n->way / 2].bend;
    // Points on the scene's step are off the plane that they had by under 4 steps between them: no bend, as who made the
    // scene sees it. Differences of such points: 2^-40 of them is far above double rounding, far below a step.
    const double rounded = 4 * f->scene->step, least_flat = (double)f->places[n->zone].radius / 1099511627776;
    entry_heights h = {.least = INFINITY, .most = -INFINITY, .bend = bend > rounded ? bend : 0};
    h.flat = least_flat + (bend > rounded ? 0 : bend);
    for (uint32_t i = 0; i < p->count; i++) {
        const cull_point q = p->points[i];
        const double above = entry->plane[0] * (q.x - base[0]) + entry->plane[1] * (q.y - base[1]) + entry->plane[2] * (q.z - base[2]);
        h.least = sign * above < h.least ? sign * above : h.least;
        h.most = sign * above > h.most ? sign * above : h.most;
    }
    return h;
}

// A line that came in through one portal goes on behind its plane, or where its points bend it before. A polygon that
// touches that plane with an edge, and is else before it, is passed by none: without this, two portals that meet at an
// edge would feed each other. One that lies in the plane is not judged.
static int is_before_entry(const flow *f, const flow_node *n, const flow_polygon *p)
{
    if (!(n->flags & NODE_CLIPPED)) return 0;
    const entry_heights h = heights_behind_entry(f, n, p);
    return h.most <= h.flat - h.bend && h.least < -h.flat - h.bend;
}

static int is_on_path(const flow *f, const flow_node *n, uint32_t portal)
{
    if (n->source == 0 || !(n->path >> portal % 64 & 1)) return 0; // the whole frustum is refused by the zone that has it
    for (const flow_node *at = n;; at = &f->nodes[at->parent]) {
        if (at->way != SCENE_NONE && at->way / 2 == portal) return 1;
        if (at->parent == SCENE_NONE) return 0;
    }
}

int flow_touches(const flow *f, const flow_node *n, uint32_t way)
{
    cull_cut cuts[CULL_MAX_PLANES];
    if (is_near(f, n->zone, way, flow_eye_height(f, way))) return 1;
    flow_cuts_make(f, n, cuts);
    const flow_polygon p = flow_clip(f, way / 2, cuts, n->plane_count);
    return p.count > 0 && !is_before_entry(f, n, &p);
}

// ---- What the zone behind takes ----

static flow_node *node_new(flow *f, const crossing *c, uint32_t planes)
{
    flow_state *s = &f->states[c->target];
    const uint32_t number = 2 * f->scene->zone_count + f->pool_count++;
    flow_node *n = &f->nodes[number];
    *n = (flow_node){.planes = f->planes + f->plane_count, .records = f->records + f->plane_count, .plane_count = planes,
                     .zone = c->target, .way = c->way, .parent = (uint32_t)(c->from - f->nodes), .key = c->key,
                     .path = c->from->path | (uint64_t)1 << (c->way / 2 % 64)};
    f->plane_count += planes;
    s->nodes[s->count++] = number;
    return n;
}

static int is_by_entry(const flow_crosser *c, uint32_t zone)
{
    return c->is_by_entry && c->is_by_entry(c->user, zone);
}

// What has the same source: all of it, unless the zone's culler would see less of it from the portal that it came in through.
static int holds_source(const flow *f, const crossing *c, const flow_node *n)
{
    if (n->source != c->from->source) return 0;
    return !n->entry || n->entry == f->entries[c->way] || !is_by_entry(&c->request->crosser, c->target);
}

static void same_add(flow *f, const crossing *c)
{
    const flow_node *from = c->from;
    if (from->source == 0) {
        flow_root_add(f, &(flow_arrival){c->target, c->way, (uint32_t)(from - f->nodes), c->key});
        return;
    }
    const flow_state *s = flow_reach(f, c->target, c->key);
    for (uint32_t i = 0; i < s->count; i++)
        if (holds_source(f, c, &f->nodes[s->nodes[i]])) {
            flow_nearer(f, &f->nodes[s->nodes[i]], c->key);
            return;
        }
    if (flow_must_merge(f, s, from->plane_count)) {
        flow_merge_add(f, c->target, &from->rectangle, c->key);
        return;
    }
    flow_node *n = node_new(f, c, from->plane_count);
    n->source = from->source;
    n->rectangle = from->rectangle;
    for (uint32_t i = 0; i < from->plane_count; i++) n->records[i] = from->records[i];
    flow_planes_in(f, c->target, n->records, from->plane_count, n->planes);
    flow_queue(f, n);
}

// A plane that the crosser copied keeps its record.
static flow_record record_find(const flow_node *from, cull_plane plane)
{
    for (uint32_t i = 0; i < from->plane_count; i++)
        if (memcmp(&from->planes[i], &plane, sizeof plane) == 0) return from->records[i];
    return (flow_record){plane, from->zone};
}

// What goes on from there passes no portal before the plane of its entry, whatever planes the crosser wrote: who lies in
// it has to be behind that plane too.
static int is_behind_entry(const flow *f, const crossing *c, const flow_node *other)
{
    if (!(other->flags & NODE_CLIPPED) || other->way == c->way || is_on_path(f, c->from, other->way / 2)) return 1;
    const entry_heights h = heights_behind_entry(f, other, &c->polygon);
    return h.least >= -h.flat - h.bend;
}

static flow_node *find_around(const flow *f, const flow_state *s, const crossing *by, const flow_candidate *c, const flow_rectangle *r)
{
    const uint32_t entry = f->entries[by->way];
    const int is_apart = is_by_entry(&by->request->crosser, by->target);
    for (uint32_t i = 0; i < s->count; i++) {
        flow_node *other = &f->nodes[s->nodes[i]];
        if (is_apart && other->entry && other->entry != entry) continue;
        const int fits = r->low[0] >= other->rectangle.low[0] && r->low[1] >= other->rectangle.low[1] &&
                         r->high[0] <= other->rectangle.high[0] && r->high[1] <= other->rectangle.high[1];
        if (fits && is_behind_entry(f, by, other) && flow_is_inside(f, c, other)) return other;
    }
    return NULL;
}

static void narrow_add(flow *f, const crossing *c, const cull_plane *planes, uint32_t count)
{
    flow_state *s = flow_reach(f, c->target, c->key);
    flow_record records[CULL_MAX_PLANES];
    for (uint32_t i = 0; i < count; i++) records[i] = record_find(c->from, planes[i]);
    const flow_rectangle rectangle = flow_rectangle_of(f, &c->polygon);
    flow_node *around = find_around(f, s, c, &(flow_candidate){records, &c->polygon, count, c->way}, &rectangle);
    if (around) {
        if (around->entry != f->entries[c->way]) around->entry = 0;
        flow_nearer(f, around, c->key);
        return;
    }
    if (flow_must_merge(f, s, count)) {
        flow_merge_add(f, c->target, &rectangle, c->key);
        return;
    }
    flow_node *n = node_new(f, c, count);
    n->entry = f->entries[c->way];
    // Not what passed unclipped: that stands for every portal that brings its source, and lies not behind the first one's plane.
    if (flow_eye_height(f, c->way) > flow_near_m(f, c->from->zone, c->way / 2)) n->flags |= NODE_CLIPPED;
    n->source = f->source_count++;
    n->rectangle = rectangle;
    for (uint32_t i = 0; i < count; i++) n->records[i] = records[i];
    flow_planes_in(f, c->target, records, count, n->planes);
    flow_queue(f, n);
}

// What a crosser wrote is its word, not ours.
static int is_sound(const cull_plane *planes, uint32_t count)
{
    if (count > CULL_MAX_PLANES) return 0;
    for (uint32_t i = 0; i < count; i++) {
        const cull_vec3 n = planes[i].normal;
        const float length = n.x * n.x + n.y * n.y + n.z * n.z;
        if (!(length > 0.99f && length < 1.01f) || !isfinite(planes[i].offset)) return 0;
    }
    return 1;
}

// What the crosser makes of one volume at the portal. NONE: nothing of it gets through.
static cull_crossing take_volume(flow *f, const crossing *c, const cull_volume *in, const cull_view *view)
{
    cull_plane *planes = f->lent.items;
    uint32_t count = 0;
    const flow_crosser *crosser = &c->request->crosser;
    if (flow_must_merge(f, &f->states[c->target], 0)) { // no need to ask
        const flow_rectangle r = flow_rectangle_of(f, &c->polygon);
        flow_merge_add(f, c->target, &r, c->key);
        return CULL_CROSS_NARROW;
    }
    const cull_crossing answer = crosser->cross(crosser->user, c->from->zone, view, in, c->local, planes, &count);
    if (answer == CULL_CROSS_NONE) return CULL_CROSS_NONE;
    if (answer == CULL_CROSS_NARROW && is_sound(planes, count)) {
        narrow_add(f, c, planes, count);
        return CULL_CROSS_NARROW;
    }
    f->result.limits_hit += answer != CULL_CROSS_SAME;
    same_add(f, c);
    return CULL_CROSS_SAME;
}

// NARROW: *out is the part. SAME: all of `in`, and no part after it. One part too many is asked for: it has to be NONE.
static cull_crossing part_ask(flow *f, const flow_crosser *crosser, const flow_sight *q, cull_volume *out)
{
    uint32_t count = 0;
    *out = *q->in;
    if (!crosser->sight) return CULL_CROSS_SAME;
    const cull_crossing seen = crosser->sight(crosser->user, q, f->seen.items, &count);
    if (seen == CULL_CROSS_NONE || seen == CULL_CROSS_SAME) return seen;
    if (seen != CULL_CROSS_NARROW || q->part == CULL_MAX_PARTS || !is_sound(f->seen.items, count)) {
        f->result.limits_hit++;
        return CULL_CROSS_SAME;
    }
    *out = (cull_volume){f->seen.items, count, 0};
    return CULL_CROSS_NARROW;
}

// What the part leaves of the portal. 0: no line gets through it.
static int part_clip(const flow *f, const cull_volume *part, crossing *c)
{
    cull_cut cuts[CULL_MAX_PLANES];
    for (uint32_t i = 0; i < part->plane_count; i++) cuts[i] = flow_cut_at_eye(f, part->planes[i], c->from->zone);
    c->polygon = flow_clip(f, c->way / 2, cuts, part->plane_count);
    return c->polygon.count > 0 && !is_before_entry(f, c->from, &c->polygon);
}

// Part by part of what gets to the portal, where the zone can tell; SAME of one part is all there is.
static void take_parts(flow *f, const crossing *whole, uint8_t before)
{
    const cull_volume in = {whole->from->planes, whole->from->plane_count, whole->from->entry};
    flow_sight q = {&f->found[f->states[whole->from->zone].found].view, &in, whole->from->zone, whole->local, 0};
    int any = 0;
    for (; !(whole->from->flags & NODE_DEAD); q.part++) {
        cull_volume through;
        crossing c = *whole;
        const cull_crossing seen = part_ask(f, &whole->request->crosser, &q, &through);
        if (seen == CULL_CROSS_NONE) break;
        const int is_all = q.part == 0 && seen == CULL_CROSS_SAME; // clipped already
        const cull_crossing answer = is_all || part_clip(f, &through, &c) ? take_volume(f, &c, &through, q.view) : CULL_CROSS_NONE;
        any |= answer != CULL_CROSS_NONE;
        if (seen == CULL_CROSS_SAME || answer == CULL_CROSS_SAME) break;
    }
    if (!any) f->ways[whole->way] = before ? before : WAY_REFUSED;
}

static void take(flow *f, const crossing *c)
{
    flow_state *s = &f->states[c->target];
    const uint8_t before = f->ways[c->way];
    f->ways[c->way] = WAY_CROSSED;
    if (s->flags & STATE_ROOT) {
        (void)flow_reach(f, c->target, c->key); // has all; maybe nearer this way
        flow_nearer(f, root_node(f, c->target), c->key);
        return;
    }
    if (!c->is_near && !c->request->crosser.cross && flow_must_merge(f, s, 0)) {
        const flow_rectangle r = flow_rectangle_of(f, &c->polygon);
        flow_merge_add(f, c->target, &r, c->key);
        return;
    }
    if (c->is_near || !c->request->crosser.cross) {
        same_add(f, c);
        return;
    }
    take_parts(f, c, before);
}

// How far the zone behind is this way: farther than the zone that is left, at least.
static double key_of(const flow *f, const crossing *c)
{
    const double along = gate_distance(&f->gates[c->way / 2], f->base.camera->eye);
    return along > c->from->key ? along : c->from->key;
}

// height: of the eye above the portal's plane, in the zone that is left.
static void portal_try(flow *f, crossing *c, double height, flow_port_walk *walk)
{
    const flow_node *from = c->from;
    const flow_state *s = &f->states[c->target];
    if (s->flags & STATE_ROOT && s->key <= key_of(f, c)) return; // it has all, and is no farther
    if (is_on_path(f, from, c->way / 2)) return;
    f->result.crossings++;
    c->is_near = is_near(f, from->zone, c->way, height);
    if (!c->is_near) {
        c->polygon = flow_clip(f, c->way / 2, flow_ports_cuts(walk), from->plane_count);
        if (c->polygon.count == 0 || is_before_entry(f, from, &c->polygon)) return;
    }
    c->key = key_of(f, c);
    take(f, c);
}

// As flow_eye_height.
static double exit_height(const flow *f, const flow_exit *e)
{
    const double *eye = f->base.camera->eye;
    return (e->normal[0] * (eye[0] - e->at[0]) + e->normal[1] * (eye[1] - e->at[1])) + e->normal[2] * (eye[2] - e->at[2]);
}

void flow_leave(flow *f, const flow_request *q, flow_node *n)
{
    const flow_exit *exits = &f->exits[f->scene->zones[n->zone].first_portal];
    const double near_m = f->corner_m + (double)f->places[n->zone].radius / 65536; // as flow_near_m
    flow_port_walk walk;
    uint32_t i;
    flow_ports_start(f, n, &walk);
    while (!(n->flags & NODE_DEAD) && flow_ports_next(&walk, &i)) {
        const flow_exit *e = &exits[i];
        const double height = exit_height(f, e);
        if (height < -(near_m + e->bend) || !q->open[e->way / 2]) continue; // the eye is behind it, or it is shut
        crossing c = {.request = q, .from = n, .way = e->way, .local = i, .target = e->target};
        portal_try(f, &c, height, &walk);
    }
}
