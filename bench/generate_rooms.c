// rooms: a grid of furnished rooms joined by doorways, closed against the outside, written as one .obj object a room.
// SPDX-License-Identifier: MIT
// Invariant: all surfaces together are one closed surface without T-junctions whose seen side is the air.
#include "generate_zoned.h"

enum {
    ROOM = 8 * METRE,   // side of a room
    HEIGHT = 3 * METRE,
    WALL = METRE / 4,
    STEP = ROOM + WALL, // from room to room
    DOOR_WIDE = METRE,
    DOOR_HIGH = 21 * METRE / 10,
    DOOR_PLACES = 3,    // discrete, so that a cut for one doorway never runs through another
    CELLS = 3,          // furniture stands in a 3 x 3 raster
    CELL = 19 * METRE / 10,
    FEET = 2 * CENTIMETRE, // furniture stands on feet too small to draw, so that no two faces coincide
    ROOM_KEY = 0x726f6f6d,
};

typedef struct room_plan {
    uint64_t seed;
    uint32_t rooms, columns;
} room_plan;

// Where the doorway between a room and its neighbour to the east (x) or south (z) starts; -1: solid wall.
typedef enum way { WAY_EAST, WAY_SOUTH } way;

static uint32_t column_of(const room_plan *p, uint32_t room)
{
    return room % p->columns;
}

// Does `room` owe its doorway to the room before it in this direction? Each room but the first owes one such, so that
// all can be reached.
static int is_kept_open(const room_plan *p, uint32_t room, way w)
{
    const int has_west = column_of(p, room) > 0, has_north = room >= p->columns;
    random_stream r = random_make(p->seed ^ ROOM_KEY, (uint64_t)room * 4 + 2);
    const int west = has_west && (!has_north || random_below(&r, 2));
    return w == WAY_EAST ? west : has_north && !west;
}

static int32_t doorway(const room_plan *p, uint32_t room, way w)
{
    const uint32_t other = room + (w == WAY_EAST ? 1 : p->columns);
    if (other >= p->rooms || (w == WAY_EAST && column_of(p, other) == 0)) return -1;
    random_stream r = random_make(p->seed ^ ROOM_KEY, (uint64_t)room * 4 + w);
    const int32_t at = METRE + (int32_t)random_below(&r, DOOR_PLACES) * (5 * METRE / 2);
    return random_below(&r, 4) < 3 || is_kept_open(p, other, w) ? at : -1;
}

typedef struct room_shell {
    block body;
    cuts u[2], height; // along x, along z
    rectangle doors[6]; // by side; u1 <= u0: none
} room_shell;

static void door_put(room_shell *s, side at, int32_t from)
{
    const int along_z = at == SIDE_MIN_X || at == SIDE_MAX_X;
    if (from < 0) return;
    from += along_z ? s->body.min.z : s->body.min.x;
    s->doors[at] = (rectangle){from, 0, from + DOOR_WIDE, DOOR_HIGH};
    cuts_add(&s->u[along_z], from);
    cuts_add(&s->u[along_z], from + DOOR_WIDE);
}

static room_shell shell_of(const room_plan *p, uint32_t room)
{
    const uint32_t column = column_of(p, room), row = room / p->columns;
    const int32_t x = (int32_t)column * STEP, z = (int32_t)row * STEP;
    room_shell s = {.body = {.min = {x, 0, z}, .max = {x + ROOM, HEIGHT, z + ROOM}}};
    cuts_add(&s.u[0], x);
    cuts_add(&s.u[0], x + ROOM);
    cuts_add(&s.u[1], z);
    cuts_add(&s.u[1], z + ROOM);
    cuts_add(&s.height, 0);
    cuts_add(&s.height, DOOR_HIGH);
    cuts_add(&s.height, HEIGHT);
    door_put(&s, SIDE_MAX_X, doorway(p, room, WAY_EAST));
    door_put(&s, SIDE_MAX_Z, doorway(p, room, WAY_SOUTH));
    if (column > 0) door_put(&s, SIDE_MIN_X, doorway(p, room - 1, WAY_EAST));
    if (row > 0) door_put(&s, SIDE_MIN_Z, doorway(p, room - p->columns, WAY_SOUTH));
    return s;
}

static void shell_write(obj_writer *w, const room_shell *s)
{
    static const char *const materials[6] = {"wall", "wall", "floor", "ceiling", "wall", "wall"};
    for (side at = SIDE_MIN_X; at <= SIDE_MAX_Z; ++at) {
        const int along_z = at == SIDE_MIN_X || at == SIDE_MAX_X, flat = at == SIDE_MIN_Y || at == SIDE_MAX_Y;
        const rectangle *door = &s->doors[at];
        const panel p = {.body = &s->body, .side = at, .facing = FACING_IN, .u = &s->u[along_z], .v = flat ? &s->u[1] : &s->height,
                         .openings = door, .opening_count = door->u1 > door->u0};
        obj_material(w, materials[at]);
        obj_panel(w, &p);
        if (!p.opening_count || at == SIDE_MIN_X || at == SIDE_MIN_Z) continue; // the neighbour has this doorway's frame
        obj_material(w, "doorframe");
        obj_reveal(w, &p, 0, WALL);
    }
}

static void furniture_write(obj_writer *w, const room_plan *p, uint32_t room, const block *body)
{
    random_stream r = random_make(p->seed ^ ROOM_KEY, (uint64_t)room * 4 + 3);
    obj_material(w, "furniture");
    for (int32_t cell = 0; cell < CELLS * CELLS; ++cell) {
        if (cell == CELLS * CELLS / 2 || random_below(&r, 5) < 2) continue; // the middle is for walking
        const int32_t wide = random_between(&r, 40, 160) * CENTIMETRE, deep = random_between(&r, 40, 160) * CENTIMETRE;
        const int32_t high = random_between(&r, 40, 200) * CENTIMETRE;
        const int32_t x = body->min.x + 11 * METRE / 10 + cell % CELLS * CELL + random_between(&r, 0, (CELL - wide) / CENTIMETRE) * CENTIMETRE;
        const int32_t z = body->min.z + 11 * METRE / 10 + cell / CELLS * CELL + random_between(&r, 0, (CELL - deep) / CENTIMETRE) * CENTIMETRE;
        obj_block(w, &(block){.min = {x, FEET, z}, .max = {x + wide, high, z + deep}});
    }
}

static room_plan plan_of(uint64_t rooms, uint64_t seed)
{
    room_plan p = {.seed = seed, .rooms = (uint32_t)rooms, .columns = 1};
    while ((uint64_t)p.columns * p.columns < rooms) p.columns++;
    return p;
}

void generate_rooms(uint64_t rooms, uint64_t seed, const allocator *memory, text_file *out)
{
    const room_plan p = plan_of(rooms, seed);
    obj_writer w = obj_open(out, memory);
    for (uint32_t room = 0; room < p.rooms && !out->failed; ++room) {
        const room_shell s = shell_of(&p, room);
        obj_numbered_object(&w, "room", room);
        shell_write(&w, &s);
        furniture_write(&w, &p, room, &s.body);
    }
    obj_close(&w);
}

// ---- Zones ----

// Its leaf slides along the wall, away from the nearer corner.
static void doorway_add(plan *out, const room_plan *p, uint32_t room, way w, random_stream *r)
{
    const int32_t from = doorway(p, room, w), x = (int32_t)column_of(p, room) * STEP, z = (int32_t)(room / p->columns) * STEP;
    if (from < 0) return;
    const int32_t start = from + (w == WAY_EAST ? z : x);
    const plan_hole h = {
        .rooms = {room, room + (w == WAY_EAST ? 1 : p->columns)},
        .side = w == WAY_EAST ? SIDE_MAX_X : SIDE_MAX_Z,
        .opening = {start, 0, start + DOOR_WIDE, DOOR_HIGH},
        .plane = (w == WAY_EAST ? x : z) + ROOM + WALL / 2,
        .depth = WALL,
        .slide = (from > METRE ? -1 : 1) * (DOOR_WIDE + 2 * CENTIMETRE),
        .door = random_below(r, 3) ? PLAN_GAP : PLAN_DOOR_OPEN,
        .leaf = "door_wood",
    };
    plan_add_hole(out, &h);
}

static void rooms_plan(const room_plan *p, plan *out)
{
    random_stream r = random_make(p->seed ^ ROOM_KEY, 1);
    for (uint32_t room = 0; room < p->rooms; ++room) {
        const int32_t x = (int32_t)column_of(p, room) * STEP, z = (int32_t)(room / p->columns) * STEP, half = WALL / 2;
        const block air = {.min = {x, 0, z}, .max = {x + ROOM, HEIGHT, z + ROOM}};
        const block zone = {.min = {x - half, -half, z - half}, .max = {x + ROOM + half, HEIGHT + half, z + ROOM + half}};
        plan_add_room(out, &(plan_room){.kind = "room", .number = room, .air = air, .zone = zone});
        doorway_add(out, p, room, WAY_EAST, &r);
        doorway_add(out, p, room, WAY_SOUTH, &r);
    }
    plan_index(out);
}

// ---- The walk: along the walls, where no furniture stands ----

enum { RING = 55 * CENTIMETRE, RING_SIDE = ROOM - 2 * RING, EYE = 165 * CENTIMETRE };

static place ring_place(const block *air, int32_t at)
{
    const int32_t corner = at / RING_SIDE % 4, rest = at % RING_SIDE;
    const int32_t x[4] = {rest, RING_SIDE, RING_SIDE - rest, 0}, z[4] = {0, rest, RING_SIDE, RING_SIDE - rest};
    return (place){air->min.x + RING + x[corner], EYE, air->min.z + RING + z[corner]};
}

static place hole_middle(const plan_hole *h)
{
    return plan_hole_place(h, (h->opening.u0 + h->opening.u1) / 2, EYE);
}

static int32_t ring_at(const plan *p, const block *air, uint32_t to)
{
    const plan_hole *h = plan_hole_at(p, to / 2);
    const place at = hole_middle(h);
    const int32_t x = at.x - air->min.x - RING, z = at.z - air->min.z - RING;
    switch (to % 2 ? plan_opposite(h->side) : h->side) {
    case SIDE_MIN_Z: return x;
    case SIDE_MAX_X: return RING_SIDE + z;
    case SIDE_MAX_Z: return 3 * RING_SIDE - x;
    default: return 4 * RING_SIDE - z;
    }
}

static void ring_walk(path_line *l, const plan *p, uint32_t room, uint32_t from, uint32_t to)
{
    const block *air = &plan_room_at(p, room)->air;
    const int32_t whole = 4 * RING_SIDE, start = from == PLAN_OUTSIDE ? 0 : ring_at(p, air, from);
    int32_t end = to == PLAN_OUTSIDE ? start : ring_at(p, air, to);
    if (from != PLAN_OUTSIDE) path_to(l, hole_middle(plan_hole_at(p, from / 2)));
    path_to(l, ring_place(air, start));
    if (from == to || end > start) end -= whole; // a room that is left as it was entered is gone round
    if (start - end > whole / 2 && from != to) {
        end += whole;
        for (int32_t at = (start / RING_SIDE + 1) * RING_SIDE; at < end; at += RING_SIDE) path_to(l, ring_place(air, at));
    } else {
        const int32_t turn = start + whole; // keeps what follows above 0
        for (int32_t at = (turn - 1) / RING_SIDE * RING_SIDE; at > end + whole; at -= RING_SIDE) path_to(l, ring_place(air, at));
        end += whole;
    }
    path_to(l, ring_place(air, end));
    if (to != PLAN_OUTSIDE) path_to(l, hole_middle(plan_hole_at(p, to / 2)));
}

void zoned_rooms(zoned_scene *z)
{
    enum { OVER_FURNITURE = 205 * CENTIMETRE, UNDER_CEILING = 275 * CENTIMETRE };
    const double walk_m = 125;
    const room_plan p = plan_of(z->size, z->seed);
    rooms_plan(&p, &z->plan);
    if (z->plan.failed) return;
    generate_rooms(z->size, z->seed, z->memory, &z->geometry);
    path_wander(&z->walk, &(wander_request){.plan = &z->plan, .route = ring_walk, .seed = z->seed, .length_m = walk_m});
    z->tour_low = OVER_FURNITURE;
    z->tour_high = UNDER_CEILING;
}
