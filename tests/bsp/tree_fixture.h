// Zones made of walls on a grid for tests of the tree, and a check of all that tree.h promises.
// SPDX-License-Identifier: MIT
#ifndef TESTS_BSP_TREE_FIXTURE_H
#define TESTS_BSP_TREE_FIXTURE_H

#include "plugins/bsp/tree.h"
#include "tests/common/culler_host.h"
#include "tests/common/hand_zone.h"

// ---- Zones: whole grid points, STEPS_PER_METRE a metre ----

#define STEPS_PER_METRE 32

typedef enum zone_kind { ZONE_EXACT, ZONE_FLOAT } zone_kind; // with exact planes, or as a mesh's polygons come

typedef struct grid_loop { int32_t p[8][3]; uint32_t count; } grid_loop; // counterclockwise from the front

uint32_t grid_wall(hand_zone *z, const grid_loop *loop); // the item; a loop without area gets the plane of its first point, facing up
void grid_end(hand_zone *z, zone_kind kind);             // as hand_zone_end, with what the kind has

// An upright wall of the floor plan: from (x0, y0) to (x1, y1) on the floor, its face on the left of that way.
uint32_t grid_plan(hand_zone *z, const int32_t from_to[4], int32_t height);
// A box of six walls that face outward, or inward.
void grid_box(hand_zone *z, const int32_t low[3], const int32_t high[3], hand_face faces);

// to = matrix * from / divisor + move, exact or aborts; the copy is closed as the kind says.
typedef struct grid_motion { int32_t matrix[3][3], divisor, move[3]; } grid_motion;
void grid_moved(const hand_zone *from, const grid_motion *motion, zone_kind kind, hand_zone *out);

// ---- Checks ----

// NULL, or what is wrong: structure, order, areas, sides of all pieces, convex leaves, boxes, where the boxed items stand.
const char *tree_fault(const cull_zone *zone, const bsp_tree *tree);
// NULL, or where the trees differ: nodes, leaves, entries' items, order. Not points.
const char *tree_difference(const bsp_tree *a, const bsp_tree *b);
// Leaves that list the item (of the zone's own order).
uint32_t tree_leaves_of(const bsp_tree *tree, uint32_t item);
uint32_t tree_place(const bsp_tree *tree, uint32_t item);
double tree_wall_area(const cull_zone *zone, uint32_t item);

#endif
