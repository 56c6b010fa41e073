// The museum of the demo scene: six rooms with doorways and windows, exhibits in them, and the house round them.
// SPDX-License-Identifier: MIT
// Invariant: rooms, doorways and facade are one closed surface; every wall has the same cuts in height, and no opening of
// one wall has a cut of another within its width.
#include "generate_demo.h"

#include "generate_models.h"

enum {
    TENTH = METRE / 10,
    CEILING = 44 * TENTH,
    SILL = 9 * TENTH,
    HEAD = 26 * TENTH,
    ROOF = 52 * TENTH,
    FOUNDATION = -3 * TENTH,
    WALL = 4 * TENTH,
};

typedef struct hole { side side; int32_t from, to, sill; const char *frame; } hole; // tenths of a metre; frame NULL: the neighbour's
typedef struct museum_room {
    const char *name;
    int32_t min_x, min_z, max_x, max_z; // tenths of a metre
    hole holes[5];
    uint32_t hole_count;
} museum_room;

static const museum_room rooms[] = {
    {"figures", -146, -216, -52, -112,
     {{SIDE_MIN_Z, -130, -110, 9, "frame_stone"}, {SIDE_MAX_Z, -104, -92, 0, "door_frame"}, {SIDE_MAX_X, -170, -154, 0, "door_frame"}}, 3},
    {"rings", -146, -108, -52, -4,
     {{SIDE_MIN_Z, -104, -92, 0, NULL}, {SIDE_MAX_Z, -130, -110, 9, "frame_stone"}, {SIDE_MAX_Z, -85, -65, 9, "frame_stone"},
      {SIDE_MAX_X, -66, -50, 0, "door_frame"}}, 4},
    {"rotunda", -48, -216, 48, -112,
     {{SIDE_MIN_X, -170, -154, 0, NULL}, {SIDE_MAX_X, -190, -174, 0, "door_frame"}, {SIDE_MAX_Z, -12, 12, 0, "door_frame"},
      {SIDE_MIN_Z, -38, -18, 9, "frame_stone"}, {SIDE_MIN_Z, 18, 38, 9, "frame_stone"}}, 5},
    {"hall", -48, -108, 48, -4,
     {{SIDE_MIN_X, -66, -50, 0, NULL}, {SIDE_MAX_X, -66, -50, 0, "door_frame"}, {SIDE_MIN_Z, -12, 12, 0, NULL},
      {SIDE_MAX_Z, -12, 12, 0, "door_frame"}}, 4},
    {"library", 52, -216, 146, -112,
     {{SIDE_MIN_X, -190, -174, 0, NULL}, {SIDE_MAX_Z, 92, 104, 0, "door_frame"}, {SIDE_MIN_Z, 110, 130, 9, "frame_stone"}}, 3},
    {"vases", 52, -108, 146, -4,
     {{SIDE_MIN_X, -66, -50, 0, NULL}, {SIDE_MIN_Z, 92, 104, 0, NULL}, {SIDE_MAX_Z, 65, 85, 9, "frame_stone"},
      {SIDE_MAX_Z, 110, 130, 9, "frame_stone"}}, 4},
};
enum { ROOM_COUNT = (int)(sizeof rooms / sizeof *rooms) };

static int is_along_z(side s)
{
    return s == SIDE_MIN_X || s == SIDE_MAX_X;
}

static rectangle hole_rectangle(const hole *h)
{
    return (rectangle){h->from * TENTH, h->sill * TENTH, h->to * TENTH, HEAD};
}

static cuts heights_between(int32_t bottom, int32_t top)
{
    cuts c = {0};
    cuts_add(&c, bottom);
    cuts_add(&c, 0);
    cuts_add(&c, SILL);
    cuts_add(&c, HEAD);
    cuts_add(&c, top);
    return c;
}

static void room_write(obj_writer *w, const museum_room *m)
{
    static const char *const materials[6] = {"gallery_wall", "gallery_wall", "floor_wood", "ceiling", "gallery_wall", "gallery_wall"};
    const block body = {.min = {m->min_x * TENTH, 0, m->min_z * TENTH}, .max = {m->max_x * TENTH, CEILING, m->max_z * TENTH}};
    const cuts heights = heights_between(0, CEILING);
    cuts u[2] = {0};
    cuts_add(&u[0], body.min.x);
    cuts_add(&u[0], body.max.x);
    cuts_add(&u[1], body.min.z);
    cuts_add(&u[1], body.max.z);
    for (uint32_t i = 0; i < m->hole_count; ++i) {
        cuts_add(&u[is_along_z(m->holes[i].side)], m->holes[i].from * TENTH);
        cuts_add(&u[is_along_z(m->holes[i].side)], m->holes[i].to * TENTH);
    }
    obj_object(w, m->name);
    for (side s = SIDE_MIN_X; s <= SIDE_MAX_Z; ++s) {
        rectangle openings[5];
        const char *frames[5];
        panel p = {.body = &body, .side = s, .facing = FACING_IN, .u = &u[is_along_z(s)], .openings = openings};
        p.v = s == SIDE_MIN_Y || s == SIDE_MAX_Y ? &u[1] : &heights;
        for (uint32_t i = 0; i < m->hole_count; ++i) {
            if (m->holes[i].side != s) continue;
            frames[p.opening_count] = m->holes[i].frame;
            openings[p.opening_count++] = hole_rectangle(&m->holes[i]);
        }
        obj_material(w, materials[s]);
        obj_panel(w, &p);
        for (uint32_t i = 0; i < p.opening_count; ++i) {
            if (!frames[i]) continue;
            obj_material(w, frames[i]);
            obj_reveal(w, &p, i, WALL);
        }
    }
}

// Is it in an outer wall along the street or the garden? The other walls towards the outside have no holes.
static int is_outer(const museum_room *m, const hole *h)
{
    return (h->side == SIDE_MIN_Z && m->min_z == -216) || (h->side == SIDE_MAX_Z && m->max_z == -4);
}

// The outer side of the holes; their reveals belong to the rooms.
static void facade_write(obj_writer *w, const block *body, side s, const cuts *x, const cuts *z)
{
    const cuts heights = heights_between(FOUNDATION, ROOF);
    rectangle openings[2 * ROOM_COUNT];
    panel p = {.body = body, .side = s, .facing = FACING_OUT, .u = is_along_z(s) ? z : x, .v = &heights, .openings = openings};
    if (s == SIDE_MIN_Y || s == SIDE_MAX_Y) p.v = z;
    for (int i = 0; i < ROOM_COUNT; ++i)
        for (uint32_t k = 0; k < rooms[i].hole_count; ++k)
            if (rooms[i].holes[k].side == s && is_outer(&rooms[i], &rooms[i].holes[k]))
                openings[p.opening_count++] = hole_rectangle(&rooms[i].holes[k]);
    obj_panel(w, &p);
}

static void parapet_write(obj_writer *w)
{
    obj_object(w, "parapet");
    obj_material(w, "cornice_stone");
    const double y = 5.21; // a centimetre over the roof: no two faces coincide
    obj_block(w, &(block){.min = {-153 * TENTH, 48 * TENTH, 2 * CENTIMETRE}, .max = {153 * TENTH, 58 * TENTH, 3 * TENTH}});
    const block rest[3] = {block_at(0, -21.8, y, 30, .4, .5), block_at(-14.8, -11, y, .4, 20.8, .5), block_at(14.8, -11, y, .4, 20.8, .5)};
    for (int i = 0; i < 3; ++i) obj_block(w, &rest[i]);
}

static void house_write(obj_writer *w)
{
    const block body = {.min = {-150 * TENTH, FOUNDATION, -220 * TENTH}, .max = {150 * TENTH, ROOF, 0}};
    cuts x = {0}, z = {0};
    cuts_add(&x, body.min.x);
    cuts_add(&x, body.max.x);
    cuts_add(&z, body.min.z);
    cuts_add(&z, body.max.z);
    for (int i = 0; i < ROOM_COUNT; ++i)
        for (uint32_t k = 0; k < rooms[i].hole_count; ++k) {
            if (!is_outer(&rooms[i], &rooms[i].holes[k])) continue;
            cuts_add(&x, rooms[i].holes[k].from * TENTH);
            cuts_add(&x, rooms[i].holes[k].to * TENTH);
        }
    obj_object(w, "museum");
    for (side s = SIDE_MIN_X; s <= SIDE_MAX_Z; ++s) {
        obj_material(w, s == SIDE_MAX_Y ? "roof_felt" : "sandstone");
        facade_write(w, &body, s, &x, &z);
    }
    parapet_write(w);
}

// ---- Exhibits ----

static const double PEDESTAL_FOOT = 0.005; // half a centimetre over the floor: no two faces coincide

static double pedestal(obj_writer *w, uint32_t number, double x, double z, double high, double wide)
{
    const block slab = block_at(x, z, PEDESTAL_FOOT, wide * 1.2, wide * 1.2, 0.1);
    const block body = block_at(x, z, 0.115, wide, wide, high - 0.115);
    obj_numbered_object(w, "pedestal", number);
    obj_material(w, "pedestal_stone");
    obj_block(w, &slab);
    obj_block(w, &body);
    return high + PEDESTAL_FOOT;
}

static void figures_fill(obj_writer *w)
{
    static const double at[4][3] = {{-12.6, -14.2, .05}, {-9.9, -16.6, .2}, {-7.4, -19.4, .35}, {-12.6, -19.2, .6}};
    for (uint32_t i = 0; i < 4; ++i) {
        const double top = pedestal(w, i, at[i][0], at[i][1], 0.5, 0.8);
        obj_numbered_object(w, "figure", i);
        obj_material(w, i % 2 ? "bronze_912" : "marble");
        model_figure(w, (spot){at[i][0], top, at[i][1]}, 1.9, at[i][2]);
    }
}

static void rings_fill(obj_writer *w)
{
    const double knot = pedestal(w, 10, -9.9, -5.2, 0.6, 1.0);
    obj_object(w, "knot");
    obj_material(w, "copper_652");
    model_knot(w, (spot){-9.9, knot + 1.02, -5.2}, 0.9);
    static const double at[4][2] = {{-13, -2.4}, {-13, -8.6}, {-6.9, -8.8}, {-6.9, -2}};
    for (uint32_t i = 0; i < 4; ++i) {
        const double top = pedestal(w, 11 + i, at[i][0], at[i][1], 1.0, 0.6);
        obj_numbered_object(w, i % 2 ? "ball" : "ring", i);
        obj_material(w, i % 2 ? "glazed_blue_2" : "gold_242");
        if (i % 2) model_ball(w, (spot){at[i][0], top + 0.455, at[i][1]}, 0.45, 32);
        else model_ring(w, (spot){at[i][0], top + 0.455, at[i][1]}, 0.33, 0.12);
    }
}

static void rotunda_fill(obj_writer *w)
{
    const double top = pedestal(w, 20, 0, -15.4, 0.7, 1.4);
    obj_object(w, "founder");
    obj_material(w, "bronze_912");
    model_figure(w, (spot){0, top, -15.4}, 2.7, 0.5);
    for (uint32_t i = 0; i < 4; ++i) {
        const double x = i % 2 ? 3.4 : -3.4, z = i < 2 ? -13.2 : -19.8;
        obj_numbered_object(w, "column", i);
        obj_material(w, "marble");
        model_column(w, (spot){x, PEDESTAL_FOOT, z}, 4.38);
    }
}

static void hall_fill(obj_writer *w)
{
    for (uint32_t i = 0; i < 4; ++i) {
        const double x = i % 2 ? 3 : -3, z = i < 2 ? -2.6 : -8.8;
        obj_numbered_object(w, "column", 4 + i);
        obj_material(w, "marble");
        model_column(w, (spot){x, PEDESTAL_FOOT, z}, 4.38);
    }
    obj_object(w, "desk");
    obj_material(w, "walnut_wood");
    const block desk[3] = {block_at(3.2, -4.3, .01, .7, 1.6, 1), block_at(3.2, -4.3, 1.02, .9, 1.8, .05), block_at(-3.6, -7.6, .4, .5, 1, .06)};
    for (int i = 0; i < 3; ++i) obj_block(w, &desk[i]);
    obj_block(w, &(block){.min = {-38 * TENTH, CENTIMETRE, -80 * TENTH}, .max = {-34 * TENTH, 39 * CENTIMETRE, -72 * TENTH}});
}

static void bookcase(obj_writer *w, uint32_t number, double x, double z, random_stream *r)
{
    static const char *const covers[3] = {"book_red_860", "book_green_391", "book_brown_199"};
    obj_numbered_object(w, "bookcase", number);
    obj_material(w, "walnut_wood");
    const block sides[3] = {block_at(x - 1.2, z, .01, .05, .4, 2.4), block_at(x + 1.2, z, .01, .05, .4, 2.4), block_at(x, z, 2.42, 2.6, .44, .06)};
    for (int i = 0; i < 3; ++i) obj_block(w, &sides[i]);
    for (int shelf = 0; shelf < 5; ++shelf) {
        const double y = 0.08 + 0.46 * shelf;
        const block board = block_at(x, z, y, 2.34, .38, .03);
        obj_material(w, "walnut_wood");
        obj_block(w, &board);
        double left = x - 1.15;
        for (;;) {
            const double wide = 0.05 + 0.09 * random_unit(r), high = 0.24 + 0.13 * random_unit(r);
            if (left + wide > x + 1.15) break;
            const block book = block_at(left + wide / 2, z, y + 0.031, wide, 0.26, high);
            if (random_below(r, 8)) {
                obj_material(w, covers[random_below(r, 3)]);
                obj_block(w, &book);
            }
            left += wide + 0.004;
        }
    }
}

static void library_fill(obj_writer *w, random_stream *r)
{
    static const double at[4][2] = {{7.2, -21.2}, {7.4, -14.6}, {12.4, -14.6}, {12.4, -17.6}};
    for (uint32_t i = 0; i < 4; ++i) bookcase(w, i, at[i][0], at[i][1], r);
    obj_object(w, "table");
    obj_material(w, "walnut_wood");
    const block table[5] = {block_at(11.6, -20, .74, 2.4, 1, .05), block_at(10.6, -20.3, .01, .08, .08, .72), block_at(12.6, -20.3, .01, .08, .08, .72),
                            block_at(10.6, -19.7, .01, .08, .08, .72), block_at(12.6, -19.7, .01, .08, .08, .72)};
    for (int i = 0; i < 5; ++i) obj_block(w, &table[i]);
}

static void vases_fill(obj_writer *w)
{
    static const double at[5][3] = {{7.2, -8.8, 1.1}, {12.8, -8.6, 1.3}, {12.8, -5.2, 0.9}, {12.8, -2, 1.2}, {7.2, -2.2, 1.0}};
    static const char *const glazes[3] = {"glazed_blue_2", "terracotta_452", "glazed_green_109"};
    for (uint32_t i = 0; i < 5; ++i) {
        const double top = pedestal(w, 30 + i, at[i][0], at[i][1], 0.8, 0.6);
        obj_numbered_object(w, "vase", i);
        obj_material(w, glazes[i % 3]);
        model_vase(w, (spot){at[i][0], top, at[i][1]}, at[i][2], i);
    }
}

void demo_museum(obj_writer *w, random_stream *r)
{
    for (int i = 0; i < ROOM_COUNT; ++i) room_write(w, &rooms[i]);
    house_write(w);
    figures_fill(w);
    rings_fill(w);
    rotunda_fill(w);
    hall_fill(w);
    library_fill(w, r);
    vases_fill(w);
}
