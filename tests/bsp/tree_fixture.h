// Zones made of walls for tests of the tree, a host that counts memory, and a check of all that tree.h promises.
// SPDX-License-Identifier: MIT
#ifndef TESTS_BSP_TREE_FIXTURE_H
#define TESTS_BSP_TREE_FIXTURE_H

#include "plugins/bsp/tree.h"
#include "tests/common/failing_allocator.h"

// ---- The host ----

typedef struct tree_host {
    cull_host host;
    failing_allocator memory;
    uint32_t lines;     // logged
    char last_line[256];
} tree_host;
void tree_host_init(tree_host *h, uint64_t fail_at); // fail_at 0: never; the struct must not move

// ---- Zones: whole grid points, STEPS_PER_METRE a metre ----

#define STEPS_PER_METRE 32

typedef enum zone_kind { ZONE_EXACT, ZONE_FLOAT } zone_kind; // with exact planes, or as a mesh's polygons come

typedef struct made_zone {
    cull_zone zone;
    cull_item *items;
    float *rows[6];
    cull_vec3 *positions;
    cull_wall *walls;
    uint32_t *wall_vertices, *indices;
    cull_plane *planes;
    cull_exact_plane *exact;
    uint32_t item_capacity, vertex_capacity, plane_capacity;
} made_zone;

typedef struct grid_loop { int32_t p[8][3]; uint32_t count; } grid_loop; // counterclockwise from the front

void made_zone_open(made_zone *z, uint32_t items_most, uint32_t vertices_most); // aborts without memory
void made_zone_free(made_zone *z);
uint32_t made_zone_wall(made_zone *z, const grid_loop *loop); // the item; a loop without area gets the plane of its first point, facing up
uint32_t made_zone_points(made_zone *z, const cull_vec3 *points, uint32_t count); // any wall, for float zones
uint32_t made_zone_cluster(made_zone *z, cull_box box);       // an item that is no wall
void made_zone_close(made_zone *z, zone_kind kind);           // sets radius, box, what the kind has

// An upright wall of the floor plan: from (x0, y0) to (x1, y1) on the floor, its face on the left of that way.
uint32_t made_zone_plan(made_zone *z, const int32_t from_to[4], int32_t height);
// A box of six walls that face outward, or inward.
typedef enum box_faces { BOX_OUTWARD, BOX_INWARD } box_faces;
void made_zone_box(made_zone *z, const int32_t low[3], const int32_t high[3], box_faces faces);

// to = matrix * from / divisor + move, exact or aborts; the copy is closed as the kind says.
typedef struct grid_motion { int32_t matrix[3][3], divisor, move[3]; } grid_motion;
void made_zone_moved(const made_zone *from, const grid_motion *motion, zone_kind kind, made_zone *out);

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
