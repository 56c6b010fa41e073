// house: one furnished house of eleven rooms on open ground, and a walk through both storeys and out of a window.
// SPDX-License-Identifier: MIT
#include "generate_house.h"

#include "generate_land.h"

enum { HOUSE_KEY = 0x686f7573, EYE = 165 };

static const house_site site = {0, -650, 500, 0, HOUSE_TALL, HOUSE_NO_CELLAR, HOUSE_DOOR_OPEN, "brick", "roof_tiles", HOUSE_CHAINS_DRAWN};

static void walk_make(path_line *l)
{
    static const int16_t at[][3] = {
        {200, 0, 1500},   {725, 0, 300},    {725, 10, 40},    {725, 20, -15},   {725, 20, -200},  {650, 20, -265},  {500, 20, -265},
        {300, 20, -265},  {255, 20, -350},  {255, 20, -500},  {280, 20, -700},  {255, 20, -500},  {300, 20, -265},  {500, 20, -265},
        {800, 20, -265},  {1000, 20, -265}, {1065, 20, -400}, {1065, 20, -500}, {1065, 20, -700}, {1065, 20, -500}, {1000, 20, -265},
        {800, 20, -265},  {650, 20, -265},  {575, 20, -350},  {575, 20, -500},  {575, 20, -600},  {575, 160, -810}, {600, 160, -890},
        {700, 160, -890}, {725, 160, -800}, {725, 320, -590}, {725, 320, -500}, {725, 320, -320}, {650, 320, -265}, {500, 320, -265},
        {280, 320, -265}, {255, 320, -500}, {255, 320, -700}, {255, 320, -500}, {330, 320, -265}, {370, 310, -130}, {370, 305, -15},
        {370, 310, 200},  {300, 500, 1200}};
    for (size_t i = 0; i < sizeof at / sizeof *at; ++i) path_to(l, house_place(&site, (local_place){at[i][0], at[i][1] + EYE, at[i][2]}));
}

void zoned_house(zoned_scene *z)
{
    random_stream plans = random_make(z->seed, HOUSE_KEY), things = random_make(z->seed, HOUSE_KEY + 1);
    const land ground = {.flat_x = 20 * METRE, .flat_z = 20 * METRE, .hole_count = 1, .holes = {house_footprint(&site)}};
    house_plan(&site, &z->plan, &plans);
    if (!plan_index(&z->plan)) return;
    obj_writer w = obj_open(&z->geometry, z->memory);
    land_write(&w, &ground);
    house_write(&site, &w, &z->plan, 0, house_room_count(&site));
    house_fill(&site, &w, &z->plan, &things);
    for (uint32_t i = 0; i < 12; ++i) {
        const double turn = (i + random_unit(&things)) / 12, far = 16 + 14 * random_unit(&things);
        const double x = far * turn_cosine(turn), at = far * turn_sine(turn) + 4;
        obj_numbered_object(&w, "tree", i);
        model_tree(&w, (spot){x, land_height(&ground, x, at) - 0.2, at}, 6 + 4 * random_unit(&things), &things);
    }
    obj_close(&w);
    walk_make(&z->walk);
    z->tour_low = 80 * CENTIMETRE;
    z->tour_high = 190 * CENTIMETRE;
}
