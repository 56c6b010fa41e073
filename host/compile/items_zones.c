// Zones into the builder: each as convex hulls, from a binary space partition by the exact planes of the zones' walls and
// portals (Fuchs, Kedem, Naylor, 1980) that stops as soon as a cell touches one zone only.
// SPDX-License-Identifier: MIT
// Invariant: a hull may hold solid and void, never another zone's air: a cell with walls of one zone and none of another's
// has no air of another, for the border of that air would be such a wall.
#include "items.h"
#include "plane_polygon.h"

#include <stdio.h>
#include <string.h>

enum {
    PORTAL_NAME_BYTES = 4352, // of a JSON scene with all prefixes, and a number
    CANDIDATES_MOST = 24, // planes tried at a node
    SAMPLES_MOST = 256,   // fragments that each is tried on
    DEPTH_MOST = 240,     // planes of a hull, less the six around all
};
#define CELL_NONE UINT32_MAX // solid, or the void
static const double ROUND_MARGIN = 1; // metres: the cells reach beyond all vertices

typedef struct fragment {
    plane_polygon shape;
    uint32_t zones[2]; // in front, behind; CELL_NONE
} fragment;

typedef struct cell_hull { uint32_t zone, first, count; } cell_hull; // in partition.planes

typedef struct partition {
    item_job *job;
    buffer fragments; // fragment: a stack of nodes' lists
    buffer edges;     // polygon_edge
    buffer hulls;     // cell_hull
    buffer planes;    // plane_ref: the hull lies behind them
    buffer signs;     // int8_t
    buffer tally;     // uint32_t: by zone
    plane_ref path[DEPTH_MOST]; // the node lies behind them
    uint32_t too_deep;
} partition;

typedef struct node { size_t first, count; uint32_t depth; } node;

// ---- Fragments ----

static result add_fragment(partition *p, const compile_polygon *q, uint32_t front, uint32_t behind)
{
    const compile_mesh *m = p->job->zones->mesh;
    fragment f = {{q->plane, (uint32_t)p->edges.count, 0}, {front, behind}};
    for (uint32_t i = 0; i < q->vertex_count; ++i) {
        if (item_goes_straight(p->job, q, i)) continue;
        polygon_edge *e = buffer_push(&p->edges, 1);
        if (!e) return RESULT_NO_MEMORY;
        *e = (polygon_edge){.plane = m->edge_planes[q->first_vertex + i]};
        memcpy(e->start, m->vertices[m->loop[q->first_vertex + i]].position, sizeof e->start);
        f.shape.count++;
    }
    return buffer_append(&p->fragments, &f, 1) ? RESULT_OK : RESULT_NO_MEMORY;
}

// A wall, or a liquid that holds the void back: the void may lie in the zone's hulls, so it counts as the zone on both sides.
static result take_polygon(partition *p, uint32_t polygon)
{
    const compiled_zones *z = p->job->zones;
    const compile_polygon *q = &z->mesh->polygons[polygon];
    const uint32_t *seal = z->seal_zones[polygon];
    if (z->polygon_zone[polygon] == CELL_NONE) return RESULT_OK;
    if (p->job->in->brushes[q->brush].role != BRUSH_LIQUID) return add_fragment(p, q, z->polygon_zone[polygon], CELL_NONE);
    if (seal[0] == CELL_NONE && seal[1] == CELL_NONE) return RESULT_OK;
    return add_fragment(p, q, seal[seal[0] == CELL_NONE], seal[seal[1] != CELL_NONE]);
}

static result take_fragments(partition *p)
{
    const compiled_zones *z = p->job->zones;
    result done = RESULT_OK;
    for (uint32_t i = 0; i < z->portal_count && done == RESULT_OK; ++i) {
        const compiled_portal *from = &z->portals[i];
        const compile_polygon q = {.plane = from->plane, .first_vertex = from->first_vertex, .vertex_count = from->vertex_count};
        done = add_fragment(p, &q, from->zones[0], from->zones[1]);
    }
    for (uint32_t i = 0; i < z->mesh->polygon_count && done == RESULT_OK; ++i) done = take_polygon(p, i);
    return done;
}

static const fragment *fragment_at(const partition *p, size_t at)
{
    return (const fragment *)p->fragments.items + at;
}

static polygon_place place_of(const partition *p, const fragment *f, plane_ref by)
{
    if (f->shape.plane >> 1 == by >> 1) return POLYGON_ON;
    return polygon_signs(p->job->in->planes, f->shape.plane, (const polygon_edge *)p->edges.items + f->shape.first, f->shape.count, by, p->signs.items);
}

// ---- Which plane ----

static uint32_t pure_zone(const partition *p, const node *n) // CELL_NONE: several
{
    const uint32_t zone = fragment_at(p, n->first)->zones[0];
    for (size_t i = 0; i < n->count; ++i) {
        const fragment *f = fragment_at(p, n->first + i);
        if (f->zones[0] != zone || (f->zones[1] != CELL_NONE && f->zones[1] != zone)) return CELL_NONE;
    }
    return zone;
}

static void count_zones(uint32_t *tally, const fragment *f, uint32_t *most)
{
    for (int side = 0; side < 2; ++side)
        if (f->zones[side] != CELL_NONE && ++tally[f->zones[side]] > *most) *most = tally[f->zones[side]];
}

// What is of another zone than most of its side, and what is cut: the less the better.
static double cost_of(partition *p, const node *n, plane_ref by)
{
    const uint32_t zones = p->job->zones->zone_count;
    uint32_t *tally = p->tally.items, most[2] = {0, 0}, all[2] = {0, 0}, cut = 0;
    memset(tally, 0, 2 * zones * sizeof *tally);
    const size_t stride = n->count / SAMPLES_MOST + 1;
    for (size_t i = 0; i < n->count; i += stride) {
        const fragment *f = fragment_at(p, n->first + i);
        const polygon_place place = place_of(p, f, by);
        if (place == POLYGON_ACROSS) ++cut;
        for (int side = 0; side < 2; ++side) {
            if (!(place & (side ? POLYGON_BEHIND : POLYGON_FRONT))) continue;
            count_zones(tally + (size_t)side * zones, f, &most[side]);
            all[side] += f->zones[1] != CELL_NONE ? 2u : 1u;
        }
    }
    const double mixed = (double)(all[0] - most[0]) + (double)(all[1] - most[1]);
    const int is_one_sided = !all[0] || !all[1];
    return mixed + 0.5 * cut + (is_one_sided ? 0.25 * (all[0] + all[1]) : 0);
}

static plane_ref best_plane(partition *p, const node *n, fragment *out)
{
    double best = 0;
    size_t chosen = n->first;
    const size_t stride = n->count / CANDIDATES_MOST + 1;
    for (size_t i = 0; i < n->count; ++i) { // portals stand first
        const fragment *f = fragment_at(p, n->first + i);
        if (i % stride && (f->zones[1] == CELL_NONE || i > CANDIDATES_MOST)) continue;
        const double cost = cost_of(p, n, f->shape.plane);
        if (i && cost >= best) continue;
        best = cost;
        chosen = n->first + i;
    }
    *out = *fragment_at(p, chosen);
    return out->shape.plane;
}

// ---- Nodes ----

static result end_cell(partition *p, uint32_t depth, uint32_t zone)
{
    if (zone == CELL_NONE) return RESULT_OK;
    const cell_hull hull = {zone, (uint32_t)p->planes.count, depth};
    return buffer_append(&p->planes, p->path, depth) && buffer_append(&p->hulls, &hull, 1) ? RESULT_OK : RESULT_NO_MEMORY;
}

static result push_part(partition *p, const fragment *f, plane_ref by, polygon_place place, uint32_t side)
{
    fragment part = *f;
    if (place == POLYGON_ACROSS) {
        const polygon_parts parts = {side ? &part.shape : NULL, side ? NULL : &part.shape};
        if (!polygon_cut(p->job->in->planes, &f->shape, p->signs.items, by, &p->edges, parts)) return RESULT_NO_MEMORY;
    }
    return buffer_append(&p->fragments, &part, 1) ? RESULT_OK : RESULT_NO_MEMORY;
}

// The list of the child on that side (0 front), on top of the stack.
static result make_child(partition *p, const node *n, plane_ref by, uint32_t side, node *out)
{
    *out = (node){p->fragments.count, 0, n->depth + 1};
    for (size_t i = 0; i < n->count; ++i) {
        const fragment f = *fragment_at(p, n->first + i);
        const polygon_place place = place_of(p, &f, by);
        if (!(place & (side ? POLYGON_BEHIND : POLYGON_FRONT))) continue;
        const result done = push_part(p, &f, by, place, side);
        if (done != RESULT_OK) return done;
    }
    out->count = p->fragments.count - out->first;
    return RESULT_OK;
}

// No deeper than DEPTH_MOST calls.
static result split_node(partition *p, const node *n)
{
    const uint32_t zone = pure_zone(p, n);
    if (zone != CELL_NONE) return end_cell(p, n->depth, zone);
    if (n->depth == DEPTH_MOST) {
        p->too_deep = 1;
        return RESULT_OK;
    }
    fragment splitter;
    const plane_ref by = best_plane(p, n, &splitter);
    result done = RESULT_OK;
    for (uint32_t side = 0; side < 2 && done == RESULT_OK; ++side) {
        const size_t fragments = p->fragments.count, edges = p->edges.count;
        node child;
        p->path[n->depth] = side ? by : plane_ref_flipped(by);
        done = make_child(p, n, by, side, &child);
        if (done == RESULT_OK) done = child.count ? split_node(p, &child) : end_cell(p, child.depth, splitter.zones[side]);
        p->fragments.count = fragments;
        p->edges.count = edges;
    }
    return done;
}

// ---- Into the builder ----

static void around_all(const item_job *j, scene_solid_plane planes[6])
{
    const compile_mesh *m = j->zones->mesh;
    for (int k = 0; k < 3; ++k) {
        double low = 0, high = 0;
        for (uint32_t v = 0; v < m->vertex_count; ++v) {
            const double at = m->vertices[v].position[k] / j->in->steps_per_metre;
            if (!v || at < low) low = at;
            if (!v || at > high) high = at;
        }
        planes[2 * k] = planes[2 * k + 1] = (scene_solid_plane){.normal = {0, 0, 0}};
        planes[2 * k].normal[k] = 1;
        planes[2 * k].distance = high + ROUND_MARGIN;
        planes[2 * k + 1].normal[k] = -1;
        planes[2 * k + 1].distance = -(low - ROUND_MARGIN);
    }
}

static void hull_planes(const partition *p, const cell_hull *h, const scene_solid_plane around[6], scene_solid_plane *out)
{
    const plane_ref *refs = (const plane_ref *)p->planes.items + h->first;
    memcpy(out, around, 6 * sizeof *out);
    for (uint32_t i = 0; i < h->count; ++i) {
        double plane[4];
        item_plane(p->job, refs[i], plane);
        out[6 + i] = (scene_solid_plane){{plane[0], plane[1], plane[2]}, -plane[3]};
    }
}

static result tell_fault(const item_job *j, const char *what, uint32_t number, const char *fault)
{
    return fault ? report_error(j->report, j->in->path, 0, "%s %u %s; please report the map", what, number, fault) : RESULT_NO_MEMORY;
}

static result add_zone(partition *p, uint32_t zone, const scene_solid_plane around[6])
{
    const compiled_zone *from = &p->job->zones->zones[zone];
    buffer hulls = buffer_make(p->job->memory, sizeof(builder_hull)), planes = buffer_make(p->job->memory, sizeof(scene_solid_plane));
    const cell_hull *all = p->hulls.items;
    size_t at = 0, count = 0;
    result done = RESULT_OK;
    for (size_t h = 0; h < p->hulls.count; ++h) count += all[h].zone == zone ? all[h].count + 6 : 0;
    scene_solid_plane *to = buffer_push(&planes, count);
    for (size_t h = 0; h < p->hulls.count && to && done == RESULT_OK; ++h) {
        if (all[h].zone != zone) continue;
        const builder_hull hull = {to + at, all[h].count + 6};
        hull_planes(p, &all[h], around, to + at);
        at += hull.plane_count;
        if (!buffer_append(&hulls, &hull, 1)) done = RESULT_NO_MEMORY;
    }
    const builder_zone made = {.name = from->name, .chain = from->chain, .hulls = hulls.items, .hull_count = (uint32_t)hulls.count, .parent = SCENE_NONE};
    const char *fault = NULL;
    uint32_t number;
    if (!to) done = RESULT_NO_MEMORY;
    if (done == RESULT_OK) done = scene_builder_zone(p->job->builder, &made, &number, &fault);
    if (done == RESULT_BAD_INPUT) done = tell_fault(p->job, "zone", zone, fault);
    buffer_free(&hulls);
    buffer_free(&planes);
    return done;
}

typedef struct named_portal { const char *kind; uint32_t number; const compiled_portal *portal; } named_portal;

// A portal brush may have a name; where walls part it, its further pieces get their numbers behind it.
static void name_portal(const item_job *j, const named_portal *of, char name[PORTAL_NAME_BYTES])
{
    const compiled_portal *portals = j->zones->portals;
    const compile_entity *e = of->portal->entity == COMPILE_NOTHING ? NULL : &j->in->entities[of->portal->entity];
    const int is_named = e && e->name && strcmp(e->class_name, "zone_portal") == 0; // then the number is the portal's
    const int is_first = is_named && (of->number == 0 || portals[of->number - 1].entity != of->portal->entity);
    if (!is_named) snprintf(name, PORTAL_NAME_BYTES, "%s %u", of->kind, of->number);
    else if (is_first) snprintf(name, PORTAL_NAME_BYTES, "%s", e->name);
    else snprintf(name, PORTAL_NAME_BYTES, "%.4200s %u", e->name, of->number);
}

static result add_piece(const item_job *j, const named_portal *of, const portal_pieces *from, uint32_t number)
{
    const compiled_portal *portal = of->portal;
    const portal_piece_of_door *piece = (const portal_piece_of_door *)from->pieces.items + number;
    const polygon_edge *edges = (const polygon_edge *)from->edges.items + piece->shape.first;
    double(*points)[3] = memory_alloc(j->memory, piece->shape.count, sizeof *points);
    if (!points) return RESULT_NO_MEMORY;
    for (uint32_t i = 0; i < piece->shape.count; ++i)
        for (int k = 0; k < 3; ++k) points[i][k] = edges[i].start[k] / j->in->steps_per_metre;
    char name[PORTAL_NAME_BYTES];
    double plane[4];
    item_plane(j, portal->plane, plane);
    name_portal(j, of, name);
    if (from->pieces.count > 1) {
        const size_t length = strlen(name);
        snprintf(name + length, sizeof name - length, " leaf %u", number);
    }
    const builder_portal made = {.name = name, .points = (const double(*)[3])points, .point_count = piece->shape.count,
                                 .zones = {portal->zones[0], portal->zones[1]}, .door = piece->door, .normal = plane};
    const char *fault = NULL;
    uint32_t added;
    result done = scene_builder_portal(j->builder, &made, &added, &fault);
    if (done == RESULT_BAD_INPUT) done = tell_fault(j, of->kind, of->number, fault);
    memory_free(j->memory, points, piece->shape.count, sizeof *points);
    return done;
}

static result add_portal(const item_job *j, const named_portal *of, portal_pieces *pieces)
{
    result done = portal_pieces_make(j, of->portal, pieces);
    for (uint32_t k = 0; k < pieces->pieces.count && done == RESULT_OK; ++k) done = add_piece(j, of, pieces, k);
    return done;
}

// A liquid that seals, and parts two zones elsewhere: seen through, so a portal there.
static result add_seal(const item_job *j, uint32_t polygon, portal_pieces *pieces)
{
    const compile_polygon *p = &j->zones->mesh->polygons[polygon];
    const uint32_t *zones = j->zones->seal_zones[polygon];
    if (zones[0] == CELL_NONE || zones[1] == CELL_NONE || zones[0] == zones[1]) return RESULT_OK;
    const compiled_portal made = {.plane = p->plane, .first_vertex = p->first_vertex, .vertex_count = p->vertex_count,
                                  .zones = {zones[0], zones[1]}, .entity = j->in->brushes[p->brush].entity};
    return add_portal(j, &(named_portal){"liquid", polygon, &made}, pieces);
}

static result add_portals(const item_job *j)
{
    portal_pieces pieces = {buffer_make(j->memory, sizeof(portal_piece_of_door)), buffer_make(j->memory, sizeof(polygon_edge))};
    result done = RESULT_OK;
    for (uint32_t i = 0; i < j->zones->portal_count && done == RESULT_OK; ++i)
        if (j->zones->portals[i].entity != COMPILE_NOTHING) done = add_portal(j, &(named_portal){"portal", i, &j->zones->portals[i]}, &pieces);
    if (done == RESULT_OK) done = items_joined_portals(j);
    for (uint32_t i = 0; i < j->zones->mesh->polygon_count && done == RESULT_OK; ++i) done = add_seal(j, i, &pieces);
    buffer_free(&pieces.pieces);
    buffer_free(&pieces.edges);
    return done;
}

static result add_everywhere(item_job *j)
{
    const compiled_zone *from = &j->zones->zones[0];
    const builder_zone made = {.name = from->name, .chain = from->chain, .parent = SCENE_NONE};
    const char *fault;
    uint32_t number;
    return scene_builder_zone(j->builder, &made, &number, &fault);
}

static result add_all(partition *p)
{
    scene_solid_plane around[6];
    around_all(p->job, around);
    result done = RESULT_OK;
    for (uint32_t z = 0; z < p->job->zones->zone_count && done == RESULT_OK; ++z) done = add_zone(p, z, around);
    return done == RESULT_OK ? add_portals(p->job) : done;
}

result items_zones(item_job *j)
{
    if (j->zones->zone_count == 0) return RESULT_OK;
    if (j->zones->zone_count == 1) return add_everywhere(j);
    partition p = {.job = j,
                   .fragments = buffer_make(j->memory, sizeof(fragment)),
                   .edges = buffer_make(j->memory, sizeof(polygon_edge)),
                   .hulls = buffer_make(j->memory, sizeof(cell_hull)),
                   .planes = buffer_make(j->memory, sizeof(plane_ref)),
                   .signs = buffer_make(j->memory, sizeof(int8_t)),
                   .tally = buffer_make(j->memory, sizeof(uint32_t))};
    result done = take_fragments(&p);
    const int never_null = buffer_push(&p.fragments, 0) && buffer_push(&p.edges, 0) && buffer_push(&p.planes, 0);
    const int has_room = never_null && buffer_push(&p.signs, j->zones->mesh->loop_count + 64) && buffer_push(&p.tally, 2 * (size_t)j->zones->zone_count);
    const node root = {0, p.fragments.count, 0};
    if (!has_room) done = RESULT_NO_MEMORY;
    if (done == RESULT_OK) done = split_node(&p, &root);
    if (done == RESULT_OK && p.too_deep)
        done = report_error(j->report, j->in->path, 0, "zones wound into each other over %d planes; part the map by fewer portals", DEPTH_MOST);
    if (done == RESULT_OK) done = add_all(&p);
    buffer *const all[] = {&p.fragments, &p.edges, &p.hulls, &p.planes, &p.signs, &p.tally};
    for (size_t i = 0; i < sizeof all / sizeof *all; ++i) buffer_free(all[i]);
    return done;
}
