// A furnished house of one or two storeys with zones, doors and windows; one of them may have a cellar of eleven zones.
// SPDX-License-Identifier: MIT
// Invariant: a house stands on a site of 13 m x 10 m; its front looks to +z, or to -z where it is mirrored. Places of its
// tables are local: x to the right, z from 0 at the front to -1000 at the back, centimetres, the ground at y = 0.
#ifndef PORTCULLIS_BENCH_GENERATE_HOUSE_H
#define PORTCULLIS_BENCH_GENERATE_HOUSE_H

#include "generate_models.h"
#include "generate_zoned.h"

enum { HOUSE_WIDE = 1300, HOUSE_DEEP = 1000, HOUSE_FRONT_WALL = 30 }; // centimetres

typedef enum house_storeys { HOUSE_LOW, HOUSE_TALL } house_storeys;
typedef enum house_cellar { HOUSE_NO_CELLAR, HOUSE_CELLAR } house_cellar;
typedef enum house_door { HOUSE_DOOR_OPEN, HOUSE_DOOR_SHUT } house_door;

typedef enum house_chains { HOUSE_CHAINS_DRAWN, HOUSE_CHAINS_OF_ROOMS } house_chains; // by lot, for tests; what suits each room

typedef struct house_site {
    uint32_t number;
    int32_t x, z; // of the front's left corner, seen in the plan, centimetres
    int is_mirrored;
    house_storeys storeys;
    house_cellar cellar;
    house_door front_door;
    const char *facade, *roof; // materials
    house_chains chains;
} house_site;

typedef struct local_place { int32_t x, y, z; } local_place; // centimetres
place house_place(const house_site *h, local_place p);
block house_block(const house_site *h, local_place a, local_place b); // a below b in each axis, before mirroring
spot house_spot(const house_site *h, local_place p);

void house_plan(const house_site *h, plan *p, random_stream *r); // before plan_index
void house_write(const house_site *h, obj_writer *w, plan *p, uint32_t first_room, uint32_t room_count); // window bars become obstacles
void house_fill(const house_site *h, obj_writer *w, plan *p, random_stream *r); // furniture and exhibits: obstacles too
void house_furnish(const house_site *h, obj_writer *w, plan *p, random_stream *r); // many more things, small and of many polygons
uint32_t house_room_count(const house_site *h);
block house_footprint(const house_site *h); // the hole that it needs in the ground: to the middle of its outer walls

#endif
