// Scenes of zones and portals for tests of the flow, put together by the scene builder, with the crosser portal at hand.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_FLOW_FIXTURE_H
#define PORTCULLIS_TESTS_FLOW_FIXTURE_H

#include "host/core/flow.h"
#include "tests/common/failing_allocator.h"
#include "tests/common/report_lines.h"

typedef struct pose { double turn[9], move[3]; } pose; // world = turn * p + move
extern const pose POSE_NONE;
pose pose_random(uint64_t *seed, double far_m); // turned anyhow, moved up to far_m

typedef struct maze {
    failing_allocator memory;
    report_lines lines;
    pose pose;
    scene_builder *builder;
    scene *scene;
    graph *graph;
    zone_data *zones;
    flow *flow;
    uint8_t *open;          // by portal; all 1 at first
    cull_culler **cullers;  // portal, by zone
    cull_query **queries;
    uint32_t item_zone;     // zones that have their triangle
} maze;

void maze_begin(maze *m, const pose *p);
uint32_t maze_box(maze *m, const double low[3], const double high[3], uint32_t parent);
typedef struct maze_part { double low[3], high[3]; } maze_part;
uint32_t maze_union(maze *m, const maze_part *parts, uint32_t count, uint32_t parent); // a zone of several hulls
uint32_t maze_wedge(maze *m, const scene_solid_plane *planes, uint32_t count, const double inside[3]); // planes in the maze's own frame
uint32_t maze_everywhere(maze *m);
uint32_t maze_portal(maze *m, uint32_t a, uint32_t b, const double (*points)[3], uint32_t count);
// A rectangle at `at` along `axis` (0 .. 2), low and high along the next two axes.
typedef struct opening { uint32_t axis; double at, low[2], high[2]; } opening;
uint32_t maze_opening(maze *m, uint32_t a, uint32_t b, const opening *o);
void maze_piece(maze *m, const double at[3]); // a small triangle, so that the zone there has an item
void maze_end(maze *m);                       // scene, graph, zone data, flow
void maze_close(maze *m);                     // asserts that nothing is left

// Mixed: every other zone floods. By entry: narrows, and volumes that came in different ways stay apart.
typedef enum crosser_kind { CROSSER_FLOOD, CROSSER_NARROW, CROSSER_MIXED, CROSSER_BY_ENTRY } crosser_kind;
flow_crosser maze_crosser(maze *m, crosser_kind kind);
camera maze_camera(const maze *m, const double eye[3], const double forward[3], double fovy_deg); // in the maze's own frame
void maze_run(maze *m, const camera *c, crosser_kind kind, flow_result *out); // a picture of 320 by 240
const flow_zone *maze_find(const flow_result *r, uint32_t zone);               // NULL: not reached

// Scenes. Grids: rooms of 4 m by 3 m by 4 m, room (x, z) is zone x + z * wide, its corner at (4 x, 0, 4 z).
typedef enum door_width { DOORS_NARROW, DOORS_RANDOM, DOORS_WHOLE_FACE } door_width;
typedef struct grid_recipe {
    uint32_t wide, deep;
    door_width doors;
    uint64_t seed;
    pose pose;
    uint32_t is_reversed; // portals added in the opposite order
} grid_recipe;
void maze_grid(maze *m, const grid_recipe *g);
void maze_village(maze *m, uint64_t seed, const pose *p); // an outdoors everywhere, houses of rooms in it, doors and windows
void maze_nested(maze *m, uint64_t seed, const pose *p);  // a hall, a house in it, a closet in the house, windows between
void maze_wedges(maze *m, const pose *p);                 // a corridor of zones parted by sloped planes

#endif
