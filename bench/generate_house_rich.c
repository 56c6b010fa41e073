// What fills furnished rooms: crockery, lamps, plants, statues, bottles; most of a house's polygons, as in a room one lives in. They stand on the
// furniture of generate_house_fill.c, along walls and under ceilings.
// SPDX-License-Identifier: MIT
// Invariant: lines from door to door stay free, and where an eye of a tour could be an obstacle says so.
#include "generate_house.h"

enum { FLOOR = 20, UPPER = 320, CELLAR = -300, DEEP = -640, TABLE = 76, CEILING = 230 }; // centimetres; the last two over a floor

typedef struct rich {
    const house_site *house;
    obj_writer *writer;
    plan *plan;
    random_stream *random;
} rich;

static spot spot_of(const rich *f, int32_t x, int32_t y, int32_t z)
{
    return house_spot(f->house, (local_place){x, y, z});
}

static void object(const rich *f, const char *name, const char *material)
{
    obj_numbered_object(f->writer, name, f->house->number);
    obj_material(f->writer, material);
}

static void keep_clear(const rich *f, local_place foot, int32_t half, int32_t high)
{
    const block out = house_block(f->house, (local_place){foot.x - half, foot.y, foot.z - half}, (local_place){foot.x + half, foot.y + high, foot.z + half});
    plan_add_obstacle(f->plan, &out);
}

static void globe(const rich *f, int32_t x, int32_t floor, int32_t z) // under a ceiling 2.6 m up
{
    object(f, "globe", "lamp_light");
    model_ball(f->writer, spot_of(f, x, floor + CEILING, z), 0.2, 24);
}

static void plant(const rich *f, int32_t x, int32_t floor, int32_t z)
{
    object(f, "plant", "terracotta_452");
    model_pot(f->writer, spot_of(f, x, floor + 1, z), 0.35, random_below(f->random, 4));
    model_tree(f->writer, spot_of(f, x, floor + 30, z), 0.9, f->random);
    keep_clear(f, (local_place){x, floor, z}, 45, 130);
}

// A row of vessels along x, `step` apart.
typedef struct row { local_place first; int32_t step; uint32_t count; double high; } row;

static void vessels(const rich *f, const char *name, row r)
{
    static const char *const glazes[4] = {"glazed_blue_2", "porcelain_light", "glazed_green_109", "terracotta_452"};
    object(f, name, glazes[random_below(f->random, 4)]);
    const uint32_t kind = random_below(f->random, 4);
    for (uint32_t i = 0; i < r.count; ++i) model_pot(f->writer, spot_of(f, r.first.x + r.step * (int32_t)i, r.first.y + 1, r.first.z), r.high, kind);
}

static void great_vase(const rich *f, int32_t x, int32_t y, int32_t z, double high)
{
    object(f, "great_vase", "glazed_blue_2");
    model_vase(f->writer, spot_of(f, x, y + 1, z), high, random_below(f->random, 4));
    keep_clear(f, (local_place){x, y, z}, (int32_t)(high * 45), (int32_t)(high * 100) + 2);
}

static void statue(const rich *f, int32_t x, int32_t y, int32_t z, double high)
{
    object(f, "statue", "marble");
    model_figure(f->writer, spot_of(f, x, y + 1, z), high, random_unit(f->random));
    keep_clear(f, (local_place){x, y, z}, (int32_t)(high * 25) + 2, (int32_t)(high * 100) + 2);
}

static void ground_floor(const rich *f)
{
    const int is_tall = f->house->storeys == HOUSE_TALL;
    globe(f, 260, FLOOR, -260);
    plant(f, 80, FLOOR, -80);
    vessels(f, "cups", (row){{100, FLOOR + TABLE, -150}, 30, 3, 0.14});
    great_vase(f, 455, FLOOR, -395, 0.7);
    globe(f, 260, FLOOR, -740);
    plant(f, 85, FLOOR, -570);
    vessels(f, "plates", (row){{90, FLOOR + TABLE, -715}, 40, 4, 0.11});
    vessels(f, "plates", (row){{90, FLOOR + TABLE, -765}, 40, 4, 0.11});
    vessels(f, "cups", (row){{108, FLOOR + TABLE, -740}, 40, 3, 0.13});
    great_vase(f, 455, FLOOR, -575, 0.6);
    statue(f, 60, FLOOR, -340, 1);
    great_vase(f, 1235, FLOOR, -350, 0.7);
    globe(f, 650, FLOOR, -260);
    plant(f, 735, FLOOR, -440);
    globe(f, 1040, FLOOR, -260);
    statue(f, 1150, FLOOR + TABLE, -140, 0.5);
    plant(f, 865, FLOOR, -90);
    globe(f, 1140, FLOOR, -740);
    vessels(f, "pans", (row){{1160, FLOOR + TABLE, -815}, 22, 4, 0.2});
    vessels(f, "jars", (row){{1145, FLOOR + 92, -560}, 18, 6, 0.22});
    if (is_tall) return;
    globe(f, 650, FLOOR, -740);
    vessels(f, "jugs", (row){{545, FLOOR, -945}, 30, 5, 0.4});
}

static void upper_floor(const rich *f)
{
    globe(f, 260, UPPER, -260);
    plant(f, 80, UPPER, -80);
    great_vase(f, 430, UPPER + 187, -455, 0.4);
    globe(f, 260, UPPER, -740);
    vessels(f, "flasks", (row){{395, UPPER + 87, -560}, 16, 4, 0.2});
    globe(f, 650, UPPER, -260);
    statue(f, 555, UPPER, -90, 1.7);
    globe(f, 1040, UPPER, -260);
    object(f, "balls", "toy_55");
    for (int i = 0; i < 6; ++i) model_ball(f->writer, spot_of(f, 860 + 28 * i, UPPER + 12, -80 - 14 * (i % 3)), 0.1, 14);
    globe(f, 1040, UPPER, -740);
    plant(f, 1215, UPPER, -575);
    great_vase(f, 455, UPPER, -80, 0.6);
    statue(f, 850, UPPER, -900, 1.2);
}

static void bottles(const rich *f) // along the wine cellar's wall
{
    enum { BOARDS = 3, BOTTLES = 14 };
    object(f, "rack", "walnut_wood");
    for (int i = 0; i < BOARDS; ++i) {
        const block board = house_block(f->house, (local_place){32, CELLAR + 20 + 50 * i, -800}, (local_place){72, CELLAR + 23 + 50 * i, -560});
        obj_block(f->writer, &board);
    }
    obj_material(f->writer, "bottle_green_109");
    for (int i = 0; i < BOARDS; ++i)
        for (int k = 0; k < BOTTLES; ++k) model_pot(f->writer, spot_of(f, 52, CELLAR + 24 + 50 * i, -790 + 17 * k), 0.32, 0);
    const block all = house_block(f->house, (local_place){30, CELLAR, -802}, (local_place){74, CELLAR + 170, -558});
    plan_add_obstacle(f->plan, &all);
}

static void cellar(const rich *f)
{
    bottles(f);
    object(f, "candles", "wax_light");
    for (int i = 0; i < 4; ++i) {
        const local_place foot = {i & 1 ? 350 : 60, CELLAR, i & 2 ? -330 : -60};
        model_lamp(f->writer, house_spot(f->house, (local_place){foot.x, foot.y + 1, foot.z}), 1.4);
        keep_clear(f, foot, 12, 145);
    }
    vessels(f, "urns", (row){{440, CELLAR, -330}, 55, 3, 0.5});
    vessels(f, "urns", (row){{560, CELLAR, -560}, 0, 1, 0.5});
    for (int i = 0; i < 3; ++i) {
        object(f, "wheel", "iron_metal");
        model_ring(f->writer, spot_of(f, 860, CELLAR + 60, -60 - 40 * i), 0.4, 0.09);
        keep_clear(f, (local_place){860, CELLAR, -60 - 40 * i}, 55, 125);
    }
    for (int i = 0; i < 3; ++i) great_vase(f, 650 + 90 * i, DEEP, -725, 0.6);
}

void house_furnish(const house_site *h, obj_writer *w, plan *p, random_stream *r)
{
    const rich f = {h, w, p, r};
    ground_floor(&f);
    if (h->storeys == HOUSE_TALL) upper_floor(&f);
    if (h->cellar == HOUSE_CELLAR) cellar(&f);
}
