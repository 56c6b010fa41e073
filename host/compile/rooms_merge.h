// Cells to rooms: those that are open to each other become one, the most open first.
// SPDX-License-Identifier: MIT
// Invariant: sizes are compared rounded far coarser than doubles err, so that a turned or moved map merges in the same order.
#ifndef PORTCULLIS_HOST_ROOMS_MERGE_H
#define PORTCULLIS_HOST_ROOMS_MERGE_H

#include "rooms_cells.h"

typedef struct room_map {
    uint32_t *room_of; // by cell
    uint32_t cell_count, room_count, portals;
} room_map;

// To be freed also after a failure, with the same memory.
result rooms_merge(const cell_set *cells, const plane_table *planes, const room_limits *limits, const allocator *memory, room_map *out);
void room_map_free(room_map *m, const allocator *memory);

#endif
