// What stands in the rooms of a house: furniture from blocks, and a few models. Lines from door to door stay free.
// SPDX-License-Identifier: MIT
#include "generate_house.h"

enum { FLOOR = 20, UPPER = 320, CELLAR = -300, DEEP = -640 }; // centimetres

typedef struct fitter {
    const house_site *house;
    obj_writer *writer;
    plan *plan;
    random_stream *random;
} fitter;

typedef struct local_box { local_place min, max; } local_box;

// The middle of its foot, its size.
static local_box box_on(int32_t x, int32_t y, int32_t z, int32_t wide, int32_t high, int32_t deep)
{
    return (local_box){{x - wide / 2, y, z - deep / 2}, {x + wide / 2, y + high, z + deep / 2}};
}

static void box_write(const fitter *f, local_box b)
{
    const block out = house_block(f->house, b.min, b.max);
    obj_block(f->writer, &out);
}

static void keep_clear(const fitter *f, local_box b)
{
    const block out = house_block(f->house, b.min, b.max);
    plan_add_obstacle(f->plan, &out);
}

static void object(const fitter *f, const char *name, const char *material)
{
    obj_numbered_object(f->writer, name, f->house->number);
    obj_material(f->writer, material);
}

static void table(const fitter *f, int32_t x, int32_t y, int32_t z, int32_t wide, int32_t deep)
{
    object(f, "table", "walnut_wood");
    box_write(f, box_on(x, y + 70, z, wide, 5, deep));
    for (int i = 0; i < 4; ++i)
        box_write(f, box_on(x + (i & 1 ? 1 : -1) * (wide / 2 - 8), y + 1, z + (i & 2 ? 1 : -1) * (deep / 2 - 8), 8, 68, 8));
    keep_clear(f, box_on(x, y, z, wide, 75, deep));
}

static void chair(const fitter *f, int32_t x, int32_t y, int32_t z, int back)
{
    object(f, "chair", "oak_wood_5");
    box_write(f, box_on(x, y + 42, z, 42, 5, 42));
    box_write(f, box_on(x, y + 48, z + back * 19, 42, 48, 4));
    for (int i = 0; i < 4; ++i) box_write(f, box_on(x + (i & 1 ? 17 : -17), y + 1, z + (i & 2 ? 17 : -17), 5, 40, 5));
    keep_clear(f, box_on(x, y, z, 44, 96, 44));
}

static void sofa(const fitter *f, int32_t x, int32_t y, int32_t z, int back)
{
    object(f, "sofa", "cloth_red_860");
    box_write(f, box_on(x, y + 8, z, 180, 34, 80));
    box_write(f, box_on(x, y + 43, z + back * 30, 180, 45, 18));
    box_write(f, box_on(x - 82, y + 43, z - back * 10, 16, 20, 58));
    box_write(f, box_on(x + 82, y + 43, z - back * 10, 16, 20, 58));
    keep_clear(f, box_on(x, y, z, 180, 90, 80));
}

static void bed(const fitter *f, int32_t x, int32_t y, int32_t z, const char *cloth)
{
    object(f, "bed", "walnut_wood");
    box_write(f, box_on(x, y + 1, z, 150, 28, 205));
    box_write(f, box_on(x, y + 30, z - 98, 150, 60, 6));
    obj_material(f->writer, cloth);
    box_write(f, box_on(x, y + 30, z + 4, 144, 18, 190));
    obj_material(f->writer, "linen");
    box_write(f, box_on(x - 35, y + 49, z - 70, 60, 10, 36));
    box_write(f, box_on(x + 35, y + 49, z - 70, 60, 10, 36));
    keep_clear(f, box_on(x, y, z, 150, 90, 205));
}

// Along the x axis, its back to the wall at z.
static void shelf(const fitter *f, int32_t x, int32_t y, int32_t z, const char *fill)
{
    static const char *const covers[3] = {"book_red_860", "book_green_391", "book_brown_199"};
    object(f, "shelf", "walnut_wood");
    box_write(f, box_on(x - 77, y + 1, z, 4, 200, 30));
    box_write(f, box_on(x + 77, y + 1, z, 4, 200, 30));
    for (int board = 0; board < 5; ++board) box_write(f, box_on(x, y + 6 + 48 * board, z, 148, 3, 28));
    for (int board = 0; board < 4; ++board)
        for (int32_t at = x - 72; at < x + 66;) {
            const int32_t wide = random_between(f->random, 4, 9), high = random_between(f->random, 22, 36);
            obj_material(f->writer, fill ? fill : covers[random_below(f->random, 3)]);
            const int32_t foot = y + 10 + 48 * board;
            if (random_below(f->random, 6)) box_write(f, (local_box){{at, foot, z - 10}, {at + wide, foot + high, z + 10}});
            at += wide + (fill ? 4 : 1);
        }
    keep_clear(f, box_on(x, y, z, 158, 202, 30));
}

static void cupboard(const fitter *f, int32_t x, int32_t y, int32_t z, int32_t wide, int32_t high)
{
    object(f, "cupboard", "oak_wood_5");
    box_write(f, box_on(x, y + 1, z, wide, high, 55));
    obj_material(f->writer, "top_stone");
    box_write(f, box_on(x, y + high + 2, z, wide + 4, 4, 59));
    keep_clear(f, box_on(x, y, z, wide + 4, high + 6, 59));
}

static void vase(const fitter *f, int32_t x, int32_t y, int32_t z, int32_t high)
{
    static const char *const glazes[3] = {"glazed_blue_2", "terracotta_452", "glazed_green_109"};
    object(f, "vase", glazes[random_below(f->random, 3)]);
    model_pot(f->writer, house_spot(f->house, (local_place){x, y + 1, z}), high / 100.0, random_below(f->random, 4));
    keep_clear(f, box_on(x, y, z, high, high, high));
}

static void pictures(const fitter *f, int32_t y)
{
    static const char *const paints[4] = {"canvas_17", "canvas_204", "canvas_61", "canvas_88"};
    for (int i = 0; i < 2; ++i) {
        object(f, "picture", "gold_242");
        box_write(f, (local_box){{i ? 811 : 484, y + 120, -450}, {i ? 816 : 489, y + 190, -350}});
        obj_material(f->writer, paints[random_below(f->random, 4)]);
        box_write(f, (local_box){{i ? 817 : 481, y + 126, -444}, {i ? 818 : 483, y + 184, -356}});
    }
}

static void ground_floor(const fitter *f)
{
    table(f, 130, FLOOR, -150, 110, 60);
    sofa(f, 130, FLOOR, -425, -1);
    shelf(f, 400, FLOOR, -472, NULL);
    vase(f, 440, FLOOR, -80, 90);
    table(f, 150, FLOOR, -740, 180, 90);
    chair(f, 110, FLOOR, -660, 1);
    chair(f, 190, FLOOR, -660, 1);
    chair(f, 110, FLOOR, -820, -1);
    chair(f, 190, FLOOR, -820, -1);
    cupboard(f, 400, FLOOR, -930, 120, 85);
    vase(f, 400, FLOOR + 92, -930, 50);
    table(f, 1190, FLOOR, -140, 130, 70);
    chair(f, 1190, FLOOR, -215, -1);
    shelf(f, 1190, FLOOR, -472, NULL);
    cupboard(f, 1190, FLOOR, -560, 120, 85);
    table(f, 1190, FLOOR, -800, 100, 70);
    vase(f, 540, FLOOR, -60, 60);
    pictures(f, FLOOR);
}

static void upper_floor(const fitter *f)
{
    bed(f, 110, UPPER, -380, "cloth_blue_2");
    cupboard(f, 430, UPPER, -455, 100, 180);
    object(f, "tub", "enamel_light");
    box_write(f, box_on(120, UPPER + 1, -900, 160, 55, 75));
    keep_clear(f, box_on(120, UPPER, -900, 160, 60, 75));
    cupboard(f, 420, UPPER, -560, 80, 80);
    bed(f, 1180, UPPER, -140, "cloth_green_391");
    shelf(f, 1180, UPPER, -472, "toy_55");
    bed(f, 900, UPPER, -640, "cloth_red_860");
    cupboard(f, 1190, UPPER, -930, 110, 90);
    vase(f, 1190, UPPER + 97, -930, 45);
    pictures(f, UPPER);
}

static void barrel(const fitter *f, int32_t x, int32_t z)
{
    object(f, "barrel", "barrel_wood");
    model_ball(f->writer, house_spot(f->house, (local_place){x, CELLAR + 46, z}), 0.45, 14);
    keep_clear(f, box_on(x, CELLAR, z, 90, 90, 90));
}

static void cellar(const fitter *f)
{
    for (int i = 0; i < 3; ++i) barrel(f, 220, -590 - 80 * i);
    shelf(f, 800, DEEP, -582, "bottle_green_109");
    object(f, "crates", "crate_wood");
    for (int i = 0; i < 3; ++i) box_write(f, box_on(250 + 110 * i, CELLAR + 1, -950, 50 + 10 * i, 30 + 8 * i, 34));
    keep_clear(f, box_on(360, CELLAR, -950, 290, 60, 36));
    object(f, "coal", "coal_rock");
    for (int i = 0; i < 40; ++i) {
        const int32_t size = random_between(f->random, 8, 26), at = random_between(f->random, 0, 90);
        box_write(f, box_on(random_between(f->random, 320, 500), CELLAR + 1 + (90 - at) / 4, -560 - at, size, size, size));
    }
    cupboard(f, 585, CELLAR, -700, 60, 110);
    object(f, "column", "marble");
    for (int i = 0; i < 2; ++i) model_column(f->writer, house_spot(f->house, (local_place){300 + 220 * i, CELLAR + 1, -480}), 2.385);
    object(f, "tomb", "tomb_stone");
    box_write(f, box_on(270, CELLAR + 1, -150, 90, 60, 180));
    obj_material(f->writer, "bronze_912");
    model_figure(f->writer, house_spot(f->house, (local_place){270, CELLAR + 62, -150}), 1.5, 0.2);
    keep_clear(f, box_on(270, CELLAR, -150, 90, 210, 180));
    shelf(f, 500, CELLAR, -48, "jar_light");
    object(f, "machine", "iron_metal");
    box_write(f, box_on(1180, CELLAR + 1, -120, 120, 150, 120));
    model_ring(f->writer, house_spot(f->house, (local_place){1050, CELLAR + 90, -100}), 0.6, 0.12);
    keep_clear(f, box_on(1120, CELLAR, -110, 270, 190, 140));
    object(f, "knot", "copper_652");
    model_knot(f->writer, house_spot(f->house, (local_place){520, DEEP + 110, -660}), 0.7);
    keep_clear(f, box_on(520, DEEP, -660, 170, 220, 170));
}

void house_fill(const house_site *h, obj_writer *w, plan *p, random_stream *r)
{
    const fitter f = {h, w, p, r};
    ground_floor(&f);
    if (h->storeys == HOUSE_TALL) upper_floor(&f);
    if (h->cellar == HOUSE_CELLAR) cellar(&f);
}
