// The street of the demo scene: ground, houses with windows and roofs on both sides, trees, lamps, cars, benches.
// SPDX-License-Identifier: MIT
#include "generate_demo.h"

#include "generate_models.h"

enum {
    TENTH = METRE / 10,
    STREET_END = 680 * TENTH,     // houses stand from -68 m to 68 m
    GROUND_END = 900 * TENTH,
    STOREY = 32 * TENTH,
    WINDOW_SILL = 9 * TENTH,
    WINDOW_HEAD = 24 * TENTH,
    WINDOW_WIDE = 12 * TENTH,
    WINDOW_DEEP = 2 * TENTH,
    DEPTH = 110 * TENTH,          // of a house
    STOREYS_MOST = 5, COLUMNS_MOST = 6,
    KERB = 12 * CENTIMETRE,
};

// ---- Ground: strips along x, cut into pieces ----

static void strip_write(obj_writer *w, const char *material, int32_t z0, int32_t z1, int32_t y)
{
    const block body = {.min = {-GROUND_END, y - METRE, z0 * TENTH}, .max = {GROUND_END, y, z1 * TENTH}};
    cuts x = {0}, z = {0};
    for (int32_t at = -GROUND_END; at <= GROUND_END; at += 6 * METRE) cuts_add(&x, at);
    for (int32_t at = z0; at < z1; at += 80) cuts_add(&z, at * TENTH);
    cuts_add(&z, z1 * TENTH);
    obj_material(w, material);
    obj_panel(w, &(panel){.body = &body, .side = SIDE_MAX_Y, .facing = FACING_OUT, .u = &x, .v = &z});
}

static void piece_write(obj_writer *w, int32_t x0, int32_t x1, int32_t z0, int32_t z1)
{
    const place corners[4] = {{x0 * TENTH, 0, z0 * TENTH}, {x0 * TENTH, 0, z1 * TENTH}, {x1 * TENTH, 0, z1 * TENTH}, {x1 * TENTH, 0, z0 * TENTH}};
    obj_polygon(w, corners, 4);
}

static void kerb_write(obj_writer *w, int32_t z, side s)
{
    const block body = {.min = {-GROUND_END, -KERB, z * TENTH}, .max = {GROUND_END, 0, z * TENTH}};
    cuts x = {0}, y = {0};
    for (int32_t at = -GROUND_END; at <= GROUND_END; at += 6 * METRE) cuts_add(&x, at);
    cuts_add(&y, -KERB);
    cuts_add(&y, 0);
    obj_panel(w, &(panel){.body = &body, .side = s, .facing = FACING_OUT, .u = &x, .v = &y});
}

static void ground_write(obj_writer *w)
{
    obj_object(w, "road");
    strip_write(w, "road_asphalt", 30, 90, -KERB);
    obj_material(w, "kerb_stone");
    kerb_write(w, 30, SIDE_MAX_Z);
    kerb_write(w, 90, SIDE_MIN_Z);
    obj_object(w, "pavement");
    strip_write(w, "paving_stone", 0, 30, 0);
    strip_write(w, "paving_stone", 90, 120, 0);
    obj_object(w, "lawn");
    strip_write(w, "grass", -600, -220, 0);
    strip_write(w, "grass", 120, 500, 0);
    obj_object(w, "yard");
    obj_material(w, "grass");
    piece_write(w, -900, -150, -220, 0); // beside the museum
    piece_write(w, 150, 900, -220, 0);
}

// ---- Houses ----

typedef struct house {
    block body;
    side front;
    uint32_t storeys, columns, number;
    const char *facade;
    int is_flat; // roof
} house;

static void window_cuts(const house *h, cuts *x, cuts *y)
{
    const int32_t left = h->body.min.x, wide = (h->body.max.x - left) / (int32_t)h->columns;
    cuts_add(x, left);
    cuts_add(x, h->body.max.x);
    for (uint32_t i = 0; i < h->columns; ++i) {
        const int32_t from = left + wide * (int32_t)i + (wide - WINDOW_WIDE) / 2;
        cuts_add(x, from);
        cuts_add(x, from + WINDOW_WIDE);
    }
    cuts_add(y, 0);
    cuts_add(y, h->body.max.y);
    for (uint32_t i = 0; i < h->storeys; ++i) {
        cuts_add(y, STOREY * (int32_t)i + WINDOW_SILL);
        cuts_add(y, STOREY * (int32_t)i + WINDOW_HEAD);
    }
}

static void sill_write(obj_writer *w, const house *h, rectangle q)
{
    const int faces_north = h->front == SIDE_MIN_Z;
    const int32_t wall = faces_north ? h->body.min.z : h->body.max.z, out = 9 * CENTIMETRE;
    obj_block(w, &(block){.min = {q.u0 - 8 * CENTIMETRE, q.v0 - 9 * CENTIMETRE, faces_north ? wall - out : wall + CENTIMETRE / 5},
                          .max = {q.u1 + 8 * CENTIMETRE, q.v0, faces_north ? wall - CENTIMETRE / 5 : wall + out}});
}

static void front_write(obj_writer *w, const house *h, side s)
{
    rectangle openings[STOREYS_MOST * COLUMNS_MOST];
    cuts x = {0}, y = {0};
    panel p = {.body = &h->body, .side = s, .facing = FACING_OUT, .u = &x, .v = &y, .openings = openings};
    window_cuts(h, &x, &y);
    for (uint32_t i = 0; i < h->storeys; ++i)
        for (uint32_t k = 0; k < h->columns; ++k) {
            const int is_door = i == 0 && k == h->columns / 2 && s == h->front;
            const int32_t foot = STOREY * (int32_t)i;
            openings[p.opening_count++] = (rectangle){x.at[2 * k + 1], is_door ? 0 : foot + WINDOW_SILL, x.at[2 * k + 2], foot + WINDOW_HEAD};
        }
    obj_material(w, h->facade);
    obj_panel(w, &p);
    obj_material(w, "frame_stone");
    for (uint32_t i = 0; i < p.opening_count; ++i) obj_reveal(w, &p, i, WINDOW_DEEP);
    for (uint32_t i = 0; i < p.opening_count; ++i) {
        obj_material(w, openings[i].v0 == 0 ? "door_wood" : "window_glass");
        obj_pane(w, &p, i, WINDOW_DEEP);
    }
    if (s != h->front) return;
    obj_material(w, "cornice_stone");
    for (uint32_t i = 0; i < p.opening_count; ++i)
        if (openings[i].v0) sill_write(w, h, openings[i]);
}

static void flat_roof_write(obj_writer *w, const house *h)
{
    const block *b = &h->body;
    const int32_t rim = 25 * CENTIMETRE, gap = CENTIMETRE, top = b->max.y + 7 * TENTH;
    const cuts x = {.at = {b->min.x, b->max.x}, .count = 2}, z = {.at = {b->min.z, b->max.z}, .count = 2};
    obj_material(w, "roof_felt");
    obj_panel(w, &(panel){.body = b, .side = SIDE_MAX_Y, .facing = FACING_OUT, .u = &x, .v = &z});
    obj_material(w, "cornice_stone");
    obj_block(w, &(block){.min = {b->min.x, b->max.y + gap, b->min.z}, .max = {b->max.x, top, b->min.z + rim}});
    obj_block(w, &(block){.min = {b->min.x, b->max.y + gap, b->max.z - rim}, .max = {b->max.x, top, b->max.z}});
    obj_block(w, &(block){.min = {b->min.x, b->max.y + gap, b->min.z + rim + gap}, .max = {b->min.x + rim, top, b->max.z - rim - gap}});
    obj_block(w, &(block){.min = {b->max.x - rim, b->max.y + gap, b->min.z + rim + gap}, .max = {b->max.x, top, b->max.z - rim - gap}});
}

static void gable_roof_write(obj_writer *w, const house *h, int32_t rise)
{
    const block *b = &h->body;
    const int32_t y = b->max.y, middle = (b->min.z + b->max.z) / 2, over = 4 * TENTH, drop = over * rise / (DEPTH / 2);
    const place west[3] = {{b->min.x, y, b->min.z}, {b->min.x, y, b->max.z}, {b->min.x, y + rise, middle}};
    const place east[3] = {{b->max.x, y, b->max.z}, {b->max.x, y, b->min.z}, {b->max.x, y + rise, middle}};
    obj_material(w, h->facade);
    obj_polygon(w, west, 3);
    obj_polygon(w, east, 3);
    // the tiles lie on the gables and reach over the walls: one thick folded sheet
    const int32_t x[2] = {b->min.x - 2 * CENTIMETRE, b->max.x + 2 * CENTIMETRE}, thick = 15 * CENTIMETRE;
    place p[2][6];
    for (int i = 0; i < 2; ++i) {
        p[i][0] = (place){x[i], y - drop + thick, b->min.z - over};
        p[i][1] = (place){x[i], y + rise + thick, middle};
        p[i][2] = (place){x[i], y - drop + thick, b->max.z + over};
        p[i][3] = (place){x[i], y - drop + CENTIMETRE, b->max.z + over};
        p[i][4] = (place){x[i], y + rise + CENTIMETRE, middle};
        p[i][5] = (place){x[i], y - drop + CENTIMETRE, b->min.z - over};
    }
    obj_material(w, "roof_tiles");
    for (int i = 0; i < 6; ++i) {
        const int k = (i + 1) % 6;
        obj_polygon(w, (const place[4]){p[0][i], p[0][k], p[1][k], p[1][i]}, 4);
    }
    obj_polygon(w, (const place[4]){p[0][0], p[0][5], p[0][4], p[0][1]}, 4);
    obj_polygon(w, (const place[4]){p[0][1], p[0][4], p[0][3], p[0][2]}, 4);
    obj_polygon(w, (const place[4]){p[1][0], p[1][1], p[1][4], p[1][5]}, 4);
    obj_polygon(w, (const place[4]){p[1][1], p[1][2], p[1][3], p[1][4]}, 4);
}

static void chimney_write(obj_writer *w, const house *h, random_stream *r)
{
    const block *b = &h->body;
    const int32_t x = random_between(r, b->min.x + METRE, b->max.x - 2 * METRE), z = (b->min.z + b->max.z) / 2 + random_between(r, METRE, 2 * METRE);
    obj_material(w, "brick");
    obj_block(w, &(block){.min = {x, b->max.y + TENTH, z}, .max = {x + 6 * TENTH, b->max.y + 45 * TENTH, z + 6 * TENTH}});
}

static void house_write(obj_writer *w, const house *h, random_stream *r)
{
    const block *b = &h->body;
    cuts x = {0}, y = {0}, z = {.at = {b->min.z, b->max.z}, .count = 2};
    window_cuts(h, &x, &y); // the side walls have the cuts in height of the front, so that they share its vertices
    obj_numbered_object(w, "house", h->number);
    front_write(w, h, SIDE_MIN_Z);
    front_write(w, h, SIDE_MAX_Z);
    obj_material(w, h->facade);
    obj_panel(w, &(panel){.body = b, .side = SIDE_MIN_X, .facing = FACING_OUT, .u = &z, .v = &y});
    obj_panel(w, &(panel){.body = b, .side = SIDE_MAX_X, .facing = FACING_OUT, .u = &z, .v = &y});
    if (h->is_flat) flat_roof_write(w, h);
    else gable_roof_write(w, h, random_between(r, 30, 50) * TENTH);
    if (!h->is_flat) chimney_write(w, h, r);
}

static uint32_t row_write(obj_writer *w, int32_t from, int32_t to, side front, uint32_t number, random_stream *r)
{
    static const char *const facades[5] = {"brick", "plaster_yellow_276", "plaster_white_785", "plaster_rose_695", "sandstone"};
    for (int32_t x = from; x + 9 * METRE <= to;) {
        int32_t wide = random_between(r, 90, 140) * TENTH;
        if (to - x - wide < 10 * METRE) wide = to - x < 16 * METRE ? to - x : (to - x) / 2;
        const int32_t back = random_between(r, 0, 6) * TENTH;
        house h = {.front = front, .number = number++, .is_flat = random_below(r, 3) == 0, .facade = facades[random_below(r, 5)]};
        h.storeys = 2 + random_below(r, STOREYS_MOST - 1);
        h.columns = 3 + random_below(r, COLUMNS_MOST - 3);
        const int32_t z = front == SIDE_MAX_Z ? -DEPTH - back : 12 * METRE + back;
        h.body = (block){.min = {x, 0, z}, .max = {x + wide - 8 * TENTH, STOREY * (int32_t)h.storeys + 4 * TENTH, z + DEPTH}};
        house_write(w, &h, r);
        x += wide;
    }
    return number;
}

// ---- Furniture of the street ----

static void car_write(obj_writer *w, uint32_t number, double x, double z, random_stream *r)
{
    static const char *const paints[4] = {"car_red_360", "car_blue_614", "car_white_126", "car_green_832"};
    static const double outline[8][2] = {{-2.1, .35}, {2.1, .35}, {2.1, .8}, {1.3, .9}, {.7, 1.42}, {-1.2, 1.42}, {-1.8, .9}, {-2.1, .85}};
    place side_a[8], side_b[8];
    for (int i = 0; i < 8; ++i) {
        const block b = block_at(x + outline[i][0], z, outline[i][1] - 0.12, 0, 1.7, 0);
        side_a[i] = (place){b.min.x, b.min.y, b.min.z};
        side_b[7 - i] = (place){b.min.x, b.min.y, b.max.z};
    }
    obj_numbered_object(w, "car", number);
    obj_material(w, paints[random_below(r, 4)]);
    for (int i = 0; i < 8; ++i) {
        const int k = (i + 1) % 8;
        obj_polygon(w, (const place[4]){side_a[i], side_a[k], side_b[7 - k], side_b[7 - i]}, 4);
    }
    // the outline is not convex: cabin and body apart
    static const int parts[3][5] = {{0, 1, 2, 3, 3}, {0, 3, 6, 7, 7}, {3, 4, 5, 6, 6}};
    for (int i = 0; i < 3; ++i) {
        place a[5], b[5];
        for (int k = 0; k < 5; ++k) {
            a[4 - k] = side_a[parts[i][k]];
            b[k] = side_b[7 - parts[i][k]];
        }
        obj_polygon(w, a, 5);
        obj_polygon(w, b, 5);
    }
    obj_material(w, "rubber_8");
    for (int i = 0; i < 4; ++i) model_ball(w, (spot){x + (i % 2 ? 1.35 : -1.35), 0.215, z + (i < 2 ? 0.72 : -0.72)}, 0.33, 12);
}

static void bench_write(obj_writer *w, uint32_t number, double x, double z)
{
    const block parts[4] = {block_at(x, z, .45, 1.8, .45, .05), block_at(x, z + .2, .52, 1.8, .05, .45), block_at(x - .7, z, .01, .08, .4, .43),
                            block_at(x + .7, z, .01, .08, .4, .43)};
    obj_numbered_object(w, "bench", number);
    obj_material(w, "walnut_wood");
    for (int i = 0; i < 4; ++i) obj_block(w, &parts[i]);
}

static void furniture_write(obj_writer *w, random_stream *r)
{
    uint32_t lamps = 0, trees = 0;
    for (int i = -4; i <= 4; ++i) {
        if (i) {
            obj_numbered_object(w, "tree", trees++);
            model_tree(w, (spot){i * 15.0, 0, i % 2 ? 1.9 : 2.1}, 6.5 + 2 * random_unit(r), r);
        }
        obj_numbered_object(w, "tree", trees++);
        model_tree(w, (spot){i * 15.0 + 6, 0, 10.2}, 6.5 + 2 * random_unit(r), r);
        obj_numbered_object(w, "lamp", lamps++);
        obj_material(w, "iron_metal");
        model_lamp(w, (spot){i * 15.0 + 7.5, 0, i % 2 ? 2.5 : 9.5}, 5);
    }
    static const double garden[4][2] = {{-11, -29}, {-3, -33}, {5, -28}, {12, -31}};
    for (int i = 0; i < 4; ++i) {
        obj_numbered_object(w, "tree", trees++);
        model_tree(w, (spot){garden[i][0], 0, garden[i][1]}, 7 + 3 * random_unit(r), r);
    }
    static const double cars[7] = {-52, -33, -21, 47, 24, 37, 57};
    for (uint32_t i = 0; i < 7; ++i) car_write(w, i, cars[i], i % 2 ? 4.1 : 7.9, r);
    bench_write(w, 0, -8, 10.6);
    bench_write(w, 1, 9, 10.6);
    bench_write(w, 2, -22, 0.6);
    bench_write(w, 3, 31, 0.6);
}

void demo_street(obj_writer *w, random_stream *r)
{
    ground_write(w);
    uint32_t number = row_write(w, -STREET_END, -16 * METRE, SIDE_MAX_Z, 0, r);
    number = row_write(w, 16 * METRE, STREET_END, SIDE_MAX_Z, number, r);
    row_write(w, -STREET_END, STREET_END, SIDE_MIN_Z, number, r);
    furniture_write(w, r);
}
