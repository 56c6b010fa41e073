// A plan of rooms: see generate_plan.h.
// SPDX-License-Identifier: MIT
#include "generate_plan.h"

#include <assert.h>

enum { HOLES_OF_A_SIDE = 32 };

plan plan_open(const allocator *memory)
{
    return (plan){.rooms = buffer_make(memory, sizeof(plan_room)), .holes = buffer_make(memory, sizeof(plan_hole)),
                  .ways = buffer_make(memory, sizeof(uint32_t)), .first_ways = buffer_make(memory, sizeof(uint32_t)),
                  .obstacles = buffer_make(memory, sizeof(block))};
}

void plan_free(plan *p)
{
    buffer_free(&p->rooms);
    buffer_free(&p->holes);
    buffer_free(&p->ways);
    buffer_free(&p->first_ways);
    buffer_free(&p->obstacles);
}

uint32_t plan_add_room(plan *p, const plan_room *room)
{
    if (p->failed || !buffer_append(&p->rooms, room, 1)) p->failed = 1;
    return (uint32_t)p->rooms.count - 1;
}

void plan_add_hole(plan *p, const plan_hole *hole)
{
    if (p->failed || !buffer_append(&p->holes, hole, 1)) p->failed = 1;
}

void plan_add_obstacle(plan *p, const block *b)
{
    if (p->failed || !buffer_append(&p->obstacles, b, 1)) p->failed = 1;
}

uint32_t plan_room_count(const plan *p)
{
    return (uint32_t)p->rooms.count;
}

const plan_room *plan_room_at(const plan *p, uint32_t room)
{
    return &((const plan_room *)p->rooms.items)[room];
}

uint32_t plan_hole_count(const plan *p)
{
    return (uint32_t)p->holes.count;
}

const plan_hole *plan_hole_at(const plan *p, uint32_t hole)
{
    return &((const plan_hole *)p->holes.items)[hole];
}

const uint32_t *plan_ways(const plan *p, uint32_t room, uint32_t *count)
{
    const uint32_t *first = p->first_ways.items;
    *count = first[room + 1] - first[room];
    return (const uint32_t *)p->ways.items + first[room];
}

uint32_t plan_behind(const plan *p, uint32_t way)
{
    return plan_hole_at(p, way / 2)->rooms[1 - way % 2];
}

int plan_index(plan *p)
{
    const uint32_t rooms = plan_room_count(p), holes = plan_hole_count(p);
    if (p->failed || !buffer_push(&p->first_ways, (size_t)rooms + 1) || !buffer_push(&p->ways, (size_t)holes * 2)) {
        p->failed = 1;
        return 0;
    }
    uint32_t *first = p->first_ways.items, *ways = p->ways.items;
    for (uint32_t i = 0; i <= rooms; ++i) first[i] = 0;
    for (uint32_t way = 0; way < 2 * holes; ++way) {
        const uint32_t room = plan_hole_at(p, way / 2)->rooms[way % 2];
        if (room != PLAN_OUTSIDE) first[room]++;
    }
    uint32_t end = 0;
    for (uint32_t i = 0; i <= rooms; ++i) first[i] = end += first[i];
    for (uint32_t way = 2 * holes; way-- > 0;) { // downwards: first[room] ends where the room's ways begin
        const uint32_t room = plan_hole_at(p, way / 2)->rooms[way % 2];
        if (room != PLAN_OUTSIDE) ways[--first[room]] = way;
    }
    p->ways.count = first[rooms];
    return 1;
}

side plan_opposite(side s)
{
    static const side opposite[PLAN_SIDES] = {SIDE_MAX_X, SIDE_MIN_X, SIDE_MAX_Y, SIDE_MIN_Y, SIDE_MAX_Z, SIDE_MIN_Z};
    return opposite[s];
}

// ---- Holes ----

static place place_on(side s, int32_t plane, int32_t u, int32_t v)
{
    if (s == SIDE_MIN_X || s == SIDE_MAX_X) return (place){plane, v, u};
    if (s == SIDE_MIN_Y || s == SIDE_MAX_Y) return (place){u, plane, v};
    return (place){u, v, plane};
}

place plan_hole_place(const plan_hole *h, int32_t u, int32_t v)
{
    return place_on(h->side, h->plane, u, v);
}

void plan_hole_corners(const plan_hole *h, place out[4])
{
    const rectangle o = h->opening;
    const int forward = h->side == SIDE_MAX_X || h->side == SIDE_MAX_Y || h->side == SIDE_MIN_Z;
    out[0] = plan_hole_place(h, o.u0, o.v0);
    out[forward ? 1 : 3] = plan_hole_place(h, o.u1, o.v0);
    out[2] = plan_hole_place(h, o.u1, o.v1);
    out[forward ? 3 : 1] = plan_hole_place(h, o.u0, o.v1);
}

block plan_leaf(const plan_hole *h)
{
    const rectangle o = h->opening;
    return (block){.min = place_on(h->side, h->plane - LEAF_HALF, o.u0 - LEAF_LAP, o.v0 - LEAF_LAP),
                   .max = place_on(h->side, h->plane + LEAF_HALF, o.u1 + LEAF_LAP, o.v1 + LEAF_LAP)};
}

// ---- Shells ----

typedef struct shell {
    rectangle openings[PLAN_SIDES][HOLES_OF_A_SIDE];
    uint32_t ways[PLAN_SIDES][HOLES_OF_A_SIDE];
    uint32_t counts[PLAN_SIDES];
    cuts along[3]; // x, y, z: shared by all sides, so that they meet corner to corner
} shell;

static void axes_of(side s, int *u, int *v)
{
    *u = s == SIDE_MIN_X || s == SIDE_MAX_X ? 2 : 0;
    *v = s == SIDE_MIN_Y || s == SIDE_MAX_Y ? 2 : 1;
}

static void shell_open(shell *s, const plan_room *r)
{
    const block *air = &r->air;
    const int32_t from[3] = {air->min.x, air->min.y, air->min.z}, to[3] = {air->max.x, air->max.y, air->max.z};
    for (int k = 0; k < 3; ++k) {
        s->along[k].count = 0;
        cuts_add(&s->along[k], from[k]);
        cuts_add(&s->along[k], to[k]);
    }
    for (uint32_t i = 0; r->heights && i < r->heights->count; ++i)
        if (r->heights->at[i] > air->min.y && r->heights->at[i] < air->max.y) cuts_add(&s->along[1], r->heights->at[i]);
    for (int k = 0; k < PLAN_SIDES; ++k) s->counts[k] = 0;
}

static void shell_cut(shell *s, side at, const rectangle *o, uint32_t way)
{
    int u, v;
    axes_of(at, &u, &v);
    assert(s->counts[at] < HOLES_OF_A_SIDE);
    if (s->counts[at] == HOLES_OF_A_SIDE) return;
    s->ways[at][s->counts[at]] = way;
    s->openings[at][s->counts[at]++] = *o;
    cuts_add(&s->along[u], o->u0);
    cuts_add(&s->along[u], o->u1);
    cuts_add(&s->along[v], o->v0);
    cuts_add(&s->along[v], o->v1);
}

void plan_write_room(obj_writer *w, const plan *p, uint32_t room)
{
    const plan_room *r = plan_room_at(p, room);
    shell s;
    uint32_t count;
    const uint32_t *ways = plan_ways(p, room, &count);
    shell_open(&s, r);
    for (uint32_t i = 0; i < count; ++i) {
        const plan_hole *h = plan_hole_at(p, ways[i] / 2);
        shell_cut(&s, ways[i] % 2 ? plan_opposite(h->side) : h->side, &h->opening, ways[i]);
    }
    for (side at = SIDE_MIN_X; at <= SIDE_MAX_Z; ++at) {
        int u, v;
        axes_of(at, &u, &v);
        const panel q = {.body = &r->air, .side = at, .facing = FACING_IN, .u = &s.along[u], .v = &s.along[v],
                         .openings = s.openings[at], .opening_count = s.counts[at]};
        obj_material(w, r->materials[at]);
        obj_panel(w, &q);
        for (uint32_t i = 0; i < s.counts[at]; ++i) {
            if (s.ways[at][i] % 2) continue; // its first room has the frame
            obj_material(w, r->frame);
            obj_reveal(w, &q, i, plan_hole_at(p, s.ways[at][i] / 2)->depth);
        }
    }
}
