// From a tracing to cells, from cells to rooms, and the faces between rooms into the set of portals.
// SPDX-License-Identifier: MIT
#include "rooms.h"

#include "rooms_doors.h"
#include "steady.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct wall_key { int64_t area, places[STEADY_CENTRES]; uint32_t wall; } wall_key;

typedef struct room_build {
    const compile_input *in;
    const zone_trace *t;
    const allocator *memory;
    buffer walls, edges; // cell_wall, polygon_edge
    cell_set cells;
    room_map rooms;
    door_set doors;
    portal_set *set;
} room_build;

// ---- Walls ----

static int goes_straight(const surface *s, const surface_corner *c, uint32_t count, uint32_t i)
{
    return surface_side(s, c[i + 1 < count ? i + 1 : 0].vertex, c[i ? i - 1 : count - 1].edge) == 0;
}

static result wall_add(room_build *b, uint32_t polygon, uint32_t front, uint32_t behind)
{
    const surface *s = &b->t->s;
    const surface_polygon *p = surface_polygon_at(s, polygon);
    const surface_corner *c = surface_corners(s, p);
    const int turned = front == CELL_SOLID; // air behind only: seen from there
    cell_wall wall = {{p->plane, (uint32_t)b->edges.count, 0}, turned ? behind : front, turned ? front : behind};
    for (uint32_t i = 0; i < p->count; ++i) {
        if (goes_straight(s, c, p->count, i)) continue;
        polygon_edge *e = buffer_push(&b->edges, 1);
        if (!e) return RESULT_NO_MEMORY;
        *e = (polygon_edge){.plane = c[i].edge};
        memcpy(e->start, surface_vertex_at(s, c[i].vertex)->position, sizeof e->start);
        wall.shape.count++;
    }
    return buffer_append(&b->walls, &wall, 1) ? RESULT_OK : RESULT_NO_MEMORY;
}

static uint32_t region_at(const zone_trace *t, uint32_t face)
{
    const uint32_t region = zone_trace_region(t, face);
    return region == REGION_VOID ? CELL_SOLID : region;
}

static result walls_take(room_build *b)
{
    result r = RESULT_OK;
    for (uint32_t i = 0; i < surface_polygon_count(&b->t->s) && r == RESULT_OK; ++i) {
        const surface_kind kind = surface_polygon_at(&b->t->s, i)->kind;
        if (kind == SURFACE_LIQUID) continue;
        const uint32_t front = region_at(b->t, 2 * i), behind = surface_is_two_sided(kind) ? region_at(b->t, 2 * i + 1) : CELL_SOLID;
        if (front != CELL_SOLID) r = wall_add(b, i, front, behind);
    }
    return r;
}

// ---- Their order ----

static void middle_of(const polygon_edge *edges, uint32_t count, double out[3])
{
    for (int k = 0; k < 3; ++k) {
        out[k] = 0;
        for (uint32_t i = 0; i < count; ++i) out[k] += edges[i].start[k] / count;
    }
}

static int by_size(const void *a, const void *b)
{
    const wall_key *x = a, *y = b;
    if (x->area != y->area) return x->area > y->area ? -1 : 1;
    const int places = steady_places_compare(x->places, y->places);
    if (places) return places;
    return (x->wall > y->wall) - (x->wall < y->wall);
}

static wall_key key_of(const room_build *b, uint32_t wall, steady_centres *centres)
{
    const cell_wall *w = (cell_wall *)b->walls.items + wall;
    const polygon_edge *edges = (polygon_edge *)b->edges.items + w->shape.first;
    const double area = polygon_area(edges, w->shape.count);
    double middle[3];
    middle_of(edges, w->shape.count, middle);
    steady_centres_add(centres, area, middle);
    return (wall_key){.area = steady_log(area), .wall = wall};
}

static void place_key(const room_build *b, const steady_centres *centres, wall_key *key)
{
    const cell_wall *w = (cell_wall *)b->walls.items + key->wall;
    double middle[3];
    middle_of((polygon_edge *)b->edges.items + w->shape.first, w->shape.count, middle);
    steady_places(centres, middle, key->places);
}

// Large walls first, then those far from the middle of all: a turned or moved map has the same order.
static result walls_order(room_build *b)
{
    const size_t count = b->walls.count;
    const cell_wall *w = b->walls.items;
    wall_key *keys = memory_alloc(b->memory, count, sizeof *keys);
    cell_wall *sorted = memory_alloc(b->memory, count, sizeof *sorted);
    if (keys && sorted && count) {
        steady_centres centres = {0};
        for (size_t i = 0; i < count; ++i) keys[i] = key_of(b, (uint32_t)i, &centres);
        for (size_t i = 0; i < count; ++i) place_key(b, &centres, &keys[i]);
        qsort(keys, count, sizeof *keys, by_size);
        for (size_t i = 0; i < count; ++i) sorted[i] = w[keys[i].wall];
        memcpy(b->walls.items, sorted, count * sizeof *sorted);
    }
    const result r = keys && sorted ? RESULT_OK : RESULT_NO_MEMORY;
    memory_free(b->memory, keys, count, sizeof *keys);
    memory_free(b->memory, sorted, count, sizeof *sorted);
    return r;
}

// ---- Portals ----

static result piece_add(room_build *b, const cell_face *f)
{
    surface *s = &b->set->s;
    const polygon_edge *edges = (polygon_edge *)b->cells.edges.items + f->shape.first;
    surface_corner *corners = memory_alloc(b->memory, f->shape.count, sizeof *corners);
    result r = corners ? RESULT_OK : RESULT_NO_MEMORY;
    for (uint32_t i = 0; i < f->shape.count && r == RESULT_OK; ++i) {
        plane_ref meet[3];
        polygon_corner(f->shape.plane, edges, f->shape.count, i, meet);
        corners[i].edge = edges[i].plane;
        r = surface_vertex(s, meet, &corners[i].vertex);
    }
    portal_piece piece = {.entity = COMPILE_NOTHING};
    const surface_polygon like = {.kind = SURFACE_PORTAL, .material = COMPILE_NOTHING, .brush = COMPILE_NOTHING};
    if (r == RESULT_OK) r = surface_add(s, f->shape.plane, corners, f->shape.count, &like, &piece.polygon);
    if (r == RESULT_OK && !buffer_append(&b->set->pieces, &piece, 1)) r = RESULT_NO_MEMORY;
    memory_free(b->memory, corners, f->shape.count, sizeof *corners);
    return r;
}

static int is_inside(const room_build *b, const cell_face *f)
{
    return b->rooms.room_of[f->cells[0]] == b->rooms.room_of[f->cells[1]];
}

static uint32_t group_of(const room_build *b, const cell_face *f)
{
    return ((const cell_door *)b->doors.doors.items)[f->door].group;
}

// A door inside of a room goes, with its group: what of it still parts rooms becomes a portal like any other.
static void doors_give_up(room_build *b, uint8_t *is_given_up)
{
    const cell_face *f = b->cells.faces.items;
    portal_piece *pieces = b->set->pieces.items;
    for (size_t i = 0; i < b->cells.faces.count; ++i)
        if (f[i].door != CELL_NO_DOOR && is_inside(b, &f[i])) is_given_up[group_of(b, &f[i])] = 1;
    for (uint32_t i = 0; i < b->doors.piece_count; ++i)
        if (is_given_up[b->doors.group_of[i]]) pieces[i].is_rejected = 1;
}

static result pieces_add(room_build *b)
{
    const cell_face *f = b->cells.faces.items;
    uint8_t *is_given_up = memory_alloc_zeroed(b->memory, b->doors.piece_count + 1, 1);
    if (!is_given_up) return RESULT_NO_MEMORY;
    doors_give_up(b, is_given_up);
    result r = RESULT_OK;
    for (size_t i = 0; i < b->cells.faces.count && r == RESULT_OK; ++i) {
        if (is_inside(b, &f[i]) || (f[i].door != CELL_NO_DOOR && !is_given_up[group_of(b, &f[i])])) continue;
        r = piece_add(b, &f[i]);
    }
    memory_free(b->memory, is_given_up, b->doors.piece_count + 1, 1);
    return r;
}

static result rooms_take(room_build *b, const room_limits *limits)
{
    const cell_input from = {.planes = b->in->planes,
                             .walls = b->walls.items,
                             .edges = b->edges.items,
                             .doors = b->doors.doors.items,
                             .wall_count = (uint32_t)b->walls.count,
                             .edge_count = (uint32_t)b->edges.count,
                             .door_count = (uint32_t)b->doors.doors.count};
    result r = cell_set_make(&from, b->memory, &b->cells);
    const merge_input merge = {.cells = &b->cells,
                               .from = &from,
                               .door_portals = b->doors.portals,
                               .fixed_portals = b->doors.fixed,
                               .limits = limits,
                               .door_places = b->doors.places.items,
                               .door_place_count = (uint32_t)b->doors.places.count};
    if (r == RESULT_OK) r = rooms_merge(&merge, b->memory, &b->rooms);
    if (r == RESULT_OK) r = pieces_add(b);
    room_map_free(&b->rooms, b->memory);
    cell_set_free(&b->cells);
    return r;
}

result rooms_portals(const compile_input *in, const zone_trace *t, const room_limits *limits, report *reports, portal_set *set)
{
    const allocator *memory = set->s.memory;
    room_build b = {.in = in,
                    .t = t,
                    .memory = memory,
                    .walls = buffer_make(memory, sizeof(cell_wall)),
                    .edges = buffer_make(memory, sizeof(polygon_edge)),
                    .set = set};
    result r = walls_take(&b);
    if (r == RESULT_OK) r = walls_order(&b);
    if (r == RESULT_OK) r = door_set_make(in, t, set, reports, memory, &b.doors);
    if (r == RESULT_OK) r = rooms_take(&b, limits);
    if (r == RESULT_OK && b.doors.fixed > limits->portals)
        report_warning(reports, in->path, 0, "portal brushes make %u portals, more than the %u that were asked for: they stay, and nothing else parts rooms; ask for more or take some out",
                       b.doors.fixed, limits->portals);
    if (b.doors.memory) door_set_free(&b.doors);
    buffer_free(&b.walls);
    buffer_free(&b.edges);
    return r;
}
