// Movers: boxes that the application moves, found by zone. A mover stands in every zone that its box touches.
// SPDX-License-Identifier: MIT
// Invariant: all memory is taken at open, enough for every way to stand; a mover in more zones than MOVER_ZONES_MOST, or
// in none, stands in the list `everywhere`, is looked at in every view, and is counted.
#ifndef PORTCULLIS_HOST_MOVERS_H
#define PORTCULLIS_HOST_MOVERS_H

#include "graph.h"

enum { MOVER_ZONES_MOST = 8, MOVER_BLOCK = 16 };

// Movers of one zone, in a list of blocks. Boxes are relative to the zone's origin, rounded outward.
typedef struct mover_block {
    float min_x[MOVER_BLOCK], min_y[MOVER_BLOCK], min_z[MOVER_BLOCK], max_x[MOVER_BLOCK], max_y[MOVER_BLOCK], max_z[MOVER_BLOCK];
    uint32_t mover[MOVER_BLOCK];
    uint32_t next, count; // next block, or SCENE_NONE
} mover_block;

typedef struct movers movers;
typedef struct mover_counts {
    uint32_t live, everywhere, capacity;
    uint64_t moves, relocations; // relocations: moves that changed zones
    uint64_t writes;             // boxes written to a zone's list, or moved within it to close a gap
} mover_counts;

typedef struct movers_request { const scene *scene; const graph *graph; uint32_t capacity; } movers_request;
// Borrows both. At most about 400 bytes a mover, and a block for each zone.
result movers_open(const movers_request *q, const allocator *memory, movers **out);
void movers_close(movers *m); // NULL is fine

// [one thread, no view being culled] BAD_INPUT: no room, a number in use or not in use, min above max, not finite or beyond
// 1e9 m; nothing changed then. `mover` is below the capacity: the caller numbers them.
result movers_add(movers *m, uint32_t mover, const double min[3], const double max[3]);
result movers_move(movers *m, uint32_t mover, const double min[3], const double max[3]);
result movers_remove(movers *m, uint32_t mover);
uint32_t movers_free_number(const movers *m); // the least number not in use, SCENE_NONE when full

// [any thread while nothing changes]
const mover_block *movers_of_zone(const movers *m, uint32_t zone); // first block, NULL: none
const mover_block *movers_next(const movers *m, const mover_block *b);
const uint32_t *movers_everywhere(const movers *m, uint32_t *count);
uint32_t movers_zones(const movers *m, uint32_t mover, const uint32_t **zones); // 0 and NULL for one that is everywhere
int movers_box(const movers *m, uint32_t mover, double min[3], double max[3]);   // 0: not in use
mover_counts movers_counts(const movers *m);

#endif
