// Cells to rooms: those that are open to each other become one, the most open first.
// SPDX-License-Identifier: MIT
// Invariant: sizes are compared rounded far coarser than doubles err, so that a turned or moved map merges in the same order.
#ifndef PORTCULLIS_HOST_ROOMS_MERGE_H
#define PORTCULLIS_HOST_ROOMS_MERGE_H

#include "rooms_cells.h"

typedef struct door_place { double middle[3], area; } door_place; // of a leaf: in steps; the largest faces of its brushes

typedef struct merge_input {
    const cell_set *cells;
    const cell_input *from;       // what the cells were made of
    const uint32_t *door_portals; // by group of doors: how many portals it makes
    uint32_t fixed_portals;       // that are there whatever is merged
    const room_limits *limits;
    const door_place *door_places; // where doors are shut, also those without a portal
    uint32_t door_place_count;
} merge_input;

typedef struct room_map {
    uint32_t *room_of; // by cell
    uint32_t cell_count, room_count, portals;
} room_map;

// To be freed also after a failure, with the same memory.
result rooms_merge(const merge_input *in, const allocator *memory, room_map *out);
void room_map_free(room_map *m, const allocator *memory);

#endif
