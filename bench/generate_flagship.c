// flagship: the street, its houses, hills and woods to the horizon; a walk from the street down to a cellar and out of an upper window.
// SPDX-License-Identifier: MIT
#include "generate_flagship.h"

#include "generate_land.h"

#include <math.h>

enum { FLAGSHIP_KEY = 0x666c6167, WALK_VIEWS = 1000, WALK_FROM = -160, WALK_TO = -50, EYE = 165, OUTDOOR_EYES = 80, HILL_TREES = 7, WOOD_SPACING = 20 }; // metres from tree to tree, about
enum { FLAT_X = 45, FLAT_Z = 25, STREET_HIGH = 14, STREET_DEEP = -8 }; // metres: half of what is level, which is the zone of the street too

static const house_site sites[FLAGSHIP_HOUSES] = {
    {0, -650, -600, 0, HOUSE_TALL, HOUSE_CELLAR, HOUSE_DOOR_OPEN, "brick", "roof_tiles", HOUSE_CHAINS_OF_ROOMS},
    {1, -2700, -600, 0, HOUSE_TALL, HOUSE_NO_CELLAR, HOUSE_DOOR_OPEN, "sandstone", "roof_slate_8", HOUSE_CHAINS_OF_ROOMS},
    {2, 1400, -600, 0, HOUSE_LOW, HOUSE_NO_CELLAR, HOUSE_DOOR_OPEN, "plaster_wall_3", "roof_tiles", HOUSE_CHAINS_OF_ROOMS},
    {3, -2700, 600, 1, HOUSE_LOW, HOUSE_NO_CELLAR, HOUSE_DOOR_OPEN, "brick_9", "roof_tiles", HOUSE_CHAINS_OF_ROOMS},
    {4, -650, 600, 1, HOUSE_TALL, HOUSE_NO_CELLAR, HOUSE_DOOR_OPEN, "plaster_wall_11", "roof_slate_8", HOUSE_CHAINS_OF_ROOMS},
    {5, 1400, 600, 1, HOUSE_TALL, HOUSE_NO_CELLAR, HOUSE_DOOR_SHUT, "sandstone", "roof_tiles", HOUSE_CHAINS_OF_ROOMS},
};

const house_site *flagship_house(uint32_t number)
{
    return &sites[number];
}

local_place flagship_lamp(uint32_t number)
{
    return (local_place){-3150 + 900 * (int32_t)number, 0, number % 2 ? 430 : -430};
}

// ---- What stands in the open ----

static void street_fill(obj_writer *w, const land *l, random_stream *r)
{
    static const double gardens[14][2] = {{-31, -12}, {-10.5, -12}, {-9.6, -19}, {2, -21}, {10, -11}, {21, -20}, {31, -13}, {-32, 13}, {-20, 20},
                                          {-10, 12.5}, {0, 20.5}, {10.2, 13}, {22, 21}, {31.5, 12}};
    for (uint32_t i = 0; i < FLAGSHIP_LAMPS; ++i) {
        const local_place at = flagship_lamp(i);
        obj_numbered_object(w, "lamp", i);
        obj_material(w, "iron_metal");
        model_lamp(w, (spot){at.x / 100.0, 0, at.z / 100.0}, 4.5);
    }
    for (uint32_t i = 0; i < 14; ++i) {
        obj_numbered_object(w, "tree", i);
        model_tree(w, (spot){gardens[i][0], -0.05, gardens[i][1]}, 6 + 2.5 * random_unit(r), r);
    }
    for (uint32_t i = 0; i < HILL_TREES; ++i) { // on the hills
        const double turn = (i + random_unit(r)) / HILL_TREES, far = 55 + 60 * random_unit(r);
        const double x = far * 1.1 * turn_cosine(turn), z = far * turn_sine(turn);
        obj_numbered_object(w, "tree", 14 + i);
        model_tree(w, (spot){x, land_height(l, x, z) - 0.3, z}, 7 + 5 * random_unit(r), r);
    }
}

static double walk_z(double x) // the way down to the street, both in metres
{
    return 2 + 0.375 * (WALK_TO - x);
}

static int is_on_the_way(double x, double z)
{
    const double clear = 7;
    return x > WALK_FROM - clear && x < WALK_TO && fabs(z - walk_z(x)) < clear;
}

// Woods on the hills beyond, a tree a square of a grid.
static void woods_fill(obj_writer *w, const land *l, random_stream *r)
{
    const int32_t half = l->half / METRE, near = LAND_NEAR / METRE - WOOD_SPACING / 2;
    uint32_t number = 0;
    for (int32_t z = -half; z + WOOD_SPACING <= half; z += WOOD_SPACING)
        for (int32_t x = -half; x + WOOD_SPACING <= half; x += WOOD_SPACING) {
            const double at_x = x + WOOD_SPACING * random_unit(r), at_z = z + WOOD_SPACING * random_unit(r);
            if ((at_x > -near && at_x < near && at_z > -near && at_z < near) || is_on_the_way(at_x, at_z)) continue;
            const spot foot = {at_x, land_height(l, at_x, at_z), at_z};
            obj_numbered_object(w, "wood", number++);
            if (random_below(r, 3)) model_conifer(w, foot, 7 + 9 * random_unit(r), r);
            else model_broadleaf(w, foot, 7 + 7 * random_unit(r), r);
        }
}

static void bench_write(obj_writer *w, uint32_t number, double x, double z)
{
    const block parts[3] = {block_at(x, z, .42, 1.7, .45, .06), block_at(x - .65, z, 0, .1, .4, .42), block_at(x + .65, z, 0, .1, .4, .42)};
    obj_numbered_object(w, "bench", number);
    obj_material(w, "walnut_wood");
    for (int i = 0; i < 3; ++i) obj_block(w, &parts[i]);
}

static void square_write(obj_writer *w) // where the street ends: a statue, vases, benches
{
    const block steps[2] = {block_at(34, 0, .01, 3, 3, .3), block_at(34, 0, .32, 1.4, 1.4, 1.1)};
    obj_object(w, "statue");
    obj_material(w, "pedestal_stone");
    obj_block(w, &steps[0]);
    obj_block(w, &steps[1]);
    obj_material(w, "bronze_912");
    model_figure(w, (spot){34, 1.43, 0}, 2.6, 0.25);
    for (uint32_t i = 0; i < 4; ++i) {
        obj_numbered_object(w, "pot", i);
        obj_material(w, "terracotta_452");
        model_pot(w, (spot){34 + (i & 1 ? 2.6 : -2.6), 0.01, i & 2 ? 2.6 : -2.6}, 0.9, i);
    }
    static const double benches[6][2] = {{-20, -4.9}, {-3, 4.9}, {9, -4.9}, {22, 4.9}, {31, -4.9}, {31, 4.9}};
    for (uint32_t i = 0; i < 6; ++i) bench_write(w, i, benches[i][0], benches[i][1]);
}

static void hedge_write(obj_writer *w)
{
    obj_object(w, "hedges");
    obj_material(w, "hedge_leaves");
    for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 2; ++k) {
            const double x = -30 + 20.25 * i, z = k ? 11 : -11;
            const block hedge = block_at(x, z - (k ? 4.5 : -4.5), -.1, i % 3 ? 5 : 4, .6, 1.3);
            obj_block(w, &hedge);
        }
}

// ---- The walk ----

static void walk_to(path_line *l, const house_site *h, int32_t x, int32_t y, int32_t z)
{
    path_to(l, house_place(h, (local_place){x, y + EYE, z}));
}

static void walk_cellar(path_line *l, const house_site *h)
{
    static const int16_t at[][3] = { // from the study's door to the stairs and back
        {935, 20, -265},    {935, 20, -500},    {935, 20, -570},    {935, -300, -865},  {900, -300, -915},  {800, -300, -915},  {665, -300, -915},
        {665, -300, -835},  {665, -300, -650},  {665, -300, -525},  {665, -300, -440},  {750, -300, -435},  {860, -300, -435},  {1000, -300, -380},
        {1130, -300, -430}, {1000, -300, -380}, {860, -300, -435},  {750, -300, -435},  {665, -300, -440},  {665, -300, -250},  {600, -300, -200},
        {665, -300, -250},  {665, -300, -440},  {420, -300, -450},  {155, -300, -440},  {155, -300, -260},  {110, -300, -160},  {155, -300, -260},
        {155, -300, -440},  {155, -300, -525},  {155, -300, -835},  {155, -300, -910},  {420, -300, -910},  {800, -300, -915},  {900, -300, -915},
        {935, -300, -865},  {935, 20, -570},    {935, 20, -500},    {935, 20, -265}};
    for (size_t i = 0; i < sizeof at / sizeof *at; ++i) walk_to(l, h, at[i][0], at[i][1], at[i][2]);
}

// Over the hills, where there are woods out of them.
static void walk_open(path_line *l, const land *ground)
{
    const int32_t step = 5;
    for (int32_t x = ground->half > LAND_NEAR ? WALK_FROM : -130; x <= WALK_TO; x += step) {
        const double z = walk_z(x);
        path_to(l, (place){x * METRE, (int32_t)floor(land_height(ground, x, z) * METRE) + EYE * CENTIMETRE, (int32_t)floor(z * METRE)});
    }
}

static void walk_make(path_line *l, const land *ground)
{
    const house_site *h = flagship_house(FLAGSHIP_CELLAR_HOUSE);
    static const int16_t up[][3] = { // through the hall and up
        {800, 20, -265},  {650, 20, -265},  {575, 20, -330},  {575, 20, -500},  {575, 20, -600},  {575, 160, -810},
        {600, 160, -890}, {700, 160, -890}, {725, 160, -800}, {725, 320, -590}, {725, 320, -500}, {725, 320, -320},
        {650, 320, -265}, {500, 320, -265}, {370, 320, -250}, {370, 310, -130}, {370, 305, -15},  {370, 305, 150}, {420, 340, 500}};
    walk_open(l, ground);
    path_to(l, (place){-36 * METRE, EYE * CENTIMETRE, 2 * METRE});
    path_to(l, (place){-20 * METRE, EYE * CENTIMETRE, METRE});
    path_to(l, (place){-6 * METRE, EYE * CENTIMETRE, 0});
    walk_to(l, h, 725, 0, 250);
    walk_to(l, h, 725, 10, 40);
    walk_to(l, h, 725, 20, -15);
    walk_to(l, h, 725, 20, -230);
    walk_to(l, h, 800, 20, -265);
    walk_cellar(l, h);
    for (size_t i = 0; i < sizeof up / sizeof *up; ++i) walk_to(l, h, up[i][0], up[i][1], up[i][2]);
    static const int8_t over[][3] = {{0, 5, -2}, {6, 6, 0},  {12, 7, 2}, {17, 8, 1}, {17, 9, -2}, // metres
                                     {12, 9, -3}, {4, 8, -2}, {-8, 7, 0}, {-20, 6, 1}};
    for (size_t i = 0; i < sizeof over / sizeof *over; ++i) path_to(l, (place){over[i][0] * METRE, over[i][1] * METRE, over[i][2] * METRE});
}

// ---- Lists of the JSON scene ----

static void light_write(json_writer *j, const char *name, uint32_t number, place at)
{
    json_item(j);
    text_add(j->out, "{\"name\": ");
    json_numbered(j->out, name, number);
    text_add(j->out, ", \"kind\": \"point\", \"at\": ");
    json_place(j->out, at);
    text_add(j->out, ", \"reach\": 12, \"colour\": [1, 0.9, 0.7]}");
}

static void lights_write(const zoned_scene *z, json_writer *j)
{
    json_item(j);
    text_add(j->out, "{\"name\": \"sun\", \"kind\": \"sun\", \"direction\": [0.4, -0.8, -0.3], \"colour\": [1, 0.98, 0.92]}");
    for (uint32_t i = 0; i < FLAGSHIP_LAMPS; ++i) {
        const local_place at = flagship_lamp(i);
        light_write(j, "lamp", i, (place){at.x * CENTIMETRE, 425 * CENTIMETRE, at.z * CENTIMETRE});
    }
    for (uint32_t i = 0; i < plan_room_count(&z->plan); ++i) {
        const block *air = &plan_room_at(&z->plan, i)->air;
        light_write(j, "ceiling", i, (place){(air->min.x + air->max.x) / 2, air->max.y - 40 * CENTIMETRE, (air->min.z + air->max.z) / 2});
    }
}

static int is_in_a_house(int32_t x, int32_t z) // with a metre round it
{
    for (uint32_t i = 0; i < FLAGSHIP_HOUSES; ++i) {
        const block b = house_footprint(&sites[i]);
        if (x > b.min.x - METRE && x < b.max.x + METRE && z > b.min.z - METRE && z < b.max.z + METRE) return 1;
    }
    return 0;
}

static void outdoor_eyes(const zoned_scene *z, json_writer *j)
{
    random_stream r = random_make(z->seed, FLAGSHIP_KEY + 1);
    for (int i = 0; i < OUTDOOR_EYES;) {
        const int32_t x = random_between(&r, -38 * METRE, 38 * METRE), at = random_between(&r, -23 * METRE, 23 * METRE);
        if (is_in_a_house(x, at)) continue;
        path_write_eye(j, (place){x, random_between(&r, METRE, 7 * METRE), at}, &r);
        ++i;
    }
}

void zoned_flagship(zoned_scene *z)
{
    random_stream plans = random_make(z->seed, FLAGSHIP_KEY), things = random_make(z->seed, FLAGSHIP_KEY + 2);
    random_stream riches = random_make(z->seed, FLAGSHIP_KEY + 3);
    const int is_small = z->size * METRE <= LAND_NEAR; // for quick tests: no woods, and rooms with little in them
    land ground = {.half = (int32_t)z->size * METRE, .flat_x = FLAT_X * METRE, .flat_z = FLAT_Z * METRE, .hole_count = FLAGSHIP_HOUSES,
                   .road_half = 35 * METRE / 10, .pavement_half = 6 * METRE, .road_end = 385 * METRE / 10};
    for (uint32_t i = 0; i < FLAGSHIP_HOUSES; ++i) {
        house_plan(&sites[i], &z->plan, &plans);
        ground.holes[i] = house_footprint(&sites[i]);
    }
    z->plan.outside_chain = "imagecache+portal";
    z->plan.quarter = (plan_quarter){.name = "street", .chain = "octree+portal+occlusion[method=hiz]",
                                     .zone = {{-FLAT_X * METRE, STREET_DEEP * METRE, -FLAT_Z * METRE}, {FLAT_X * METRE, STREET_HIGH * METRE, FLAT_Z * METRE}}};
    if (!plan_index(&z->plan)) return;
    obj_writer w = obj_open(&z->geometry, z->memory);
    land_write(&w, &ground);
    uint32_t room = 0;
    for (uint32_t i = 0; i < FLAGSHIP_HOUSES; ++i) {
        house_write(&sites[i], &w, &z->plan, room, house_room_count(&sites[i]));
        house_fill(&sites[i], &w, &z->plan, &things);
        if (!is_small) house_furnish(&sites[i], &w, &z->plan, &riches);
        room += house_room_count(&sites[i]);
    }
    street_fill(&w, &ground, &things);
    square_write(&w);
    hedge_write(&w);
    if (!is_small) woods_fill(&w, &ground, &things);
    obj_close(&w);
    walk_make(&z->walk, &ground);
    z->walk_views = WALK_VIEWS;
    z->tour_low = 80 * CENTIMETRE;
    z->tour_high = 190 * CENTIMETRE;
    z->movers = flagship_movers;
    z->lights = lights_write;
    z->paths = outdoor_eyes;
}
