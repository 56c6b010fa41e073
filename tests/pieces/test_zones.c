// The order of zones: along any ray through open portals, and in a picture where distances say the opposite.
// SPDX-License-Identifier: MIT
#include "fixture.h"

#include "host/render/render.h"
#include "host/render/zone_order.h"

#include "../common/random.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 5, ROOMS = SIDE * SIDE, WIDE = 160, HIGH = 120, PIXELS = WIDE * HIGH };
static const double ROOM_M = 4, TALL_M = 3, DOOR_FROM_M = 1.25, DOOR_TO_M = 2.75, DOOR_TALL_M = 2.25;

// ---- Rooms in a square, a doorway in each wall between two ----

static void add_zone(scene_builder *b, uint32_t x, uint32_t z)
{
    const double low[3] = {x * ROOM_M, 0, z * ROOM_M}, high[3] = {low[0] + ROOM_M, TALL_M, low[2] + ROOM_M};
    scene_solid_plane planes[6] = {{{0}, 0}};
    for (int k = 0; k < 3; ++k) {
        planes[2 * k].normal[k] = 1;
        planes[2 * k].distance = high[k];
        planes[2 * k + 1].normal[k] = -1;
        planes[2 * k + 1].distance = -low[k];
    }
    const builder_hull hull = {planes, 6};
    const char *fault = NULL;
    char name[32];
    uint32_t zone;
    snprintf(name, sizeof name, "room %u %u", x, z);
    assert_int_equal(scene_builder_zone(b, &(builder_zone){.name = name, .hulls = &hull, .hull_count = 1, .parent = SCENE_NONE}, &zone, &fault), RESULT_OK);
}

// In the wall between the room and the next along x (axis 0) or z (axis 2).
static void add_doorway(scene_builder *b, uint32_t x, uint32_t z, int axis)
{
    const int across = 2 - axis;
    const double corner[3] = {x * ROOM_M, 0, z * ROOM_M};
    const double spots[4][2] = {{DOOR_FROM_M, 0}, {DOOR_TO_M, 0}, {DOOR_TO_M, DOOR_TALL_M}, {DOOR_FROM_M, DOOR_TALL_M}};
    const uint32_t from = x + z * SIDE, to = axis == 0 ? from + 1 : from + SIDE;
    double points[4][3];
    char name[32];
    const char *fault = NULL;
    for (int i = 0; i < 4; ++i) {
        points[i][axis] = corner[axis] + ROOM_M;
        points[i][across] = corner[across] + spots[i][0];
        points[i][1] = spots[i][1];
    }
    snprintf(name, sizeof name, "door %u %u %d", x, z, axis);
    const builder_portal portal = {.name = name, .points = (const double(*)[3])points, .point_count = 4, .zones = {from, to}, .door = SCENE_NONE};
    assert_int_equal(scene_builder_portal(b, &portal, &(uint32_t){0}, &fault), RESULT_OK);
}

typedef struct glass { double middle[3], u[3], v[3]; uint32_t colour; } glass;

static void add_glass(scene_builder *b, const glass *g, uint32_t number)
{
    static const double signs[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    const uint32_t indices[6] = {0, 1, 2, 0, 2, 3}, two = 2;
    builder_vertex vertices[4] = {{{0}, {0}, {0}}};
    uint32_t material, first, loop[4], moved[6];
    double n[3], size = 0;
    char name[32];
    snprintf(name, sizeof name, "glass %u", number);
    assert_int_equal(scene_builder_material(b, name, strlen(name), MATERIAL_TRANSLUCENT, &material), RESULT_OK);
    assert_int_equal(scene_builder_material_colour(b, material, g->colour), RESULT_OK);
    for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 3; ++k) vertices[i].position[k] = g->middle[k] + signs[i][0] * g->u[k] + signs[i][1] * g->v[k];
    assert_int_equal(scene_builder_vertices(b, vertices, 4, material, &first), RESULT_OK);
    for (uint32_t i = 0; i < 4; ++i) loop[i] = first + i;
    for (int i = 0; i < 6; ++i) moved[i] = first + indices[i];
    builder_item item = {.indices = moved, .polygon_triangles = &two, .loop = loop, .index_count = 6, .polygon_count = 1, .loop_count = 4,
                         .material = material, .flags = CULL_ITEM_WALL};
    for (int k = 0; k < 3; ++k) {
        n[k] = g->u[(k + 1) % 3] * g->v[(k + 2) % 3] - g->u[(k + 2) % 3] * g->v[(k + 1) % 3];
        size += n[k] * n[k];
    }
    for (int k = 0; k < 3; ++k) {
        item.plane[k] = n[k] / sqrt(size);
        item.plane[3] -= item.plane[k] * g->middle[k];
    }
    assert_int_equal(scene_builder_item(b, &item), RESULT_OK);
}

static scene *rooms_with(const glass *panes, uint32_t count)
{
    scene_builder *b = NULL;
    scene *s = NULL;
    report r = report_to_stderr();
    uint32_t object;
    assert_int_equal(scene_builder_open(allocator_heap(), &b), RESULT_OK);
    assert_int_equal(scene_builder_object(b, "glass", 5, &object), RESULT_OK);
    for (uint32_t i = 0; i < count; ++i) add_glass(b, &panes[i], i);
    for (uint32_t i = 0; i < ROOMS; ++i) add_zone(b, i % SIDE, i / SIDE);
    for (uint32_t i = 0; i < ROOMS; ++i) {
        if (i % SIDE + 1 < SIDE) add_doorway(b, i % SIDE, i / SIDE, 0);
        if (i / SIDE + 1 < SIDE) add_doorway(b, i % SIDE, i / SIDE, 2);
    }
    assert_int_equal(scene_builder_finish(b, "rooms", &r, &s), RESULT_OK);
    scene_builder_close(b);
    return s;
}

// ---- Along rays ----

static int is_in_doorway(double along, double y)
{
    const double at = along - floor(along / ROOM_M) * ROOM_M;
    return at > DOOR_FROM_M && at < DOOR_TO_M && y > 0 && y < DOOR_TALL_M;
}

// Walks from room to room while doorways let the ray through. Returns how many it goes through.
static uint32_t follow(const zone_order *o, const double eye[3], const double along[3])
{
    int room[2] = {(int)floor(eye[0] / ROOM_M), (int)floor(eye[2] / ROOM_M)};
    const double from[2] = {eye[0], eye[2]}, step[2] = {along[0], along[2]};
    uint32_t rooms = 0, last = o->ranks[room[0] + room[1] * SIDE];
    for (;;) {
        double t[2];
        for (int k = 0; k < 2; ++k) t[k] = step[k] == 0 ? INFINITY : ((room[k] + (step[k] > 0)) * ROOM_M - from[k]) / step[k];
        const int k = t[0] < t[1] ? 0 : 1;
        if (t[k] == INFINITY || !is_in_doorway(from[1 - k] + t[k] * step[1 - k], eye[1] + t[k] * along[1])) return rooms;
        room[k] += step[k] > 0 ? 1 : -1;
        if (room[k] < 0 || room[k] >= SIDE) return rooms;
        const uint32_t rank = o->ranks[room[0] + room[1] * SIDE];
        assert_int_not_equal(rank, SCENE_NONE);
        assert_true(rank > last || t[k] == 0); // of length 0: the eye is in the portal's plane
        last = rank;
        rooms++;
    }
}

static void a_ray_goes_through_zones_in_their_order(void **state)
{
    (void)state;
    const glass one = {{2, 1, 2}, {0.5, 0, 0}, {0, 0.5, 0}, 0xff0000ff};
    scene *s = rooms_with(&one, 1);
    zone_order o;
    uint64_t seed = 1;
    uint32_t through = 0;
    assert_int_equal(zone_order_open(s->zone_count, allocator_heap(), &o), RESULT_OK);
    for (int i = 0; i < 2000; ++i) {
        double eye[3] = {random_between(&seed, 0, SIDE * ROOM_M), random_between(&seed, 0.1, 2.1), random_between(&seed, 0, SIDE * ROOM_M)};
        if (i % 4 == 0) eye[i % 8 ? 0 : 2] = ROOM_M * random_below(&seed, SIDE); // in the plane of portals
        for (uint32_t z = 0; z < s->zone_count; ++z) o.keys[z] = random_between(&seed, 0, 100); // whatever the distances
        zone_order_run(&o, s, eye);
        for (int k = 0; k < 100; ++k) {
            const double turn = random_between(&seed, 0, 6.2831853), along[3] = {cos(turn), random_between(&seed, -0.05, 0.05), sin(turn)};
            through += follow(&o, eye, along);
        }
    }
    assert_true(through > 20000);
    zone_order_close(&o, allocator_heap());
    scene_free(s, allocator_heap());
}

static void zones_that_portals_leave_free_go_by_distance(void **state)
{
    (void)state;
    const glass one = {{2, 1, 2}, {0.5, 0, 0}, {0, 0.5, 0}, 0xff0000ff};
    scene *s = rooms_with(&one, 1);
    zone_order o;
    const double eye[3] = {2, 1, 2};
    assert_int_equal(zone_order_open(s->zone_count, allocator_heap(), &o), RESULT_OK);
    for (uint32_t z = 0; z < s->zone_count; ++z) o.keys[z] = INFINITY;
    o.keys[1] = 5; // beside the eye's room, along x and along z: no ray goes through both
    o.keys[SIDE] = 4;
    zone_order_run(&o, s, eye);
    assert_true(o.ranks[SIDE] < o.ranks[1]);
    o.keys[SIDE] = 6;
    zone_order_run(&o, s, eye);
    assert_true(o.ranks[1] < o.ranks[SIDE]);
    zone_order_close(&o, allocator_heap());
    scene_free(s, allocator_heap());
}

static void a_ring_of_portals_ends_and_ranks_all(void **state)
{
    (void)state;
    scene_zone zones[3] = {{.name = "a"}, {.name = "b"}, {.name = "c"}};
    scene_portal portals[3] = {{.name = "ab", .zones = {0, 1}, .plane = {1, 0, 0, 1}},
                               {.name = "bc", .zones = {1, 2}, .plane = {1, 0, 0, 1}},
                               {.name = "ca", .zones = {2, 0}, .plane = {1, 0, 0, 1}}};
    uint32_t ways[6] = {0, 5, 1, 2, 3, 4};
    for (uint32_t z = 0; z < 3; ++z) {
        zones[z].first_portal = 2 * z;
        zones[z].portal_count = 2;
    }
    const scene s = {.zones = zones, .zone_count = 3, .portals = portals, .portal_count = 3, .zone_portals = ways};
    zone_order o;
    const double eye[3] = {0, 0, 0}; // on the near side of each: a before b before c before a
    assert_int_equal(zone_order_open(4, allocator_heap(), &o), RESULT_OK); // one more than the scene has
    o.keys[0] = 3;
    o.keys[1] = 1;
    o.keys[2] = 2;
    o.keys[3] = INFINITY;
    zone_order_run(&o, &s, eye);
    assert_int_equal(o.ranks[1] < o.ranks[2] && o.ranks[2] < o.ranks[0], 1); // the nearest first, then as the portals say
    zone_order_close(&o, allocator_heap());
}

// ---- In a picture ----

typedef struct zone_bed {
    report r;
    renderer *g;
    scene *s;
    zone_chain chains[ROOMS];
    uint32_t items[ROOMS][4]; // global ids, in the chain's order
    const cull_pieces *lent[ROOMS];
    render_layout *l;
} zone_bed;

static void open_zones(zone_bed *b)
{
    render_layout_zone zones[ROOMS];
    assert_int_equal(renderer_upload(b->g, b->s, &b->r), RESULT_OK);
    for (uint32_t z = 0; z < ROOMS; ++z) {
        const scene_zone *zone = &b->s->zones[z];
        zones[z] = (render_layout_zone){b->items[z], zone->item_count};
        if (!zone->item_count) continue;
        zone_chain_open(b->s, z, piece_chains[0], &b->chains[z]);
        b->lent[z] = b->chains[z].lent;
        for (uint32_t i = 0; i < zone->item_count; ++i) b->items[z][i] = b->s->zone_items[zone->first_item + zone_chain_item(&b->chains[z], i)];
    }
    assert_int_equal(render_layout_open(b->g, zones, ROOMS, &b->r, &b->l), RESULT_OK);
}

static void close_zones(zone_bed *b)
{
    render_layout_close(b->l);
    for (uint32_t z = 0; z < ROOMS; ++z) zone_chain_close(&b->chains[z]);
    scene_free(b->s, allocator_heap());
}

// Panes by number, SCENE_NONE: none.
static void draw_pane(zone_bed *b, uint32_t pane)
{
    for (uint32_t z = 0; z < ROOMS; ++z)
        for (uint32_t i = 0; i < b->s->zones[z].item_count; ++i)
            if (b->items[z][i] == pane) renderer_draw(b->g, b->l, z, &(cull_run){i, 1}, 1);
}

static void draw(zone_bed *b, const camera *c, uint32_t first, uint32_t second, uint8_t *rgba)
{
    const frame_request q = {.camera = c, .width_px = WIDE, .height_px = HIGH, .mode = RENDER_SHADED};
    assert_int_equal(renderer_begin(b->g, &q, &b->r), RESULT_OK);
    draw_pane(b, first);
    draw_pane(b, second);
    renderer_end(b->g);
    assert_int_equal(renderer_read(b->g, rgba, &b->r), RESULT_OK);
}

// Of pixels of a part of the picture where both panes are seen, how many show the one before the other, and how many the other way
// round.
typedef struct columns { int first, end; } columns;
static void count_orders(zone_bed *b, const camera *c, const uint32_t panes[2], columns within, uint32_t out[2])
{
    static uint8_t none[4 * PIXELS], single[2][4 * PIXELS], both[4 * PIXELS];
    draw(b, c, SCENE_NONE, SCENE_NONE, none);
    for (int i = 0; i < 2; ++i) draw(b, c, panes[i], SCENE_NONE, single[i]);
    draw(b, c, panes[0], panes[1], both);
    out[0] = out[1] = 0;
    for (int p = 0; p < PIXELS; ++p)
        for (int first = 0; first < 2; ++first) {
            int fits = p % WIDE >= within.first && p % WIDE < within.end;
            if (memcmp(none + 4 * p, single[0] + 4 * p, 3) == 0 || memcmp(none + 4 * p, single[1] + 4 * p, 3) == 0) continue;
            for (int k = 0; k < 3; ++k) { // the near one over the far one's picture: half of that and half its colour, 2 * single - none
                const double expected = single[1 - first][4 * p + k] / 2.0 + single[first][4 * p + k] - none[4 * p + k] / 2.0;
                fits &= fabs(expected - both[4 * p + k]) <= 2.5;
            }
            out[first] += (uint32_t)fits;
        }
}

// Pane 0 is before pane 1, and has its middle farther away.
static void assert_nearer_is_before(zone_bed *b, const glass panes[2], const camera *c)
{
    const columns all = {0, WIDE};
    uint32_t orders[2];
    b->s = rooms_with(panes, 2);
    open_zones(b);
    count_orders(b, c, (const uint32_t[2]){0, 1}, all, orders);
    assert_true(orders[1] > 100); // by distance the wrong one is
    assert_int_equal(orders[0], 0);
    assert_int_equal(render_layout_pieces(b->l, b->lent, &b->r), RESULT_OK);
    count_orders(b, c, (const uint32_t[2]){0, 1}, all, orders);
    assert_true(orders[0] > 100);
    assert_int_equal(orders[1], 0);
    count_orders(b, c, (const uint32_t[2]){1, 0}, all, orders); // drawn in another order: the same
    assert_true(orders[1] > 100);
    assert_int_equal(orders[0], 0);
    close_zones(b);
}

// Near panes start before the eye and have their middle far back in the room.
static const glass pair[2] = {{{2.05, 1.2, 2.6}, {1.85, 0, -1.3}, {0, 1, 0}, 0xff2020ff}, {{4.5, 1.2, 2.3}, {0, 0, 0.6}, {0, 0.8, 0}, 0xff20ff20}};
static const camera at_pair = {.eye = {3.4, 1.2, 1.4}, .forward = {1.1, 0, 0.9}, .up = {0, 1, 0}, .fovy_deg = 70, .aspect = (double)WIDE / HIGH,
                               .near_m = 1.0 / 16, .far_m = INFINITY};

static void the_zone_in_front_is_in_front_however_far_its_glass_reaches(void **state)
{
    assert_nearer_is_before(*state, pair, &at_pair); // one on each side of a doorway
}

static void in_a_zone_far_from_the_scene_s_origin_too(void **state)
{
    // The same two, a little smaller and nearer, both in the last room.
    const double to[3] = {15.8, 0, 16};
    glass moved[2] = {{{2.05, 1.2, 2.6}, {1.75, 0, -1.23}, {0, 1, 0}, 0xff2020ff}, {{4.1, 1.2, 2.3}, {0, 0, 0.6}, {0, 0.8, 0}, 0xff20ff20}};
    camera c = at_pair;
    for (int k = 0; k < 3; ++k) {
        for (int i = 0; i < 2; ++i) moved[i].middle[k] += to[k];
        c.eye[k] += to[k];
    }
    assert_nearer_is_before(*state, moved, &c);
}

static void panes_that_cross_there_are_cut_where_they_do(void **state)
{
    zone_bed *b = *state;
    const glass panes[2] = {{{18, 1.5, 18}, {1.2, 0, 0.7}, {0, 1, 0}, 0xff2020ff}, {{18, 1.5, 18}, {1.2, 0, -0.7}, {0, 1, 0}, 0xff20ff20}};
    camera c = at_pair;
    const double eyes[2][3] = {{18, 1.5, 16.2}, {18, 1.5, 19.8}};
    b->s = rooms_with(panes, 2);
    open_zones(b);
    assert_int_equal(render_layout_pieces(b->l, b->lent, &b->r), RESULT_OK);
    for (int i = 0; i < 2; ++i) {
        uint32_t orders[2];
        memcpy(c.eye, eyes[i], sizeof c.eye);
        c.forward[0] = 0;
        c.forward[2] = i ? -1 : 1;
        for (int nearer = 0; nearer < 2; ++nearer) { // on the left the second comes nearer, from either side
            count_orders(b, &c, (const uint32_t[2]){0, 1}, nearer ? (columns){0, WIDE / 2} : (columns){WIDE / 2, WIDE}, orders);
            assert_true(orders[nearer] > 100);
            assert_int_equal(orders[1 - nearer], 0);
        }
    }
    close_zones(b);
}

static int setup(void **state)
{
    zone_bed *b = calloc(1, sizeof *b);
    if (!b) return -1;
    b->r = report_to_stderr();
    *state = b;
    return 0;
}

static int setup_gl(void **state)
{
    if (setup(state) != 0) return -1;
    zone_bed *b = *state;
    return renderer_open(NULL, allocator_heap(), &b->r, &b->g) == RESULT_OK ? 0 : -1;
}

static int teardown(void **state)
{
    zone_bed *b = *state;
    const uint32_t errors = renderer_errors(b->g);
    renderer_close(b->g);
    free(b);
    return errors ? -1 : 0;
}

int main(void)
{
    const struct CMUnitTest orders[] = {
        cmocka_unit_test(a_ray_goes_through_zones_in_their_order),
        cmocka_unit_test(zones_that_portals_leave_free_go_by_distance),
        cmocka_unit_test(a_ring_of_portals_ends_and_ranks_all),
    };
    const struct CMUnitTest pictures[] = {
        cmocka_unit_test_setup_teardown(the_zone_in_front_is_in_front_however_far_its_glass_reaches, setup_gl, teardown),
        cmocka_unit_test_setup_teardown(in_a_zone_far_from_the_scene_s_origin_too, setup_gl, teardown),
        cmocka_unit_test_setup_teardown(panes_that_cross_there_are_cut_where_they_do, setup_gl, teardown),
    };
    renderer *g = NULL;
    report r = report_to_stderr();
    const int failed = cmocka_run_group_tests(orders, NULL, NULL);
    if (failed || renderer_open(NULL, allocator_heap(), &r, &g) == RESULT_NO_GL) {
        if (!failed) fprintf(stderr, "SKIPPED: pictures, no OpenGL 4.5 on this machine\n");
        return failed ? failed : 77;
    }
    renderer_close(g);
    return cmocka_run_group_tests(pictures, NULL, NULL);
}
