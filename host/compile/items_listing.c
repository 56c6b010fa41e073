// Which zones list a wall: its own, as edge tracing found it, and each other that its corners touch. Where zones touch in an
// edge, without a portal, the depths of their walls are equal there, so a pixel on it may be the wall's behind.
// SPDX-License-Identifier: MIT
// Invariant: walls of both zones of a portal share its corners; no list is longer for that, the portal's own slack shows them.
#include "items.h"

#include <stdlib.h>

typedef struct vertex_zone { uint32_t vertex, zone; } vertex_zone; // a wall of the zone has the vertex
typedef struct vertex_pair { uint32_t vertex, low, high; } vertex_pair; // a portal between the two zones has it

static int compare_zones(const void *a, const void *b)
{
    const vertex_zone *p = a, *q = b;
    if (p->vertex != q->vertex) return p->vertex < q->vertex ? -1 : 1;
    return p->zone != q->zone ? p->zone < q->zone ? -1 : 1 : 0;
}

static int compare_pairs(const void *a, const void *b)
{
    const vertex_pair *p = a, *q = b;
    if (p->vertex != q->vertex) return p->vertex < q->vertex ? -1 : 1;
    if (p->low != q->low) return p->low < q->low ? -1 : 1;
    return p->high != q->high ? p->high < q->high ? -1 : 1 : 0;
}

int item_zones_by_box(const item_job *j, uint32_t polygon)
{
    const compile_polygon *p = &j->zones->mesh->polygons[polygon];
    return j->zones->zone_count < 2 || j->in->brushes[p->brush].role == BRUSH_LIQUID;
}

// The zone of each vertex that has one only; those of the others into `zones`, each once.
static result take_walls(const item_job *j, const rounded_mesh *rounded, wall_lists *l)
{
    const compile_mesh *m = j->zones->mesh;
    for (uint32_t v = 0; v < m->vertex_count; ++v) l->zone_of[v] = SCENE_NONE;
    for (int pass = 0; pass < 2; ++pass) { // the second knows which vertices have several
        for (uint32_t i = 0; i < m->polygon_count; ++i) {
            const compile_polygon *p = &m->polygons[i];
            const uint32_t zone = j->zones->polygon_zone[i];
            if (zone == UINT32_MAX || item_zones_by_box(j, i)) continue;
            for (uint32_t k = 0; k < p->vertex_count; ++k) {
                const uint32_t v = rounded->same_as[m->loop[p->first_vertex + k]];
                const vertex_zone found = {v, zone};
                if (pass && l->zone_of[v] == WALLS_SEVERAL && !buffer_append(&l->zones, &found, 1)) return RESULT_NO_MEMORY;
                if (pass) continue;
                if (l->zone_of[v] == SCENE_NONE) l->zone_of[v] = zone;
                else if (l->zone_of[v] != zone) l->zone_of[v] = WALLS_SEVERAL;
            }
        }
    }
    return RESULT_OK;
}

static result take_portals(const item_job *j, const rounded_mesh *rounded, wall_lists *l)
{
    const compiled_zones *z = j->zones;
    for (uint32_t i = 0; i < z->portal_count; ++i) {
        const compiled_portal *p = &z->portals[i];
        const uint32_t low = p->zones[0] < p->zones[1] ? p->zones[0] : p->zones[1], high = low == p->zones[0] ? p->zones[1] : p->zones[0];
        for (uint32_t k = 0; k < p->vertex_count; ++k) {
            const vertex_pair joined = {rounded->same_as[z->mesh->loop[p->first_vertex + k]], low, high};
            if (!buffer_append(&l->joined, &joined, 1)) return RESULT_NO_MEMORY;
        }
    }
    return RESULT_OK;
}

result wall_lists_make(const item_job *j, const rounded_mesh *rounded, wall_lists *out)
{
    *out = (wall_lists){.job = j,
                        .rounded = rounded,
                        .zones = buffer_make(j->memory, sizeof(vertex_zone)),
                        .joined = buffer_make(j->memory, sizeof(vertex_pair)),
                        .found = buffer_make(j->memory, sizeof(uint32_t))};
    if (j->zones->zone_count < 2) return RESULT_OK;
    out->zone_of = memory_alloc(j->memory, j->zones->mesh->vertex_count, sizeof *out->zone_of);
    result done = out->zone_of ? take_walls(j, rounded, out) : RESULT_NO_MEMORY;
    if (done == RESULT_OK) done = take_portals(j, rounded, out);
    if (done != RESULT_OK) return done;
    if (out->zones.count) qsort(out->zones.items, out->zones.count, sizeof(vertex_zone), compare_zones);
    if (out->joined.count) qsort(out->joined.items, out->joined.count, sizeof(vertex_pair), compare_pairs);
    return RESULT_OK;
}

void wall_lists_free(wall_lists *l)
{
    if (!l->job) return;
    if (l->zone_of) memory_free(l->job->memory, l->zone_of, l->job->zones->mesh->vertex_count, sizeof *l->zone_of);
    buffer_free(&l->zones);
    buffer_free(&l->joined);
    buffer_free(&l->found);
}

static int are_joined(const wall_lists *l, uint32_t vertex, uint32_t a, uint32_t b)
{
    const vertex_pair key = {vertex, a < b ? a : b, a < b ? b : a};
    return l->joined.count && bsearch(&key, l->joined.items, l->joined.count, sizeof key, compare_pairs) != NULL;
}

static int is_found(const wall_lists *l, uint32_t zone)
{
    const uint32_t *found = l->found.items;
    for (size_t i = 0; i < l->found.count; ++i)
        if (found[i] == zone) return 1;
    return 0;
}

// The first of the vertex's entries in `zones`, which holds all its zones together.
static size_t first_of(const wall_lists *l, uint32_t vertex)
{
    const vertex_zone *all = l->zones.items;
    size_t low = 0, high = l->zones.count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (all[middle].vertex < vertex) low = middle + 1;
        else high = middle;
    }
    return low;
}

static result find_touching(wall_lists *l, uint32_t vertex, uint32_t own)
{
    const vertex_zone *all = l->zones.items;
    for (size_t i = first_of(l, vertex); i < l->zones.count && all[i].vertex == vertex; ++i) {
        const uint32_t zone = all[i].zone;
        if (zone == own || is_found(l, zone) || are_joined(l, vertex, own, zone)) continue;
        if (!buffer_append(&l->found, &zone, 1)) return RESULT_NO_MEMORY;
    }
    return RESULT_OK;
}

result wall_lists_tell(wall_lists *l, uint32_t polygon)
{
    const item_job *j = l->job;
    const compile_mesh *m = j->zones->mesh;
    const compile_polygon *p = &m->polygons[polygon];
    const uint32_t own = j->zones->polygon_zone[polygon];
    if (item_zones_by_box(j, polygon)) return RESULT_OK;
    l->found.count = 0;
    if (!buffer_append(&l->found, &own, 1)) return RESULT_NO_MEMORY;
    for (uint32_t k = 0; k < p->vertex_count; ++k) {
        const uint32_t v = l->rounded->same_as[m->loop[p->first_vertex + k]];
        if (l->zone_of[v] == WALLS_SEVERAL && find_touching(l, v, own) != RESULT_OK) return RESULT_NO_MEMORY;
    }
    return scene_builder_item_zones(j->builder, l->found.items, (uint32_t)l->found.count);
}
