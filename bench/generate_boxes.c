// city and swarm: scenes of boxes, written as .boxes files.
// SPDX-License-Identifier: MIT
// City: streets every 60 m and 14 m wide, 2 x 2 buildings and 3 pieces of street furniture a block. Invariant: a block
// depends on the seed and its place only, so that the N boxes nearest the origin are the same in every larger city.
#include "generate_kinds.h"

#include "generate_random.h"

#include <stdlib.h>

enum {
    PITCH = 60 * METRE,       // from street to street
    LOT = 23 * METRE,         // a quarter of a block, side
    BLOCK_BOXES = 7,          // 4 buildings, 3 pieces of street furniture
    RING_BOXES = 28,          // a square of 2R x 2R blocks has 28 R R boxes
    CITY_KEY = 0x63697479,    // streams of their own
    SHUFFLE_KEY = 0x73687566,
    SWARM_KEY = 0x7377726d,
    SWARM_HALF = 500 * METRE,
};

typedef struct city_box { int32_t min[3], max[3]; } city_box;

// e^x for |x| < 4, to 1e-10: the same bits everywhere, which a C library doesn't promise.
static double exponential(double x)
{
    const double part = x / 16;
    double sum = 1, term = 1;
    for (int i = 1; i < 10; ++i) {
        term = term * part / i;
        sum += term;
    }
    for (int i = 0; i < 4; ++i) sum *= sum;
    return sum;
}

static double random_normal(random_stream *r) // Irwin-Hall of 12: mean 0, deviation 1, within 6
{
    double sum = -6;
    for (int i = 0; i < 12; ++i) sum += random_unit(r);
    return sum;
}

static int32_t building_height(random_stream *r)
{
    double metres = 14 * exponential(0.55 * random_normal(r));
    if (metres < 4) metres = 4;
    if (metres > 90) metres = 90;
    return (int32_t)(metres * 100) * CENTIMETRE;
}

static int32_t centimetres(random_stream *r, int32_t least, int32_t most)
{
    return random_between(r, least, most) * CENTIMETRE;
}

static city_box building(random_stream *r, int32_t x, int32_t z)
{
    city_box b = {.min = {x, 0, z}, .max = {x + LOT, 0, z + LOT}};
    b.min[0] += centimetres(r, 5, 300);
    b.min[2] += centimetres(r, 5, 300);
    b.max[0] -= centimetres(r, 5, 300);
    b.max[2] -= centimetres(r, 5, 300);
    b.max[1] = building_height(r);
    return b;
}

static city_box street_furniture(random_stream *r, int32_t block_x, int32_t block_z)
{
    int32_t wide = 180, along, high;
    const uint32_t what = random_below(r, 10);
    if (what < 5) { // a parked car
        along = random_between(r, 190, 260) * 2;
        high = random_between(r, 140, 190);
    } else if (what < 8) { // a lamp post
        wide = along = 20;
        high = random_between(r, 450, 700);
    } else { // a bin
        wide = 60;
        along = 80;
        high = random_between(r, 90, 130);
    }
    const int32_t across_at = centimetres(r, 490, 590) * (random_below(r, 2) ? 1 : -1);
    const int32_t along_at = PITCH / 2 + centimetres(r, -2200, 2200);
    const int on_z_street = random_below(r, 2) != 0;
    const int32_t x = block_x * PITCH + (on_z_street ? across_at : along_at);
    const int32_t z = block_z * PITCH + (on_z_street ? along_at : across_at);
    const int32_t half_x = (on_z_street ? wide : along) * CENTIMETRE / 2, half_z = (on_z_street ? along : wide) * CENTIMETRE / 2;
    return (city_box){.min = {x - half_x, 0, z - half_z}, .max = {x + half_x, high * CENTIMETRE, z + half_z}};
}

static void block_fill(uint64_t seed, int32_t block_x, int32_t block_z, city_box *out)
{
    const uint64_t place = (uint64_t)(uint32_t)block_x << 32 | (uint32_t)block_z;
    random_stream r = random_make(seed ^ CITY_KEY, place);
    const int32_t x = block_x * PITCH + PITCH / 2 - LOT, z = block_z * PITCH + PITCH / 2 - LOT;
    for (int32_t i = 0; i < 4; ++i) out[i] = building(&r, x + (i & 1) * LOT, z + (i >> 1) * LOT);
    for (int32_t i = 4; i < BLOCK_BOXES; ++i) out[i] = street_furniture(&r, block_x, block_z);
}

static int64_t ring_distance(const city_box *b) // twice the centre's distance in squares round the origin
{
    const int64_t x = llabs((int64_t)b->min[0] + b->max[0]), z = llabs((int64_t)b->min[2] + b->max[2]);
    return x > z ? x : z;
}

static int nearer_first(const void *left, const void *right) // a total order, so that ties fall alike in every city
{
    const city_box *a = left, *b = right;
    const int64_t distance_a = ring_distance(a), distance_b = ring_distance(b);
    if (distance_a != distance_b) return distance_a < distance_b ? -1 : 1;
    for (int i = 0; i < 3; ++i) {
        if (a->min[i] != b->min[i]) return a->min[i] < b->min[i] ? -1 : 1;
        if (a->max[i] != b->max[i]) return a->max[i] < b->max[i] ? -1 : 1;
    }
    return 0;
}

static void shuffle(city_box *boxes, uint32_t count, uint64_t seed)
{
    random_stream r = random_make(seed ^ SHUFFLE_KEY, count);
    for (uint32_t i = count; i > 1; --i) {
        const uint32_t other = random_below(&r, i);
        const city_box kept = boxes[i - 1];
        boxes[i - 1] = boxes[other];
        boxes[other] = kept;
    }
}

static void box_write(text_file *out, const city_box *b)
{
    for (int i = 0; i < 6; ++i) {
        text_decimal(out, i < 3 ? b->min[i] : b->max[i - 3], PLACE_DECIMALS);
        text_add(out, i < 5 ? " " : "\n");
    }
}

static void head_write(text_file *out, uint64_t boxes)
{
    text_add(out, "boxes ");
    text_count(out, boxes);
    text_add(out, "\n");
}

// Rings until the furniture of the ring beyond, which may stand 6 m on this side, is farther than `boxes` others.
static int32_t rings_for(uint64_t boxes)
{
    int32_t rings = 1;
    while ((uint64_t)rings * (uint64_t)rings * RING_BOXES < boxes) rings++;
    return rings + 1;
}

void generate_city(uint64_t boxes, uint64_t seed, const allocator *memory, text_file *out)
{
    const int32_t rings = rings_for(boxes);
    const size_t count = (size_t)(2 * rings) * (size_t)(2 * rings) * BLOCK_BOXES;
    city_box *all = memory_alloc(memory, count, sizeof *all);
    if (!all) {
        out->failed = 1;
        return;
    }
    city_box *next = all;
    for (int32_t x = -rings; x < rings; ++x)
        for (int32_t z = -rings; z < rings; ++z, next += BLOCK_BOXES) block_fill(seed, x, z, next);
    qsort(all, count, sizeof *all, nearer_first);
    shuffle(all, (uint32_t)boxes, seed);
    head_write(out, boxes);
    for (size_t i = 0; i < boxes; ++i) box_write(out, &all[i]);
    memory_free(memory, all, count, sizeof *all);
}

void generate_swarm(uint64_t boxes, uint64_t seed, text_file *out)
{
    random_stream r = random_make(seed, SWARM_KEY);
    head_write(out, boxes);
    for (uint64_t i = 0; i < boxes; ++i) {
        city_box b;
        for (int axis = 0; axis < 3; ++axis) {
            const int32_t side = centimetres(&r, 10, 200);
            b.min[axis] = random_between(&r, -SWARM_HALF / CENTIMETRE, (SWARM_HALF - side) / CENTIMETRE) * CENTIMETRE;
            b.max[axis] = b.min[axis] + side;
        }
        box_write(out, &b);
    }
}
