// The portals that a tracing has before rooms are made: those of doors, which may be given up where there are too many, and the rest.
// SPDX-License-Identifier: MIT
// Invariant: doors of one group stand and fall together: those in one plane between the same regions, and parts of one piece.
#ifndef PORTCULLIS_HOST_ROOMS_DOORS_H
#define PORTCULLIS_HOST_ROOMS_DOORS_H

#include "rooms_merge.h"
#include "zone_trace.h"

typedef struct door_set {
    const allocator *memory;
    buffer doors;        // cell_door
    buffer places;       // door_place
    uint32_t *group_of;  // by piece: itself or another one
    uint32_t *portals;   // by group: as they will stand in the scene, one a leaf
    uint32_t piece_count, fixed; // fixed: portals that stay, those of portal brushes
} door_set;

// To be freed also after a failure.
result door_set_make(const compile_input *in, const zone_trace *t, const portal_set *set, report *r, const allocator *memory, door_set *out);
void door_set_free(door_set *d);

#endif
