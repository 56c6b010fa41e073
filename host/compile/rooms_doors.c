// Doors of a tracing in groups, and how many portals each makes: by the same parting among leaves as the scene's. See rooms_doors.h.
// SPDX-License-Identifier: MIT
#include "rooms_doors.h"

#include "items.h"

#include <math.h>
#include <string.h>

typedef struct door_taker {
    const compile_input *in;
    const zone_trace *t;
    const portal_set *set;
    door_set *out;
    compile_mesh mesh; // of one portal
    compiled_zones zones;
    item_job job;      // no more of it than portal_pieces_make asks
    portal_pieces pieces;
} door_taker;

static uint32_t group_find(door_set *d, uint32_t piece)
{
    while (d->group_of[piece] != piece) piece = d->group_of[piece] = d->group_of[d->group_of[piece]];
    return piece;
}

static void groups_join(door_set *d, uint32_t a, uint32_t b)
{
    const uint32_t first = group_find(d, a), second = group_find(d, b);
    d->group_of[first > second ? first : second] = first > second ? second : first;
}

static result door_add(door_set *d, uint32_t plane, const uint32_t regions[2], uint32_t piece)
{
    const cell_door made = {plane, {regions[0] < regions[1] ? regions[0] : regions[1], regions[0] < regions[1] ? regions[1] : regions[0]}, piece};
    const cell_door *all = d->doors.items;
    for (size_t i = 0; i < d->doors.count; ++i) {
        if (all[i].plane != plane || memcmp(all[i].regions, made.regions, sizeof made.regions) != 0) continue;
        groups_join(d, piece, all[i].group);
        return RESULT_OK;
    }
    return buffer_append(&d->doors, &made, 1) ? RESULT_OK : RESULT_NO_MEMORY;
}

// Of all doors, those without a piece too.
static result places_take(door_taker *d)
{
    const brush_bodies *all = &d->job.bodies;
    result r = RESULT_OK;
    for (uint32_t e = 0; e < d->in->entity_count && r == RESULT_OK; ++e) {
        const compile_entity *entity = &d->in->entities[e];
        door_place made = {{0, 0, 0}, 0};
        uint32_t corners = 0;
        for (uint32_t b = entity->first_brush; b < entity->first_brush + entity->brush_count && d->job.door_of[e] != SCENE_NONE; ++b) {
            const brush_body *body = &all->of[b];
            const body_corner *c = (const body_corner *)all->corners.items + body->first_corner;
            const body_polygon *p = (const body_polygon *)all->polygons.items + body->first_polygon;
            corners += body->corner_count;
            for (uint32_t i = 0; i < body->corner_count; ++i)
                for (int k = 0; k < 3; ++k) made.middle[k] += c[i].position[k];
            double largest = 0;
            for (uint32_t i = 0; i < body->polygon_count; ++i)
                largest = fmax(largest, polygon_area((const polygon_edge *)all->edges.items + p[i].shape.first, p[i].shape.count));
            made.area += largest;
        }
        if (!corners) continue;
        for (int k = 0; k < 3; ++k) made.middle[k] /= corners;
        if (!buffer_append(&d->out->places, &made, 1)) r = RESULT_NO_MEMORY;
    }
    return r;
}

// ---- How many portals ----

static result portals_count(door_taker *d, const surface_polygon *p, uint32_t *out)
{
    const surface_corner *c = surface_corners(&d->t->s, p);
    const allocator *memory = d->out->memory;
    compile_mesh *m = &d->mesh;
    m->vertices = memory_alloc(memory, p->count, sizeof *m->vertices);
    m->loop = memory_alloc(memory, p->count, sizeof *m->loop);
    m->edge_planes = memory_alloc(memory, p->count, sizeof *m->edge_planes);
    result r = m->vertices && m->loop && m->edge_planes ? RESULT_OK : RESULT_NO_MEMORY;
    for (uint32_t i = 0; i < p->count && r == RESULT_OK; ++i) {
        m->vertices[i] = *surface_vertex_at(&d->t->s, c[i].vertex);
        m->loop[i] = i;
        m->edge_planes[i] = c[i].edge;
    }
    const compiled_portal portal = {.plane = p->plane, .vertex_count = p->count, .entity = p->brush};
    if (r == RESULT_OK) r = portal_pieces_make(&d->job, &portal, &d->pieces);
    *out = (uint32_t)d->pieces.pieces.count;
    memory_free(memory, m->vertices, p->count, sizeof *m->vertices);
    memory_free(memory, m->loop, p->count, sizeof *m->loop);
    memory_free(memory, m->edge_planes, p->count, sizeof *m->edge_planes);
    return r;
}

// Every door counts as one that closes; numbers of movers come later.
static result job_open(door_taker *d, report *r)
{
    const compile_input *in = d->in;
    d->zones.mesh = &d->mesh;
    d->job = (item_job){.in = in, .zones = &d->zones, .memory = d->out->memory, .report = r};
    d->job.door_of = memory_alloc(d->out->memory, in->entity_count, sizeof *d->job.door_of);
    if (!d->job.door_of) return RESULT_NO_MEMORY;
    for (uint32_t e = 0; e < in->entity_count; ++e) d->job.door_of[e] = strncmp(in->entities[e].class_name, "func_door", 9) == 0 ? e : SCENE_NONE;
    return brush_bodies_make(in, 1u << BRUSH_ENTITY, r, d->out->memory, &d->job.bodies);
}

static void job_close(door_taker *d)
{
    brush_bodies_free(&d->job.bodies);
    memory_free(d->out->memory, d->job.door_of, d->in->entity_count, sizeof *d->job.door_of);
    buffer_free(&d->pieces.pieces);
    buffer_free(&d->pieces.edges);
}

static result polygon_take(door_taker *d, uint32_t polygon)
{
    const surface_polygon *p = surface_polygon_at(&d->t->s, polygon);
    if (p->kind != SURFACE_PORTAL) return RESULT_OK;
    const portal_piece *piece = (const portal_piece *)d->set->pieces.items + p->source;
    const uint32_t regions[2] = {zone_trace_region(d->t, 2 * polygon), zone_trace_region(d->t, 2 * polygon + 1)};
    if (regions[0] == regions[1] || regions[0] == REGION_VOID || regions[1] == REGION_VOID) return RESULT_OK;
    uint32_t count = 0;
    result r = portals_count(d, p, &count);
    if (r != RESULT_OK) return r;
    if (!piece->is_door) {
        d->out->fixed += count;
        return RESULT_OK;
    }
    d->out->portals[p->source] += count;
    return door_add(d->out, p->plane >> 1, regions, p->source);
}

// What was counted by piece stands with its group.
static void groups_close(door_set *d)
{
    for (uint32_t i = 0; i < d->piece_count; ++i) {
        const uint32_t group = group_find(d, i);
        if (group == i) continue;
        d->portals[group] += d->portals[i];
        d->portals[i] = 0;
    }
    for (uint32_t i = 0; i < d->piece_count; ++i) d->group_of[i] = group_find(d, i);
    cell_door *all = d->doors.items;
    for (size_t i = 0; i < d->doors.count; ++i) all[i].group = d->group_of[all[i].group];
}

result door_set_make(const compile_input *in, const zone_trace *t, const portal_set *set, report *r, const allocator *memory, door_set *out)
{
    *out = (door_set){.memory = memory, .doors = buffer_make(memory, sizeof(cell_door)), .places = buffer_make(memory, sizeof(door_place)),
                      .piece_count = (uint32_t)set->pieces.count};
    if (!out->piece_count) return RESULT_OK;
    out->group_of = memory_alloc(memory, out->piece_count, sizeof *out->group_of);
    out->portals = memory_alloc_zeroed(memory, out->piece_count, sizeof *out->portals);
    if (!out->group_of || !out->portals) return RESULT_NO_MEMORY;
    for (uint32_t i = 0; i < out->piece_count; ++i) out->group_of[i] = i;
    door_taker d = {.in = in, .t = t, .set = set, .out = out,
                    .pieces = {buffer_make(memory, sizeof(portal_piece_of_door)), buffer_make(memory, sizeof(polygon_edge))}};
    result done = job_open(&d, r);
    if (done == RESULT_OK) done = places_take(&d);
    for (uint32_t i = 0; i < surface_polygon_count(&t->s) && done == RESULT_OK; ++i) done = polygon_take(&d, i);
    if (done == RESULT_OK) groups_close(out);
    job_close(&d);
    return done;
}

void door_set_free(door_set *d)
{
    buffer_free(&d->doors);
    buffer_free(&d->places);
    memory_free(d->memory, d->group_of, d->piece_count, sizeof *d->group_of);
    memory_free(d->memory, d->portals, d->piece_count, sizeof *d->portals);
}
