// What moves in the flagship scene: a cart on the street, walkers through doors and rooms, a lift in the cellar.
// SPDX-License-Identifier: MIT
// Invariant: every path ends where it began, so that it may start again.
#include "generate_flagship.h"

#include <math.h>

enum { KEYS_MOST = 12, MILLISECOND_DECIMALS = 3, WALKERS = 7 };

typedef struct route { local_place points[KEYS_MOST]; uint32_t count; } route; // local to a house; the way back is the same

typedef struct key { double time_s; place offset; } key;
typedef struct moving { const char *name; uint32_t number; block box; const char *material; const key *keys; uint32_t key_count; } moving;

static void mover_write(json_writer *j, const moving *m)
{
    json_item(j);
    text_add(j->out, "{\"name\": ");
    json_numbered(j->out, m->name, m->number);
    text_add(j->out, ", \"box\": ");
    json_box(j->out, &m->box, m->material);
    text_add(j->out, ", \"path\": [");
    for (uint32_t i = 0; i < m->key_count; ++i) {
        text_add(j->out, i ? ", {\"time\": " : "{\"time\": ");
        text_decimal(j->out, (int64_t)floor(m->keys[i].time_s * 1000 + 0.5), MILLISECOND_DECIMALS);
        text_add(j->out, ", \"at\": ");
        json_place(j->out, m->keys[i].offset);
        text_add(j->out, "}");
    }
    text_add(j->out, "], \"loop\": true}");
}

// ---- The cart ----

static void cart_write(json_writer *j)
{
    static const key round[] = {{0, {0, 0, 0}}, {16, {60 * METRE, 0, 0}}, {18, {60 * METRE, 0, 3 * METRE}}, {34, {0, 0, 3 * METRE}}, {36, {0, 0, 0}}};
    const double x = -30, z = -1.5;
    const moving parts[3] = {{"cart", PLAN_OUTSIDE, block_at(x, z, .5, 2.6, 1.3, .3), "oak_wood_5", round, 5},
                             {"cart_load", PLAN_OUTSIDE, block_at(x - .3, z, .81, 1.6, 1.1, .7), "cloth_green_391", round, 5},
                             {"cart_seat", PLAN_OUTSIDE, block_at(x + 1, z, .81, .3, 1.1, .4), "walnut_wood", round, 5}};
    for (int i = 0; i < 3; ++i) mover_write(j, &parts[i]);
    for (uint32_t i = 0; i < 4; ++i) {
        const moving wheel = {"cart_wheel", i, block_at(x + (i & 1 ? .8 : -.8), z + (i & 2 ? .72 : -.72), .02, .6, .1, .6), "iron_metal", round, 5};
        mover_write(j, &wheel);
    }
}

// ---- Walkers ----

static uint32_t keys_of(const house_site *h, const route *way, key out[2 * KEYS_MOST])
{
    const double speed_m_s = 1.3;
    const place start = house_place(h, way->points[0]);
    uint32_t count = 0;
    double time = 0;
    place last = start;
    for (uint32_t i = 0; i < 2 * way->count - 1; ++i) {
        const place at = house_place(h, way->points[i < way->count ? i : 2 * way->count - 2 - i]);
        const double x = (double)at.x - last.x, y = (double)at.y - last.y, z = (double)at.z - last.z;
        time += sqrt(x * x + y * y + z * z) / METRE / speed_m_s;
        out[count++] = (key){time, {at.x - start.x, at.y - start.y, at.z - start.z}};
        last = at;
    }
    return count;
}

static void walker_write(json_writer *j, uint32_t number, const house_site *h, const route *way)
{
    static const char *const coats[4] = {"coat_red_860", "coat_blue_2", "coat_green_391", "coat_brown_199"};
    key keys[2 * KEYS_MOST];
    const uint32_t count = keys_of(h, way, keys);
    const spot foot = house_spot(h, way->points[0]);
    const moving parts[3] = {{"legs", number, block_at(foot.x, foot.z, foot.y + .02, .34, .24, .8), "trousers_8", keys, count},
                             {"coat", number, block_at(foot.x, foot.z, foot.y + .83, .46, .3, .62), coats[number % 4], keys, count},
                             {"head", number, block_at(foot.x, foot.z, foot.y + 1.47, .2, .22, .26), "skin_452", keys, count}};
    for (int i = 0; i < 3; ++i) mover_write(j, &parts[i]);
}

static void walkers_write(json_writer *j)
{
    static const struct { uint32_t house; route way; } walkers[WALKERS] = {
        {0, {{{300, 0, 150}, {725, 0, 150}, {725, 20, 0}, {725, 20, -200}, {650, 20, -265}, {400, 20, -265}, {255, 20, -350}, {255, 20, -580}}, 8}},
        {1, {{{255, 20, -600}, {255, 20, -265}, {650, 20, -265}, {900, 20, -265}, {1065, 20, -400}, {1065, 20, -700}}, 6}},
        {3, {{{575, 20, -700}, {575, 20, -350}, {725, 20, -200}, {725, 20, 0}, {725, 0, 120}, {1500, 0, 120}}, 6}},
        {4, {{{650, 20, -265}, {1000, 20, -265}, {1065, 20, -400}, {1065, 20, -760}}, 4}},
        {0, {{{665, -300, -250}, {665, -300, -450}, {665, -300, -900}, {155, -300, -900}, {155, -300, -450}, {155, -300, -300}}, 6}},
        {2, {{{725, 0, 300}, {725, 0, 60}, {725, 20, 0}, {725, 20, -265}, {300, 20, -265}, {255, 20, -400}, {255, 20, -580}}, 7}},
        {4, {{{575, 20, -400}, {575, 20, -610}, {575, 160, -810}, {725, 160, -850}, {725, 320, -580}, {725, 320, -300}, {400, 320, -265}}, 7}},
    };
    for (uint32_t i = 0; i < WALKERS; ++i) walker_write(j, i, flagship_house(walkers[i].house), &walkers[i].way);
}

static void lift_write(json_writer *j)
{
    static const key round[] = {{0, {0, 0, 0}}, {3, {0, 0, 0}}, {7, {0, -34 * METRE / 10, 0}}, {10, {0, -34 * METRE / 10, 0}}, {14, {0, 0, 0}}};
    const house_site *h = flagship_house(FLAGSHIP_CELLAR_HOUSE);
    const moving platform = {"lift", PLAN_OUTSIDE,
                             house_block(h, (local_place){1034, -315, -756}, (local_place){1226, -301, -564}), "iron_metal", round, 5};
    mover_write(j, &platform);
}

void flagship_movers(const zoned_scene *z, json_writer *j)
{
    (void)z;
    cart_write(j);
    walkers_write(j);
    lift_write(j);
}
