// What the cells promise, one small zone a promise.
// SPDX-License-Identifier: MIT
#include "cells_fixture.h"
#include "tests/common/random.h"
#include "tests/common/test.h"

#include <stdlib.h>
#include <math.h>
#include <string.h>

// ---- Zones ----

static const cull_box ROOM = {{0, 0, 0}, {2, 2, 2}};

typedef struct flat { int axis; float at, low[2], high[2]; } flat; // a rectangle across an axis; low, high: of the next two axes

static void flat_points(const flat *f, int towards, cull_vec3 out[4]) // towards: 1 faces along the axis, -1 against it
{
    static const int around[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (int i = 0; i < 4; i++) {
        float p[3];
        p[f->axis] = f->at;
        p[(f->axis + 1) % 3] = around[i][0] ? f->high[0] : f->low[0];
        p[(f->axis + 2) % 3] = around[i][1] ? f->high[1] : f->low[1];
        out[towards > 0 ? i : 3 - i] = (cull_vec3){p[0], p[1], p[2]};
    }
}

static void put_flat(hand_zone *z, flat f, int towards, uint32_t flags)
{
    cull_vec3 points[4];
    flat_points(&f, towards, points);
    hand_zone_wall(z, points, 4, flags);
}

static void room_init(hand_zone *z)
{
    hand_zone_init(z);
    hand_zone_box(z, ROOM, FACE_IN, 0);
}

static void build(cells_built *b, hand_zone *z)
{
    hand_zone_end(z);
    cells_built_make(b, &z->zone);
}

static void finish(cells_built *b, hand_zone *z)
{
    assert_true(cells_built_free(b));
    hand_zone_free(z);
}

static uint32_t cell_at(const cells_built *b, double x, double y, double z)
{
    const double p[3] = {x, y, z};
    return cell_of(&b->cells, p);
}

static const bsp_opening *way(const cells_built *b, uint32_t from, uint32_t to)
{
    const bsp_cell *cell = &b->cells.cells[from];
    for (uint32_t i = 0; i < cell->opening_count; i++)
        if (b->cells.openings[cell->first_opening + i].to == to) return &b->cells.openings[cell->first_opening + i];
    return NULL;
}

// Of item `item` of the zone: 0 nowhere, bit 0 among the fronts of the cell, bit 1 among its backs.
static int stands(const cells_built *b, uint32_t cell, uint32_t item)
{
    const bsp_cell *c = &b->cells.cells[cell];
    int out = 0;
    for (uint32_t i = 0; i < c->entry_count; i++) out |= b->tree.order[b->cells.entries[c->first_entry + i].item] == item;
    for (uint32_t i = 0; i < c->back_count; i++) out |= 2 * (b->tree.order[b->cells.entries[c->first_back + i].item] == item);
    return out;
}

// ---- Walls ----

static void a_room_is_one_cell_that_nothing_leaves(void **state)
{
    (void)state;
    hand_zone z;
    cells_built b;
    room_init(&z);
    build(&b, &z);
    const uint32_t inside = cell_at(&b, 1, 1, 1);
    assert_int_equal(b.cells.cell_count, 7);
    assert_int_equal(b.cells.node_count, 6);
    assert_int_equal(b.cells.cells[inside].opening_count, 0);
    assert_int_equal(b.cells.cells[inside].entry_count, 6);
    for (uint32_t c = 0; c < 7; c++) {
        if (c == inside) continue;
        assert_non_null(way(&b, c, inside)); // behind a wall one sees through it
        assert_int_equal(b.cells.cells[c].entry_count, 0);
        assert_int_equal(b.cells.cells[c].back_count, 1);
    }
    finish(&b, &z);
}

static void a_box_seen_from_outside_hides_its_inside(void **state)
{
    (void)state;
    hand_zone z;
    cells_built b;
    hand_zone_init(&z);
    hand_zone_box(&z, ROOM, FACE_OUT, 0);
    build(&b, &z);
    const uint32_t inside = cell_at(&b, 1, 1, 1);
    assert_int_equal(b.cells.cells[inside].opening_count, 6);
    assert_int_equal(b.cells.cells[inside].back_count, 6);
    for (uint32_t c = 0; c < b.cells.cell_count; c++) assert_null(way(&b, c, inside));
    finish(&b, &z);
}

// Rooms of [0, 4] and [5, 9] with a tunnel between, y in [0, 2], z in [1, 2]; all [0, 3] in y and z.
static void put_two_rooms(hand_zone *z)
{
    for (int room = 0; room < 2; room++) {
        const float low = room ? 5.0f : 0.0f, high = low + 4, door = room ? low : high, far = room ? high : low;
        const int towards = room ? 1 : -1;
        put_flat(z, (flat){0, far, {0, 0}, {3, 3}}, -towards, 0);
        put_flat(z, (flat){0, door, {2, 0}, {3, 3}}, towards, 0); // above the door, and both sides of it
        put_flat(z, (flat){0, door, {0, 0}, {2, 1}}, towards, 0);
        put_flat(z, (flat){0, door, {0, 2}, {2, 3}}, towards, 0);
        for (int end = 0; end < 2; end++) {
            put_flat(z, (flat){1, end ? 3.0f : 0.0f, {0, low}, {3, high}}, end ? -1 : 1, 0);
            put_flat(z, (flat){2, end ? 3.0f : 0.0f, {low, 0}, {high, 3}}, end ? -1 : 1, 0);
        }
    }
    for (int end = 0; end < 2; end++) {
        put_flat(z, (flat){1, end ? 2.0f : 0.0f, {1, 4}, {2, 5}}, end ? -1 : 1, 0);
        put_flat(z, (flat){2, end ? 2.0f : 1.0f, {4, 0}, {5, 2}}, end ? -1 : 1, 0);
    }
}

static void flood(const cells_built *b, uint32_t from, uint8_t *seen)
{
    if (seen[from]) return;
    seen[from] = 1;
    const bsp_cell *c = &b->cells.cells[from];
    for (uint32_t i = 0; i < c->opening_count; i++) flood(b, b->cells.openings[c->first_opening + i].to, seen);
}

static void a_doorway_is_the_only_way_between_two_rooms(void **state)
{
    (void)state;
    hand_zone z;
    cells_built b;
    hand_zone_init(&z);
    put_two_rooms(&z);
    build(&b, &z);
    uint8_t seen[256] = {0};
    assert_in_range(b.cells.cell_count, 3, 255);
    const uint32_t left = cell_at(&b, 2, 1.5, 1.5), door = cell_at(&b, 4.5, 1, 1.5), right = cell_at(&b, 7, 1.5, 1.5);
    flood(&b, left, seen);
    assert_true(seen[right] && seen[door]);
    uint32_t reached = 0;
    for (uint32_t c = 0; c < b.cells.cell_count; c++) {
        reached += seen[c];
        assert_true(!seen[c] || b.cells.cells[c].entry_count > 0); // no rock
    }
    assert_int_equal(reached, 3);
    const bsp_opening *o = way(&b, left, door);
    assert_int_equal(o->point_count, 4);
    for (uint32_t i = 0; i < 4; i++) {
        const cull_point p = b.cells.opening_points[o->first_point + i];
        assert_true(p.x == 4 && (p.y == 0 || p.y == 2) && (p.z == 1 || p.z == 2));
    }
    finish(&b, &z);
}

// A room with panels across it at x = 1 that face its far side; what eyes there and what eyes here look through.
typedef struct panels { float low[4], high[4]; uint32_t count, flags; } panels; // in y, all of z

static void panels_open(const panels *p, int *from_front, int *from_behind)
{
    hand_zone z;
    cells_built b;
    room_init(&z);
    for (uint32_t i = 0; i < p->count; i++) put_flat(&z, (flat){0, 1, {p->low[i], 0}, {p->high[i], 2}}, 1, p->flags);
    build(&b, &z);
    const uint32_t front = cell_at(&b, 1.5, 1, 1), behind = cell_at(&b, 0.5, 1, 1);
    assert_int_not_equal(front, behind);
    *from_front = way(&b, front, behind) != NULL;
    *from_behind = way(&b, behind, front) != NULL;
    for (uint32_t i = 0; i < p->count; i++) {
        assert_int_equal(stands(&b, front, 6 + i), 1);
        assert_int_equal(stands(&b, behind, 6 + i), 2);
    }
    finish(&b, &z);
}

static void expect_panels(const panels *p, int from_front, int from_behind)
{
    int front, behind;
    panels_open(p, &front, &behind);
    assert_int_equal(front, from_front);
    assert_int_equal(behind, from_behind);
}

static void a_wall_hides_from_its_front_alone(void **state)
{
    (void)state;
    expect_panels(&(panels){{0}, {2}, 1, 0}, 0, 1);
    expect_panels(&(panels){{0}, {2}, 1, CULL_ITEM_TWO_SIDED}, 0, 0);
}

static void what_is_seen_through_hides_nothing(void **state)
{
    (void)state;
    expect_panels(&(panels){{0}, {2}, 1, CULL_ITEM_SEE_THROUGH}, 1, 1);
    expect_panels(&(panels){{0}, {2}, 1, CULL_ITEM_CUT_OUT}, 1, 1);
    expect_panels(&(panels){{0}, {2}, 1, CULL_ITEM_SEE_THROUGH | CULL_ITEM_TWO_SIDED}, 1, 1);
}

static void walls_hide_together_what_they_cover_together(void **state)
{
    (void)state;
    expect_panels(&(panels){{0, 1}, {1, 2}, 2, 0}, 0, 1);
    expect_panels(&(panels){{0, 0.75f}, {1.25f, 2}, 2, 0}, 0, 1);      // they overlap
    expect_panels(&(panels){{0.5f, 0, 1.5f}, {1.5f, 0.5f, 2}, 3, 0}, 0, 1);
}

static void coincident_walls_do_not_hide_what_they_leave_free(void **state)
{
    (void)state;
    expect_panels(&(panels){{0, 0}, {1, 1}, 2, 0}, 1, 1); // their areas sum to the whole
    expect_panels(&(panels){{0, 0, 0, 0}, {1.9f, 1.9f, 1.9f, 1.9f}, 4, 0}, 1, 1);
    expect_panels(&(panels){{0, 1.5f, 0, 1.5f}, {1, 2, 1.25f, 2}, 4, 0}, 1, 1);
}

static void a_gap_is_open_as_soon_as_slack_can_be_told(void **state)
{
    (void)state;
    const float step = 1.0f / (1 << 23); // float's at 1; slack is 8 or 16 of half of it
    expect_panels(&(panels){{0, 1 + step}, {1, 2}, 2, 0}, 0, 1);
    expect_panels(&(panels){{0, 1 + 64 * step}, {1, 2}, 2, 0}, 1, 1);
}

static void the_far_end_of_a_needle_hides_nothing_beyond_it(void **state)
{
    (void)state;
    hand_zone z;
    cells_built b;
    room_init(&z);
    // A panel with a notch at its top, 0.01 m wide, closed but for its last 0.2 m by a needle that points down from above.
    put_flat(&z, (flat){0, 1, {0, 0}, {2, 0.995f}}, 1, 0);
    put_flat(&z, (flat){0, 1, {0, 1.005f}, {2, 2}}, 1, 0);
    const cull_vec3 needle[3] = {{1, 2, 0.995f}, {1, 2, 1.005f}, {1, 0.2f, 1}};
    hand_zone_wall(&z, needle, 3, 0);
    build(&b, &z);
    const uint32_t front = cell_at(&b, 1.5, 0.1, 1), behind = cell_at(&b, 0.5, 0.1, 1);
    const bsp_opening *o = way(&b, front, behind);
    assert_non_null(o);
    finish(&b, &z);
}

// ---- Walls that touch a cell ----

// Of item `item`: 0 does not touch the cell, 1 does and is seen past the edge, 2 no way leads around.
static int touches(const cells_built *b, uint32_t cell, uint32_t item)
{
    const bsp_cell *c = &b->cells.cells[cell];
    for (uint32_t i = 0; i < c->touching_count; i++)
        if (b->tree.order[b->cells.entries[c->first_touching + i].item] == item) return i < c->apart_count ? 2 : 1;
    return 0;
}

static void steps_that_touch_along_an_edge_are_listed_on_both_sides_of_it(void **state)
{
    (void)state;
    hand_zone z;
    cells_built b;
    hand_zone_init(&z);
    put_flat(&z, (flat){2, 1, {0, 0}, {1, 2}}, -1, 0); // the underside of the upper step, x in [0, 1]
    put_flat(&z, (flat){0, 1, {0, 1}, {2, 2}}, 1, 0);  // and its face
    put_flat(&z, (flat){2, 1, {1, 0}, {2, 2}}, 1, 0);  // the top of the lower one, x in [1, 2]
    put_flat(&z, (flat){0, 1, {0, 0}, {2, 1}}, -1, 0); // and its back
    hand_zone_box(&z, ROOM, FACE_IN, 0);
    build(&b, &z);
    const uint32_t above = cell_at(&b, 1.5, 1, 1.5), below = cell_at(&b, 0.5, 1, 0.5);
    assert_int_equal(stands(&b, below, 0), 1);
    assert_int_equal(touches(&b, above, 0), 2);
    assert_int_equal(touches(&b, above, 3), 2);
    assert_int_equal(touches(&b, below, 1), 2);
    assert_int_equal(touches(&b, below, 2), 2);
    assert_int_equal(touches(&b, above, 2), 0); // it faces it
    finish(&b, &z);
}

static void a_wall_around_a_corner_touches_and_is_seen_past_it(void **state)
{
    (void)state;
    hand_zone z;
    cells_built b;
    hand_zone_init(&z);
    hand_zone_box(&z, (cull_box){{0, 0, 0}, {8, 8, 2}}, FACE_IN, 0);
    put_flat(&z, (flat){0, 3, {3, 0}, {5, 2}}, -1, 0); // a pillar: item 6 and its sides
    put_flat(&z, (flat){1, 3, {0, 3}, {2, 5}}, -1, 0);
    put_flat(&z, (flat){0, 5, {3, 0}, {5, 2}}, 1, 0);
    put_flat(&z, (flat){1, 5, {0, 3}, {2, 5}}, 1, 0);
    build(&b, &z);
    const uint32_t west = cell_at(&b, 2.9, 4, 1), south = cell_at(&b, 4, 2.9, 1);
    assert_int_equal(stands(&b, west, 6), 1);
    assert_int_equal(stands(&b, south, 7), 1);
    if (!stands(&b, west, 7)) assert_int_equal(touches(&b, west, 7), 1);
    if (!stands(&b, south, 6)) assert_int_equal(touches(&b, south, 6), 1);
    assert_true(!stands(&b, west, 7) || !stands(&b, south, 6)); // one of their planes parts the two cells
    finish(&b, &z);
}

static void faces_buried_between_boxes_that_touch_are_listed_where_they_meet_the_air(void **state)
{
    (void)state;
    hand_zone z;
    cells_built b;
    hand_zone_init(&z);
    hand_zone_box(&z, (cull_box){{0, 0, 0}, {8, 8, 4}}, FACE_IN, 0);
    hand_zone_box(&z, (cull_box){{2, 3, 0}, {4, 5, 2}}, FACE_OUT, 0);
    hand_zone_box(&z, (cull_box){{4, 3, 0}, {6, 5, 2}}, FACE_OUT, 0); // each shows a side to the other's inside
    build(&b, &z);
    const uint32_t above = cell_at(&b, 4.1, 4, 3), also_above = cell_at(&b, 3.9, 4, 3);
    uint32_t listed = 0;
    for (uint32_t i = 6; i < 18; i++) {
        const cull_vec3 *p = &z.positions[z.walls[i].first_vertex];
        if (!(p[0].x == 4 && p[1].x == 4 && p[2].x == 4)) continue;
        assert_true(touches(&b, above, i) == 2 || touches(&b, also_above, i) == 2);
        listed++;
    }
    assert_int_equal(listed, 2);
    finish(&b, &z);
}

// ---- Portals ----

static double stand_area(const cells_built *b, uint32_t stand)
{
    const bsp_stand *s = &b->cells.stands[stand];
    const cull_vec3 *p = b->cells.stand_points + s->first_point;
    double n[3] = {0, 0, 0};
    for (uint32_t i = 1; i + 1 < s->point_count; i++) {
        const double u[3] = {(double)p[i].x - (double)p[0].x, (double)p[i].y - (double)p[0].y, (double)p[i].z - (double)p[0].z};
        const double v[3] = {(double)p[i + 1].x - (double)p[0].x, (double)p[i + 1].y - (double)p[0].y, (double)p[i + 1].z - (double)p[0].z};
        for (int k = 0; k < 3; k++) n[k] += u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
    }
    return sqrt((n[0] * n[0] + n[1] * n[1]) + n[2] * n[2]) / 2;
}

static void a_portal_ends_the_zone_for_who_looks_out_and_names_the_cells_inside(void **state)
{
    (void)state;
    hand_zone z;
    cells_built b;
    hand_zone_init(&z);
    hand_zone_box(&z, ROOM, FACE_IN, 0);
    z.zone.item_count = 5; // all but the last, at z = 2: there the portal is
    cull_vec3 points[4];
    flat_points(&(flat){2, 2, {0, 0}, {2, 2}}, -1, points);
    hand_zone_portal(&z, points, 4);
    put_flat(&z, (flat){2, 3, {0, 0}, {2, 2}}, -1, 0); // beyond it, were it open
    build(&b, &z);
    const uint32_t inside = cell_at(&b, 1, 1, 1), beyond = cell_at(&b, 1, 1, 2.5);
    assert_int_not_equal(inside, beyond);
    assert_int_equal(b.cells.cells[inside].opening_count, 0);
    assert_int_equal(b.cells.cells[inside].is_beyond, 0);
    assert_int_equal(b.cells.cells[beyond].is_beyond, 1); // though a wall of the zone shows its front there
    assert_true(b.cells.cells[beyond].entry_count > 0);
    assert_non_null(way(&b, beyond, inside)); // an eye a hair beyond it still sees in
    assert_int_equal(b.cells.portal_count, 1);
    assert_int_equal(b.cells.stand_count, 1);
    assert_int_equal(b.cells.portal_offsets[0], 0);
    assert_int_equal(b.cells.portal_offsets[1], 1);
    assert_int_equal(b.cells.stands[0].cell, inside);
    finish(&b, &z);
}

static void a_portal_larger_than_its_hole_does_not_start_in_the_rock_around_it(void **state)
{
    (void)state;
    hand_zone z;
    cells_built b;
    hand_zone_init(&z);
    put_two_rooms(&z);
    for (uint32_t i = 0, kept = 0; i < z.zone.item_count; i++) { // the left room alone, its tunnel ends in a portal
        const cull_vec3 *p = &z.positions[z.walls[i].first_vertex];
        int is_left = 1;
        for (uint32_t k = 0; k < 4; k++) is_left &= p[k].x < 5 || (i >= 16 && p[k].x <= 5);
        if (!is_left) continue;
        z.items[kept] = z.items[i];
        for (int r = 0; r < 6; r++) z.rows[r][kept] = z.rows[r][i];
        z.walls[kept++] = z.walls[i];
        if (i + 1 == z.zone.item_count) z.zone.item_count = kept;
    }
    cull_vec3 points[4];
    flat_points(&(flat){0, 5, {-1, 0}, {3, 4}}, -1, points); // the hole is y in [0, 2], z in [1, 2]
    hand_zone_portal(&z, points, 4);
    build(&b, &z);
    const uint32_t door = cell_at(&b, 4.5, 1, 1.5);
    assert_int_equal(b.cells.stand_count, 1);
    assert_int_equal(b.cells.stands[0].cell, door);
    assert_float_equal(stand_area(&b, 0), 2, 1e-6); // the hole's, of the portal's 20
    uint8_t seen[256] = {0};
    flood(&b, door, seen);
    uint32_t reached = 0;
    for (uint32_t c = 0; c < b.cells.cell_count; c++) reached += seen[c];
    assert_int_equal(reached, 2);
    finish(&b, &z);
}

static void a_portal_in_an_open_zone_keeps_all_cells_that_it_borders(void **state)
{
    (void)state;
    hand_zone z;
    cells_built b;
    hand_zone_init(&z);
    put_flat(&z, (flat){1, 1, {0, 0}, {2, 2}}, 1, 0); // a shelf; above it its front, below its back
    cull_vec3 points[4];
    flat_points(&(flat){0, 0, {0, 0}, {2, 2}}, 1, points);
    hand_zone_portal(&z, points, 4);
    build(&b, &z);
    const uint32_t above = cell_at(&b, 1, 1.5, 1), below = cell_at(&b, 1, 0.5, 1);
    assert_int_equal(b.cells.stand_count, 2);
    assert_int_equal(b.cells.stands[0].cell, above < below ? above : below);
    assert_int_equal(b.cells.stands[1].cell, above < below ? below : above);
    for (uint32_t i = 0; i < 2; i++) assert_float_equal(stand_area(&b, i), 2, 1e-6); // each its half of the portal's 4
    finish(&b, &z);
}

static void a_portal_in_no_wall_s_plane_gets_its_own(void **state)
{
    (void)state;
    hand_zone z;
    cells_built b;
    hand_zone_init(&z);
    const cull_vec3 points[4] = {{0, 0, 0.3f}, {2, 0, 1.9f}, {2, 2, 1.9f}, {0, 2, 0.3f}}; // slanting, faces up: the room ends there
    const cull_vec3 low_y[4] = {{0, 0, 0.3f}, {0, 0, 2}, {2, 0, 2}, {2, 0, 1.9f}}, high_y[4] = {{2, 2, 1.9f}, {2, 2, 2}, {0, 2, 2}, {0, 2, 0.3f}};
    hand_zone_wall(&z, low_y, 4, 0);
    hand_zone_wall(&z, high_y, 4, 0);
    put_flat(&z, (flat){0, 0, {0, 0.3f}, {2, 2}}, 1, 0);
    put_flat(&z, (flat){0, 2, {0, 1.9f}, {2, 2}}, -1, 0);
    put_flat(&z, (flat){2, 2, {0, 0}, {2, 2}}, -1, 0);
    hand_zone_portal(&z, points, 4);
    build(&b, &z);
    const uint32_t above = cell_at(&b, 0.5, 1, 1.5), below = cell_at(&b, 1.5, 1, 0.5);
    assert_null(way(&b, above, below));
    assert_non_null(way(&b, below, above));
    assert_int_equal(b.cells.stand_count, 1);
    assert_int_equal(b.cells.stands[0].cell, above);
    finish(&b, &z);
}

// A portal may be the hull of several holes: what else of this zone its plane cuts through stays one with it.
static void a_portal_over_a_niche_of_its_own_zone_leaves_the_niche_open(void **state)
{
    (void)state;
    hand_zone z;
    cells_built b;
    cull_vec3 points[4];
    hand_zone_init(&z);
    put_flat(&z, (flat){0, 0, {0, 0}, {3, 2}}, 1, 0); // a room without its side at x = 4
    put_flat(&z, (flat){1, 0, {0, 0}, {2, 4}}, 1, 0);
    put_flat(&z, (flat){1, 3, {0, 0}, {2, 4}}, -1, 0);
    put_flat(&z, (flat){2, 0, {0, 0}, {4, 3}}, 1, 0);
    put_flat(&z, (flat){2, 2, {0, 0}, {4, 3}}, -1, 0);
    put_flat(&z, (flat){0, 4, {1, 0}, {2, 2}}, -1, 0); // there: a hole, y in [0, 1], a wall, and a niche, y in [2, 3]
    put_flat(&z, (flat){0, 5, {2, 0}, {3, 2}}, -1, 0);
    put_flat(&z, (flat){1, 2, {0, 4}, {2, 5}}, 1, 0);
    put_flat(&z, (flat){1, 3, {0, 4}, {2, 5}}, -1, 0);
    put_flat(&z, (flat){2, 0, {4, 2}, {5, 3}}, 1, 0);
    put_flat(&z, (flat){2, 2, {4, 2}, {5, 3}}, -1, 0);
    flat_points(&(flat){0, 4, {0, 0}, {3, 2}}, -1, points);
    hand_zone_portal(&z, points, 4);
    build(&b, &z);
    const uint32_t niche = cell_at(&b, 4.5, 2.5, 1);
    uint8_t seen[256] = {0};
    flood(&b, cell_at(&b, 1, 1.5, 1), seen);
    assert_int_equal(seen[niche], 1);
    assert_int_equal(b.cells.cells[niche].is_beyond, 1); // for all that is known
    assert_int_equal(b.cells.cells[cell_at(&b, 1, 1.5, 1)].is_beyond, 0);
    assert_int_equal(seen[cell_at(&b, 4.5, 0.5, 1)], 0);
    assert_int_equal(seen[cell_at(&b, 4.5, 1.5, 1)], 0);
    assert_non_null(way(&b, niche, cell_at(&b, 3.9, 2.5, 1)));
    finish(&b, &z);
}

static void a_portal_without_area_is_told_and_left_out(void **state)
{
    (void)state;
    hand_zone z;
    cells_built b;
    room_init(&z);
    const cull_vec3 points[3] = {{0.5f, 1, 1}, {0.5f, 1, 1}, {0.5f, 1, 1}};
    hand_zone_portal(&z, points, 3);
    build(&b, &z);
    assert_int_equal(b.cells.cell_count, 7);
    assert_int_equal(b.cells.stand_count, 0);
    assert_non_null(strstr(b.host.last_line, "no area"));
    finish(&b, &z);
}

// ---- What is no wall ----

static void a_cluster_stands_wherever_its_box_reaches(void **state)
{
    (void)state;
    hand_zone z;
    cells_built b;
    room_init(&z);
    put_flat(&z, (flat){0, 1, {0, 0}, {2, 2}}, 1, 0);
    hand_zone_cluster(&z, (cull_box){{0.5f, 0.5f, 0.5f}, {1.5f, 1, 1}});
    hand_zone_cluster(&z, (cull_box){{1.25f, 0.5f, 0.5f}, {1.5f, 1, 1}});
    build(&b, &z);
    const uint32_t front = cell_at(&b, 1.5, 1, 1), behind = cell_at(&b, 0.5, 1, 1);
    assert_int_equal(stands(&b, front, 7), 1);
    assert_int_equal(stands(&b, behind, 7), 1);
    assert_int_equal(stands(&b, front, 8), 1);
    assert_int_equal(stands(&b, behind, 8), 0);
    finish(&b, &z);
}

// ---- Odd input ----

static void nothing_at_all_is_one_cell(void **state)
{
    (void)state;
    hand_zone z;
    cells_built b;
    hand_zone_init(&z);
    build(&b, &z);
    assert_int_equal(b.cells.cell_count, 1);
    assert_int_equal(b.cells.node_count, 0);
    assert_int_equal(b.cells.opening_count, 0);
    finish(&b, &z);
}

static void a_wall_without_area_is_filed_all_the_same(void **state)
{
    (void)state;
    hand_zone z;
    cells_built b;
    room_init(&z);
    const cull_vec3 line[3] = {{0.5f, 1, 1}, {1, 1, 1}, {1.5f, 1, 1}};
    hand_zone_wall(&z, line, 3, 0);
    build(&b, &z);
    assert_int_equal(b.cells.cell_count, 7);
    assert_int_equal(stands(&b, cell_at(&b, 1, 1, 1), 6), 1);
    finish(&b, &z);
}

static void ten_thousand_coincident_walls_are_one_node(void **state)
{
    (void)state;
    hand_zone z;
    cells_built b;
    room_init(&z);
    for (int i = 0; i < 10000; i++) put_flat(&z, (flat){0, 1, {0, 0}, {2, 2}}, i & 1 ? 1 : -1, 0);
    build(&b, &z);
    assert_true(b.cells.node_count <= 11); // their plane may cut all space about the room in two
    const uint32_t front = cell_at(&b, 1.5, 1, 1), behind = cell_at(&b, 0.5, 1, 1);
    assert_null(way(&b, front, behind));
    assert_null(way(&b, behind, front));
    assert_int_equal(b.cells.cells[front].entry_count, 5005);
    assert_int_equal(b.cells.cells[behind].back_count, 5000);
    finish(&b, &z);
}

static void put_random_wall(hand_zone *z, uint64_t *seed, double size) // a triangle
{
    cull_vec3 p[3];
    for (int i = 0; i < 3; i++)
        p[i] = (cull_vec3){(float)random_between(seed, -size, size), (float)random_between(seed, -size, size), (float)random_between(seed, -size, size)};
    hand_zone_wall(z, p, 3, 0);
}

static void too_many_cells_are_told_and_there_are_none(void **state)
{
    (void)state;
    hand_zone z;
    cells_built b;
    hand_zone_init(&z);
    uint64_t seed = 3;
    for (int i = 0; i < 2500; i++) put_random_wall(&z, &seed, 4);
    build(&b, &z);
    assert_int_equal(b.cells.cell_count, 0);
    assert_null(b.cells.nodes);
    assert_int_equal(bsp_cells_bytes(&b.cells), 0);
    assert_non_null(strstr(b.host.last_line, "no cells"));
    finish(&b, &z);
}

// ---- The same again ----

static void put_random_scene(hand_zone *z, uint64_t seed, int axis_shift, float move)
{
    hand_zone_init(z);
    for (int i = 0; i < 40; i++) {
        float low[3], high[3], c[2][3];
        for (int k = 0; k < 3; k++) {
            low[k] = (float)random_below(&seed, 56) / 4;
            high[k] = low[k] + (float)(1 + random_below(&seed, 16)) / 4;
        }
        for (int k = 0; k < 3; k++) {
            c[0][(k + axis_shift) % 3] = low[k] + move;
            c[1][(k + axis_shift) % 3] = high[k] + move;
        }
        hand_zone_box(z, (cull_box){{c[0][0], c[0][1], c[0][2]}, {c[1][0], c[1][1], c[1][2]}}, FACE_OUT, 0);
    }
    for (int i = 0; i < 20; i++) {
        float v[3][3];
        cull_vec3 p[3];
        for (int k = 0; k < 9; k++) v[k / 3][(k % 3 + axis_shift) % 3] = (float)random_below(&seed, 256) / 16 + move;
        for (int k = 0; k < 3; k++) p[k] = (cull_vec3){v[k][0], v[k][1], v[k][2]};
        hand_zone_wall(z, p, 3, i % 4 ? 0 : CULL_ITEM_TWO_SIDED);
    }
}

static void the_bytes_are_the_same_each_time_and_with_each_compiler(void **state)
{
    (void)state;
    uint64_t hash[2];
    for (int i = 0; i < 2; i++) {
        hand_zone z;
        cells_built b;
        put_random_scene(&z, 77, 0, 0);
        build(&b, &z);
        hash[i] = cells_hash(&b.cells, b.tree.order);
        finish(&b, &z);
    }
    assert_int_equal(hash[0], hash[1]);
    assert_true(hash[0] == 0xcb83ac077bd5ae5fu); // golden: gcc 12 and clang 14
}

static void the_tree_s_options_change_nothing(void **state)
{
    (void)state;
    hand_zone z;
    cells_built b;
    put_random_scene(&z, 6, 0, 0);
    build(&b, &z);
    const uint64_t hash = cells_hash(&b.cells, b.tree.order);
    for (int choose = BSP_BALANCE; choose <= BSP_FIRST; choose++)
        for (int split = BSP_WHOLE; split <= BSP_SPLIT_NODES; split++) {
            bsp_tree tree;
            bsp_cells_data cells;
            const bsp_source source = {.zone = &z.zone, .wish = {(bsp_split)split, (bsp_choose)choose, 0, 0}};
            assert_int_equal(bsp_tree_build(&b.host.host, &source, &tree), CULL_OK);
            assert_int_equal(bsp_cells_build(&b.host.host, &z.zone, &tree, &cells), CULL_OK);
            assert_true(cells_hash(&cells, tree.order) == hash);
            bsp_cells_free(&b.host.host, &cells);
            bsp_tree_free(&b.host.host, &tree);
        }
    finish(&b, &z);
}

static void moved_by_whole_metres_it_has_the_same_cells(void **state)
{
    (void)state;
    hand_zone z, moved;
    cells_built b, c;
    put_random_scene(&z, 5, 0, 16);
    put_random_scene(&moved, 5, 0, 28); // the same power of two above the radius, so the same slack
    build(&b, &z);
    build(&c, &moved);
    assert_true(b.cells.cell_count > 100);
    assert_int_equal(b.cells.cell_count, c.cells.cell_count);
    assert_int_equal(b.cells.opening_count, c.cells.opening_count);
    assert_int_equal(b.cells.entry_count, c.cells.entry_count);
    assert_memory_equal(b.cells.cells, c.cells.cells, b.cells.cell_count * sizeof *b.cells.cells);
    finish(&b, &z);
    finish(&c, &moved);
}

// ---- Memory ----

static void no_allocation_s_failure_is_lost(void **state)
{
    (void)state;
    hand_zone z;
    cells_built b;
    put_random_scene(&z, 8, 0, 0);
    cull_vec3 points[4];
    flat_points(&(flat){2, 7, {0, 0}, {2, 2}}, -1, points);
    hand_zone_portal(&z, points, 4);
    build(&b, &z);
    const uint64_t hash = cells_hash(&b.cells, b.tree.order);
    bsp_cells_free(&b.host.host, &b.cells);
    const uint64_t blocks = b.host.memory.live_blocks;
    uint64_t failed = 0;
    for (uint64_t k = 1;; k++) {
        b.host.memory.fail_at = b.host.memory.calls + k;
        b.host.memory.failures = 0;
        b.host.lines = 0;
        const cull_result result = bsp_cells_build(&b.host.host, &z.zone, &b.tree, &b.cells);
        if (b.host.memory.failures == 0) {
            assert_int_equal(result, CULL_OK);
            assert_int_equal(cells_hash(&b.cells, b.tree.order), hash);
            break;
        }
        failed++;
        assert_int_equal(result, CULL_ERR_MEMORY);
        assert_int_equal(b.host.lines, 1);
        assert_int_equal(b.cells.cell_count, 0);
        assert_int_equal(b.host.memory.live_blocks, blocks);
    }
    assert_true(failed > 50);
    finish(&b, &z);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_room_is_one_cell_that_nothing_leaves),
        cmocka_unit_test(a_box_seen_from_outside_hides_its_inside),
        cmocka_unit_test(a_doorway_is_the_only_way_between_two_rooms),
        cmocka_unit_test(a_wall_hides_from_its_front_alone),
        cmocka_unit_test(what_is_seen_through_hides_nothing),
        cmocka_unit_test(walls_hide_together_what_they_cover_together),
        cmocka_unit_test(coincident_walls_do_not_hide_what_they_leave_free),
        cmocka_unit_test(a_gap_is_open_as_soon_as_slack_can_be_told),
        cmocka_unit_test(the_far_end_of_a_needle_hides_nothing_beyond_it),
        cmocka_unit_test(steps_that_touch_along_an_edge_are_listed_on_both_sides_of_it),
        cmocka_unit_test(a_wall_around_a_corner_touches_and_is_seen_past_it),
        cmocka_unit_test(faces_buried_between_boxes_that_touch_are_listed_where_they_meet_the_air),
        cmocka_unit_test(a_portal_ends_the_zone_for_who_looks_out_and_names_the_cells_inside),
        cmocka_unit_test(a_portal_larger_than_its_hole_does_not_start_in_the_rock_around_it),
        cmocka_unit_test(a_portal_in_an_open_zone_keeps_all_cells_that_it_borders),
        cmocka_unit_test(a_portal_in_no_wall_s_plane_gets_its_own),
        cmocka_unit_test(a_portal_over_a_niche_of_its_own_zone_leaves_the_niche_open),
        cmocka_unit_test(a_portal_without_area_is_told_and_left_out),
        cmocka_unit_test(a_cluster_stands_wherever_its_box_reaches),
        cmocka_unit_test(nothing_at_all_is_one_cell),
        cmocka_unit_test(a_wall_without_area_is_filed_all_the_same),
        cmocka_unit_test(ten_thousand_coincident_walls_are_one_node),
        cmocka_unit_test(too_many_cells_are_told_and_there_are_none),
        cmocka_unit_test(the_bytes_are_the_same_each_time_and_with_each_compiler),
        cmocka_unit_test(the_tree_s_options_change_nothing),
        cmocka_unit_test(moved_by_whole_metres_it_has_the_same_cells),
        cmocka_unit_test(no_allocation_s_failure_is_lost),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
