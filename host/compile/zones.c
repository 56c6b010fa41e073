// Zones of the mesh: portals tried, those that separate nothing left out, regions of air made zones, or one open zone of
// a map that leaks.
// SPDX-License-Identifier: MIT
#include "rooms.h"
#include "stages.h"
#include "zone_trace.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#define UNITS_A_METRE 32.0

typedef struct zone_build {
    const compile_input *in;
    const allocator *memory;
    report *report;
    portal_set portals;
    zone_trace trace;
    zone_places places;
    const zone_options *options;
    uint8_t *seals; // by polygon of the mesh; NULL: liquids bound nothing
} zone_build;

// ---- Portals that are none ----

typedef struct sheet { uint32_t piece, sides[2]; } sheet; // a polygon of a portal; sides: regions, the void is the last

static uint32_t region_or_void(const zone_trace *t, uint32_t face)
{
    const uint32_t region = zone_trace_region(t, face);
    return region == REGION_VOID ? t->regions.region_count : region;
}

static uint32_t merged_into(uint32_t *parent, uint32_t region)
{
    while (parent[region] != region) region = parent[region] = parent[parent[region]];
    return region;
}

// A lift counts like any door: what is up can't be asked here, for a map that lies on its side has to have the same zones.
static int separates(uint32_t *parent, uint32_t all_void, const sheet *s)
{
    const uint32_t front = merged_into(parent, s->sides[0]), back = merged_into(parent, s->sides[1]);
    return front != back && front != all_void && back != all_void;
}

// Regions on the two sides of what was just rejected are one; the void stays the void.
static void merge_sides(uint32_t *parent, const sheet *s)
{
    const uint32_t front = merged_into(parent, s->sides[0]), back = merged_into(parent, s->sides[1]);
    parent[front < back ? front : back] = front < back ? back : front;
}

static result gather_sheets(const zone_build *b, buffer *out)
{
    const portal_piece *pieces = b->portals.pieces.items;
    for (uint32_t i = 0; i < surface_polygon_count(&b->trace.s); ++i) {
        const surface_polygon *p = surface_polygon_at(&b->trace.s, i);
        if (p->kind != SURFACE_PORTAL || pieces[p->source].is_rejected) continue;
        const sheet made = {p->source, {region_or_void(&b->trace, 2 * i), region_or_void(&b->trace, 2 * i + 1)}};
        if (!buffer_append(out, &made, 1)) return RESULT_NO_MEMORY;
    }
    return RESULT_OK;
}

// A piece stays when any part of it separates; the count of those that don't. `stays`: by piece.
static uint32_t reject_round(zone_build *b, const buffer *sheets, uint32_t *parent, uint8_t *stays)
{
    const sheet *all = sheets->items;
    const uint32_t all_void = b->trace.regions.region_count;
    portal_piece *pieces = b->portals.pieces.items;
    uint32_t rejected = 0;
    memset(stays, 0, b->portals.pieces.count);
    for (size_t i = 0; i < sheets->count; ++i)
        if (separates(parent, all_void, &all[i])) stays[all[i].piece] = 1;
    for (size_t i = 0; i < sheets->count; ++i)
        if (!stays[all[i].piece] && !pieces[all[i].piece].is_rejected) merge_sides(parent, &all[i]);
    for (size_t i = 0; i < b->portals.pieces.count; ++i) {
        if (stays[i] || pieces[i].is_rejected) continue;
        pieces[i].is_rejected = 1;
        ++rejected;
    }
    return rejected;
}

// Where a piece goes, air becomes one that others may have parted: a row of doors into the void goes one by one, but
// without a tracing for each.
static result reject_portals(zone_build *b, uint32_t *rejected)
{
    const uint32_t regions = b->trace.regions.region_count + 1;
    const size_t pieces = b->portals.pieces.count;
    buffer sheets = buffer_make(b->memory, sizeof(sheet));
    uint32_t *parent = memory_alloc(b->memory, regions, sizeof(*parent));
    uint8_t *stays = memory_alloc(b->memory, pieces, 1);
    result r = parent && stays ? gather_sheets(b, &sheets) : RESULT_NO_MEMORY;
    *rejected = 0;
    for (uint32_t i = 0; i < regions && r == RESULT_OK; ++i) parent[i] = i;
    for (uint32_t more = 1; more && r == RESULT_OK;) *rejected += more = reject_round(b, &sheets, parent, stays);
    memory_free(b->memory, parent, regions, sizeof(*parent));
    memory_free(b->memory, stays, pieces, 1);
    buffer_free(&sheets);
    return r;
}

static result trace_again(zone_build *b, const compile_mesh *mesh)
{
    const trace_input from = {b->in, mesh, &b->portals, b->seals};
    zone_trace_free(&b->trace);
    return zone_trace_make(&from, b->memory, &b->trace);
}

// The last tracing has no piece that separates nothing: rejected ones cut nothing either.
static result trace_until_settled(zone_build *b, const compile_mesh *mesh)
{
    uint32_t rejected = 1;
    result r = RESULT_OK;
    while (r == RESULT_OK && rejected) {
        r = trace_again(b, mesh);
        if (r == RESULT_OK) r = reject_portals(b, &rejected);
    }
    return r;
}

// ---- Leaks ----

static void set_rejected(zone_build *b, uint32_t is_rejected)
{
    portal_piece *pieces = b->portals.pieces.items;
    for (size_t i = 0; i < b->portals.pieces.count; ++i) pieces[i].is_rejected = is_rejected;
}

static result settle(zone_build *b, const compile_mesh *mesh)
{
    result r = trace_until_settled(b, mesh);
    zone_places_free(&b->places);
    return r == RESULT_OK ? zone_places_make(b->in, &b->trace, b->memory, &b->places) : r;
}

// All liquids as walls, to see which of them look into the void: those alone stay walls.
static result find_seals(zone_build *b, const compile_mesh *mesh, uint32_t *count)
{
    uint8_t *facing = memory_alloc_zeroed(b->memory, mesh->polygon_count, 1);
    b->seals = memory_alloc_zeroed(b->memory, mesh->polygon_count, 1);
    if (!facing || !b->seals) {
        memory_free(b->memory, facing, mesh->polygon_count, 1);
        return RESULT_NO_MEMORY;
    }
    for (uint32_t i = 0; i < mesh->polygon_count; ++i) b->seals[i] = (uint8_t)compile_polygon_is_liquid(b->in, &mesh->polygons[i]);
    set_rejected(b, 1);
    const result r = trace_again(b, mesh);
    *count = 0;
    for (uint32_t i = 0; i < surface_polygon_count(&b->trace.s) && r == RESULT_OK; ++i) {
        const surface_polygon *p = surface_polygon_at(&b->trace.s, i);
        if (p->kind != SURFACE_SEAL) continue;
        const int front = zone_trace_region(&b->trace, 2 * i) == REGION_VOID, back = zone_trace_region(&b->trace, 2 * i + 1) == REGION_VOID;
        if (front != back) facing[p->source] = 1;
    }
    for (uint32_t i = 0; i < mesh->polygon_count; ++i) *count += b->seals[i] = facing[i];
    memory_free(b->memory, facing, mesh->polygon_count, 1);
    return r;
}

static int mesh_polygon_meets(const compile_mesh *mesh, const compile_polygon *a, const surface_polygon *b)
{
    for (int k = 0; k < 3; ++k) {
        double low = HUGE_VAL, high = -HUGE_VAL;
        for (uint32_t i = 0; i < a->vertex_count; ++i) {
            const double at = mesh->vertices[mesh->loop[a->first_vertex + i]].position[k];
            low = at < low ? at : low;
            high = at > high ? at : high;
        }
        if (low > b->max[k] || high < b->min[k]) return 0;
    }
    return 1;
}

// A portal in the plane of a seal that it may touch would be a second surface in the same place: the seal alone parts there.
static void reject_on_seals(zone_build *b, const compile_mesh *mesh)
{
    portal_piece *pieces = b->portals.pieces.items;
    for (size_t i = 0; i < b->portals.pieces.count; ++i) {
        const surface_polygon *p = surface_polygon_at(&b->portals.s, pieces[i].polygon);
        for (uint32_t m = 0; m < mesh->polygon_count && !pieces[i].is_rejected; ++m)
            if (b->seals[m] && mesh->polygons[m].plane >> 1 == p->plane >> 1) pieces[i].is_rejected = (uint32_t)mesh_polygon_meets(mesh, &mesh->polygons[m], p);
    }
}

static void tell_seal(const zone_build *b, const compile_mesh *mesh)
{
    uint32_t i = 0, count = 0;
    for (uint32_t k = mesh->polygon_count; k-- > 0;)
        if (b->seals[k]) i = k, ++count;
    const compile_polygon *p = &mesh->polygons[i];
    report_warning(b->report, b->in->path, b->in->faces[p->face].line,
                   "faces of liquids hold back the void: %u, this one first; without them the map leaks: put a wall behind them", count);
}

// A liquid that stands against the void holds it back, as the maps' own compilers have it; only where the map would leak.
static result settle_sealed(zone_build *b, const compile_mesh *mesh)
{
    result r = settle(b, mesh);
    uint32_t liquids = 0, seals = 0;
    for (uint32_t i = 0; i < mesh->polygon_count; ++i) liquids += compile_polygon_is_liquid(b->in, &mesh->polygons[i]) != 0;
    if (r != RESULT_OK || b->places.leaking == ZONE_NONE || liquids == 0) return r;
    r = find_seals(b, mesh, &seals);
    if (r == RESULT_OK && seals) {
        set_rejected(b, 0);
        reject_on_seals(b, mesh);
        r = settle(b, mesh);
        if (r == RESULT_OK && b->places.leaking == ZONE_NONE) tell_seal(b, mesh);
        if (r != RESULT_OK || b->places.leaking == ZONE_NONE) return r;
    }
    if (r != RESULT_OK) return r;
    memory_free(b->memory, b->seals, mesh->polygon_count, 1); // of no use: the leak is elsewhere
    b->seals = NULL;
    set_rejected(b, 0);
    return settle(b, mesh);
}

static result tell_leak(zone_build *b, compiled_zones *z)
{
    const compile_entity *e = &b->in->entities[b->places.leaking];
    const double *at = e->origin;
    z->leak = 1;
    report_warning(b->report, b->in->path, e->line,
                   "the map leaks: the %s at %g %g %g in a map's units (%g %g %g m) can reach the void, so all of it is one open zone; close the hole that the leak line leads to",
                   e->class_name, at[0] * UNITS_A_METRE + 0.0, -at[2] * UNITS_A_METRE + 0.0, at[1] * UNITS_A_METRE + 0.0, at[0], at[1], at[2]);
    return leak_line_make(b->in, &b->trace, b->places.leaking, b->memory, z);
}

static result open_up(zone_build *b, const compile_mesh *mesh)
{
    set_rejected(b, 1);
    return b->portals.pieces.count ? trace_again(b, mesh) : RESULT_OK;
}

// ---- All of it ----

static void check_closed(zone_build *b)
{
    assert(b->trace.shells.open_segments == 0 && b->trace.regions.unclear == 0);
    if (b->trace.shells.open_segments || b->trace.regions.unclear)
        report_warning(b->report, b->in->path, 0, "the surface is open at %u edges and unclear at %u shells: zones there may be wrong; please report the map",
                       b->trace.shells.open_segments, b->trace.regions.unclear);
}

static result part_rooms(zone_build *b, const compile_mesh *mesh)
{
    const result r = rooms_portals(b->in, &b->trace, &b->options->rooms, b->report, &b->portals);
    return r == RESULT_OK ? settle(b, mesh) : r;
}

static result run(zone_build *b, compiled_zones *z)
{
    result r = settle_sealed(b, z->mesh);
    if (r != RESULT_OK) return r;
    if (b->options->portals == PORTALS_AUTO && b->places.leaking == ZONE_NONE) r = part_rooms(b, z->mesh);
    if (r != RESULT_OK) return r;
    check_closed(b);
    z->shells = b->trace.shells.shell_count;
    if (b->places.leaking != ZONE_NONE) {
        r = tell_leak(b, z);
        if (r == RESULT_OK) r = open_up(b, z->mesh);
        if (r != RESULT_OK) return r;
    }
    z->zone_count = z->leak ? 1 : b->places.region_count;
    z->zones = arena_push(&z->memory, z->zone_count, sizeof(compiled_zone));
    if (!z->zones) return RESULT_NO_MEMORY;
    for (uint32_t i = 0; i < z->zone_count; ++i) z->zones[i] = (compiled_zone){0};
    r = zone_places_name(b->in, &b->places, b->report, z);
    if (r == RESULT_OK) compile_tell(&(compile_view){STAGE_ZONES, b->in, .trace = &b->trace, .places = &b->places, .zones = z});
    if (r == RESULT_OK) r = line_set_add_touches(&b->trace.lines);
    if (r == RESULT_OK) r = zone_emit(&b->trace, &b->trace.rays, &b->places, z->leak ? ZONES_OPEN : ZONES_CLOSED, z);
    if (r == RESULT_OK) compile_tell(&(compile_view){STAGE_T_JUNCTIONS, b->in, .zones = z});
    return r;
}

result compile_zones_with(const compile_input *in, compile_mesh *mesh, const zone_options *options, report *r, const allocator *memory, compiled_zones **out)
{
    zone_build b = {.options = options, .in = in, .memory = memory, .report = r};
    compiled_zones *z = memory_alloc_zeroed(memory, 1, sizeof(*z));
    if (!z) {
        compile_mesh_free(mesh);
        return report_no_memory(r, in->path);
    }
    z->memory = arena_make(memory);
    z->mesh = mesh;
    const uint32_t polygon_count = mesh->polygon_count;
    result made = portal_set_make(in, options->portals, r, memory, &b.portals);
    if (made == RESULT_OK) {
        compile_tell(&(compile_view){STAGE_PORTALS, in, .portals = &b.portals});
        made = run(&b, z);
        portal_set_free(&b.portals);
    }
    memory_free(memory, b.seals, polygon_count, 1);
    zone_trace_free(&b.trace);
    zone_places_free(&b.places);
    if (made == RESULT_OK) {
        *out = z;
        return RESULT_OK;
    }
    compiled_zones_free(z);
    return made == RESULT_NO_MEMORY ? report_no_memory(r, in->path) : made;
}

zone_options zone_options_of(portal_choice choice)
{
    return (zone_options){choice, {.portals = 100}};
}

result compile_zones(const compile_input *in, compile_mesh *mesh, portal_choice choice, report *r, const allocator *memory, compiled_zones **out)
{
    const zone_options options = zone_options_of(choice);
    return compile_zones_with(in, mesh, &options, r, memory, out);
}

void compiled_zones_free(compiled_zones *z)
{
    if (!z) return;
    const allocator *memory = z->memory.memory;
    compile_mesh_free(z->mesh);
    arena_free(&z->memory);
    memory_free(memory, z, 1, sizeof(*z));
}
