// A house: its plan, facade, roof and stairs. See generate_house.h.
// SPDX-License-Identifier: MIT
// Invariant: openings along one axis are equal or apart, in all rooms of a house, so that no cut runs through another's rim.
#include "generate_house.h"

enum { TOP = 610, LOW_TOP = 330, FOOT = -30, OUT = 255, FLOOR = 20, UPPER = 320, RISE = 20 };

typedef enum room_use { USE_ALL, USE_TALL, USE_CELLAR, USE_NO_CELLAR, USE_LOW } room_use;
typedef struct room_row {
    const char *kind;
    room_use use;
    int16_t air[6], zone[6]; // x, y, z from; x, y, z to
    uint8_t look;
} room_row;

enum { R_LIVING, R_DINING, R_HALL, R_STAIR, R_STUDY, R_KITCHEN, R_WIDE_KITCHEN, R_BEDROOM, R_BATH, R_LANDING, R_NURSERY, R_GUEST,
       R_CELLAR_STAIR, R_PASSAGE, R_WINE, R_COAL, R_STORE, R_VAULT, R_CRYPT, R_LARDER, R_MACHINES, R_LIFT, R_DEEP, R_PANTRY, ROOM_ROWS };
enum { LOOK_ROOM, LOOK_TILES, LOOK_STAIR, LOOK_ROCK, LOOK_BRICK, LOOK_SANDSTONE, LOOK_CONCRETE, LOOKS };

static const room_row rooms[ROOM_ROWS] = {
    {"living", USE_ALL, {30, 20, -490, 490, 290, -30}, {15, 10, -500, 500, 305, -15}, LOOK_ROOM},
    {"dining", USE_ALL, {30, 20, -970, 490, 290, -510}, {15, 10, -985, 500, 305, -500}, LOOK_ROOM},
    {"hall", USE_ALL, {510, 20, -490, 790, 290, -30}, {500, 10, -500, 800, 305, -15}, LOOK_ROOM},
    {"stair", USE_TALL, {510, 20, -970, 790, 580, -510}, {500, 10, -985, 800, 595, -500}, LOOK_STAIR},
    {"study", USE_ALL, {810, 20, -490, 1270, 290, -30}, {800, 10, -500, 1285, 305, -15}, LOOK_ROOM},
    {"kitchen", USE_CELLAR, {1010, 20, -970, 1270, 290, -510}, {1000, 10, -985, 1285, 305, -500}, LOOK_TILES},
    {"kitchen", USE_NO_CELLAR, {810, 20, -970, 1270, 290, -510}, {800, 10, -985, 1285, 305, -500}, LOOK_TILES},
    {"bedroom", USE_TALL, {30, 320, -490, 490, 580, -30}, {15, 305, -500, 500, 595, -15}, LOOK_ROOM},
    {"bath", USE_TALL, {30, 320, -970, 490, 580, -510}, {15, 305, -985, 500, 595, -500}, LOOK_TILES},
    {"landing", USE_TALL, {510, 320, -490, 790, 580, -30}, {500, 305, -500, 800, 595, -15}, LOOK_ROOM},
    {"nursery", USE_TALL, {810, 320, -490, 1270, 580, -30}, {800, 305, -500, 1285, 595, -15}, LOOK_ROOM},
    {"guest", USE_TALL, {810, 320, -970, 1270, 580, -510}, {800, 305, -985, 1285, 595, -500}, LOOK_ROOM},
    {"cellar_stair", USE_CELLAR, {810, -300, -970, 990, 290, -510}, {800, -320, -985, 1000, 305, -500}, LOOK_BRICK},
    {"passage", USE_CELLAR, {30, -300, -970, 770, -60, -850}, {15, -320, -985, 800, -40, -835}, LOOK_BRICK},
    {"wine", USE_CELLAR, {30, -300, -820, 270, -60, -540}, {15, -320, -835, 285, -40, -525}, LOOK_ROCK},
    {"coal", USE_CELLAR, {300, -300, -820, 520, -60, -540}, {285, -320, -835, 535, -40, -525}, LOOK_ROCK},
    {"store", USE_CELLAR, {550, -300, -820, 770, -60, -540}, {535, -320, -835, 800, -40, -525}, LOOK_BRICK},
    {"vault", USE_CELLAR, {30, -300, -510, 770, -60, -390}, {15, -320, -525, 800, -40, -375}, LOOK_SANDSTONE},
    {"crypt", USE_CELLAR, {30, -300, -360, 380, -60, -30}, {15, -320, -375, 395, -40, -15}, LOOK_SANDSTONE},
    {"larder", USE_CELLAR, {410, -300, -360, 770, -60, -30}, {395, -320, -375, 800, -40, -15}, LOOK_BRICK},
    {"machines", USE_CELLAR, {810, -300, -480, 1270, -60, -30}, {800, -320, -500, 1285, -40, -15}, LOOK_CONCRETE},
    {"lift", USE_CELLAR, {1030, -640, -760, 1230, -60, -560}, {1010, -660, -780, 1250, -40, -500}, LOOK_CONCRETE},
    {"deep", USE_CELLAR, {400, -640, -760, 950, -400, -560}, {380, -660, -780, 1010, -380, -540}, LOOK_ROCK},
    {"pantry", USE_LOW, {510, 20, -970, 790, 290, -510}, {500, 10, -985, 800, 305, -500}, LOOK_TILES},
};

typedef enum hole_kind { HOLE_GAP, HOLE_DOOR, HOLE_SHUT, HOLE_FRONT, HOLE_WINDOW, HOLE_BARE } hole_kind; // BARE: a window without bars
typedef struct hole_row {
    uint8_t from, to;
    uint8_t side;
    int16_t plane, depth, u0, u1, v0, v1;
    int16_t slide;
    uint8_t kind;
} hole_row;

// Inner doors: from, to, side, plane, depth, along, height, slide, kind. Behind them the windows.
static const hole_row holes[] = {
    {R_HALL, OUT, SIDE_MAX_Z, -15, 30, 680, 770, 20, 230, 92, HOLE_FRONT},
    {R_HALL, R_LIVING, SIDE_MIN_X, 500, 20, -310, -220, 20, 230, -92, HOLE_DOOR},
    {R_HALL, R_STUDY, SIDE_MAX_X, 800, 20, -310, -220, 20, 230, -92, HOLE_DOOR},
    {R_HALL, R_STAIR, SIDE_MIN_Z, -500, 20, 530, 620, 20, 230, -92, HOLE_GAP},
    {R_HALL, R_PANTRY, SIDE_MIN_Z, -500, 20, 530, 620, 20, 230, -92, HOLE_DOOR},
    {R_LIVING, R_DINING, SIDE_MIN_Z, -500, 20, 210, 300, 20, 230, 92, HOLE_GAP},
    {R_STUDY, R_KITCHEN, SIDE_MIN_Z, -500, 20, 1020, 1110, 20, 230, 92, HOLE_SHUT},
    {R_STUDY, R_WIDE_KITCHEN, SIDE_MIN_Z, -500, 20, 1020, 1110, 20, 230, 92, HOLE_DOOR},
    {R_STUDY, R_CELLAR_STAIR, SIDE_MIN_Z, -500, 20, 890, 980, 20, 230, -92, HOLE_DOOR},
    {R_LANDING, R_BEDROOM, SIDE_MIN_X, 500, 20, -310, -220, 320, 530, -92, HOLE_DOOR},
    {R_LANDING, R_NURSERY, SIDE_MAX_X, 800, 20, -310, -220, 320, 530, -92, HOLE_SHUT},
    {R_LANDING, R_STAIR, SIDE_MIN_Z, -500, 20, 680, 770, 320, 530, 92, HOLE_GAP},
    {R_BEDROOM, R_BATH, SIDE_MIN_Z, -500, 20, 210, 300, 320, 530, 92, HOLE_DOOR},
    {R_NURSERY, R_GUEST, SIDE_MIN_Z, -500, 20, 1020, 1110, 320, 530, 92, HOLE_DOOR},
    {R_PASSAGE, R_CELLAR_STAIR, SIDE_MAX_X, 800, 40, -960, -870, -300, -90, 92, HOLE_GAP},
    {R_PASSAGE, R_WINE, SIDE_MAX_Z, -835, 30, 110, 200, -300, -90, 92, HOLE_DOOR},
    {R_PASSAGE, R_COAL, SIDE_MAX_Z, -835, 30, 370, 460, -300, -90, -92, HOLE_SHUT},
    {R_PASSAGE, R_STORE, SIDE_MAX_Z, -835, 30, 620, 710, -300, -90, -92, HOLE_DOOR},
    {R_WINE, R_VAULT, SIDE_MAX_Z, -525, 30, 110, 200, -300, -90, 92, HOLE_GAP},
    {R_STORE, R_VAULT, SIDE_MAX_Z, -525, 30, 620, 710, -300, -90, -92, HOLE_GAP},
    {R_VAULT, R_CRYPT, SIDE_MAX_Z, -375, 30, 110, 200, -300, -90, 92, HOLE_GAP},
    {R_VAULT, R_LARDER, SIDE_MAX_Z, -375, 30, 620, 710, -300, -90, -92, HOLE_DOOR},
    {R_VAULT, R_MACHINES, SIDE_MAX_X, 800, 40, -470, -400, -300, -90, 92, HOLE_GAP},
    {R_MACHINES, R_LIFT, SIDE_MIN_Z, -500, 80, 1080, 1180, -300, -90, 92, HOLE_GAP},
    {R_LIFT, R_DEEP, SIDE_MIN_X, 1010, 80, -710, -610, -640, -430, 92, HOLE_GAP},
    {R_LIVING, OUT, SIDE_MAX_Z, -15, 30, 80, 180, 110, 230, 0, HOLE_WINDOW},
    {R_LIVING, OUT, SIDE_MAX_Z, -15, 30, 320, 420, 110, 230, 0, HOLE_WINDOW},
    {R_LIVING, OUT, SIDE_MIN_X, 15, 30, -310, -220, 110, 230, 0, HOLE_WINDOW},
    {R_DINING, OUT, SIDE_MIN_Z, -985, 30, 80, 180, 110, 230, 0, HOLE_WINDOW},
    {R_DINING, OUT, SIDE_MIN_Z, -985, 30, 320, 420, 110, 230, 0, HOLE_WINDOW},
    {R_DINING, OUT, SIDE_MIN_X, 15, 30, -800, -710, 110, 230, 0, HOLE_WINDOW},
    {R_STUDY, OUT, SIDE_MAX_Z, -15, 30, 890, 980, 110, 230, 0, HOLE_WINDOW},
    {R_STUDY, OUT, SIDE_MAX_Z, -15, 30, 1140, 1230, 110, 230, 0, HOLE_WINDOW},
    {R_STUDY, OUT, SIDE_MAX_X, 1285, 30, -310, -220, 110, 230, 0, HOLE_WINDOW},
    {R_KITCHEN, OUT, SIDE_MIN_Z, -985, 30, 1140, 1230, 110, 230, 0, HOLE_WINDOW},
    {R_KITCHEN, OUT, SIDE_MAX_X, 1285, 30, -800, -710, 110, 230, 0, HOLE_WINDOW},
    {R_WIDE_KITCHEN, OUT, SIDE_MIN_Z, -985, 30, 890, 980, 110, 230, 0, HOLE_WINDOW},
    {R_WIDE_KITCHEN, OUT, SIDE_MIN_Z, -985, 30, 1140, 1230, 110, 230, 0, HOLE_WINDOW},
    {R_WIDE_KITCHEN, OUT, SIDE_MAX_X, 1285, 30, -800, -710, 110, 230, 0, HOLE_WINDOW},
    {R_PANTRY, OUT, SIDE_MIN_Z, -985, 30, 680, 770, 110, 230, 0, HOLE_WINDOW},
    {R_STAIR, OUT, SIDE_MIN_Z, -985, 30, 680, 770, 410, 530, 0, HOLE_WINDOW},
    {R_BEDROOM, OUT, SIDE_MAX_Z, -15, 30, 80, 180, 410, 530, 0, HOLE_WINDOW},
    {R_BEDROOM, OUT, SIDE_MAX_Z, -15, 30, 320, 420, 410, 530, 0, HOLE_BARE},
    {R_BEDROOM, OUT, SIDE_MIN_X, 15, 30, -310, -220, 410, 530, 0, HOLE_WINDOW},
    {R_BATH, OUT, SIDE_MIN_Z, -985, 30, 320, 420, 410, 530, 0, HOLE_WINDOW},
    {R_LANDING, OUT, SIDE_MAX_Z, -15, 30, 680, 770, 410, 530, 0, HOLE_WINDOW},
    {R_NURSERY, OUT, SIDE_MAX_Z, -15, 30, 890, 980, 410, 530, 0, HOLE_WINDOW},
    {R_NURSERY, OUT, SIDE_MAX_Z, -15, 30, 1140, 1230, 410, 530, 0, HOLE_WINDOW},
    {R_NURSERY, OUT, SIDE_MAX_X, 1285, 30, -310, -220, 410, 530, 0, HOLE_WINDOW},
    {R_GUEST, OUT, SIDE_MIN_Z, -985, 30, 890, 980, 410, 530, 0, HOLE_WINDOW},
    {R_GUEST, OUT, SIDE_MIN_Z, -985, 30, 1140, 1230, 410, 530, 0, HOLE_WINDOW},
    {R_GUEST, OUT, SIDE_MAX_X, 1285, 30, -800, -710, 410, 530, 0, HOLE_WINDOW},
};
enum { HOLE_ROWS = (int)(sizeof holes / sizeof *holes) };

// ---- From local to world ----

static int32_t world_z(const house_site *h, int32_t z)
{
    return CENTIMETRE * (h->is_mirrored ? h->z - z : h->z + z);
}

place house_place(const house_site *h, local_place p)
{
    return (place){CENTIMETRE * (h->x + p.x), CENTIMETRE * p.y, world_z(h, p.z)};
}

block house_block(const house_site *h, local_place a, local_place b)
{
    block out = {house_place(h, a), house_place(h, b)};
    if (h->is_mirrored) {
        const int32_t kept = out.min.z;
        out.min.z = out.max.z;
        out.max.z = kept;
    }
    return out;
}

spot house_spot(const house_site *h, local_place p)
{
    const place at = house_place(h, p);
    return (spot){(double)at.x / METRE, (double)at.y / METRE, (double)at.z / METRE};
}

static side house_side(const house_site *h, side s)
{
    return h->is_mirrored && (s == SIDE_MIN_Z || s == SIDE_MAX_Z) ? plan_opposite(s) : s;
}

block house_footprint(const house_site *h)
{
    const int32_t in = HOUSE_FRONT_WALL / 2;
    return house_block(h, (local_place){in, 0, in - HOUSE_DEEP}, (local_place){HOUSE_WIDE - in, 0, -in});
}

// ---- The plan ----

static int is_used(const house_site *h, uint32_t row)
{
    switch (rooms[row].use) {
    case USE_TALL: return h->storeys == HOUSE_TALL;
    case USE_LOW: return h->storeys == HOUSE_LOW;
    case USE_CELLAR: return h->cellar == HOUSE_CELLAR;
    case USE_NO_CELLAR: return h->cellar == HOUSE_NO_CELLAR;
    default: return 1;
    }
}

uint32_t house_room_count(const house_site *h)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < ROOM_ROWS; ++i) count += (uint32_t)is_used(h, i);
    return count;
}

static block box_of(const house_site *h, const int16_t b[6])
{
    return house_block(h, (local_place){b[0], b[1], b[2]}, (local_place){b[3], b[4], b[5]});
}

// Zones end, and portals lie, on eighths of a metre, which rounding to a scene's step leaves alone: no plane is half way
// between two eighths.
static int32_t eighth(int32_t at)
{
    enum { EIGHTH = METRE / 8, FAR = 1000 * METRE };
    return (at + FAR + EIGHTH / 2) / EIGHTH * EIGHTH - FAR;
}

static block zone_of(const house_site *h, const int16_t b[6])
{
    const block z = box_of(h, b);
    return (block){.min = {eighth(z.min.x), eighth(z.min.y), eighth(z.min.z)}, .max = {eighth(z.max.x), eighth(z.max.y), eighth(z.max.z)}};
}

// Heights at which all walls of a house are cut.
static const cuts heights = {.at = {FLOOR * CENTIMETRE, 110 * CENTIMETRE, 230 * CENTIMETRE, UPPER * CENTIMETRE, 410 * CENTIMETRE, 530 * CENTIMETRE},
                             .count = 6};

// Rooms of few walls and next to no furniture have nothing that a tree of walls could find.
static const char *room_chain(uint32_t row)
{
    return row == R_BATH || row == R_LANDING || row == R_PANTRY || row == R_LIFT ? "frustum+portal" : "bsp+portal";
}

static const char *drawn_chain(random_stream *r)
{
    static const char *const chains[4] = {"frustum", "none", "brute", NULL};
    return chains[random_below(r, 4)];
}

static void rooms_add(const house_site *h, plan *p, uint32_t numbers[ROOM_ROWS], random_stream *r)
{
    static const char *const looks[LOOKS][PLAN_SIDES] = {
        {"wall_cream", "wall_cream", "floor_wood", "ceiling", "wall_cream", "wall_cream"},
        {"wall_tiles_7", "wall_tiles_7", "floor_tiles", "ceiling", "wall_tiles_7", "wall_tiles_7"},
        {"wall_stair", "wall_stair", "floor_wood", "ceiling", "wall_stair", "wall_stair"},
        {"rock_vault", "rock_vault", "floor_stone", "rock_vault", "rock_vault", "rock_vault"},
        {"brick_9", "brick_9", "floor_stone", "ceiling", "brick_9", "brick_9"},
        {"sandstone", "sandstone", "floor_stone", "sandstone", "sandstone", "sandstone"},
        {"concrete", "concrete", "metal_floor", "concrete", "concrete", "concrete"}};
    for (uint32_t i = 0; i < ROOM_ROWS; ++i) {
        if (!is_used(h, i)) continue;
        numbers[i] = plan_add_room(p, &(plan_room){.kind = rooms[i].kind, .number = h->number, .air = box_of(h, rooms[i].air),
                                                   .zone = zone_of(h, rooms[i].zone), .materials = looks[rooms[i].look], .frame = "frame_stone",
                                                   .chain = h->chains == HOUSE_CHAINS_DRAWN ? drawn_chain(r) : room_chain(i), .heights = &heights});
    }
}

static plan_door door_of(const house_site *h, const hole_row *row)
{
    switch ((hole_kind)row->kind) {
    case HOLE_DOOR: return PLAN_DOOR_OPEN;
    case HOLE_SHUT: return PLAN_DOOR_SHUT;
    case HOLE_FRONT: return h->front_door == HOUSE_DOOR_OPEN ? PLAN_DOOR_OPEN : PLAN_DOOR_SHUT;
    default: return PLAN_GAP;
    }
}

static plan_hole hole_of(const house_site *h, const hole_row *row)
{
    const int on_x = row->side == SIDE_MIN_X || row->side == SIDE_MAX_X;
    const local_place a = on_x ? (local_place){row->plane, row->v0, row->u0} : (local_place){row->u0, row->v0, row->plane};
    const local_place b = on_x ? (local_place){row->plane, row->v1, row->u1} : (local_place){row->u1, row->v1, row->plane};
    const block box = house_block(h, a, b);
    return (plan_hole){.side = house_side(h, (side)row->side),
                       .opening = {on_x ? box.min.z : box.min.x, box.min.y, on_x ? box.max.z : box.max.x, box.max.y},
                       .plane = eighth(on_x ? box.min.x : box.min.z),
                       .depth = row->depth * CENTIMETRE,
                       .slide = row->slide * CENTIMETRE * (on_x && h->is_mirrored ? -1 : 1),
                       .door = door_of(h, row),
                       .leaf = row->kind == HOLE_FRONT ? "front_door_3" : "door_wood"};
}

void house_plan(const house_site *h, plan *p, random_stream *r)
{
    uint32_t numbers[ROOM_ROWS] = {0};
    rooms_add(h, p, numbers, r);
    for (int i = 0; i < HOLE_ROWS; ++i) {
        const hole_row *row = &holes[i];
        if (!is_used(h, row->from) || (row->to != OUT && !is_used(h, row->to))) continue;
        plan_hole hole = hole_of(h, row);
        hole.rooms[0] = numbers[row->from];
        hole.rooms[1] = row->to == OUT ? PLAN_OUTSIDE : numbers[row->to];
        plan_add_hole(p, &hole);
    }
    p->has_outside = 1;
}

// ---- The house from outside ----

static int is_facade_of(const house_site *h, const plan *p, const plan_hole *hole, side s)
{
    return hole->rooms[1] == PLAN_OUTSIDE && hole->side == s && plan_room_at(p, hole->rooms[0])->number == h->number;
}

static void facade_write(const house_site *h, obj_writer *w, const plan *p)
{
    enum { OPENINGS = 24 };
    const block body = house_block(h, (local_place){0, FOOT, -HOUSE_DEEP}, (local_place){HOUSE_WIDE, h->storeys == HOUSE_TALL ? TOP : LOW_TOP, 0});
    cuts x = {0}, y = {0}, z = {0};
    cuts_add(&x, body.min.x);
    cuts_add(&x, body.max.x);
    cuts_add(&z, body.min.z);
    cuts_add(&z, body.max.z);
    cuts_add(&y, body.min.y);
    cuts_add(&y, body.max.y);
    for (uint32_t i = 0; i < heights.count; ++i)
        if (heights.at[i] < body.max.y) cuts_add(&y, heights.at[i]);
    for (uint32_t i = 0; i < plan_hole_count(p); ++i)
        for (side s = SIDE_MIN_X; s <= SIDE_MAX_Z; ++s) {
            const plan_hole *hole = plan_hole_at(p, i);
            if (!is_facade_of(h, p, hole, s)) continue;
            cuts *along = s == SIDE_MIN_X || s == SIDE_MAX_X ? &z : &x;
            cuts_add(along, hole->opening.u0);
            cuts_add(along, hole->opening.u1);
        }
    for (side s = SIDE_MIN_X; s <= SIDE_MAX_Z; ++s) {
        if (s == SIDE_MIN_Y) continue; // stands in the ground
        rectangle openings[OPENINGS];
        const int on_x = s == SIDE_MIN_X || s == SIDE_MAX_X;
        panel q = {.body = &body, .side = s, .facing = FACING_OUT, .u = on_x ? &z : &x, .v = s == SIDE_MAX_Y ? &z : &y, .openings = openings};
        for (uint32_t i = 0; i < plan_hole_count(p) && q.opening_count < OPENINGS; ++i)
            if (is_facade_of(h, p, plan_hole_at(p, i), s)) openings[q.opening_count++] = plan_hole_at(p, i)->opening;
        obj_material(w, s == SIDE_MAX_Y ? "roof_felt" : h->facade);
        obj_panel(w, &q);
    }
}

static void roof_write(const house_site *h, obj_writer *w)
{
    const int32_t y = (h->storeys == HOUSE_TALL ? TOP : LOW_TOP) - 5, over = 45, thick = 18; // a little into the walls: no slit
    const int32_t ridge = y + (h->storeys == HOUSE_TALL ? 330 : 240), middle = -HOUSE_DEEP / 2;
    // one solid: eaves, ridge, and a flat bottom
    const int32_t back = -HOUSE_DEEP - over;
    const local_place outline[5] = {{0, y, over}, {0, y + thick, over}, {0, ridge, middle}, {0, y + thick, back}, {0, y, back}};
    place p[2][5];
    for (int i = 0; i < 2; ++i)
        for (int k = 0; k < 5; ++k) {
            const int to = h->is_mirrored ? 4 - k : k; // the turn stays the same
            p[i][to] = house_place(h, (local_place){i ? HOUSE_WIDE + 30 : -30, outline[k].y, outline[k].z});
        }
    obj_material(w, h->roof);
    for (int k = 0; k < 5; ++k) {
        const int next = (k + 1) % 5;
        const place quad[4] = {p[0][k], p[1][k], p[1][next], p[0][next]};
        obj_polygon(w, quad, 4);
    }
    obj_material(w, h->facade);
    const place west[5] = {p[0][0], p[0][1], p[0][2], p[0][3], p[0][4]}, east[5] = {p[1][4], p[1][3], p[1][2], p[1][1], p[1][0]};
    obj_polygon(w, west, 5);
    obj_polygon(w, east, 5);
    obj_material(w, "brick");
    const block chimney = house_block(h, (local_place){950, y + 60, -380}, (local_place){1020, ridge + 90, -310});
    obj_block(w, &chimney);
}

static void porch_write(const house_site *h, obj_writer *w)
{
    const block step = house_block(h, (local_place){650, -10, 1}, (local_place){800, 18, 50});
    const block canopy = house_block(h, (local_place){640, 250, 1}, (local_place){810, 258, 90});
    obj_material(w, "step_stone");
    obj_block(w, &step);
    obj_material(w, h->roof);
    obj_block(w, &canopy);
}

// ---- Stairs: neighbouring steps are parts of two objects, so that each object is a surface everywhere ----

typedef struct flight { const house_site *house; obj_writer *writer; int32_t parity, next; } flight;

// A step goes into what it stands by, every second one deeper: no two faces coincide, which no depth could order.
static void step_write(flight *f, local_place a, local_place b)
{
    const int32_t sunk = 1 + f->next % 2;
    const block step = house_block(f->house, (local_place){a.x - sunk, a.y - sunk, a.z - sunk}, (local_place){b.x + sunk, b.y, b.z + sunk});
    if (f->next++ % 2 == f->parity) obj_block(f->writer, &step);
}

// Up along the west wall to a landing at half height, and back along a spine wall.
static void stair_write(flight *f)
{
    enum { FIRST_STEPS = 7, SECOND_STEPS = 8, TREAD = 30, TURN = -800, FIRST = -620 };
    for (int32_t i = 0; i + 1 < FIRST_STEPS; ++i)
        step_write(f, (local_place){510, FLOOR, FIRST - TREAD * (i + 1)}, (local_place){640, FLOOR + RISE * (i + 1), FIRST - TREAD * i});
    const int32_t half = FLOOR + FIRST_STEPS * RISE;
    step_write(f, (local_place){510, FLOOR, -970}, (local_place){790, half, TURN});
    for (int32_t i = 0; i < SECOND_STEPS; ++i) {
        const int32_t from = TURN + TREAD * i, to = i + 1 == SECOND_STEPS ? -510 : from + TREAD;
        step_write(f, (local_place){660, FLOOR, from}, (local_place){790, half + RISE * (i + 1), to});
    }
}

static void cellar_stair_write(flight *f)
{
    enum { STEPS = 15, TREAD = 19, TOP_STEP = -580, DOWN = -300 };
    step_write(f, (local_place){810, DOWN, TOP_STEP}, (local_place){990, FLOOR, -510});
    for (int32_t i = 0; i < STEPS; ++i)
        step_write(f, (local_place){810, DOWN, TOP_STEP - TREAD * (i + 1)}, (local_place){990, -RISE * i, TOP_STEP - TREAD * i});
}

static void stairs_write(const house_site *h, obj_writer *w)
{
    for (int32_t parity = 0; parity < 2; ++parity) {
        flight up = {h, w, parity, 0}, down = {h, w, parity, 0};
        obj_numbered_object(w, parity ? "stairs_odd" : "stairs", h->number);
        obj_material(w, "stair_wood");
        if (h->storeys == HOUSE_TALL) stair_write(&up);
        obj_material(w, "stair_stone");
        if (h->cellar == HOUSE_CELLAR) cellar_stair_write(&down);
    }
    if (h->storeys != HOUSE_TALL) return;
    const block spine = house_block(h, (local_place){640, FLOOR, -800}, (local_place){660, 410, -510});
    obj_numbered_object(w, "spine", h->number);
    obj_material(w, "wall_stair");
    obj_block(w, &spine);
}

// A bar upright and one across in every window, on the portal's plane.
static void sashes_write(const house_site *h, obj_writer *w, plan *p)
{
    const int32_t half = 2 * CENTIMETRE, inner = 15 * CENTIMETRE / 10; // the one across is thinner: no two faces coincide
    for (int i = 0; i < HOLE_ROWS; ++i) {
        if (holes[i].kind != HOLE_WINDOW || !is_used(h, holes[i].from)) continue;
        const plan_hole q = hole_of(h, &holes[i]);
        const rectangle o = q.opening;
        const int32_t u = (o.u0 + o.u1) / 2, v = (o.v0 + 2 * o.v1) / 3;
        plan_hole near = q, far = q;
        near.plane -= half;
        far.plane += half;
        const block upright = {plan_hole_place(&near, u - half, o.v0), plan_hole_place(&far, u + half, o.v1)};
        near.plane += half - inner;
        far.plane -= half - inner;
        const block across = {plan_hole_place(&near, o.u0, v - inner), plan_hole_place(&far, o.u1, v + inner)};
        obj_numbered_object(w, "sash", h->number);
        obj_material(w, "sash_light");
        obj_block(w, &upright);
        obj_block(w, &across);
        plan_add_obstacle(p, &upright);
        plan_add_obstacle(p, &across);
    }
}

void house_write(const house_site *h, obj_writer *w, plan *p, uint32_t first_room, uint32_t room_count)
{
    obj_numbered_object(w, "house", h->number);
    facade_write(h, w, p);
    obj_numbered_object(w, "roof", h->number);
    roof_write(h, w);
    porch_write(h, w);
    for (uint32_t i = first_room; i < first_room + room_count; ++i) {
        obj_numbered_object(w, plan_room_at(p, i)->kind, h->number);
        plan_write_room(w, p, i);
    }
    stairs_write(h, w);
    sashes_write(h, w, p);
}
