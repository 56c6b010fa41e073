// Hand-made cells for tests of the flow: a block of box rooms, shut, open or with doorways between them, and rays walked through it.
// SPDX-License-Identifier: MIT
// Invariant: the rays know nothing of trees, windows or pictures: they go from wall to wall in the unposed block.
#ifndef PORTCULLIS_TESTS_GRID_CELLS_H
#define PORTCULLIS_TESTS_GRID_CELLS_H

#include "plugins/bsp/cells.h"

enum { GRID_MOST = 24, GRID_SIDES = 2, GRID_PIECES = 4 };

typedef enum grid_kind { GRID_OPEN, GRID_SHUT, GRID_DOOR, GRID_ONE_WAY_UP, GRID_ONE_WAY_DOWN, GRID_PORTAL } grid_kind; // one way: a wall that faces up/down only

typedef struct grid_face { // between a room and the next along an axis, or the block's outside
    grid_kind kind;
    double door[4];                              // low and high along the two next axes
    uint32_t items[GRID_SIDES][GRID_PIECES];     // walls that face up (0: seen from above) and down; BSP_NONE: none
} grid_face;

typedef struct grid_wish {
    uint32_t size[3];
    uint64_t seed;
    double open, shut, one_way; // shares of faces; the rest has doors
    double turn[3];             // radians about x, y, z
    double move[3];
    double scale;
    uint32_t has_foreign; // 1: one room belongs to another zone, its faces are portals
} grid_wish;

typedef struct grid_cells {
    bsp_cells_data data;
    bsp_flow_index index;
    cull_zone zone;
    uint32_t size[3];
    double places[3][GRID_MOST + 1]; // of planes along each axis, unposed
    grid_face *faces[3];             // of axis a: at plane i of a, (size + 1) along a
    double turned[3][3], move[3], scale;
    uint32_t foreign; // the room of another zone, or BSP_NONE
    cull_portal portals[6];
    cull_vec3 portal_points[6][4];
    cull_item *items;
    float *box_memory;
    uint32_t item_count, first_box; // items from first_box: a box in the middle half of each room
} grid_cells;

const cull_host *grid_host(void); // malloc and free
void grid_make(const grid_wish *wish, grid_cells *out);
void grid_free(grid_cells *g);
void grid_pose(const grid_cells *g, const double in[3], double out[3]);      // of points
void grid_pose_way(const grid_cells *g, const double in[3], double out[3]);  // of directions
void grid_unpose_way(const grid_cells *g, const double in[3], double out[3]);

enum { GRID_STEPS = 4 * GRID_MOST };
typedef struct grid_trace {
    uint32_t rooms[GRID_STEPS], room_count;
    uint32_t seen[GRID_STEPS], seen_count; // backs that it went through
    uint32_t hit;                          // item; BSP_NONE: it left the grid at an edge too near to tell
} grid_trace;
// From a point of the block, unposed. 0: it passed an edge by less than `clear`, so nothing is certain after that.
int grid_trace_ray(const grid_cells *g, const double from[3], const double way[3], double clear, grid_trace *out);

#endif
