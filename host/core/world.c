// Worlds: opens zones, graph, movers and chains of a scene; doors and movers on top. Chains: world_chains.c.
// SPDX-License-Identifier: MIT
#include "world_parts.h"

#include <assert.h>
#include <math.h>
#include <string.h>

// ---- Opening ----

static result count_shared(world *w)
{
    const scene *s = w->scene;
    for (uint32_t i = 0; i < s->item_count; ++i) w->shared_count += s->listings[i] > 1;
    w->shared_items = memory_alloc(w->memory, w->shared_count, sizeof *w->shared_items);
    if (!w->shared_items) return RESULT_NO_MEMORY;
    uint32_t count = 0;
    for (uint32_t i = 0; i < s->item_count; ++i)
        if (s->listings[i] > 1) w->shared_items[count++] = i;
    return RESULT_OK;
}

static result open_zones(world *w)
{
    const scene *s = w->scene;
    const uint32_t most = s->zone_count == 1 || w->mover_numbers < ZONE_MOVERS_MOST ? w->mover_numbers : ZONE_MOVERS_MOST;
    w->data = memory_alloc_zeroed(w->memory, s->zone_count, sizeof *w->data);
    w->chains = memory_alloc_zeroed(w->memory, s->zone_count, sizeof *w->chains);
    result done = w->data && w->chains ? RESULT_OK : RESULT_NO_MEMORY;
    for (uint32_t i = 0; i < s->zone_count && done == RESULT_OK; ++i)
        done = zone_data_open(&(zone_data_request){s, i, most}, w->memory, &w->data[i]);
    return done;
}

static const double MOVER_REACH_M = 1e9; // as far as movers.h takes boxes

static void place_mover(world *w, uint32_t mover, result (*place)(movers *, uint32_t, const double *, const double *))
{
    const scene *s = w->scene;
    const uint32_t door = s->movers[mover].door;
    scene_pose pose;
    double min[3], max[3];
    scene_pose_at(s, mover, w->time_s, door == SCENE_NONE ? DOORS_SHUT : w->doors[door], &pose);
    scene_pose_box(s, mover, &pose, min, max);
    w->poses[mover] = pose;
    if (place(w->movers, mover, min, max) == RESULT_OK) return;
    for (int k = 0; k < 3; ++k) { // too far out to be placed: then it may be anywhere, and is seen from everywhere
        min[k] = -MOVER_REACH_M;
        max[k] = MOVER_REACH_M;
    }
    const result anywhere = place(w->movers, mover, min, max);
    assert(anywhere == RESULT_OK);
    (void)anywhere;
}

static void shut_portals(world *w, uint32_t door)
{
    for (uint32_t i = w->door_first[door]; i < w->door_first[door + 1]; ++i) w->open[w->door_portals[i]] = w->doors[door] == DOORS_OPEN;
    w->open_changes++;
}

// Opening a door costs its own portals, not all.
static result open_doors(world *w)
{
    const scene *s = w->scene;
    const size_t firsts = (size_t)s->door_count + 1;
    w->doors = memory_alloc_zeroed(w->memory, s->door_count, sizeof *w->doors);
    w->open = memory_alloc_zeroed(w->memory, s->portal_count, 1);
    w->door_portals = memory_alloc(w->memory, s->portal_count, sizeof *w->door_portals);
    w->door_first = memory_alloc_zeroed(w->memory, firsts, sizeof *w->door_first);
    if (!w->doors || !w->open || !w->door_portals || !w->door_first) return RESULT_NO_MEMORY;
    for (uint32_t d = 0; d < s->door_count; ++d) w->doors[d] = s->doors[d].at_rest;
    for (uint32_t p = 0; p < s->portal_count; ++p) {
        const uint32_t door = s->portals[p].door;
        w->open[p] = door == SCENE_NONE || w->doors[door] == DOORS_OPEN;
        if (door != SCENE_NONE) w->door_first[door]++;
    }
    for (uint32_t d = 0, sum = 0; d < firsts; ++d) w->door_first[d] = sum += w->door_first[d]; // where each ends
    for (uint32_t p = s->portal_count; p-- > 0;)
        if (s->portals[p].door != SCENE_NONE) w->door_portals[--w->door_first[s->portals[p].door]] = p;
    return RESULT_OK;
}

static result open_movers(world *w)
{
    const scene *s = w->scene;
    w->poses = memory_alloc_zeroed(w->memory, s->mover_count, sizeof *w->poses);
    if (!w->poses || open_doors(w) != RESULT_OK || graph_open(s, w->memory, &w->graph) != RESULT_OK) return RESULT_NO_MEMORY;
    const movers_request q = {s, w->graph, w->mover_numbers};
    if (movers_open(&q, w->memory, &w->movers) != RESULT_OK) return RESULT_NO_MEMORY;
    for (uint32_t i = 0; i < s->mover_count; ++i) place_mover(w, i, movers_add);
    return RESULT_OK;
}

static result open_chains(world *w, const world_request *q, report *r)
{
    result done = RESULT_OK;
    for (uint32_t i = 0; i < w->scene->zone_count && done == RESULT_OK; ++i) {
        const chain_spec *spec = q->chains && q->chains[i] ? q->chains[i] : q->chain;
        if (w->data[i].zone.item_count) done = zone_chain_build(&(zone_chain_request){w, i, spec}, r, &w->chains[i]);
    }
    return done;
}

static result open_lock(world *w)
{
    w->loading = memory_alloc(w->memory, 1, sizeof *w->loading);
    if (!w->loading) return RESULT_NO_MEMORY;
    if (pthread_mutex_init(w->loading, NULL) == 0) return RESULT_OK;
    memory_free(w->memory, w->loading, 1, sizeof *w->loading);
    w->loading = NULL;
    return RESULT_NO_MEMORY;
}

result world_open(const world_request *q, report *r, world **out)
{
    const allocator *memory = q->services->memory;
    if (q->scene->mover_count > MOVERS_MOST || q->more_movers > MOVERS_MOST - q->scene->mover_count)
        return report_error(r, q->scene->path, 0, "%u movers and room for %u more are over %d; ask for room for fewer", (unsigned)q->scene->mover_count, (unsigned)q->more_movers, MOVERS_MOST);
    world *w = memory_alloc_zeroed(memory, 1, sizeof *w);
    if (!w) return report_no_memory(r, NULL);
    w->scene = q->scene;
    w->plugins = q->plugins;
    w->services = q->services;
    w->memory = memory;
    w->mover_numbers = q->scene->mover_count + q->more_movers;
    result done = open_lock(w);
    if (done == RESULT_OK) done = count_shared(w);
    if (done == RESULT_OK) done = open_zones(w);
    if (done == RESULT_OK) done = open_movers(w);
    if (done != RESULT_OK) report_no_memory(r, NULL);
    else done = open_chains(w, q, r);
    if (done != RESULT_OK) {
        world_close(w);
        return done;
    }
    *out = w;
    return RESULT_OK;
}

static void close_zones(world *w)
{
    const uint32_t count = w->scene->zone_count;
    for (uint32_t i = 0; w->data && w->chains && i < count; ++i) zone_chain_close(&w->chains[i], w, i);
    for (uint32_t i = 0; w->data && i < count; ++i) zone_data_close(&w->data[i]);
    memory_free(w->memory, w->chains, count, sizeof *w->chains);
    memory_free(w->memory, w->data, count, sizeof *w->data);
}

void world_close(world *w)
{
    if (!w) return;
    world_assert_still(w);
    while (w->views) world_view_close(w->views);
    const scene *s = w->scene;
    const allocator *memory = w->memory;
    close_zones(w);
    movers_close(w->movers);
    graph_close(w->graph);
    memory_free(memory, w->shared_items, w->shared_count, sizeof *w->shared_items);
    memory_free(memory, w->poses, s->mover_count, sizeof *w->poses);
    memory_free(memory, w->doors, s->door_count, sizeof *w->doors);
    memory_free(memory, w->door_portals, s->portal_count, sizeof *w->door_portals);
    memory_free(memory, w->door_first, (size_t)s->door_count + 1, sizeof *w->door_first);
    memory_free(memory, w->open, s->portal_count, 1);
    if (w->loading) pthread_mutex_destroy(w->loading);
    memory_free(memory, w->loading, 1, sizeof *w->loading);
    memory_free(memory, w, 1, sizeof *w);
}

const zone_data *world_zone(const world *w, uint32_t zone)
{
    return &w->data[zone];
}

// ---- What pictures show ----

// To float and back is off by 2^-24 of the number, and so is the picture's own box: 2^-22 of it outward finds all that touch.
static cull_box box_in_zone(const double origin[3], const double min[3], const double max[3])
{
    float low[3], high[3];
    for (int k = 0; k < 3; ++k) {
        low[k] = (float)(min[k] - origin[k] - fabs(min[k] - origin[k]) * 0x1p-22);
        high[k] = (float)(max[k] - origin[k] + fabs(max[k] - origin[k]) * 0x1p-22);
    }
    return (cull_box){{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
}

void world_changed(world *w, const double min[3], const double max[3])
{
    world_assert_still(w);
    for (uint32_t zone = 0; w->views && zone < w->scene->zone_count; ++zone) {
        const cull_box box = box_in_zone(w->scene->zones[zone].origin, min, max);
        for (world_view *v = w->views; v; v = v->next)
            if (v->zones[zone]) viewer_empty_slots(v->zones[zone], &box);
    }
}

// ---- Doors and movers ----

// No picture holds a door or a mover: they are drawn as they are. But what stands about a door may look otherwise now.
static void door_changed(world *w, uint32_t mover)
{
    double min[3], max[3];
    if (movers_box(w->movers, mover, min, max)) world_changed(w, min, max);
}

void world_set_door(world *w, uint32_t door, door_state state)
{
    world_assert_still(w);
    assert(door < w->scene->door_count);
    if (w->doors[door] == state) return;
    w->doors[door] = state;
    shut_portals(w, door);
    const uint32_t mover = w->scene->doors[door].mover;
    if (mover == SCENE_NONE) return;
    door_changed(w, mover); // where it was
    place_mover(w, mover, movers_move);
    door_changed(w, mover); // and where it is
}

door_state world_door(const world *w, uint32_t door)
{
    return w->doors[door];
}

void world_set_time(world *w, double time_s)
{
    world_assert_still(w);
    w->time_s = time_s;
    for (uint32_t i = 0; i < w->scene->mover_count; ++i)
        if (w->scene->movers[i].key_count) place_mover(w, i, movers_move);
}

const scene_pose *world_poses(const world *w)
{
    return w->poses;
}

result world_mover_add(world *w, const double min[3], const double max[3], uint32_t *out)
{
    world_assert_still(w);
    const uint32_t mover = movers_free_number(w->movers);
    if (mover == SCENE_NONE) return RESULT_BAD_INPUT;
    const result done = movers_add(w->movers, mover, min, max);
    if (done == RESULT_OK) *out = mover;
    return done;
}

// The scene's own movers go where doors and paths have them.
static int is_of_the_application(const world *w, uint32_t mover)
{
    return mover >= w->scene->mover_count && mover < w->mover_numbers;
}

result world_mover_move(world *w, uint32_t mover, const double min[3], const double max[3])
{
    world_assert_still(w);
    return is_of_the_application(w, mover) ? movers_move(w->movers, mover, min, max) : RESULT_BAD_INPUT;
}

result world_mover_remove(world *w, uint32_t mover)
{
    world_assert_still(w);
    return is_of_the_application(w, mover) ? movers_remove(w->movers, mover) : RESULT_BAD_INPUT;
}

const movers *world_movers(const world *w)
{
    return w->movers;
}

const graph *world_graph(const world *w)
{
    return w->graph;
}
