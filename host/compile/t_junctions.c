// The traced surface back into the mesh. T-junctions go by construction: an edge gets every vertex that its line has
// between its ends (the thesis's A6).
// SPDX-License-Identifier: MIT
#include "zone_trace.h"

#include <assert.h>

typedef struct emitter {
    const zone_trace *t;
    ray_space *rays;
    const zone_places *places;
    zone_shape shape;
    compiled_zones *z;
    compile_mesh *mesh;
    uint32_t *number_of; // of the surface's vertices in the mesh
} emitter;

static const line_edge *edge_at(const emitter *e, const surface_polygon *p, uint32_t corner)
{
    return (line_edge *)e->t->lines.edges.items + e->t->lines.edge_of[p->first + corner];
}

static uint32_t loop_length(const emitter *e, const surface_polygon *p)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < p->count; ++i) {
        const line_edge *edge = edge_at(e, p, i);
        count += edge->from < edge->to ? edge->to - edge->from : edge->from - edge->to;
    }
    return count;
}

static void write_loop(emitter *e, const surface_polygon *p)
{
    compile_mesh *m = e->mesh;
    for (uint32_t i = 0; i < p->count; ++i) {
        const line_edge *edge = edge_at(e, p, i);
        const surface_line *line = (surface_line *)e->t->lines.lines.items + edge->line;
        const uint32_t *vertices = (uint32_t *)e->t->lines.vertices.items + line->first_vertex;
        assert(vertices[edge->from] == surface_corners(&e->t->s, p)[i].vertex);
        for (uint32_t rank = edge->from; rank != edge->to; rank += edge->from < edge->to ? 1 : UINT32_MAX) {
            m->edge_planes[m->loop_count] = surface_corners(&e->t->s, p)[i].edge;
            m->loop[m->loop_count++] = e->number_of[vertices[rank]];
        }
    }
}

static uint32_t zone_of_region(const emitter *e, uint32_t region)
{
    if (e->shape == ZONES_OPEN) return 0;
    return region < e->places->region_count ? e->places->zone_of[region] : ZONE_NONE;
}

static int is_kept_portal(const emitter *e, uint32_t polygon)
{
    const uint32_t front = zone_trace_region(e->t, 2 * polygon), back = zone_trace_region(e->t, 2 * polygon + 1);
    return e->shape == ZONES_CLOSED && surface_polygon_at(&e->t->s, polygon)->kind == SURFACE_PORTAL && front != back && front != REGION_VOID &&
           back != REGION_VOID;
}

static int is_written(const emitter *e, uint32_t polygon)
{
    return surface_polygon_at(&e->t->s, polygon)->kind != SURFACE_PORTAL || is_kept_portal(e, polygon);
}

// Counts, and marks the vertices in use.
static result make_room(emitter *e)
{
    const surface *s = &e->t->s;
    uint32_t loops = 0, polygons = 0, portals = 0, vertices = 0;
    for (uint32_t i = 0; i < surface_polygon_count(s); ++i) {
        const surface_polygon *p = surface_polygon_at(s, i);
        if (!is_written(e, i)) continue;
        const uint32_t length = loop_length(e, p);
        loops += length;
        if (p->kind == SURFACE_PORTAL) portals++;
        else polygons++, e->z->t_junctions_inserted += length - p->count;
        for (uint32_t c = 0; c < p->count; ++c) {
            const line_edge *edge = edge_at(e, p, c);
            const surface_line *line = (surface_line *)e->t->lines.lines.items + edge->line;
            const uint32_t low = edge->from < edge->to ? edge->from : edge->to, high = edge->from < edge->to ? edge->to : edge->from;
            for (uint32_t k = low; k <= high; ++k) e->number_of[((uint32_t *)e->t->lines.vertices.items)[line->first_vertex + k]] = 1;
        }
    }
    for (uint32_t v = 0; v < s->vertices.count; ++v)
        if (e->number_of[v]) e->number_of[v] = vertices++;
        else e->number_of[v] = UINT32_MAX;
    compile_mesh *m = e->mesh;
    m->vertices = arena_push(&m->memory, vertices, sizeof(*m->vertices));
    m->loop = arena_push(&m->memory, loops, sizeof(*m->loop));
    m->edge_planes = arena_push(&m->memory, loops, sizeof(*m->edge_planes));
    m->polygons = arena_push(&m->memory, polygons, sizeof(*m->polygons));
    m->vertex_count = vertices;
    m->loop_count = m->polygon_count = 0;
    e->z->polygon_zone = arena_push(&e->z->memory, polygons, sizeof(uint32_t));
    e->z->seal_zones = arena_push(&e->z->memory, polygons, sizeof(*e->z->seal_zones));
    e->z->portals = arena_push(&e->z->memory, portals, sizeof(compiled_portal));
    return m->vertices && m->loop && m->edge_planes && m->polygons && e->z->polygon_zone && e->z->seal_zones && e->z->portals ? RESULT_OK : RESULT_NO_MEMORY;
}

static result write_polygon(emitter *e, uint32_t number)
{
    const surface_polygon *p = surface_polygon_at(&e->t->s, number);
    compile_mesh *m = e->mesh;
    uint32_t region = zone_trace_region(e->t, 2 * number);
    if (p->kind == SURFACE_LIQUID && e->shape == ZONES_CLOSED) {
        const result r = region_of_face(&e->t->regions, e->rays, 2 * number, &region);
        if (r != RESULT_OK) return r;
    }
    for (uint32_t side = 0; side < 2; ++side)
        e->z->seal_zones[m->polygon_count][side] = p->kind == SURFACE_SEAL ? zone_of_region(e, zone_trace_region(e->t, 2 * number + side)) : ZONE_NONE;
    if (p->kind == SURFACE_SEAL && region == REGION_VOID) region = zone_trace_region(e->t, 2 * number + 1);
    e->z->polygon_zone[m->polygon_count] = zone_of_region(e, region);
    const uint32_t first = m->loop_count;
    write_loop(e, p);
    const compile_polygon made = {p->plane, first, m->loop_count - first, p->material, p->brush, p->face};
    m->polygons[m->polygon_count++] = made;
    return RESULT_OK;
}

static void write_portal(emitter *e, uint32_t number)
{
    const surface_polygon *p = surface_polygon_at(&e->t->s, number);
    compiled_portal made = {.plane = p->plane, .first_vertex = e->mesh->loop_count, .entity = p->brush};
    write_loop(e, p);
    made.vertex_count = e->mesh->loop_count - made.first_vertex;
    for (uint32_t side = 0; side < 2; ++side) made.zones[side] = zone_of_region(e, zone_trace_region(e->t, 2 * number + side));
    e->z->portals[e->z->portal_count++] = made;
}

result zone_emit(const zone_trace *t, ray_space *rays, const zone_places *p, zone_shape shape, compiled_zones *z)
{
    const size_t vertices = t->s.vertices.count;
    emitter e = {.t = t, .rays = rays, .places = p, .shape = shape, .z = z, .mesh = z->mesh};
    e.number_of = memory_alloc_zeroed(t->s.memory, vertices, sizeof(uint32_t));
    result r = e.number_of ? make_room(&e) : RESULT_NO_MEMORY;
    for (uint32_t v = 0; v < vertices && r == RESULT_OK; ++v)
        if (e.number_of[v] != UINT32_MAX) z->mesh->vertices[e.number_of[v]] = *surface_vertex_at(&t->s, v);
    for (uint32_t i = 0; i < surface_polygon_count(&t->s) && r == RESULT_OK; ++i) {
        if (surface_polygon_at(&t->s, i)->kind != SURFACE_PORTAL) r = write_polygon(&e, i);
        else if (is_kept_portal(&e, i)) write_portal(&e, i);
    }
    memory_free(t->s.memory, e.number_of, vertices, sizeof(uint32_t));
    return r;
}
