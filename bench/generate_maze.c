// maze: rooms of many sizes and long corridors on two levels, a spanning tree of doorways with some loops, stair shafts.
// SPDX-License-Identifier: MIT
// Invariant: rooms fill the cells of each level in raster order, so each has an earlier neighbour and all can be reached;
// doorways stand in the middle of cells' sides, so no room's cut runs through another's doorway.
#include "generate_zoned.h"

#include <assert.h>

enum {
    CELL = 4 * METRE,
    HALF_WALL = METRE / 8,
    LEVEL = 4 * METRE,             // from floor to floor
    LEVELS = 2,
    FLOOR_HALF = METRE / 4,        // zones end so far under their floor
    DOOR_FROM = 15 * METRE / 10,   // in its cell side
    DOOR_WIDE = METRE,
    DOOR_HIGH = 21 * METRE / 10,
    CORRIDOR_INSET = 12 * METRE / 10,
    EYE = 165 * CENTIMETRE,
    SHAFT_CELLS = 3,               // landing, flight, landing
    SHAFT_PITCH = 12,              // cells from shaft to shaft
    STEPS = 16,
    NO_ROOM = -1,
    MAZE_KEY = 0x6d617a65,
};

typedef struct maze_room {
    uint32_t level, column, row, wide, deep; // cells
    int is_corridor, is_shaft;
} maze_room;

typedef struct maze_edge { uint32_t rooms[2], column, row, level; side side; uint64_t order; } maze_edge; // side of that cell: MAX_X or MAX_Z

typedef struct maze {
    zoned_scene *out;
    random_stream random;
    uint32_t columns, rows, rooms;
    int32_t *cells;  // LEVELS * rows * columns
    buffer list;     // maze_room
    buffer edges;    // maze_edge
    uint32_t *roots; // by room: a forest of what is joined already
} maze;

static const maze_room *room_at(const maze *m, uint32_t room)
{
    return &((const maze_room *)m->list.items)[room];
}

static int32_t *cell_at(const maze *m, uint32_t level, uint32_t column, uint32_t row)
{
    return &m->cells[((size_t)level * m->rows + row) * m->columns + column];
}

static int room_put(maze *m, const maze_room *r)
{
    for (uint32_t level = r->level; level < (r->is_shaft ? LEVELS : r->level + 1); ++level)
        for (uint32_t z = 0; z < r->deep; ++z)
            for (uint32_t x = 0; x < r->wide; ++x) *cell_at(m, level, r->column + x, r->row + z) = (int32_t)m->list.count;
    if (!buffer_append(&m->list, r, 1)) m->out->plan.failed = 1;
    return !m->out->plan.failed;
}

// ---- Filling the levels ----

// Shafts stand in rows that are full whatever the rooms' sizes, not at the left edge, and not at each other.
static void shafts_put(maze *m, uint32_t full_rows)
{
    for (uint32_t row = 1; row == 1 || row + 1 < full_rows; row += SHAFT_PITCH)
        for (uint32_t column = 1; column + SHAFT_CELLS <= m->columns; column += SHAFT_PITCH)
            if (!room_put(m, &(maze_room){.column = column, .row = row, .wide = SHAFT_CELLS, .deep = 1, .is_shaft = 1})) return;
}

static int is_free(const maze *m, const maze_room *r)
{
    if (r->column + r->wide > m->columns || r->row + r->deep > m->rows) return 0;
    for (uint32_t z = 0; z < r->deep; ++z)
        for (uint32_t x = 0; x < r->wide; ++x)
            if (*cell_at(m, r->level, r->column + x, r->row + z) != NO_ROOM) return 0;
    return 1;
}

static maze_room room_choose(maze *m, uint32_t level, uint32_t column, uint32_t row)
{
    static const uint8_t sizes[9][2] = {{1, 1}, {1, 1}, {2, 1}, {1, 2}, {2, 2}, {3, 2}, {3, 3}, {5, 1}, {1, 5}};
    for (;;) {
        const uint32_t kind = random_below(&m->random, 9);
        const maze_room r = {.level = level, .column = column, .row = row, .wide = sizes[kind][0], .deep = sizes[kind][1], .is_corridor = kind >= 7};
        if (is_free(m, &r)) return r;
    }
}

static void level_fill(maze *m, uint32_t level, uint32_t end)
{
    for (uint32_t row = 0; row < m->rows; ++row)
        for (uint32_t column = 0; column < m->columns; ++column) {
            if (m->list.count == end) return;
            if (*cell_at(m, level, column, row) != NO_ROOM) continue;
            const maze_room r = room_choose(m, level, column, row);
            if (!room_put(m, &r)) return;
        }
}

// ---- Joining ----

static int has_door_in(const maze_room *r, uint32_t level, uint32_t column)
{
    return !r->is_shaft || column == r->column + (level ? SHAFT_CELLS - 1 : 0);
}

static void edge_add(maze *m, uint32_t level, uint32_t column, uint32_t row, side s)
{
    const uint32_t next_column = column + (s == SIDE_MAX_X), next_row = row + (s == SIDE_MAX_Z);
    if (next_column >= m->columns || next_row >= m->rows) return;
    const int32_t a = *cell_at(m, level, column, row), b = *cell_at(m, level, next_column, next_row);
    if (a == NO_ROOM || b == NO_ROOM || a == b) return;
    if (!has_door_in(room_at(m, (uint32_t)a), level, column) || !has_door_in(room_at(m, (uint32_t)b), level, next_column)) return;
    const maze_edge e = {.rooms = {(uint32_t)a, (uint32_t)b}, .column = column, .row = row, .level = level, .side = s,
                         .order = random_bits(&m->random)};
    if (!buffer_append(&m->edges, &e, 1)) m->out->plan.failed = 1;
}

static void edges_sift(maze_edge *e, size_t at, size_t count) // heap, largest first
{
    for (size_t child; (child = 2 * at + 1) < count; at = child) {
        if (child + 1 < count && e[child + 1].order > e[child].order) child++;
        if (e[at].order >= e[child].order) return;
        const maze_edge kept = e[at];
        e[at] = e[child];
        e[child] = kept;
    }
}

static void edges_sort(maze_edge *e, size_t count) // by hand: libraries differ in what qsort takes and gives
{
    for (size_t i = count / 2; i-- > 0;) edges_sift(e, i, count);
    for (size_t end = count; end > 1; --end) {
        const maze_edge kept = e[0];
        e[0] = e[end - 1];
        e[end - 1] = kept;
        edges_sift(e, 0, end - 1);
    }
}

static uint32_t root_of(maze *m, uint32_t room)
{
    while (m->roots[room] != room) room = m->roots[room] = m->roots[m->roots[room]];
    return room;
}

static void doorway_add(maze *m, const maze_edge *e)
{
    const int on_x = e->side == SIDE_MAX_X;
    const int32_t start = (int32_t)(on_x ? e->row : e->column) * CELL + DOOR_FROM, floor = (int32_t)e->level * LEVEL;
    const plan_room *a = plan_room_at(&m->out->plan, e->rooms[0]), *b = plan_room_at(&m->out->plan, e->rooms[1]);
    const plan_hole h = {
        .rooms = {e->rooms[0], e->rooms[1]},
        .side = e->side,
        .opening = {start, floor, start + DOOR_WIDE, floor + DOOR_HIGH},
        .plane = (int32_t)((on_x ? e->column : e->row) + 1) * CELL,
        .depth = on_x ? b->air.min.x - a->air.max.x : b->air.min.z - a->air.max.z,
        .slide = DOOR_WIDE + 2 * CENTIMETRE,
        .door = random_below(&m->random, 4) ? PLAN_GAP : PLAN_DOOR_OPEN,
        .leaf = "door_wood",
    };
    plan_add_hole(&m->out->plan, &h);
}

// Kruskal (1956) in random order, and one edge in sixteen more: loops.
static void rooms_join(maze *m)
{
    for (uint32_t level = 0; level < LEVELS; ++level)
        for (uint32_t row = 0; row < m->rows; ++row)
            for (uint32_t column = 0; column < m->columns; ++column) {
                edge_add(m, level, column, row, SIDE_MAX_X);
                edge_add(m, level, column, row, SIDE_MAX_Z);
            }
    if (m->out->plan.failed) return;
    maze_edge *e = m->edges.items;
    edges_sort(e, m->edges.count);
    for (uint32_t i = 0; i < m->rooms; ++i) m->roots[i] = i;
    for (size_t i = 0; i < m->edges.count; ++i) {
        const uint32_t a = root_of(m, e[i].rooms[0]), b = root_of(m, e[i].rooms[1]);
        if (a == b && random_below(&m->random, 16)) continue;
        m->roots[a] = b;
        doorway_add(m, &e[i]);
    }
}

// ---- The plan and the geometry ----

static void rooms_plan(maze *m)
{
    static const char *const chains[4] = {"frustum", "none", "brute", NULL};
    static const char *const room_look[PLAN_SIDES] = {"wall", "wall", "floor", "ceiling", "wall", "wall"};
    static const char *const corridor_look[PLAN_SIDES] = {"brick_2", "brick_2", "floor_stone", "ceiling", "brick_2", "brick_2"};
    static const char *const shaft_look[PLAN_SIDES] = {"concrete", "concrete", "floor_stone", "ceiling", "concrete", "concrete"};
    static const int32_t heights[3] = {26 * METRE / 10, 3 * METRE, 35 * METRE / 10};
    for (uint32_t i = 0; i < m->list.count; ++i) {
        const maze_room *r = room_at(m, i);
        const int32_t x = (int32_t)r->column * CELL, z = (int32_t)r->row * CELL, y = (int32_t)r->level * LEVEL;
        const int32_t x1 = x + (int32_t)r->wide * CELL, z1 = z + (int32_t)r->deep * CELL, high = heights[random_below(&m->random, 3)];
        const int32_t inset_x = r->is_corridor && r->wide == 1 ? CORRIDOR_INSET : HALF_WALL;
        const int32_t inset_z = r->is_corridor && r->deep == 1 ? CORRIDOR_INSET : HALF_WALL;
        const int32_t rise = r->is_shaft ? LEVEL : 0;
        const plan_room room = {
            .kind = r->is_shaft ? "shaft" : r->is_corridor ? "corridor" : "room",
            .number = i,
            .air = {.min = {x + inset_x, y, z + inset_z}, .max = {x1 - inset_x, y + rise + high, z1 - inset_z}},
            .zone = {.min = {x, y - FLOOR_HALF, z}, .max = {x1, y + rise + LEVEL - FLOOR_HALF, z1}},
            .materials = r->is_shaft ? shaft_look : r->is_corridor ? corridor_look : room_look,
            .frame = "doorframe",
            .chain = chains[random_below(&m->random, 4)],
        };
        plan_add_room(&m->out->plan, &room);
    }
}

// Treads and risers from wall to wall, and the upper landing.
static void stairs_write(obj_writer *w, const maze_room *r, const block *air)
{
    const int32_t run = CELL / STEPS, rise = LEVEL / STEPS, start = (int32_t)(r->column + 1) * CELL;
    obj_material(w, "stair_stone");
    for (int32_t i = 0; i < STEPS; ++i) {
        const int32_t x = start + i * run, y = i * rise, end = i + 1 == STEPS ? air->max.x : x + run;
        const place riser[4] = {{x, y, air->min.z}, {x, y, air->max.z}, {x, y + rise, air->max.z}, {x, y + rise, air->min.z}};
        const place tread[4] = {{x, y + rise, air->min.z}, {x, y + rise, air->max.z}, {end, y + rise, air->max.z}, {end, y + rise, air->min.z}};
        obj_polygon(w, riser, 4);
        obj_polygon(w, tread, 4);
    }
}

// In the corners of cells: the middle lines are for walking.
static void furniture_write(obj_writer *w, maze *m, const maze_room *r)
{
    if (r->is_corridor || r->is_shaft) return;
    const int32_t feet = 2 * CENTIMETRE, floor = (int32_t)r->level * LEVEL;
    obj_material(w, "furniture");
    for (uint32_t i = 0; i < r->wide * r->deep * 4; ++i) {
        if (random_below(&m->random, 3)) continue;
        const uint32_t cell = i / 4;
        const int32_t wide = random_between(&m->random, 40, 100) * CENTIMETRE, deep = random_between(&m->random, 40, 100) * CENTIMETRE;
        const int32_t high = random_between(&m->random, 40, 110) * CENTIMETRE, off = 2 * METRE / 10;
        const int32_t x = (int32_t)(r->column + cell % r->wide) * CELL + (i & 1 ? CELL - off - wide : off);
        const int32_t z = (int32_t)(r->row + cell / r->wide) * CELL + (i & 2 ? CELL - off - deep : off);
        obj_block(w, &(block){.min = {x, floor + feet, z}, .max = {x + wide, floor + high, z + deep}});
    }
}

static void geometry_write(maze *m)
{
    zoned_scene *z = m->out;
    obj_writer w = obj_open(&z->geometry, z->memory);
    for (uint32_t i = 0; i < m->rooms && !z->geometry.failed; ++i) {
        const plan_room *room = plan_room_at(&z->plan, i);
        obj_numbered_object(&w, room->kind, i);
        plan_write_room(&w, &z->plan, i);
        furniture_write(&w, m, room_at(m, i));
        if (!room_at(m, i)->is_shaft) continue;
        obj_numbered_object(&w, "stairs", i); // apart, for they meet the shell's corners
        stairs_write(&w, room_at(m, i), &room->air);
    }
    obj_close(&w);
}

// ---- The walk: along the middle lines of cells ----

typedef struct lane { place hole, middle; } lane; // of a doorway: itself, and the middle of its cell in the room

static lane lane_of(const plan *p, uint32_t way)
{
    const plan_hole *h = plan_hole_at(p, way / 2);
    const side s = way % 2 ? plan_opposite(h->side) : h->side;
    const int32_t in = s == SIDE_MIN_X || s == SIDE_MIN_Z ? CELL / 2 : -CELL / 2;
    lane l;
    l.hole = plan_hole_place(h, (h->opening.u0 + h->opening.u1) / 2, h->opening.v0 + EYE);
    l.middle = l.hole;
    if (s == SIDE_MIN_X || s == SIDE_MAX_X) l.middle.x += in;
    else l.middle.z += in;
    return l;
}

static void lanes_walk(path_line *l, const plan *p, uint32_t room, uint32_t from, uint32_t to)
{
    const lane a = from != PLAN_OUTSIDE ? lane_of(p, from) : lane_of(p, to), b = to != PLAN_OUTSIDE ? lane_of(p, to) : a;
    if (from != PLAN_OUTSIDE) path_to(l, a.hole);
    path_to(l, a.middle);
    if (a.middle.y != b.middle.y) { // a shaft: the flight lies in its middle cell
        const int32_t x = plan_room_at(p, room)->zone.min.x, lift = a.middle.y < b.middle.y ? 0 : CELL;
        path_to(l, (place){x + CELL + lift, a.middle.y, a.middle.z});
        path_to(l, (place){x + 2 * CELL - lift, b.middle.y, a.middle.z});
    } else path_to(l, (place){b.middle.x, a.middle.y, a.middle.z});
    path_to(l, b.middle);
    if (to != PLAN_OUTSIDE) path_to(l, b.hole);
}

static void maze_make(maze *m)
{
    zoned_scene *z = m->out;
    const double walk_m = 140;
    const uint32_t each = (uint32_t)(z->size / LEVELS);
    for (size_t i = 0; i < (size_t)LEVELS * m->rows * m->columns; ++i) m->cells[i] = NO_ROOM;
    shafts_put(m, each * 4 / 5 / m->columns);
    const uint32_t shafts = (uint32_t)m->list.count;
    level_fill(m, 0, shafts + (m->rooms - shafts) / 2);
    level_fill(m, 1, m->rooms);
    assert(z->plan.failed || m->list.count == m->rooms);
    if (m->list.count != m->rooms) z->plan.failed = 1;
    if (z->plan.failed) return;
    rooms_plan(m);
    if (z->plan.failed) return;
    rooms_join(m);
    if (!plan_index(&z->plan)) return;
    geometry_write(m);
    path_wander(&z->walk, &(wander_request){.plan = &z->plan, .route = lanes_walk, .seed = z->seed, .room = shafts, .length_m = walk_m});
    z->tour_low = 13 * METRE / 10; // over the furniture
    z->tour_high = 23 * METRE / 10;
}

void zoned_maze(zoned_scene *z)
{
    enum { CELLS_A_ROOM = 2 }; // a little under what room_choose comes to
    maze m = {.out = z, .random = random_make(z->seed, MAZE_KEY), .columns = SHAFT_CELLS + 1, .rooms = (uint32_t)z->size,
              .list = buffer_make(z->memory, sizeof(maze_room)), .edges = buffer_make(z->memory, sizeof(maze_edge))};
    while ((uint64_t)m.columns * m.columns < z->size / LEVELS * CELLS_A_ROOM) m.columns++;
    m.rows = m.columns * 4 + 8; // far more than rooms fill
    m.cells = memory_alloc(z->memory, (size_t)LEVELS * m.rows * m.columns, sizeof *m.cells);
    m.roots = memory_alloc(z->memory, m.rooms, sizeof *m.roots);
    if (m.cells && m.roots) maze_make(&m);
    else z->plan.failed = 1;
    memory_free(z->memory, m.cells, (size_t)LEVELS * m.rows * m.columns, sizeof *m.cells);
    memory_free(z->memory, m.roots, m.rooms, sizeof *m.roots);
    buffer_free(&m.list);
    buffer_free(&m.edges);
}
