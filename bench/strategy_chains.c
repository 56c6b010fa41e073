// Strategies: the chains of the world's zones, in their turn, with what depends on them: orders, pictures, walls.
// SPDX-License-Identifier: MIT
#include "strategy_parts.h"

#include "../host/core/pieces.h"

#include <string.h>

enum { TESTS_RESERVED_MOST = 65536 }; // for all zones of a view together, unless one alone asks for more

static const chain_spec *spec_of(const bench_strategy_request *q, uint32_t zone, uint32_t turn)
{
    const chain_spec *spec = q->set_count ? q->sets[((uint64_t)zone + turn) % q->set_count][zone] : NULL;
    return spec ? spec : q->chain;
}

static uint32_t turn_of(const strategy *s, uint32_t view)
{
    return s->chains->swap_views ? view / s->chains->swap_views : 0;
}

static uint32_t turns_of(const bench_strategy_request *q)
{
    return q->swap_views && q->set_count ? q->set_count : 1;
}

static uint32_t slots_of(const chain *c)
{
    uint32_t slots = 0;
    for (uint32_t i = 0; i < c->stage_count; ++i)
        if (c->stages[i].built.slot_count > slots) slots = c->stages[i].built.slot_count;
    return slots;
}

static uint32_t tests_of(const chain *c)
{
    uint32_t tests = 0;
    for (uint32_t i = 0; i < c->stage_count; ++i)
        if (c->stages[i].built.max_tests > tests) tests = c->stages[i].built.max_tests;
    return tests;
}

uint32_t strategy_tests(const strategy *s)
{
    uint64_t tests = 0, most = TESTS_RESERVED_MOST;
    for (uint32_t z = 0; z < s->q->scene->zone_count; ++z) {
        const chain *c = world_chain(s->world, z);
        if (!c) continue;
        tests += tests_of(c);
        most = tests_of(c) > most ? tests_of(c) : most;
    }
    return (uint32_t)(tests < most ? tests : most);
}

static void free_slots(strategy *s, strategy_zone *z)
{
    memory_free(s->q->services->memory, z->slot_bits, (size_t)z->slot_count * z->words, sizeof(uint32_t));
    z->slot_bits = NULL;
    z->slot_count = 0;
}

static result take_slots(strategy *s, strategy_zone *z, uint32_t slots, report *r)
{
    if (slots == z->slot_count) {
        if (slots) memset(z->slot_bits, 0, (size_t)slots * z->words * sizeof(uint32_t));
        return RESULT_OK;
    }
    free_slots(s, z);
    z->slot_bits = memory_alloc_zeroed(s->q->services->memory, (size_t)slots * z->words, sizeof(uint32_t));
    if (!z->slot_bits) return report_no_memory(r, s->q->scene->path);
    z->slot_count = slots;
    s->has_pictures = 1;
    return RESULT_OK;
}

// After the zone got a chain: the order of its places, what it promises, what it needs.
static result take_chain(strategy *s, uint32_t zone, report *r)
{
    strategy_zone *z = &s->zones[zone];
    const chain *c = world_chain(s->world, zone);
    world_order(s->world, zone, s->order + z->first);
    z->is_identity = !c->order && !world_zone(s->world, zone)->items;
    s->uses_renderer |= c->uses_renderer;
    for (uint32_t i = 0; i < c->stage_count; ++i) {
        s->may_step |= c->stages[i].built.max_steps > 1;
        s->has_pictures |= c->stages[i].built.max_clipped > 0;
    }
    return take_slots(s, z, slots_of(c), r);
}

static int open_zones(strategy *s)
{
    const allocator *memory = s->q->services->memory;
    const uint32_t zone_count = s->q->scene->zone_count;
    s->zones = memory_alloc_zeroed(memory, zone_count, sizeof *s->zones);
    if (!s->zones) return 0;
    uint32_t places = 0;
    for (uint32_t z = 0; z < zone_count; ++z) {
        const uint32_t count = world_chain(s->world, z) ? world_zone(s->world, z)->zone.item_count : 0;
        s->zones[z] = (strategy_zone){.first = places, .item_count = count, .words = (count + 31) / 32};
        places += count;
    }
    s->order = memory_alloc_zeroed(memory, (size_t)places + RUNS_OVERWRITE, sizeof(uint32_t));
    s->order_count = s->order ? places + RUNS_OVERWRITE : 0;
    return s->order != NULL;
}

// Which walls judge it must be known before the first turn: that of every chain that it will have.
static result find_walls(strategy *s, report *r)
{
    const uint32_t turns = turns_of(s->chains);
    uint32_t chains = 0, of_fronts = 0;
    for (uint32_t z = 0; z < s->q->scene->zone_count; ++z)
        for (uint32_t t = 0; t < turns && world_chain(s->world, z); ++t) {
            const chain_spec *spec = spec_of(s->chains, z, t);
            const cull_plugin *plugin;
            const result done = loader_find(s->q->plugins, spec->stages[0].id, r, &plugin);
            if (done != RESULT_OK) return done;
            of_fronts += walls_of_chain(plugin->descriptor, spec) == WALLS_FRONT_ONLY;
            chains++;
        }
    s->walls = of_fronts == 0 ? WALLS_BOTH_SIDES : of_fronts == chains ? WALLS_FRONT_ONLY : WALLS_MIXED;
    return RESULT_OK;
}

static void judge_both_sides(const scene *s, uint32_t zone, truth *t)
{
    const scene_zone *z = &s->zones[zone];
    for (uint32_t i = z->first_item; i < z->first_item + z->item_count; ++i)
        t->front_bits[s->zone_items[i] / 32] &= ~(1u << (s->zone_items[i] % 32));
}

result strategy_judge(const strategy *s, uint32_t view, report *r, truth *t)
{
    const scene *sc = s->q->scene;
    const uint32_t turn = turn_of(s, view);
    if (!t->front_bits || t->front_turn == turn + 1) return RESULT_OK;
    t->front_turn = 0;
    memset(t->front_bits, 0xff, s->words * sizeof *t->front_bits);
    for (uint32_t z = 0; z < sc->zone_count; ++z) {
        if (!world_chain(s->world, z)) continue;
        const chain_spec *spec = spec_of(s->chains, z, turn);
        const cull_plugin *plugin;
        const result done = loader_find(s->q->plugins, spec->stages[0].id, r, &plugin);
        if (done != RESULT_OK) return done;
        if (walls_of_chain(plugin->descriptor, spec) == WALLS_BOTH_SIDES) judge_both_sides(sc, z, t);
    }
    t->front_turn = turn + 1;
    return RESULT_OK;
}

static result open_world(strategy *s, report *r)
{
    const allocator *memory = s->q->services->memory;
    const uint32_t zone_count = s->q->scene->zone_count;
    const chain_spec **specs = memory_alloc_zeroed(memory, zone_count, sizeof *specs);
    if (!specs) return report_no_memory(r, s->q->scene->path);
    for (uint32_t z = 0; z < zone_count; ++z) specs[z] = spec_of(s->chains, z, 0);
    const world_request q = {.scene = s->q->scene, .plugins = s->q->plugins, .services = s->q->services, .chains = specs, .chain = s->chains->chain};
    const result done = world_open(&q, r, &s->world);
    memory_free(memory, specs, zone_count, sizeof *specs);
    return done;
}

result chains_open(strategy *s, report *r)
{
    result done = open_world(s, r);
    if (done == RESULT_OK && !open_zones(s)) done = report_no_memory(r, s->q->scene->path);
    if (done == RESULT_OK) done = find_walls(s, r);
    for (uint32_t z = 0; z < s->q->scene->zone_count && done == RESULT_OK; ++z) {
        const chain *c = world_chain(s->world, z);
        if (!c) continue;
        done = take_chain(s, z, r);
        s->build_ms += c->build_ms;
        s->index_bytes += c->index_bytes;
        s->indices_built++;
    }
    return done;
}

void chains_figures(strategy *s)
{
    s->figures.count = 0;
    for (uint32_t z = 0; z < s->q->scene->zone_count; ++z)
        if (world_chain(s->world, z)) figures_add_chain(&s->figures, world_chain(s->world, z));
}

void chains_close(strategy *s)
{
    const allocator *memory = s->q->services->memory;
    world_close(s->world);
    for (uint32_t z = 0; s->zones && z < s->q->scene->zone_count; ++z) free_slots(s, &s->zones[z]);
    memory_free(memory, s->zones, s->q->scene->zone_count, sizeof *s->zones);
    memory_free(memory, s->order, s->order_count, sizeof(uint32_t));
}

result chains_tell_slots(strategy *s, report *r)
{
    const allocator *memory = s->q->services->memory;
    const uint32_t zone_count = s->q->scene->zone_count;
    if (!s->has_pictures) return RESULT_OK;
    uint32_t *counts = memory_alloc_zeroed(memory, zone_count, sizeof *counts);
    if (!counts) return report_no_memory(r, s->q->scene->path);
    for (uint32_t z = 0; z < zone_count; ++z) counts[z] = s->zones[z].slot_count;
    const result done = render_layout_slots(s->layout, counts, r);
    memory_free(memory, counts, zone_count, sizeof *counts);
    return done;
}

result chains_tell_pieces(strategy *s, report *r)
{
    const allocator *memory = s->q->services->memory;
    const uint32_t zone_count = s->q->scene->zone_count;
    const cull_pieces **pieces = memory_alloc(memory, zone_count, sizeof *pieces);
    if (!pieces) return report_no_memory(r, s->q->scene->path);
    for (uint32_t z = 0; z < zone_count; ++z) pieces[z] = chain_pieces(world_chain(s->world, z), r);
    const result done = render_layout_pieces(s->layout, pieces, r);
    memory_free(memory, pieces, zone_count, sizeof *pieces);
    return done;
}

static result swap_zone(strategy *s, uint32_t zone, const chain_spec *spec, report *r)
{
    const double start = thread_cpu_ns();
    result done = world_set_chain(s->world, zone, spec, r);
    s->times.swap_ns += thread_cpu_ns() - start;
    s->times.swaps++;
    if (done == RESULT_OK) done = take_chain(s, zone, r);
    if (done == RESULT_OK && s->layout) done = render_layout_reorder(s->layout, zone, s->order + s->zones[zone].first, r);
    return done;
}

result chains_turn(strategy *s, uint32_t view, report *r)
{
    const uint32_t turn = turn_of(s, view);
    if (turn == s->turn) return RESULT_OK;
    result done = RESULT_OK;
    for (uint32_t z = 0; z < s->q->scene->zone_count && done == RESULT_OK; ++z) {
        const chain_spec *spec = spec_of(s->chains, z, turn);
        if (world_chain(s->world, z) && spec != spec_of(s->chains, z, s->turn)) done = swap_zone(s, z, spec, r);
    }
    if (done == RESULT_OK) s->turn = turn;
    if (done != RESULT_OK || !s->layout) return done;
    done = chains_tell_slots(s, r);
    if (done == RESULT_OK) done = chains_tell_pieces(s, r);
    return done == RESULT_OK ? renderer_reserve(s->g, strategy_tests(s), r) : done;
}

result strategy_turn(strategy *s, uint32_t view, report *r)
{
    return chains_turn(s, view, r);
}

uint32_t strategy_is_stateless(const strategy *s)
{
    if (s->chains->swap_views || s->has_pictures) return 0;
    for (uint32_t z = 0; z < s->q->scene->zone_count; ++z) {
        const chain *c = world_chain(s->world, z);
        if (c && !(c->promises & CULL_STATELESS)) return 0;
    }
    return 1;
}
