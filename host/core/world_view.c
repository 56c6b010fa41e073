// Views of a world: opened with all the memory that their frames need.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "world_parts.h"

#include <string.h>

// The least time between two readings: what a frame of no work would show.
static double clock_overhead_ns(void)
{
    double least = 1e9;
    for (int i = 0; i < 64; ++i) {
        struct timespec a, b;
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &a);
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &b);
        const double ns = (double)(b.tv_sec - a.tv_sec) * 1e9 + (double)(b.tv_nsec - a.tv_nsec);
        if (ns < least) least = ns;
    }
    return least;
}

result world_view_open_zone(world_view *v, uint32_t zone, const zone_chain *c, report *r, viewer **out)
{
    const world *w = v->world;
    viewer_room_size size = {0};
    (void)zone;
    viewer_room_size_add(&size, c->chain);
    if (viewer_room_fit(&v->room, &size, w->memory) != RESULT_OK) return report_no_memory(r, NULL);
    const viewer_request q = {c->chain, c->shared, &v->room, w->services, v->checks,
                              w->scene->zone_count > GUARDED_ZONES_MOST ? LIST_PLAIN : LIST_GUARDED, w->mover_numbers};
    return viewer_open(&q, r, out);
}

// Each crossing adds a volume to one zone, which has at most FLOW_ZONE_VOLUMES.
static uint32_t volumes_most(uint32_t zone_count)
{
    const uint64_t by_zone = (uint64_t)zone_count * FLOW_ZONE_VOLUMES, by_crossing = (uint64_t)zone_count + 2 * FLOW_CROSSINGS;
    return (uint32_t)(by_zone < by_crossing ? by_zone : by_crossing);
}

static uint32_t lent_most(const world *w)
{
    const uint64_t by_zone = (uint64_t)w->scene->zone_count * w->data[0].zone.mover_capacity, by_mover = (uint64_t)w->mover_numbers * MOVER_ZONES_MOST;
    return (uint32_t)(by_zone < by_mover ? by_zone : by_mover);
}

static int open_lists(world_view *v)
{
    const world *w = v->world;
    const uint32_t zones = w->scene->zone_count;
    v->volume_capacity = zones > 1 ? volumes_most(zones) : 1;
    v->zones = memory_alloc_zeroed(w->memory, zones, sizeof(viewer *));
    v->active = memory_alloc_zeroed(w->memory, zones, sizeof(viewer *));
    v->stepping = memory_alloc_zeroed(w->memory, zones, sizeof(viewer *));
    v->volumes = memory_alloc_zeroed(w->memory, v->volume_capacity, sizeof *v->volumes);
    v->lent_capacity = lent_most(w);
    v->lent = memory_alloc_zeroed(w->memory, v->lent_capacity, sizeof *v->lent);
    v->visible = memory_alloc_zeroed(w->memory, zones, sizeof *v->visible);
    v->stamps = memory_alloc_zeroed(w->memory, w->shared_count, sizeof *v->stamps);
    v->marks.stamps = memory_alloc_zeroed(w->memory, w->mover_numbers, sizeof(uint32_t));
    v->marks.visible = memory_alloc_zeroed(w->memory, w->mover_numbers, sizeof(uint32_t));
    v->open = memory_alloc_zeroed(w->memory, w->scene->portal_count, 1);
    return v->open && v->zones && v->active && v->stepping && v->volumes && v->lent && v->visible && v->stamps && v->marks.stamps && v->marks.visible;
}

static result open_viewers(world_view *v, report *r)
{
    const world *w = v->world;
    viewer_room_size size = {0};
    for (uint32_t i = 0; i < w->scene->zone_count; ++i)
        if (w->chains[i].chain) viewer_room_size_add(&size, w->chains[i].chain);
    if (viewer_room_fit(&v->room, &size, w->memory) != RESULT_OK) return report_no_memory(r, NULL);
    result done = RESULT_OK;
    for (uint32_t i = 0; i < w->scene->zone_count && done == RESULT_OK; ++i)
        if (w->chains[i].chain) done = world_view_open_zone(v, i, &w->chains[i], r, &v->zones[i]);
    return done;
}

result world_view_open(world *w, viewer_checks checks, report *r, world_view **out)
{
    world_assert_still(w);
    world_view *v = memory_alloc_zeroed(w->memory, 1, sizeof *v);
    if (!v) return report_no_memory(r, NULL);
    v->world = w;
    v->checks = checks;
    v->next = w->views;
    w->views = v;
    const flow_open_request q = {w->scene, w->graph, w->data};
    result done = open_lists(v) && flow_open(&q, w->memory, &v->flow) == RESULT_OK ? RESULT_OK : report_no_memory(r, NULL);
    if (done == RESULT_OK) done = open_viewers(v, r);
    if (done != RESULT_OK) {
        world_view_close(v);
        return done;
    }
    v->clock_overhead_ns = clock_overhead_ns();
    *out = v;
    return RESULT_OK;
}

void world_view_close(world_view *v)
{
    if (!v) return;
    world *w = v->world;
    const uint32_t zones = w->scene->zone_count;
    world_assert_still(w);
    world_view **at = &w->views;
    while (*at != v) at = &(*at)->next;
    *at = v->next;
    for (uint32_t i = 0; v->zones && i < zones; ++i) viewer_close(v->zones[i]);
    viewer_room_close(&v->room, w->memory);
    flow_close(v->flow);
    memory_free(w->memory, v->zones, zones, sizeof(viewer *));
    memory_free(w->memory, v->active, zones, sizeof(viewer *));
    memory_free(w->memory, v->stepping, zones, sizeof(viewer *));
    memory_free(w->memory, v->volumes, v->volume_capacity, sizeof *v->volumes);
    memory_free(w->memory, v->lent, v->lent_capacity, sizeof *v->lent);
    memory_free(w->memory, v->visible, zones, sizeof *v->visible);
    memory_free(w->memory, v->stamps, w->shared_count, sizeof *v->stamps);
    memory_free(w->memory, v->open, w->scene->portal_count, 1);
    memory_free(w->memory, v->marks.stamps, w->mover_numbers, sizeof(uint32_t));
    memory_free(w->memory, v->marks.visible, w->mover_numbers, sizeof(uint32_t));
    memory_free(w->memory, v, 1, sizeof *v);
}

const flow_result *world_view_flow(const world_view *v)
{
    return &v->reached;
}

double world_view_clock_overhead_ns(const world_view *v)
{
    return v->clock_overhead_ns;
}
