// The scenes of fixture.h.
// SPDX-License-Identifier: MIT
#include "tests/flow/fixture.h"

#include "tests/common/random.h"
#include "tests/common/test.h"

#include <math.h>

#define ROOM_M 4.0
#define ROOM_HEIGHT_M 3.0

// Between room a and the next one along x (axis 0) or z (axis 2); `low` is the room's corner along the other of the two.
typedef struct doorway { uint32_t a, b, axis; double at, low; } doorway;

static double sixteenths(double v)
{
    return floor(v * 16) / 16;
}

static void doorway_add(maze *m, door_width doors, uint64_t *seed, const doorway *d)
{
    double from = 1.5, to = 2.5, bottom = 0, top = 2;
    if (doors == DOORS_WHOLE_FACE) {
        from = 0, to = ROOM_M, top = ROOM_HEIGHT_M;
    } else if (doors == DOORS_RANDOM) {
        from = sixteenths(random_between(seed, 0, 2.5));
        to = sixteenths(random_between(seed, from + 0.25, ROOM_M));
        bottom = sixteenths(random_between(seed, 0, 1));
        top = sixteenths(random_between(seed, bottom + 0.5, ROOM_HEIGHT_M));
    }
    opening o = {.axis = d->axis, .at = d->at};
    const uint32_t upright = d->axis == 0 ? 0 : 1; // which of the next two axes is y
    o.low[upright] = bottom;
    o.high[upright] = top;
    o.low[1 - upright] = d->low + from;
    o.high[1 - upright] = d->low + to;
    (void)maze_opening(m, d->a, d->b, &o);
}

static doorway grid_doorway(const grid_recipe *g, uint32_t number)
{
    const uint32_t along_x = (g->wide - 1) * g->deep;
    if (number < along_x) {
        const uint32_t x = number % (g->wide - 1), z = number / (g->wide - 1), a = x + z * g->wide;
        return (doorway){a, a + 1, 0, ROOM_M * (x + 1), ROOM_M * z};
    }
    const uint32_t rest = number - along_x, x = rest % g->wide, z = rest / g->wide, a = x + z * g->wide;
    return (doorway){a, a + g->wide, 2, ROOM_M * (z + 1), ROOM_M * x};
}

void maze_grid(maze *m, const grid_recipe *g)
{
    maze_begin(m, &g->pose);
    for (uint32_t z = 0; z < g->deep; z++) {
        for (uint32_t x = 0; x < g->wide; x++) {
            const double low[3] = {ROOM_M * x, 0, ROOM_M * z}, high[3] = {low[0] + ROOM_M, ROOM_HEIGHT_M, low[2] + ROOM_M};
            (void)maze_box(m, low, high, SCENE_NONE);
        }
    }
    const uint32_t doorways = (g->wide - 1) * g->deep + (g->deep - 1) * g->wide;
    for (uint32_t i = 0; i < doorways; i++) {
        const doorway d = grid_doorway(g, g->is_reversed ? doorways - 1 - i : i);
        uint64_t seed = g->seed + d.a * 2 + (d.axis == 0); // the same door whatever the order
        doorway_add(m, g->doors, &seed, &d);
    }
    maze_end(m);
}

// A house of two rooms in a row along x; a door between them, one out of the first, a window out of each.
static void house_add(maze *m, uint32_t outdoors, const double at[3], uint64_t *seed)
{
    uint32_t rooms[2];
    for (uint32_t i = 0; i < 2; i++) {
        const double low[3] = {at[0] + ROOM_M * i, at[1], at[2]}, high[3] = {low[0] + ROOM_M, at[1] + ROOM_HEIGHT_M, at[2] + ROOM_M};
        rooms[i] = maze_box(m, low, high, outdoors);
    }
    const double shift = sixteenths(random_between(seed, 0, 2));
    (void)maze_opening(m, rooms[0], rooms[1], &(opening){0, at[0] + ROOM_M, {at[1], at[2] + shift}, {at[1] + 2, at[2] + shift + 1.5}});
    (void)maze_opening(m, rooms[0], outdoors, &(opening){0, at[0], {at[1], at[2] + 1}, {at[1] + 2.5, at[2] + 3}});
    for (uint32_t i = 0; i < 2; i++) {
        const double left = at[0] + ROOM_M * i + 1;
        (void)maze_opening(m, rooms[i], outdoors, &(opening){2, at[2] + ROOM_M * i, {left, at[1] + 0.5}, {left + 2, at[1] + 2}});
    }
}

void maze_village(maze *m, uint64_t seed, const pose *p)
{
    maze_begin(m, p);
    const uint32_t outdoors = maze_everywhere(m);
    maze_piece(m, (const double[3]){-6, 1, -6});
    maze_piece(m, (const double[3]){40, 1, 40});
    for (uint32_t i = 0; i < 6; i++) {
        const double at[3] = {16.0 * (i % 3), 0, 12.0 * (i / 3)};
        house_add(m, outdoors, at, &seed);
    }
    maze_end(m);
}

// Two windows on opposite faces and one on a third, of a box that stands in another zone.
static void windows_add(maze *m, uint32_t inner, uint32_t outer, const double low[3], const double high[3], uint64_t *seed)
{
    for (int i = 0; i < 3; i++) {
        const uint32_t axis = i == 2 ? 2 : 0;
        opening o = {.axis = axis, .at = i == 1 ? low[axis] : high[axis]};
        for (uint32_t k = 0; k < 2; k++) {
            const uint32_t along = (axis + 1 + k) % 3;
            o.low[k] = low[along] + sixteenths(random_between(seed, 0, (high[along] - low[along]) / 2));
            o.high[k] = o.low[k] + sixteenths((high[along] - low[along]) / 2);
        }
        (void)maze_opening(m, inner, outer, &o);
    }
}

void maze_nested(maze *m, uint64_t seed, const pose *p)
{
    const double lows[3][3] = {{0, 0, 0}, {4, 1, 4}, {6, 2, 6}}, highs[3][3] = {{16, 8, 16}, {12, 6, 12}, {9, 5, 9}};
    uint32_t zones[3];
    maze_begin(m, p);
    for (int i = 0; i < 3; i++) zones[i] = maze_box(m, lows[i], highs[i], i == 0 ? SCENE_NONE : zones[i - 1]);
    maze_piece(m, (const double[3]){1, 1, 1}); // the boxes' middles are all in the closet
    maze_piece(m, (const double[3]){4.5, 1.5, 4.5});
    for (int i = 1; i < 3; i++) windows_add(m, zones[i], zones[i - 1], lows[i], highs[i], &seed);
    maze_end(m);
}

void maze_wedges(maze *m, const pose *p)
{
    maze_begin(m, p);
    // Along x; part i is bounded by planes through x = 4 i, leaning to and fro.
    enum { PARTS = 6 };
    double lean[PARTS + 1][3];
    for (uint32_t i = 0; i <= PARTS; i++) {
        const double slope = i == 0 || i == PARTS ? 0 : i % 2 ? 0.5 : -0.375, turn = i % 3 ? 0.25 : -0.25, length = sqrt(1 + slope * slope + turn * turn);
        lean[i][0] = 1 / length, lean[i][1] = slope / length, lean[i][2] = turn / length;
    }
    for (uint32_t i = 0; i < PARTS; i++) {
        scene_solid_plane planes[6] = {{{0, 1, 0}, 2}, {{0, -1, 0}, 2}, {{0, 0, 1}, 2}, {{0, 0, -1}, 2}, {{0}, 0}, {{0}, 0}};
        for (int k = 0; k < 3; k++) planes[4].normal[k] = lean[i + 1][k], planes[5].normal[k] = -lean[i][k];
        planes[4].distance = lean[i + 1][0] * ROOM_M * (i + 1);
        planes[5].distance = -lean[i][0] * ROOM_M * i;
        (void)maze_wedge(m, planes, 6, (const double[3]){ROOM_M * i + 2, 0, 0});
    }
    for (uint32_t i = 1; i < PARTS; i++) {
        double points[5][3];
        const double loop[5][2] = {{-1.5, -1.5}, {1.5, -1}, {1.25, 1}, {0, 1.5}, {-1, 1}}; // y, z
        for (int k = 0; k < 5; k++) {
            points[k][1] = loop[k][0] * (i % 2 ? 1 : 0.5);
            points[k][2] = loop[k][1] * (i % 2 ? 0.625 : 1);
            points[k][0] = ROOM_M * i - (lean[i][1] * points[k][1] + lean[i][2] * points[k][2]) / lean[i][0];
        }
        (void)maze_portal(m, i - 1, i, (const double(*)[3])points, 5);
    }
    maze_end(m);
}
