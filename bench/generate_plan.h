// A plan of rooms: boxes of air in boxes of zones, joined by holes in their walls. What the zoned scenes are made from.
// SPDX-License-Identifier: MIT
// Invariant: a room's shell with the frames of its holes is closed but for the holes' far rims; edges of a hole are cuts of
// both rooms, and no cut of a room runs through a hole, so shells of neighbours meet without T-junctions.
#ifndef PORTCULLIS_BENCH_GENERATE_PLAN_H
#define PORTCULLIS_BENCH_GENERATE_PLAN_H

#include "generate_obj.h"

#define PLAN_OUTSIDE UINT32_MAX // instead of a room's number

enum {
    PLAN_SIDES = 6,
    LEAF_HALF = 3 * CENTIMETRE,  // half a door leaf's thickness, about the portal's plane
    LEAF_LAP = CENTIMETRE,       // a leaf reaches that far into its frame, so that nothing shows beside it
};

typedef struct plan_room {
    const char *kind; // with `number` its name: kind_number; PLAN_OUTSIDE: kind alone
    uint32_t number;
    block air, zone;
    const char *const *materials; // by side
    const char *frame;            // material of the frames of holes that it is first of
    const char *chain;            // or NULL
    const cuts *heights;          // or NULL: cuts of all rooms and of the facade of a house, those between floor and ceiling count
} plan_room;

typedef enum plan_door { PLAN_GAP, PLAN_DOOR_OPEN, PLAN_DOOR_SHUT } plan_door;

typedef struct plan_hole {
    uint32_t rooms[2];   // the second may be PLAN_OUTSIDE
    side side;           // of the first
    rectangle opening;   // u along x (z on the x sides), v along y (z on the y sides)
    int32_t plane;       // of the portal, within the wall
    int32_t depth;       // of the wall
    int32_t slide;       // a leaf slides along u so far when it opens
    plan_door door;
    const char *leaf;    // its material
} plan_hole;

// A part of the open: all rooms lie in it, and what is PLAN_OUTSIDE of them is it. Its top, and its sides from the ground up, are portals to "outside".
typedef struct plan_quarter {
    const char *name; // NULL: there is none
    const char *chain;
    block zone;
    int32_t ground; // nothing is seen through its sides below that height
} plan_quarter;

typedef struct plan {
    buffer rooms, holes; // plan_room, plan_hole
    buffer ways;         // uint32_t, by plan_index: 2 * hole + side, room by room
    buffer first_ways;   // uint32_t, rooms + 1
    buffer obstacles;    // block: where no eye of a tour may be
    int failed;          // out of memory, now or before
    int has_outside;     // a zone "outside" that all rooms lie in
    const char *outside_chain; // NULL: frustum
    plan_quarter quarter;
} plan;

plan plan_open(const allocator *memory);
void plan_free(plan *p);
uint32_t plan_add_room(plan *p, const plan_room *room); // its number
void plan_add_hole(plan *p, const plan_hole *hole);
void plan_add_obstacle(plan *p, const block *b);
int plan_index(plan *p); // after the last hole: the ways of each room; 0: out of memory

uint32_t plan_room_count(const plan *p);
const plan_room *plan_room_at(const plan *p, uint32_t room);
uint32_t plan_hole_count(const plan *p);
const plan_hole *plan_hole_at(const plan *p, uint32_t hole);
// The ways out of a room: 2 * hole + 0 where it is the hole's first room, + 1 where it is the second.
const uint32_t *plan_ways(const plan *p, uint32_t room, uint32_t *count);
uint32_t plan_behind(const plan *p, uint32_t way); // the room that the way leads to, or PLAN_OUTSIDE
side plan_opposite(side s);

place plan_hole_place(const plan_hole *h, int32_t u, int32_t v); // on the portal's plane
void plan_hole_corners(const plan_hole *h, place out[4]);        // counterclockwise seen from the first room
block plan_leaf(const plan_hole *h);                             // shut

// Walls, floor and ceiling of a room, seen from within, and the frames of the holes that it is first of.
void plan_write_room(obj_writer *w, const plan *p, uint32_t room);

#endif
