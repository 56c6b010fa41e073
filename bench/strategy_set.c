// Strategies: the set D of a view by global id, its counts.
// SPDX-License-Identifier: MIT
// Invariant: an item that several zones list stands once in D; one that the host gives twice is a repeat, a fault.
#define _POSIX_C_SOURCE 200809L
#include "strategy_parts.h"

#include <time.h>

double thread_cpu_ns(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec * 1e9 + (double)t.tv_nsec;
}

static void mark_item(strategy *s, uint32_t item)
{
    const uint32_t bit = 1u << (item % 32);
    s->repeats += (s->drawn_bits[item / 32] & bit) != 0;
    s->drawn_bits[item / 32] |= bit;
}

static void mark_run(strategy *s, const strategy_zone *z, cull_run run)
{
    const uint32_t *order = s->order + z->first;
    if (z->is_identity)
        for (uint32_t p = run.first; p < run.first + run.count; ++p) mark_item(s, p);
    else
        for (uint32_t p = run.first; p < run.first + run.count; ++p) mark_item(s, order[p]);
}

void set_mark(strategy *s, const visible_set *set)
{
    const scene *sc = s->q->scene;
    for (uint32_t i = 0; i < set->zone_count; ++i)
        for (uint32_t k = 0; k < set->zones[i].run_count; ++k) mark_run(s, &s->zones[set->zones[i].zone], set->zones[i].runs[k]);
    for (uint32_t i = 0; i < set->mover_count; ++i) {
        if (set->movers[i] < sc->mover_count) mark_item(s, sc->item_count + set->movers[i]);
        else s->repeats++; // none of the scene's
    }
    for (uint32_t w = 0; s->has_pictures && w < s->words; ++w) s->drawn_bits[w] |= s->picture_bits[w] | s->clipped_bits[w];
}

// Zones whose ids there is room for: all, unless some stand twice. Outside the time: no culler needs it.
static uint32_t zones_that_fit(const strategy *s, const visible_set *set)
{
    uint64_t total = 0;
    for (uint32_t i = 0; i < set->zone_count; ++i) {
        for (uint32_t k = 0; k < set->zones[i].run_count; ++k) total += set->zones[i].runs[k].count;
        if (total > s->q->scene->item_count) return i;
    }
    return set->zone_count;
}

double set_write_ids(strategy *s, const visible_set *set)
{
    const uint32_t zones = zones_that_fit(s, set);
    const double start = thread_cpu_ns();
    uint32_t *ids = s->ids;
    s->id_faults = zones < set->zone_count;
    for (uint32_t i = 0; i < zones; ++i) {
        const strategy_zone *z = &s->zones[set->zones[i].zone];
        ids += s->kernel->expand(set->zones[i].runs, set->zones[i].run_count, z->is_identity ? NULL : s->order + z->first, ids);
    }
    return thread_cpu_ns() - start;
}

view_counts strategy_count(const strategy *s, const visible_set *set)
{
    const scene *sc = s->q->scene;
    view_counts c = {.polygons = s->again_polygons, .triangles = s->again_triangles};
    for (uint32_t i = 0; i < set->zone_count; ++i) c.runs += set->zones[i].run_count;
    for (uint32_t w = 0; w < s->words; ++w)
        for (uint32_t bits = s->drawn_bits[w]; bits; bits &= bits - 1) {
            const uint32_t id = w * 32 + (uint32_t)__builtin_ctz(bits);
            c.triangles += sc->items[id].index_count / 3;
            if (id >= sc->item_count) c.mover_polygons += sc->items[id].polygon_count;
            else {
                c.items++;
                c.polygons += sc->items[id].polygon_count;
            }
        }
    return c;
}
