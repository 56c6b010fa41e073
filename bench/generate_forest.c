// forest: woods and a town on rolling ground to the horizon, the open zone that image caches exist for: most of its triangles are far away.
// SPDX-License-Identifier: MIT
// Invariant: a block's content is of its place and the seed alone, blocks follow one another in rings round the origin, so a larger forest holds a
// smaller one but for the block where that ends; ground meets without cracks.
#include "generate_models.h"

#include <stdlib.h>

enum {
    CELL = 8 * METRE,
    BLOCK_CELLS = 8,
    BLOCK = BLOCK_CELLS * CELL, // its first row and column of cells are roads
    GROUND_TRIANGLES = 2 * BLOCK_CELLS * BLOCK_CELLS,
    THING_TRIANGLES = 400, // no house and no tree has more
    TREES = 42,            // tried in a block of woods; the margin keeps them off the roads
    LOTS = 3,              // a side of a block of houses
    FLOOR_HIGH = 3 * METRE,
    FOUNDATION = 4 * METRE, // below the ground's height in the middle: its slope never shows a house's foot
    NOISE_BLOCKS = 5,       // between two values of where the town is
    FOREST_KEY = 0x666f7265,
};
static const double TOWN_PART = 0.4; // of the land

typedef struct forest {
    obj_writer w;
    uint64_t seed, most; // triangles
} forest;

static double ground_height(double x_m, double z_m) // metres; the steepest slope is 0.1
{
    return 3.5 * turn_sine(x_m / 611 + z_m / 1733) + 2.5 * turn_sine(z_m / 433 - x_m / 1511) + 1.2 * turn_sine(x_m / 197 + z_m / 311);
}

static place ground_place(int32_t x, int32_t z)
{
    return (place){x, (int32_t)(ground_height((double)x / METRE, (double)z / METRE) * METRE), z};
}

static double noise_value(const forest *f, int32_t column, int32_t row)
{
    random_stream r = random_make(f->seed ^ FOREST_KEY, (uint64_t)(uint32_t)column << 32 | (uint32_t)row);
    return random_unit(&r);
}

static int32_t floor_divide(int32_t a, int32_t b)
{
    return a >= 0 ? a / b : -((b - 1 - a) / b);
}

static int is_town(const forest *f, int32_t column, int32_t row)
{
    const int32_t i = floor_divide(column, NOISE_BLOCKS), k = floor_divide(row, NOISE_BLOCKS);
    const double u = (double)(column - i * NOISE_BLOCKS) / NOISE_BLOCKS, v = (double)(row - k * NOISE_BLOCKS) / NOISE_BLOCKS;
    const double north = noise_value(f, i, k) * (1 - u) + noise_value(f, i + 1, k) * u;
    const double south = noise_value(f, i, k + 1) * (1 - u) + noise_value(f, i + 1, k + 1) * u;
    return north * (1 - v) + south * v < TOWN_PART;
}

// ---- Ground ----

static void ground_write(forest *f, place corner, int town)
{
    obj_object(&f->w, "ground");
    for (int32_t k = 0; k < BLOCK_CELLS; ++k)
        for (int32_t i = 0; i < BLOCK_CELLS; ++i) {
            const int32_t x = corner.x + i * CELL, z = corner.z + k * CELL;
            const place a = ground_place(x, z), b = ground_place(x, z + CELL), c = ground_place(x + CELL, z + CELL), d = ground_place(x + CELL, z);
            obj_material(&f->w, i == 0 || k == 0 ? (town ? "road" : "sand_path") : town ? "grass" : "earth");
            obj_polygon(&f->w, (const place[3]){a, b, c}, 3);
            obj_polygon(&f->w, (const place[3]){a, c, d}, 3);
        }
}

// ---- Woods ----

static int has_room(const forest *f)
{
    return !f->w.out->failed && f->w.triangle_count + THING_TRIANGLES <= f->most;
}

static void woods_write(forest *f, place corner, random_stream *r)
{
    const double margin = 1.5, wide = (double)BLOCK / METRE - 8 - 2 * margin, path = 8;
    for (uint32_t i = 0; i < TREES && has_room(f); ++i) {
        const double x = (double)corner.x / METRE + path + margin + wide * random_unit(r), z = (double)corner.z / METRE + path + margin + wide * random_unit(r);
        const spot foot = {x, ground_height(x, z), z};
        const double height = 7 + 9 * random_unit(r);
        obj_numbered_object(&f->w, "tree", f->w.object_count);
        if (random_below(r, 3)) model_conifer(&f->w, foot, height, r);
        else model_broadleaf(&f->w, foot, height, r);
    }
}

// ---- Houses ----

static void wall_write(forest *f, const block *b, side s, uint32_t storeys)
{
    const int on_x = s == SIDE_MIN_X || s == SIDE_MAX_X;
    const int32_t low = on_x ? b->min.z : b->min.x, high = on_x ? b->max.z : b->max.x, bay = 4 * METRE, wide = 12 * METRE / 10;
    cuts u = {0}, v = {0};
    rectangle openings[12];
    uint32_t count = 0;
    cuts_add(&u, low);
    cuts_add(&u, high);
    cuts_add(&v, b->min.y);
    cuts_add(&v, b->max.y);
    for (int32_t at = low + bay / 2; at + bay / 2 <= high && count < 8; at += bay)
        for (uint32_t storey = 0; storey < storeys && count < 8; ++storey) {
            const int32_t sill = b->min.y + FOUNDATION + (int32_t)storey * FLOOR_HIGH + METRE;
            openings[count++] = (rectangle){at - wide / 2, sill, at + wide / 2, sill + wide};
            cuts_add(&u, at - wide / 2);
            cuts_add(&u, at + wide / 2);
            cuts_add(&v, sill);
            cuts_add(&v, sill + wide);
        }
    const panel p = {.body = b, .side = s, .facing = FACING_OUT, .u = &u, .v = &v, .openings = openings, .opening_count = count};
    obj_panel(&f->w, &p);
}

static void windows_write(forest *f, const block *b)
{
    const int32_t depth = METRE / 10;
    const block glass = {{b->min.x + depth, b->min.y, b->min.z + depth}, {b->max.x - depth, b->max.y, b->max.z - depth}};
    obj_material(&f->w, "glass_window");
    obj_block(&f->w, &glass);
}

static void roof_write(forest *f, const block *b, random_stream *r)
{
    static const char *const materials[] = {"roof_tiles", "roof_slate", "roof_tiles_dark"};
    const int32_t over = METRE / 2, rise = random_between(r, 20, 35) * METRE / 10, along_x = b->max.x - b->min.x >= b->max.z - b->min.z;
    const int32_t x0 = b->min.x - over, x1 = b->max.x + over, z0 = b->min.z - over, z1 = b->max.z + over, y = b->max.y, top = y + rise;
    const place c[4] = {{x0, y, z0}, {x0, y, z1}, {x1, y, z1}, {x1, y, z0}};
    const int32_t mid_x = (x0 + x1) / 2, mid_z = (z0 + z1) / 2;
    const place e = along_x ? (place){x0, top, mid_z} : (place){mid_x, top, z1}, g = along_x ? (place){x1, top, mid_z} : (place){mid_x, top, z0};
    obj_material(&f->w, materials[random_below(r, 3)]);
    const int k = along_x ? 0 : 1; // the corner where the gable under e begins
    obj_polygon(&f->w, (const place[4]){c[k + 1], c[k + 2], g, e}, 4);
    obj_polygon(&f->w, (const place[4]){c[(k + 3) % 4], c[k], e, g}, 4);
    obj_polygon(&f->w, (const place[3]){c[k], c[k + 1], e}, 3);
    obj_polygon(&f->w, (const place[3]){c[k + 2], c[(k + 3) % 4], g}, 3);
    obj_polygon(&f->w, (const place[4]){c[0], c[3], c[2], c[1]}, 4); // eaves, from below
}

static void house_write(forest *f, place middle, random_stream *r)
{
    static const char *const facades[] = {"brick", "plaster_wall", "sandstone", "brick_9", "building_5"};
    const uint32_t storeys = 1 + random_below(r, 3);
    const int32_t half_x = random_between(r, 40, 70) * METRE / 10, half_z = random_between(r, 40, 70) * METRE / 10;
    const block b = {{middle.x - half_x, middle.y - FOUNDATION, middle.z - half_z},
                     {middle.x + half_x, middle.y + (int32_t)storeys * FLOOR_HIGH, middle.z + half_z}};
    obj_numbered_object(&f->w, "house", f->w.object_count);
    obj_material(&f->w, facades[random_below(r, 5)]);
    const side walls[4] = {SIDE_MIN_X, SIDE_MAX_X, SIDE_MIN_Z, SIDE_MAX_Z};
    for (int i = 0; i < 4; ++i) wall_write(f, &b, walls[i], storeys);
    windows_write(f, &b);
    roof_write(f, &b, r);
}

static void houses_write(forest *f, place corner, random_stream *r)
{
    const int32_t lot = (BLOCK - CELL) / LOTS;
    for (int32_t i = 0; i < LOTS * LOTS && has_room(f); ++i) {
        const int32_t x = corner.x + CELL + i % LOTS * lot + lot / 2, z = corner.z + CELL + i / LOTS * lot + lot / 2;
        const place middle = ground_place(x, z);
        if (i == LOTS * LOTS / 2) { // the yard in the middle
            obj_numbered_object(&f->w, "tree", f->w.object_count);
            model_broadleaf(&f->w, (spot){(double)x / METRE, (double)middle.y / METRE, (double)z / METRE}, 8 + 4 * random_unit(r), r);
            continue;
        }
        house_write(f, middle, r);
    }
}

static int block_write(forest *f, int32_t column, int32_t row)
{
    if (f->w.out->failed || f->w.triangle_count + GROUND_TRIANGLES + THING_TRIANGLES > f->most) return 0;
    random_stream r = random_make(f->seed, (uint64_t)(uint32_t)column << 32 | (uint32_t)row);
    const place corner = {column * BLOCK, 0, row * BLOCK};
    const int town = is_town(f, column, row);
    ground_write(f, corner, town);
    if (town) houses_write(f, corner, &r);
    else woods_write(f, corner, &r);
    return 1;
}

static int ring_write(forest *f, int32_t ring)
{
    for (int32_t row = -ring; row <= ring; ++row)
        for (int32_t column = -ring; column <= ring; ++column)
            if ((abs(row) == ring || abs(column) == ring) && !block_write(f, column, row)) return 0;
    return 1;
}

void generate_forest(uint64_t triangles, uint64_t seed, const allocator *memory, text_file *out)
{
    forest f = {.w = obj_open(out, memory), .seed = seed, .most = triangles};
    for (int32_t ring = 0; ring_write(&f, ring); ++ring) {}
    obj_close(&f.w);
}
