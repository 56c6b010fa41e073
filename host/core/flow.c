// Flow: one view's way through the zones. Opening, where it starts, and the run. See flow.h.
// SPDX-License-Identifier: MIT
#include "flow_internal.h"

#include <portcullis/box.h>

#include <math.h>
#include <string.h>

static double larger(double a, double b)
{
    return a > b ? a : b;
}

// ---- Opening ----

static void gate_make(flow *f, uint32_t portal)
{
    const scene_portal *p = &f->scene->portals[portal];
    flow_gate *g = &f->gates[portal];
    const double(*points)[3] = (const double(*)[3]) & f->scene->portal_points[p->first_point];
    memcpy(g->low, points[0], sizeof g->low);
    memcpy(g->high, points[0], sizeof g->high);
    g->bend = 0;
    for (uint32_t i = 1; i < p->point_count; i++) {
        double above = 0;
        for (int k = 0; k < 3; k++) {
            if (points[i][k] < g->low[k]) g->low[k] = points[i][k];
            if (points[i][k] > g->high[k]) g->high[k] = points[i][k];
            above += p->plane[k] * (points[i][k] - points[0][k]);
        }
        g->bend = larger(g->bend, fabs(above));
    }
    f->most_bend = larger(f->most_bend, g->bend);
}

static void exit_make(flow *f, uint32_t place)
{
    const uint32_t way = f->scene->zone_portals[place];
    const scene_portal *p = &f->scene->portals[way / 2];
    flow_exit *e = &f->exits[place];
    *e = (flow_exit){.bend = f->gates[way / 2].bend, .way = way, .target = p->zones[1 - way % 2]};
    memcpy(e->at, f->scene->portal_points[p->first_point], sizeof e->at);
    for (int k = 0; k < 3; k++) e->normal[k] = way % 2 == 0 ? p->plane[k] : -p->plane[k];
    f->entries[way ^ 1] = 1 + place - f->scene->zones[p->zones[way % 2]].first_portal;
}

// Planes that this box lies inside of are left out of the zone's volumes: it holds the items, and where movers may come
// the zone's hulls, without hulls everything.
static cull_box box_with_movers(const scene *s, const zone_data *z)
{
    const scene_zone *zone = &s->zones[z->index];
    cull_box box = z->zone.box;
    if (!z->zone.mover_capacity) return box;
    if (!zone->hull_count) return (cull_box){{-FLT_MAX, -FLT_MAX, -FLT_MAX}, {FLT_MAX, FLT_MAX, FLT_MAX}};
    for (uint32_t h = zone->first_hull; h < zone->first_hull + zone->hull_count; h++) {
        const double *low = s->hulls[h].min, *high = s->hulls[h].max;
        const cull_box hull = {{(float)(low[0] - zone->origin[0]), (float)(low[1] - zone->origin[1]), (float)(low[2] - zone->origin[2])},
                               {(float)(high[0] - zone->origin[0]), (float)(high[1] - zone->origin[1]), (float)(high[2] - zone->origin[2])}};
        box = cull_box_union(box, hull);
    }
    return box;
}

static void places_make(flow *f, const zone_data *zones)
{
    for (uint32_t z = 0; z < f->scene->zone_count; z++) {
        f->places[z] = (view_place){.box = box_with_movers(f->scene, &zones[z]), .radius = zones[z].zone.radius};
        memcpy(f->places[z].origin, f->scene->zones[z].origin, sizeof f->places[z].origin);
    }
    for (uint32_t p = 0; p < f->scene->portal_count; p++) gate_make(f, p);
    for (uint32_t i = 0; i < 2 * f->scene->portal_count; i++) exit_make(f, i);
    zone_seams_find(f->scene, f->seams);
    f->first_stray = f->scene->zone_count;
    for (uint32_t z = f->scene->zone_count; z-- > 0;)
        if (f->scene->zones[z].flags & ZONE_STRAY) f->first_stray = z;
    for (uint32_t z = 0; z < f->scene->zone_count; z++)
        f->most_start_m = larger(f->most_start_m, f->seams[z].out + (double)f->places[z].radius / 65536);
}

static void sizes_find(flow *f)
{
    const scene *s = f->scene;
    uint32_t points = 0;
    for (uint32_t i = 0; i < s->portal_count; i++)
        if (s->portals[i].point_count > points) points = s->portals[i].point_count;
    f->polygon_capacity = 2 * (points + CULL_MAX_PLANES + 2); // twice: rounding may bend a loop
    const uint64_t wanted = (uint64_t)s->zone_count * FLOW_ZONE_VOLUMES; // a zone takes no more of them in a run
    f->pool_capacity = s->portal_count == 0 ? 0 : wanted < FLOW_CROSSINGS ? (uint32_t)wanted : FLOW_CROSSINGS;
    f->node_capacity = 2 * s->zone_count + f->pool_capacity;
    f->plane_capacity = 2 * s->zone_count * FLOW_ROOT_SIDES + f->pool_capacity * FLOW_PLANES_PER_CROSSING + CULL_MAX_PLANES;
}

static result arrays_open(flow *f)
{
    const size_t zones = f->scene->zone_count, portals = f->scene->portal_count, nodes = f->node_capacity;
    arena *a = &f->blocks;
    f->places = arena_push(a, zones, sizeof *f->places);
    f->seams = arena_push(a, zones, sizeof *f->seams);
    f->gates = arena_push(a, portals, sizeof *f->gates);
    f->exits = arena_push(a, 2 * portals, sizeof *f->exits);
    f->entries = arena_push(a, 2 * portals, sizeof *f->entries);
    f->nodes = arena_push(a, nodes, sizeof *f->nodes);
    f->planes = arena_push(a, f->plane_capacity, sizeof *f->planes);
    f->records = arena_push(a, f->plane_capacity, sizeof *f->records);
    f->states = arena_push(a, zones, sizeof *f->states);
    f->queue = arena_push(a, nodes, sizeof *f->queue);
    f->queue_places = arena_push(a, nodes, sizeof *f->queue_places);
    f->ways = arena_push(a, 2 * portals, sizeof *f->ways);
    for (int i = 0; i < 2; i++) f->polygon[i] = arena_push(a, f->polygon_capacity, sizeof *f->polygon[i]);
    for (int i = 0; i < 2; i++) f->order[i] = arena_push(a, zones, sizeof *f->order[i]);
    f->found = arena_push(a, zones, sizeof *f->found);
    f->sorted = arena_push(a, zones, sizeof *f->sorted);
    f->starts = arena_push(a, zones, sizeof *f->starts);
    f->volumes = arena_push(a, nodes, sizeof *f->volumes);
    f->by_zone = arena_push(a, nodes, sizeof *f->by_zone);
    const int has_all = f->places && f->seams && f->gates && f->exits && f->entries && f->nodes && f->planes && f->records && f->states && f->queue && f->queue_places && f->ways &&
                        f->polygon[0] && f->polygon[1] && f->order[0] && f->order[1] && f->found && f->sorted && f->starts && f->volumes &&
                        f->by_zone;
    if (!has_all) return RESULT_NO_MEMORY;
    memset(f->states, 0, zones * sizeof *f->states);
    memset(f->nodes, 0, nodes * sizeof *f->nodes);
    memset(f->ways, 0, 2 * portals);
    memset(f->queue_places, 0, nodes * sizeof *f->queue_places);
    f->lent = list_open(f->memory, CULL_MAX_PLANES, sizeof(cull_plane));
    f->seen = list_open(f->memory, CULL_MAX_PLANES, sizeof(cull_plane));
    return f->lent.items && f->seen.items ? RESULT_OK : RESULT_NO_MEMORY;
}

result flow_open(const flow_open_request *q, const allocator *memory, flow **out)
{
    flow *f = memory_alloc_zeroed(memory, 1, sizeof *f);
    if (!f) return RESULT_NO_MEMORY;
    f->scene = q->scene;
    f->graph = q->graph;
    f->memory = memory;
    f->blocks = arena_make(memory);
    sizes_find(f);
    if (arrays_open(f) != RESULT_OK) {
        flow_close(f);
        return RESULT_NO_MEMORY;
    }
    places_make(f, q->zones);
    if (flow_ports_open(f) != RESULT_OK) {
        flow_close(f);
        return RESULT_NO_MEMORY;
    }
    *out = f;
    return RESULT_OK;
}

void flow_close(flow *f)
{
    if (!f) return;
    flow_ports_close(f);
    list_close(&f->lent, f->memory);
    list_close(&f->seen, f->memory);
    arena_free(&f->blocks);
    memory_free(f->memory, f, 1, sizeof *f);
}

// ---- Zones reached ----

flow_state *flow_reach(flow *f, uint32_t zone, double key)
{
    flow_state *s = &f->states[zone];
    if (s->flags & STATE_REACHED) {
        if (key < s->key) s->key = key;
        return s;
    }
    s->flags = STATE_REACHED;
    s->key = key;
    s->found = f->found_count++;
    f->found[s->found].zone = zone;
    view_in_zone(&f->base, &f->places[zone], &f->found[s->found].view);
    return s;
}

void flow_root_add(flow *f, const flow_arrival *a)
{
    flow_state *s = flow_reach(f, a->zone, a->key);
    if (s->flags & STATE_ROOT) return;
    for (uint32_t i = 0; i < s->count; i++) f->nodes[s->nodes[i]].flags |= NODE_DEAD;
    s->flags = (s->flags & ~(uint32_t)STATE_MERGED) | STATE_ROOT;
    s->count = 1;
    s->nodes[0] = a->zone;
    flow_node *n = root_node(f, a->zone);
    *n = (flow_node){.planes = f->planes + (size_t)a->zone * FLOW_ROOT_SIDES, .records = f->records + (size_t)a->zone * FLOW_ROOT_SIDES,
                     .zone = a->zone, .way = a->way, .parent = a->parent, .rectangle = {{-1, -1}, {1, 1}}, .key = a->key};
    if (a->parent != SCENE_NONE) n->path = f->nodes[a->parent].path | (uint64_t)1 << (a->way / 2 % 64);
    view_volume volume;
    view_volume_in_zone(&f->base, &f->places[a->zone], &volume);
    n->plane_count = volume.plane_count;
    for (uint32_t i = 0; i < volume.plane_count; i++) {
        n->planes[i] = volume.planes[i];
        n->records[i] = (flow_record){volume.planes[i], FLOW_ROOT_RECORD + volume.sides[i]};
    }
    flow_queue(f, n);
}

// ---- A run ----

static void run_begin(flow *f, const flow_request *q)
{
    for (uint32_t i = 0; i < f->found_count; i++) f->states[f->found[i].zone] = (flow_state){0};
    memset(f->ways, 0, 2 * (size_t)f->scene->portal_count);
    f->found_count = f->queue_count = f->queue_turns = f->pool_count = 0;
    f->plane_count = 2 * f->scene->zone_count * FLOW_ROOT_SIDES;
    f->source_count = 1;
    f->result = (flow_result){0};
    f->camera = *q->camera;
    view_base_make(&f->camera, &q->frame, &f->base);
    const double tall = f->base.tall, wide = f->base.wide;
    f->corner_m = q->camera->near_m * sqrt((tall * tall + wide * wide) + 1);
    // As cull_guard_plane moves a line of the picture: pixels, and the boxes' widening at the picture's corner.
    f->widening = 1.7320508075688772 * CULL_GUARD_DISTANCE * (1 + 1.0 / 262144) * f->base.reach;
    f->guard_tangent = CULL_GUARD_PX * f->base.pixel_tangent + f->widening * f->base.reach;
}

static double place_distance(const view_place *p, const double eye[3])
{
    const double low[3] = {(double)p->box.min.x, (double)p->box.min.y, (double)p->box.min.z};
    const double high[3] = {(double)p->box.max.x, (double)p->box.max.y, (double)p->box.max.z};
    double sum = 0;
    for (int i = 0; i < 3; i++) {
        const double at = eye[i] - p->origin[i], off = larger(larger(low[i] - at, at - high[i]), 0);
        sum += off * off;
    }
    return sqrt(sum);
}

// graph_zones_at knows one distance; this is the zone's own, which a huge neighbour's radius does not reach into.
static int is_start(const flow *f, uint32_t zone, double beyond_m)
{
    const double near_m = beyond_m + (double)f->places[zone].radius / 65536 + f->seams[zone].out;
    return graph_zone_reaches(f->graph, zone, f->base.camera->eye, near_m);
}

static void start(flow *f)
{
    const scene *s = f->scene;
    const double *eye = f->base.camera->eye;
    const uint32_t count = graph_zones_at(f->graph, eye, f->corner_m + f->most_start_m, f->starts, s->zone_count);
    // A zone that only the near plane reaches into does not hold the eye, and says nothing of what stands between the zones.
    uint32_t holder = 0; // the first
    while (holder < count && !is_start(f, f->starts[holder], 0)) holder++;
    for (uint32_t i = 0; i < count && holder < count; i++)
        if (i == holder || is_start(f, f->starts[i], f->corner_m)) flow_root_add(f, &(flow_arrival){f->starts[i], SCENE_NONE, SCENE_NONE, 0});
    if (holder < count) return;
    f->result.is_everything = 1;
    for (uint32_t z = 0; z < s->zone_count; z++)
        if (!(s->zones[z].flags & ZONE_STRAY))
            flow_root_add(f, &(flow_arrival){z, SCENE_NONE, SCENE_NONE, place_distance(&f->places[z], eye)});
    f->queue_count = 0; // nothing is left to be reached
}

void flow_run(flow *f, const flow_request *q, flow_result *out)
{
    run_begin(f, q);
    start(f);
    while (f->queue_count > 0) {
        flow_node *n = flow_queue_pop(f);
        if (!(n->flags & NODE_DEAD)) flow_leave(f, q, n);
    }
    for (uint32_t z = f->first_stray; z < f->scene->zone_count; z++) // made up ones stand last
        if (f->scene->zones[z].flags & ZONE_STRAY) flow_root_add(f, &(flow_arrival){z, SCENE_NONE, SCENE_NONE, INFINITY});
    f->queue_count = 0;
    flow_finish(f, out);
}
