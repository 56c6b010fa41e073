// The application's API, changes between frames: chains, doors, time, movers. See api/portcullis/scene.h.
// SPDX-License-Identifier: MIT
#include "library.h"

#include <math.h>

struct cull_scene_swap {
    const cull_scene *owner;
    world_swap *swap;
};

static result swap_build(const cull_scene *s, uint32_t zone, const char *chain, world_swap **out)
{
    report r = {.line = s->report.line, .user = s->report.user}; // building may run beside views: the scene's counters are not touched
    arena texts = arena_make(s->memory);
    chain_spec spec;
    result done = chain_parse(chain, &texts, &r, &spec);
    if (done == RESULT_OK) done = world_swap_build(s->world, zone, &spec, &r, out);
    arena_free(&texts);
    return done;
}

cull_result cull_scene_swap_build(const cull_scene *s, uint32_t zone, const char *chain, cull_scene_swap **out)
{
    if (zone >= s->scene->zone_count)
        return library_refuse(s, CULL_ERR_ZONE, "zone %u: the scene has %u, counted from 0", zone, s->scene->zone_count);
    if (!chain || !out) return library_refuse(s, CULL_ERR_OPTION, "a swap takes a chain and a place for itself");
    cull_scene_swap *swap = memory_alloc_zeroed(s->memory, 1, sizeof *swap);
    if (!swap) return library_refuse(s, CULL_ERR_MEMORY, "out of memory");
    swap->owner = s;
    const result done = swap_build(s, zone, chain, &swap->swap);
    if (done != RESULT_OK) {
        memory_free(s->memory, swap, 1, sizeof *swap);
        return done == RESULT_NO_MEMORY ? CULL_ERR_MEMORY : CULL_ERR_OPTION;
    }
    *out = swap;
    return CULL_OK;
}

cull_result cull_scene_swap_commit(cull_scene *s, cull_scene_swap *swap)
{
    if (swap->owner != s) {
        cull_scene_swap_drop(swap);
        return library_refuse(s, CULL_ERR_OPTION, "a swap that was built for another scene; it is dropped");
    }
    const result done = world_swap_commit(s->world, swap->swap, &s->report);
    memory_free(s->memory, swap, 1, sizeof *swap);
    return library_result(done);
}

void cull_scene_swap_drop(cull_scene_swap *swap)
{
    if (!swap) return;
    world_swap_drop(swap->swap);
    memory_free(swap->owner->memory, swap, 1, sizeof *swap);
}

cull_result cull_scene_set_chain(cull_scene *s, uint32_t zone, const char *chain)
{
    cull_scene_swap *swap = NULL;
    const cull_result built = cull_scene_swap_build(s, zone, chain, &swap);
    return built == CULL_OK ? cull_scene_swap_commit(s, swap) : built;
}

cull_result cull_scene_set_door(cull_scene *s, uint32_t door, uint32_t is_open)
{
    if (door >= s->scene->door_count)
        return library_refuse(s, CULL_ERR_ZONE, "door %u: the scene has %u, counted from 0", door, s->scene->door_count);
    if (is_open > 1) return library_refuse(s, CULL_ERR_OPTION, "door state %u: 1 opens, 0 shuts", is_open);
    world_set_door(s->world, door, is_open ? DOORS_OPEN : DOORS_SHUT);
    return CULL_OK;
}

cull_result cull_scene_set_time(cull_scene *s, double time_s)
{
    if (!isfinite(time_s)) return library_refuse(s, CULL_ERR_OPTION, "a time that is not finite; the movers stay");
    world_set_time(s->world, time_s);
    return CULL_OK;
}

static cull_result tell_mover(const cull_scene *s, result done, const char *what)
{
    if (done == RESULT_OK) return CULL_OK;
    return library_refuse(
        s, CULL_ERR_ZONE,
        "a mover can't be %s: no such mover of the application, no room, or a box that is not finite, not within 1e9 m or inside out; "
        "nothing changed",
        what);
}

cull_result cull_scene_mover_add(cull_scene *s, const double min[3], const double max[3], uint32_t *out_mover)
{
    return tell_mover(s, world_mover_add(s->world, min, max, out_mover), "added");
}

cull_result cull_scene_mover_move(cull_scene *s, uint32_t mover, const double min[3], const double max[3])
{
    return tell_mover(s, world_mover_move(s->world, mover, min, max), "moved");
}

cull_result cull_scene_mover_remove(cull_scene *s, uint32_t mover)
{
    return tell_mover(s, world_mover_remove(s->world, mover), "removed");
}
