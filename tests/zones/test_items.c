// Tests of which zones list which item, against a loop over all hulls.
// SPDX-License-Identifier: MIT
#include "zone_scene.h"

#include "tests/common/random.h"
#include "tests/common/test.h"

#include <portcullis/box.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int lists(const scene *s, uint32_t zone, uint32_t item)
{
    const scene_zone *z = &s->zones[zone];
    for (uint32_t i = z->first_item; i < z->first_item + z->item_count; ++i)
        if (s->zone_items[i] == item) return 1;
    return 0;
}

static void put_box(builder_fixture *f, const zone_box *box)
{
    static const uint32_t sides[2] = {0, 7};
    builder_vertex v[3] = {0};
    uint32_t first;
    for (uint32_t c = 0; c < 3; ++c)
        for (int k = 0; k < 3; ++k) v[c].position[k] = sides[c % 2] >> k & 1 ? box->max[k] : box->min[k];
    assert_int_equal(scene_builder_vertices(f->builder, v, 3, 0, &first), RESULT_OK);
    const uint32_t indices[3] = {first, first + 1, first + 2};
    const builder_item item = {.indices = indices, .index_count = 3, .polygon_count = 1};
    assert_int_equal(scene_builder_item(f->builder, &item), RESULT_OK);
}

static void a_scene_without_zones_has_one_that_is_everywhere_and_lists_all(void **state)
{
    builder_fixture *f = *state;
    for (int i = 0; i < 5; ++i) put_box(f, &(zone_box){{i, 0, 0}, {i + 1, 1, 1}});
    assert_int_equal(builder_fixture_finish(f), RESULT_OK);
    const scene *s = f->scene;
    assert_int_equal(s->zone_count, 1);
    assert_string_equal(s->zones[0].name, "all");
    assert_int_equal(s->zones[0].flags, ZONE_EVERYWHERE);
    assert_int_equal(s->zones[0].parent, SCENE_NONE);
    assert_int_equal(s->zones[0].item_count, 5);
    for (uint32_t i = 0; i < 5; ++i) {
        assert_int_equal(s->zone_items[i], i);
        assert_int_equal(s->listings[i], 1);
    }
    assert_memory_equal(s->zones[0].origin, s->whole.origin, sizeof s->whole.origin);
    assert_int_equal(s->stray_items, 0);
}

// The least and the most height of the box's corners over the hull's planes, in metres.
typedef struct reach { double least, most; } reach;
static reach reach_of(const scene *s, uint32_t hull, uint32_t item)
{
    const cull_box b = cull_box_at(&s->boxes, item);
    const scene_hull *h = &s->hulls[hull];
    reach r = {-INFINITY, -INFINITY};
    for (uint32_t p = h->first_plane; p < h->first_plane + h->plane_count; ++p) {
        double low = INFINITY;
        for (int c = 0; c < 8; ++c) {
            const double at[3] = {(double)(c & 1 ? b.max.x : b.min.x) + s->whole.origin[0], (double)(c & 2 ? b.max.y : b.min.y) + s->whole.origin[1],
                                  (double)(c & 4 ? b.max.z : b.min.z) + s->whole.origin[2]};
            const double *n = s->hull_planes[p].normal, height = n[0] * at[0] + n[1] * at[1] + n[2] * at[2] - s->hull_planes[p].distance;
            low = fmin(low, height);
            r.most = fmax(r.most, height);
        }
        r.least = fmax(r.least, low);
    }
    const double low[3] = {(double)b.min.x, (double)b.min.y, (double)b.min.z}, high[3] = {(double)b.max.x, (double)b.max.y, (double)b.max.z};
    for (int k = 0; k < 3; ++k) { // the hull's bounds are planes too
        const double slack = 1e-8 * (h->max[k] - h->min[k]);
        r.least = fmax(r.least, low[k] + s->whole.origin[k] - h->max[k] - slack);
        r.least = fmax(r.least, h->min[k] - (high[k] + s->whole.origin[k]) - slack);
    }
    return r;
}

static int expected(const scene *s, uint32_t zone, const reach *reaches)
{
    int touched = (s->zones[zone].flags & ZONE_EVERYWHERE) != 0, taken = 0;
    for (uint32_t h = 0; h < s->hull_count; ++h) {
        const reach r = reaches[h];
        const uint32_t owner = s->hulls[h].zone;
        if (owner == zone && r.least <= s->step) touched = 1;
        if (s->zones[owner].parent == zone && r.most < -2 * s->step) taken = 1;
    }
    return touched && !taken;
}

static void assert_items_are_as_expected(const scene *s)
{
    enum { HULLS_MOST = 256 };
    reach reaches[HULLS_MOST];
    uint32_t stray = 0, listed = 0;
    assert_true(s->hull_count <= HULLS_MOST);
    for (uint32_t i = 0; i < s->item_count; ++i) {
        uint32_t zones = 0;
        for (uint32_t h = 0; h < s->hull_count; ++h) reaches[h] = reach_of(s, h, i);
        for (uint32_t z = 0; z < s->zone_count; ++z) {
            if (s->zones[z].flags & ZONE_STRAY) continue;
            const int wanted = expected(s, z, reaches);
            assert_int_equal(lists(s, z, i), wanted);
            zones += (uint32_t)wanted;
        }
        stray += zones == 0;
        assert_int_equal(s->listings[i], zones ? zones : 1);
        listed += zones ? zones : 1;
    }
    assert_int_equal(s->stray_items, stray);
    assert_int_equal(s->zone_item_count, listed);
    const scene_zone *last = &s->zones[s->zone_count - 1];
    assert_int_equal((last->flags & ZONE_STRAY) != 0, stray != 0);
    if (stray) assert_int_equal(last->item_count, stray);
    for (uint32_t z = 0; z < s->zone_count; ++z)
        for (uint32_t i = 1; i < s->zones[z].item_count; ++i)
            assert_true(s->zone_items[s->zones[z].first_item + i - 1] < s->zone_items[s->zones[z].first_item + i]);
}

static void every_item_is_in_just_the_zones_that_a_loop_over_all_hulls_finds(void **state)
{
    builder_fixture *f = *state;
    for (uint64_t seed = 0; seed < 24; ++seed) {
        builder_fixture_restart(f);
        const zone_scene z = {.zones = 1 + (uint32_t)seed * 3, .items = 200, .seed = seed, .outside = (zone_outside)(seed % 3)};
        assert_int_equal(zone_scene_make(&z, &f->memory.memory, &f->lines.report, &f->scene), RESULT_OK);
        assert_items_are_as_expected(f->scene);
        assert_true(z.outside == OUTSIDE_NONE || f->scene->stray_items == 0);
    }
}

static void an_item_on_a_border_is_in_both_zones_and_one_inside_is_in_one(void **state)
{
    builder_fixture *f = *state;
    uint32_t left, right;
    assert_int_equal(add_box_zone(f->builder, "left", &(zone_box){{0, 0, 0}, {4, 4, 4}}, SCENE_NONE, &left), RESULT_OK);
    assert_int_equal(add_box_zone(f->builder, "right", &(zone_box){{4, 0, 0}, {8, 4, 4}}, SCENE_NONE, &right), RESULT_OK);
    put_box(f, &(zone_box){{1, 1, 1}, {2, 2, 2}});
    put_box(f, &(zone_box){{5, 1, 1}, {6, 2, 2}});
    put_box(f, &(zone_box){{3, 1, 1}, {4, 2, 2}});       // touches the border from the left
    put_box(f, &(zone_box){{3, 1, 1}, {5, 2, 2}});       // goes through it
    put_box(f, &(zone_box){{0, -3, 0}, {8, -1, 4}});     // under the floor
    put_box(f, &(zone_box){{-90, -90, -90}, {90, 90, 90}}); // larger than all
    assert_int_equal(builder_fixture_finish(f), RESULT_OK);
    const scene *s = f->scene;
    static const uint32_t in_left[] = {1, 0, 1, 1, 0, 1}, in_right[] = {0, 1, 1, 1, 0, 1};
    for (uint32_t i = 0; i < 6; ++i) {
        assert_int_equal(lists(s, left, i), in_left[i]);
        assert_int_equal(lists(s, right, i), in_right[i]);
    }
    assert_int_equal(s->zone_count, 3);
    assert_string_equal(s->zones[2].name, "(stray)");
    assert_int_equal(s->zones[2].flags, ZONE_STRAY);
    assert_true(lists(s, 2, 4));
    assert_int_equal(s->stray_items, 1);
}

static void a_house_in_the_open_takes_what_lies_wholly_in_it_and_shares_its_walls(void **state)
{
    builder_fixture *f = *state;
    uint32_t open, house, room;
    assert_int_equal(add_box_zone(f->builder, "house", &(zone_box){{0, 0, 0}, {10, 4, 10}}, SCENE_NONE, &house), RESULT_OK);
    assert_int_equal(add_box_zone(f->builder, "room", &(zone_box){{1, 0, 1}, {4, 3, 4}}, house, &room), RESULT_OK);
    assert_int_equal(add_everywhere(f->builder, "open", &open), RESULT_OK);
    put_box(f, &(zone_box){{6, 1, 6}, {7, 2, 7}});     // house
    put_box(f, &(zone_box){{2, 1, 2}, {3, 2, 3}});     // room
    put_box(f, &(zone_box){{2, 0, 2}, {3, 2, 3}});     // room, on the floor of all three
    put_box(f, &(zone_box){{20, 0, 20}, {21, 1, 21}}); // open
    put_box(f, &(zone_box){{9, 1, 5}, {11, 2, 6}});    // house and open
    assert_int_equal(builder_fixture_finish(f), RESULT_OK);
    const scene *s = f->scene;
    assert_int_equal(s->zones[house].parent, open); // though it comes later
    assert_int_equal(s->zones[room].parent, house);
    assert_int_equal(s->zones[open].parent, SCENE_NONE);
    static const uint32_t expected_in[5][3] = {{1, 0, 0}, {0, 1, 0}, {1, 1, 1}, {0, 0, 1}, {1, 0, 1}};
    for (uint32_t i = 0; i < 5; ++i)
        for (uint32_t z = 0; z < 3; ++z) assert_int_equal(lists(s, z, i), expected_in[i][z]);
}

static scene *made_through(builder_fixture *f, const zone_scene *z, const builder_transform *t)
{
    builder_fixture_restart(f);
    if (t) assert_int_equal(scene_builder_transform(f->builder, t), RESULT_OK);
    assert_int_equal(zone_scene_fill(f->builder, z), RESULT_OK);
    assert_int_equal(builder_fixture_finish(f), RESULT_OK);
    scene *s = f->scene;
    f->scene = NULL;
    return s;
}

static void a_scene_turned_by_quarters_scaled_or_moved_has_the_same_items_in_each_zone(void **state)
{
    builder_fixture *f = *state;
    static const builder_transform ways[] = {{{{0, 0, 1, 0}, {0, 1, 0, 0}, {-1, 0, 0, 0}}}, {{{0, -1, 0, 0}, {1, 0, 0, 0}, {0, 0, 1, 0}}},
                                             {{{4, 0, 0, 0}, {0, 4, 0, 0}, {0, 0, 4, 0}}},  {{{1, 0, 0, 1e7}, {0, 1, 0, -1e5}, {0, 0, 1, 1e3}}}};
    static const zone_scene z = {.zones = 60, .items = 300, .seed = 11};
    for (size_t w = 0; w < sizeof ways / sizeof *ways; ++w) {
        scene *plain = made_through(f, &z, NULL);
        uint32_t *items = calloc(plain->zone_item_count, sizeof *items), *counts = calloc(plain->zone_count, sizeof *counts);
        const uint32_t zone_count = plain->zone_count, item_count = plain->zone_item_count;
        assert_true(items && counts);
        memcpy(items, plain->zone_items, item_count * sizeof *items);
        for (uint32_t i = 0; i < zone_count; ++i) counts[i] = plain->zones[i].item_count;
        scene_free(plain, &f->memory.memory);
        scene *turned = made_through(f, &z, &ways[w]);
        assert_int_equal(turned->zone_count, zone_count);
        assert_int_equal(turned->zone_item_count, item_count);
        assert_memory_equal(turned->zone_items, items, item_count * sizeof *items);
        for (uint32_t i = 0; i < zone_count; ++i) assert_int_equal(turned->zones[i].item_count, counts[i]);
        scene_free(turned, &f->memory.memory);
        free(items);
        free(counts);
    }
}

static void a_zone_that_lists_nothing_is_there(void **state)
{
    builder_fixture *f = *state;
    uint32_t used, empty;
    assert_int_equal(add_box_zone(f->builder, "used", &(zone_box){{0, 0, 0}, {4, 4, 4}}, SCENE_NONE, &used), RESULT_OK);
    assert_int_equal(add_box_zone(f->builder, "empty", &(zone_box){{40, 0, 0}, {47, 4, 4}}, SCENE_NONE, &empty), RESULT_OK);
    put_box(f, &(zone_box){{1, 1, 1}, {2, 2, 2}});
    assert_int_equal(builder_fixture_finish(f), RESULT_OK);
    assert_int_equal(f->scene->zone_count, 2);
    assert_int_equal(f->scene->zones[empty].item_count, 0);
    assert_true(f->scene->zones[empty].origin[0] == 44);
}

// ---- Zones that are refused ----

typedef struct bad_zone { builder_zone zone; const char *fault; } bad_zone;

static void zones_that_are_no_zones_are_refused_with_their_fault(void **state)
{
    builder_fixture *f = *state;
    scene_solid_plane room[6], open[6], empty[6], flat[6], nan[6], infinite[6], no_normal[6], far[6], many[257];
    box_planes(&(zone_box){{0, 0, 0}, {4, 4, 4}}, room);
    scene_solid_plane *const copies[] = {open, empty, flat, nan, infinite, no_normal};
    for (size_t i = 0; i < sizeof copies / sizeof *copies; ++i) memcpy(copies[i], room, sizeof room);
    box_planes(&(zone_box){{0, 0, 0}, {1.5e9, 4, 4}}, far);
    for (int i = 0; i < 257; ++i) many[i] = room[i % 6];
    open[1] = open[0];
    empty[3].distance = -5; // x >= 5 and x <= 4
    flat[3].distance = -4;  // 4 and 4
    nan[2].normal[1] = NAN;
    infinite[2].distance = INFINITY;
    memset(no_normal[4].normal, 0, sizeof no_normal[4].normal);
    const builder_hull hulls[] = {{room, 6},      {open, 6}, {empty, 6},  {flat, 6}, {nan, 6}, {infinite, 6},
                                  {no_normal, 6}, {far, 6},  {many, 257}, {room, 1}, {room, 0}};
    const bad_zone bad[] = {
        {{.name = "", .hulls = hulls, .hull_count = 1, .parent = SCENE_NONE}, "has no name"},
        {{.name = "hall", .hulls = hulls, .hull_count = 1, .parent = SCENE_NONE}, "has a name that is taken"},
        {{.name = "z", .hulls = hulls, .hull_count = 1, .parent = 1}, "lies in a zone that is not there"},
        {{.name = "z", .parent = 0}, "has no hull, so it is everywhere and lies in no zone"},
        {{.name = "z", .hulls = hulls + 1, .hull_count = 1, .parent = SCENE_NONE}, "has a hull that is not closed on all sides"},
        {{.name = "z", .hulls = hulls + 2, .hull_count = 1, .parent = SCENE_NONE}, "has an empty hull; its planes leave nothing between them"},
        {{.name = "z", .hulls = hulls + 3, .hull_count = 1, .parent = SCENE_NONE}, "has an empty hull; its planes leave nothing between them"},
        {{.name = "z", .hulls = hulls + 4, .hull_count = 1, .parent = SCENE_NONE},
         "has a plane with a number that is not finite, or without a normal"},
        {{.name = "z", .hulls = hulls + 5, .hull_count = 1, .parent = SCENE_NONE},
         "has a plane with a number that is not finite, or without a normal"},
        {{.name = "z", .hulls = hulls + 6, .hull_count = 1, .parent = SCENE_NONE},
         "has a plane with a number that is not finite, or without a normal"},
        {{.name = "z", .hulls = hulls + 7, .hull_count = 1, .parent = SCENE_NONE}, "reaches beyond 1e9 m; move it nearer to the origin"},
        {{.name = "z", .hulls = hulls + 8, .hull_count = 1, .parent = SCENE_NONE}, "has a hull of over 256 planes"},
        {{.name = "z", .hulls = hulls + 9, .hull_count = 1, .parent = SCENE_NONE}, "has a hull that is not closed on all sides"},
        {{.name = "z", .hulls = hulls + 10, .hull_count = 1, .parent = SCENE_NONE}, "has a hull that is not closed on all sides"},
        {{.name = "z", .hulls = hulls, .hull_count = 3, .parent = SCENE_NONE}, "has a hull that is not closed on all sides"},
    };
    uint32_t id = 77;
    const char *fault;
    const builder_zone hall = {.name = "hall", .hulls = hulls, .hull_count = 1, .parent = SCENE_NONE};
    assert_int_equal(scene_builder_zone(f->builder, &hall, &id, &fault), RESULT_OK);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i) {
        assert_int_equal(scene_builder_zone(f->builder, &bad[i].zone, &id, &fault), RESULT_BAD_INPUT);
        assert_string_equal(fault, bad[i].fault);
    }
    assert_int_equal(add_everywhere(f->builder, "open", &id), RESULT_OK);
    const builder_zone second = {.name = "sky", .parent = SCENE_NONE};
    assert_int_equal(scene_builder_zone(f->builder, &second, &id, &fault), RESULT_BAD_INPUT);
    assert_string_equal(fault, "is the second without a hull; one zone may be everywhere");
    put_box(f, &(zone_box){{1, 1, 1}, {2, 2, 2}});
    assert_int_equal(builder_fixture_finish(f), RESULT_OK);
    assert_int_equal(f->scene->zone_count, 2); // what was refused left nothing
    assert_int_equal(f->scene->hull_count, 1);
    assert_int_equal(f->scene->hull_plane_count, 6);
}

static void a_hull_is_measured_wherever_it_lies_and_however_it_is_turned(void **state)
{
    builder_fixture *f = *state;
    static const double places[] = {0, 1e3, 1e5, 1e7, 1e8};
    static const double sizes[] = {0.01, 1, 300};
    for (int i = 0; i < 15; ++i) {
        builder_fixture_restart(f);
        const double at = places[i % 5], size = sizes[i / 5], yaw = 0.3;
        scene_solid_plane planes[6];
        box_planes(&(zone_box){{-size, -size, -size}, {size, size, size}}, planes);
        for (int p = 0; p < 6; ++p) {
            double *n = planes[p].normal;
            const double x = cos(yaw) * n[0] - sin(yaw) * n[2], z = sin(yaw) * n[0] + cos(yaw) * n[2];
            n[0] = x;
            n[2] = z;
            planes[p].distance += at * (n[0] + n[1] + n[2]);
        }
        const builder_hull hull = {planes, 6};
        const builder_zone zone = {.name = "turned", .hulls = &hull, .hull_count = 1, .parent = SCENE_NONE};
        uint32_t id;
        const char *fault;
        assert_int_equal(scene_builder_zone(f->builder, &zone, &id, &fault), RESULT_OK);
        put_box(f, &(zone_box){{at, at, at}, {at + 1, at + 1, at + 1}});
        assert_int_equal(builder_fixture_finish(f), RESULT_OK);
        const scene_hull *h = &f->scene->hulls[0];
        const double reach[3] = {size * (cos(yaw) + sin(yaw)), size, size * (cos(yaw) + sin(yaw))};
        for (int k = 0; k < 3; ++k) {
            assert_true(fabs(h->min[k] - (at - reach[k])) <= 1e-9 * size + 4e-16 * at * 8);
            assert_true(fabs(h->max[k] - (at + reach[k])) <= 1e-9 * size + 4e-16 * at * 8);
        }
    }
}

static void a_ball_of_250_planes_some_of_them_twice_is_measured(void **state)
{
    builder_fixture *f = *state;
    scene_solid_plane planes[250];
    uint64_t random = 21;
    for (int i = 0; i < 250; ++i) {
        double n[3], square = 0;
        for (int k = 0; k < 3; ++k) n[k] = random_between(&random, -1, 1);
        for (int k = 0; k < 3; ++k) square += n[k] * n[k];
        for (int k = 0; k < 3; ++k) planes[i].normal[k] = n[k] / sqrt(square);
        planes[i].distance = 5 + 1e5 * planes[i].normal[1]; // about (0, 1e5, 0)
        if (i % 10 == 9) planes[i] = planes[i / 2];
        if (i % 25 == 24) planes[i].distance += 1e6; // cuts nothing
    }
    const builder_hull hull = {planes, 250};
    const builder_zone zone = {.name = "ball", .hulls = &hull, .hull_count = 1, .parent = SCENE_NONE};
    uint32_t id;
    const char *fault;
    assert_int_equal(scene_builder_zone(f->builder, &zone, &id, &fault), RESULT_OK);
    put_box(f, &(zone_box){{-1, 1e5 - 1, -1}, {1, 1e5 + 1, 1}});
    assert_int_equal(builder_fixture_finish(f), RESULT_OK);
    const scene_hull *h = &f->scene->hulls[0];
    for (int k = 0; k < 3; ++k) { // the ball's box, and corners a little outside of it
        const double middle = k == 1 ? 1e5 : 0;
        assert_true(h->min[k] <= middle - 5 && h->min[k] > middle - 6.5);
        assert_true(h->max[k] >= middle + 5 && h->max[k] < middle + 6.5);
    }
    assert_int_equal(f->scene->stray_items, 0);
}

// ---- Overlaps ----

static void zones_side_by_side_that_overlap_are_named_and_others_are_not(void **state)
{
    builder_fixture *f = *state;
    static const zone_box boxes[] = {{{0, 0, 0}, {4, 4, 4}},      {{3.98, 0, 0}, {8, 4, 4}},     // over 1 cm into the first
                                     {{0, 4, 0}, {4, 8, 4}},      {{0, 7.995, 0}, {4, 12, 4}}}; // they meet; they overlap by 5 mm
    static const char *const names[] = {"west", "east", "up", "attic"};
    uint32_t id;
    for (int i = 0; i < 4; ++i) assert_int_equal(add_box_zone(f->builder, names[i], &boxes[i], SCENE_NONE, &id), RESULT_OK);
    assert_int_equal(add_box_zone(f->builder, "cupboard", &(zone_box){{1, 1, 1}, {2, 2, 2}}, 0, &id), RESULT_OK); // in the first
    put_box(f, &(zone_box){{1, 1, 1}, {2, 2, 2}});
    assert_int_equal(builder_fixture_finish(f), RESULT_OK);
    assert_true(report_lines_is_one_with(&f->lines, "test.scene: warning: the zones \"west\" and \"east\" overlap by over 1 cm"));
}

static void a_thousand_zones_in_one_place_are_not_a_thousand_warnings(void **state)
{
    builder_fixture *f = *state;
    uint32_t id;
    char name[16];
    for (int i = 0; i < 1000; ++i) {
        snprintf(name, sizeof name, "z%d", i);
        assert_int_equal(add_box_zone(f->builder, name, &(zone_box){{0, 0, 0}, {4, 4, 4}}, SCENE_NONE, &id), RESULT_OK);
    }
    put_box(f, &(zone_box){{1, 1, 1}, {2, 2, 2}});
    assert_int_equal(builder_fixture_finish(f), RESULT_OK);
    assert_int_equal(f->lines.count, 9);
    assert_int_equal(f->scene->listings[0], 255); // as high as it counts
    assert_int_equal(f->scene->zone_item_count, 1000);
}

int main(void)
{
#define TEST(t) cmocka_unit_test_setup_teardown(t, builder_fixture_set_up, builder_fixture_tear_down)
    const struct CMUnitTest tests[] = {
        TEST(a_scene_without_zones_has_one_that_is_everywhere_and_lists_all),
        TEST(every_item_is_in_just_the_zones_that_a_loop_over_all_hulls_finds),
        TEST(an_item_on_a_border_is_in_both_zones_and_one_inside_is_in_one),
        TEST(a_house_in_the_open_takes_what_lies_wholly_in_it_and_shares_its_walls),
        TEST(a_scene_turned_by_quarters_scaled_or_moved_has_the_same_items_in_each_zone),
        TEST(a_zone_that_lists_nothing_is_there),
        TEST(zones_that_are_no_zones_are_refused_with_their_fault),
        TEST(a_hull_is_measured_wherever_it_lies_and_however_it_is_turned),
        TEST(a_ball_of_250_planes_some_of_them_twice_is_measured),
        TEST(zones_side_by_side_that_overlap_are_named_and_others_are_not),
        TEST(a_thousand_zones_in_one_place_are_not_a_thousand_warnings),
    };
    return cmocka_run_group_tests_name("zones items", tests, NULL, NULL);
}
