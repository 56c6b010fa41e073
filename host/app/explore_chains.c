// The viewer's chains: the next one for the zone that the camera is in, with layout, pictures and tests as it needs them.
// SPDX-License-Identifier: MIT
// Invariant: the layout holds a zone in the order of its chain, or e->failure is set and nothing is drawn any more.
#include "explore.h"

#include "../render/costs.h"

#include "../core/pieces.h"

#include <stdio.h>
#include <string.h>

enum { TESTS_RESERVED_MOST = 65536 }; // for all zones together, unless one alone asks for more

static const chain_spec *entry_of(const explore *e, uint32_t zone, uint32_t entry)
{
    return entry ? &e->chains[entry - 1] : e->own[zone];
}

static uint32_t slots_of(const chain *c)
{
    uint32_t slots = 0;
    for (uint32_t i = 0; c && i < c->stage_count; ++i)
        if (c->stages[i].built.slot_count > slots) slots = c->stages[i].built.slot_count;
    return slots;
}

static uint32_t tests_of(const chain *c)
{
    uint32_t tests = 0;
    for (uint32_t i = 0; c && i < c->stage_count; ++i)
        if (c->stages[i].built.max_tests > tests) tests = c->stages[i].built.max_tests;
    return tests;
}

static result tell_slots(explore *e)
{
    const uint32_t zone_count = e->a->scene->zone_count;
    uint32_t *counts = memory_alloc(e->a->memory, zone_count, sizeof *counts);
    if (!counts) return report_no_memory(&e->a->report, NULL);
    for (uint32_t z = 0; z < zone_count; ++z) {
        counts[z] = slots_of(world_chain(e->w, z));
        e->has_pictures |= counts[z] != 0;
    }
    cull_costs costs;
    result done = e->has_pictures ? render_layout_slots(e->layout, counts, &e->a->report) : RESULT_OK;
    memory_free(e->a->memory, counts, zone_count, sizeof *counts);
    if (done == RESULT_OK && e->has_pictures) {
        done = renderer_costs(e->g, &e->a->report, &costs);
        costs.frame_ns = e->frame_ms * 1e6;
        if (done == RESULT_OK) done = render_layout_levels(e->layout, &e->a->report, &costs);
        if (done == RESULT_OK) host_costs_set(&e->a->services, &costs);
    }
    return done;
}

static result tell_pieces(explore *e)
{
    const uint32_t zone_count = e->a->scene->zone_count;
    const cull_pieces **pieces = memory_alloc(e->a->memory, zone_count, sizeof *pieces);
    if (!pieces) return report_no_memory(&e->a->report, NULL);
    for (uint32_t z = 0; z < zone_count; ++z) pieces[z] = chain_pieces(world_chain(e->w, z), &e->a->report);
    const result done = render_layout_pieces(e->layout, pieces, &e->a->report);
    memory_free(e->a->memory, pieces, zone_count, sizeof *pieces);
    return done;
}

result explore_reserve(explore *e)
{
    uint64_t tests = 0, most = TESTS_RESERVED_MOST;
    for (uint32_t z = 0; z < e->a->scene->zone_count; ++z) {
        const uint32_t wanted = tests_of(world_chain(e->w, z));
        tests += wanted;
        most = wanted > most ? wanted : most;
    }
    result done = tell_slots(e);
    if (done == RESULT_OK) done = tell_pieces(e);
    return done == RESULT_OK ? renderer_reserve(e->g, (uint32_t)(tests < most ? tests : most), &e->a->report) : done;
}

// The world has the new chain; without the layout that goes with it nothing true can be drawn.
static result follow(explore *e, uint32_t zone)
{
    world_order(e->w, zone, e->order);
    const result done = render_layout_reorder(e->layout, zone, e->order, &e->a->report);
    return done == RESULT_OK ? explore_reserve(e) : done;
}

// Those that cannot be built are passed over, so that one of them does not end the round.
void explore_cycle_chain(explore *e)
{
    const scene *s = e->a->scene;
    const uint32_t entries = e->chain_count + 1;
    explore_find_zone(e);
    if (e->zone == SCENE_NONE || !s->zones[e->zone].item_count) {
        snprintf(e->message, sizeof e->message, "the camera is in no zone that has items");
        return;
    }
    const uint32_t zone = e->zone, now = e->zone_chain[zone];
    uint32_t failed = 0;
    for (uint32_t i = 1; i < entries; ++i) {
        const uint32_t next = (now + i) % entries;
        const chain_spec *spec = entry_of(e, zone, next);
        if (strcmp(spec->text, entry_of(e, zone, now)->text) == 0) continue;
        if (next && strcmp(spec->text, e->own[zone]->text) == 0) continue; // it stands at 0
        if (world_set_chain(e->w, zone, spec, &e->a->report) != RESULT_OK) {
            failed++;
            continue;
        }
        e->freeze = FREEZE_NOT; // its set is of the old order
        e->zone_chain[zone] = next;
        e->counters.swaps++;
        e->counters.swap_failures += failed;
        e->failure = follow(e, zone);
        snprintf(e->message, sizeof e->message, "zone '%s' is culled by %s%s%s", s->zones[zone].name, spec->text, next ? "" : ", as at first",
                 failed ? "; others failed" : "");
        return;
    }
    e->counters.swap_failures += failed;
    snprintf(e->message, sizeof e->message, "zone '%s': %s, the old chain stays", s->zones[zone].name,
             failed ? "no other could be built" : "there is no other");
}
