// Strategies: what a view misses, and whether a zone's chain broke its promise by that.
// SPDX-License-Identifier: MIT
// An item is lost by the zones that list it and that the view reached, by any that lists it when it reached none of them:
// one whose chain promises nothing does not excuse the others.
#include "strategy_parts.h"

#include <string.h>

enum { BLAME_REACHED, BLAME_REACHED_PROMISE, BLAME_PROMISE, BLAME_SETS };

int blame_open(strategy *s)
{
    s->blame = memory_alloc_zeroed(s->q->services->memory, (size_t)s->words * BLAME_SETS, sizeof *s->blame);
    return s->blame != NULL;
}

void blame_close(strategy *s)
{
    memory_free(s->q->services->memory, s->blame, (size_t)s->words * BLAME_SETS, sizeof *s->blame);
}

static uint32_t *set_of(const strategy *s, uint32_t which)
{
    return s->blame + (size_t)which * s->words;
}

static void set_bit(uint32_t *bits, uint32_t i)
{
    bits[i / 32] |= 1u << (i % 32);
}

static int has_bit(const uint32_t *bits, uint32_t i)
{
    return bits[i / 32] >> (i % 32) & 1;
}

// A zone without a chain lists nothing and drops nothing: its movers are drawn.
// SAMPLED is about the pixels of the view: what lies between them it never promised.
static int promises_all(const strategy *s, uint32_t zone)
{
    const chain *c = world_chain(s->world, zone);
    return !c || c->promises & CULL_CONSERVATIVE || (c->promises & CULL_SAMPLED && s->q->samples <= 1);
}

static void blame_movers(const strategy *s, uint32_t zone, uint32_t *bits)
{
    const scene *sc = s->q->scene;
    for (uint32_t m = 0; m < sc->mover_count; ++m) {
        const uint32_t *zones;
        const uint32_t count = movers_zones(world_movers(s->world), m, &zones);
        int stands = count == 0; // everywhere
        for (uint32_t i = 0; i < count; ++i) stands |= zones[i] == zone;
        if (stands) set_bit(bits, sc->item_count + m);
    }
}

static void blame_zone(const strategy *s, uint32_t zone, uint32_t *bits)
{
    const scene *sc = s->q->scene;
    const scene_zone *z = &sc->zones[zone];
    for (uint32_t i = z->first_item; i < z->first_item + z->item_count; ++i) set_bit(bits, sc->zone_items[i]);
    if (sc->mover_count) blame_movers(s, zone, bits);
}

static void find_blame(const strategy *s)
{
    const flow_result *flow = world_view_flow(s->view);
    memset(s->blame, 0, (size_t)s->words * BLAME_SETS * sizeof *s->blame);
    for (uint32_t i = 0; i < flow->zone_count; ++i) {
        blame_zone(s, flow->zones[i].zone, set_of(s, BLAME_REACHED));
        if (promises_all(s, flow->zones[i].zone)) blame_zone(s, flow->zones[i].zone, set_of(s, BLAME_REACHED_PROMISE));
    }
    for (uint32_t z = 0; z < s->q->scene->zone_count; ++z)
        if (promises_all(s, z)) blame_zone(s, z, set_of(s, BLAME_PROMISE));
}

view_misses strategy_misses(const strategy *s, const truth *t, uint32_t view)
{
    const truth_view *v = (const truth_view *)t->views.items + view;
    view_misses m = {0};
    if (!v->count) return m; // of a whole path that sees nothing there is no list
    const truth_item *items = (const truth_item *)t->items.items + v->first;
    for (uint32_t i = 0; i < v->count; ++i) {
        const uint32_t id = items[i].item;
        if (has_bit(s->drawn_bits, id)) continue;
        if (m.items++ == 0) find_blame(s);
        m.pixels += items[i].pixels;
        m.broken += has_bit(set_of(s, has_bit(set_of(s, BLAME_REACHED), id) ? BLAME_REACHED_PROMISE : BLAME_PROMISE), id) != 0;
    }
    return m;
}
