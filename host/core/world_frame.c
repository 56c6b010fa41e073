// A frame of a view: the flow, then all zones that it reaches, stepped in rounds near to far.
// SPDX-License-Identifier: MIT
// Invariant: in each round all zones step, then all draw, then all test, then all answers are collected: half the stalls of
// zone by zone, and no test is asked before the near zones' draws. After a cut of the view there is nothing to guess by,
// and zone by zone draws least; so does who asks no more than one test a step, and has chosen to wait.
#define _POSIX_C_SOURCE 200809L
#include "world_parts.h"

#include <math.h>
#include <string.h>

// The clock's own code may be in no cache by now: what a first reading fetches is not the frame's time.
static void time_wake(world_view *v)
{
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &v->since);
}

static void time_start(world_view *v)
{
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &v->since);
}

static void time_stop(world_view *v)
{
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    const double ns = (double)(now.tv_sec - v->since.tv_sec) * 1e9 + (double)(now.tv_nsec - v->since.tv_nsec) - v->clock_overhead_ns;
    if (ns > 0) v->stats->cull_ns += ns;
}

// ---- Crossers ----

static const chain_stage *crosser_of(const viewer *zone, cull_query **query)
{
    for (uint32_t i = 1; i < zone->chain->stage_count; ++i)
        if (zone->chain->stages[i].role == ROLE_CROSS) {
            *query = zone->stages[i].query;
            return &zone->chain->stages[i];
        }
    return NULL;
}

static const char *crossing_fault(cull_crossing crossing, const cull_plane *planes, uint32_t count)
{
    if (crossing != CULL_CROSS_NONE && crossing != CULL_CROSS_NARROW && crossing != CULL_CROSS_SAME) return "it returned neither NONE, NARROW nor SAME";
    if (crossing != CULL_CROSS_NARROW) return NULL;
    if (count > CULL_MAX_PLANES) return "it narrows to more planes than there is room for";
    for (uint32_t i = 0; i < count; ++i)
        if (!isfinite(planes[i].normal.x) || !isfinite(planes[i].normal.y) || !isfinite(planes[i].normal.z) || !isfinite(planes[i].offset))
            return "it narrows to a plane that is not finite";
    return NULL;
}

static void tell_crosser(world_view *v, const char *id, uint32_t zone, const char *what)
{
    v->stats->faults++;
    if (v->told_crosser) return;
    v->told_crosser = 1;
    report_error(v->world->services->log, NULL, 0, "culler '%s' misbehaves: %s (zone '%s'); volumes pass its portals unclipped where it does",
                 id, what, v->world->scene->zones[zone].name);
}

cull_crossing world_view_cross(void *user, uint32_t zone, const cull_view *view, const cull_volume *in, uint32_t portal, cull_plane *planes,
                               uint32_t *plane_count)
{
    world_view *v = user;
    cull_query *query;
    const chain_stage *stage = v->zones[zone] ? crosser_of(v->zones[zone], &query) : NULL;
    if (!stage) return CULL_CROSS_SAME;
    const cull_crossing crossing = stage->plugin->cross(query, view, in, portal, planes, plane_count);
    const char *fault = crossing_fault(crossing, planes, *plane_count);
    if (!fault) return crossing;
    tell_crosser(v, stage->plugin->descriptor->id, zone, fault);
    return CULL_CROSS_SAME;
}

cull_crossing world_view_sight(void *user, const flow_sight *q, cull_plane *planes, uint32_t *plane_count)
{
    world_view *v = user;
    const viewer *zone = v->zones[q->zone];
    if (!zone || !zone->sight) return CULL_CROSS_SAME;
    const cull_crossing seen = zone->sight->part(zone->stages[0].query, q->view, q->in, q->portal, q->part, planes, plane_count);
    const char *fault = crossing_fault(seen, planes, *plane_count);
    if (!fault && q->part == CULL_MAX_PARTS && seen != CULL_CROSS_NONE) fault = "it parts a volume into more parts than there may be";
    if (!fault) return seen;
    tell_crosser(v, zone->chain->stages[0].plugin->descriptor->id, q->zone, fault);
    return CULL_CROSS_SAME;
}

int world_view_is_by_entry(void *user, uint32_t zone)
{
    const world_view *v = user;
    return v->zones[zone] && v->zones[zone]->sight;
}

// ---- Beginning ----

static void mark(const world_view *v, frame_mark what, uint32_t zone)
{
    const frame_driver *d = &v->frame.input->driver;
    if (d->mark) d->mark(d->user, what, zone);
}

static void run_flow(world_view *v, const frame_input *q)
{
    const flow_request request = {.camera = q->camera, .frame = q->frame, .open = v->open, .crosser = {v, world_view_cross, world_view_sight, world_view_is_by_entry}};
    mark(v, FRAME_FLOW_BEGINS, 0);
    flow_run(v->flow, &request, &v->reached);
    mark(v, FRAME_FLOW_ENDED, v->reached.zone_count);
    v->stats->zones = v->reached.zone_count;
    v->stats->volumes = v->reached.volume_count;
    v->stats->crossings = v->reached.crossings;
    v->stats->portal_merges = v->reached.portal_merges;
    v->stats->limits_hit = v->reached.limits_hit;
}

// The zone's volumes one behind the other. Where there is no room the zone is seen whole.
static const cull_volume *volumes_of(world_view *v, const flow_zone *z, uint32_t *count)
{
    static const cull_volume everything = {NULL, 0, 0};
    const uint32_t *numbers = &v->reached.by_zone[z->first];
    *count = z->count;
    if (z->count == 1) return &v->reached.volumes[numbers[0]].volume;
    if (z->count > v->volume_capacity - v->volume_count) {
        v->stats->limits_hit++;
        *count = 1;
        return &everything;
    }
    cull_volume *out = v->volumes + v->volume_count;
    for (uint32_t i = 0; i < z->count; ++i) out[i] = v->reached.volumes[numbers[i]].volume;
    v->volume_count += z->count;
    return out;
}

static void begin_zone(world_view *v, const flow_zone *z, int has_movers)
{
    viewer *zone = v->zones[z->zone];
    if (!zone && !has_movers) return;
    mover_search search = {.zone = z->zone, .viewer = zone};
    search.volumes = volumes_of(v, z, &search.volume_count);
    if (zone) {
        viewer_begin(zone, &v->frame, &(viewer_visit){&z->view, search.volumes, search.volume_count});
        v->active[v->active_count++] = zone;
    }
    if (has_movers) view_find_movers(v, &search);
}

static void begin_frame(world_view *v, const frame_input *q, frame_stats *stats)
{
    if (++v->serial == 0) { // after 2^32 frames: no stamp may look like one of this frame
        memset(v->stamps, 0, v->world->shared_count * sizeof *v->stamps);
        memset(v->marks.stamps, 0, v->world->mover_numbers * sizeof(uint32_t));
        v->serial = 1;
    }
    if (v->serial == 1 || v->open_changes != v->world->open_changes) memcpy(v->open, v->world->open, v->world->scene->portal_count);
    v->open_changes = v->world->open_changes;
    v->stats = stats;
    v->active_count = v->volume_count = v->lent_count = v->marks.count = 0;
    v->marks.serial = v->serial;
    v->frame = (viewer_frame){q, stats, v->stamps, &v->marks, v->serial};
}

// ---- Rounds ----

static void collect_early(world_view *v, viewer *const *zones, uint32_t count)
{
    uint32_t askers = 0;
    if (!v->frame.input->driver.collect) return;
    for (uint32_t i = 0; i < count; ++i) askers += zones[i]->answer_capacity != 0;
    if (!askers) return;
    time_stop(v);
    for (uint32_t i = 0; i < count; ++i) viewer_collect(zones[i], &v->frame);
    time_start(v);
}

static void carry_out(world_view *v, viewer *const *zones, uint32_t count)
{
    time_stop(v);
    for (uint32_t i = 0; i < count; ++i) viewer_draw(zones[i], &v->frame);
    for (uint32_t i = 0; i < count; ++i) viewer_test(zones[i], &v->frame);
    for (uint32_t i = 0; i < count; ++i)
        if (viewer_is_stepping(zones[i])) viewer_collect(zones[i], &v->frame);
    time_start(v);
}

static void run_rounds(world_view *v, viewer *const *zones, uint32_t count)
{
    collect_early(v, zones, count);
    uint32_t left = count;
    while (left) {
        int has_work = 0;
        for (uint32_t i = 0; i < left; ++i) {
            mark(v, FRAME_STEP_BEGINS, zones[i]->chain->data->index);
            viewer_step(zones[i], &v->frame);
            mark(v, FRAME_STEP_ENDED, zones[i]->chain->data->index);
            has_work |= viewer_has_work(zones[i], &v->frame.input->driver);
        }
        if (has_work) carry_out(v, zones, left);
        uint32_t still = 0;
        for (uint32_t i = 0; i < left; ++i)
            if (viewer_is_stepping(zones[i])) v->stepping[still++] = zones[i];
        left = still;
        zones = v->stepping;
    }
}

static int may_step(const viewer *v)
{
    return v->chain->stages[v->last].built.max_steps > 1 || v->answer_capacity;
}

// A test a step, each after what the one before it let be drawn: in rounds with zones in front its tests would come before their draws.
static int tests_singly(const viewer *v)
{
    const cull_built *last = &v->chain->stages[v->last].built;
    return last->max_tests == 1 && last->max_steps > 1;
}

// Where a run of zones that step in common rounds ends. After a cut that is the first that may step: zones that don't go with
// the next that does. Else one that tests singly begins when all nearer zones have drawn, and ends before the next begins.
static uint32_t rounds_end(const world_view *v, uint32_t first)
{
    const int is_cut = (v->frame.input->frame.flags & CULL_VIEW_CUT) != 0;
    uint32_t end = first;
    int steps = 0; // one of the run does
    for (; end < v->active_count; ++end) {
        const viewer *zone = v->active[end];
        if (!may_step(zone)) continue;
        if (is_cut) return end + 1;
        if (!tests_singly(zone)) steps = 1;
        else return steps ? end : end + 1;
    }
    return end;
}

static void run_zones(world_view *v)
{
    for (uint32_t first = 0, end; first < v->active_count; first = end) {
        end = rounds_end(v, first);
        run_rounds(v, v->active + first, end - first);
    }
}

// ---- Ending ----

// The check has counted the culler's own runs already: reading them again would cost a brute culler 3%.
static uint64_t items_of(const viewer *zone)
{
    uint64_t items = 0;
    if (zone->out == zone->batch.runs) return zone->check.items;
    for (uint32_t k = 0; k < zone->out_count; ++k) items += zone->out[k].count;
    return items;
}

static void finish(world_view *v, visible_set *out)
{
    *out = (visible_set){.zones = v->visible};
    for (uint32_t i = 0; i < v->active_count; ++i) {
        const viewer *zone = v->active[i];
        const uint32_t index = zone->chain->data->index;
        if (zone->state == VIEWER_FAULTY) view_mark_all_movers(v, index);
        if (!zone->out_count) continue;
        v->visible[out->zone_count++] = (visible_zone){index, zone->out_count, zone->out};
        v->stats->items_drawn += items_of(zone);
    }
    out->movers = v->marks.visible;
    out->mover_count = v->stats->movers_drawn = v->marks.count;
}

static void run_frame(world_view *v, const frame_input *q, visible_set *out)
{
    const int has_movers = v->world->mover_numbers != 0;
    run_flow(v, q);
    for (uint32_t i = 0; i < v->reached.zone_count; ++i) begin_zone(v, &v->reached.zones[i], has_movers);
    run_zones(v);
    if (has_movers) view_find_movers_everywhere(v, q);
    finish(v, out);
}

static void culling_changes(world *w, int by)
{
#ifndef NDEBUG
    if (by > 0) atomic_fetch_add(&w->culling, 1);
    else atomic_fetch_sub(&w->culling, 1);
#else
    (void)w;
    (void)by;
#endif
}

void world_cull(world_view *v, const frame_input *q, visible_set *out_set, frame_stats *out_stats)
{
    *out_stats = (frame_stats){0};
    culling_changes(v->world, 1);
    begin_frame(v, q, out_stats);
    time_wake(v);
    time_start(v);
    run_frame(v, q, &v->set);
    time_stop(v);
    if (q->driver.draw_movers && v->set.mover_count) q->driver.draw_movers(q->driver.user, v->set.movers, v->set.mover_count);
    culling_changes(v->world, -1);
    if (out_set) *out_set = v->set;
}
