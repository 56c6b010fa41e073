// Which plane divides a set of pieces, or none where they are convex together.
// SPDX-License-Identifier: MIT
// Invariant: the choice rests on counts, on areas in steps of an eighth of an octave, and on the pieces' order, so that a set moved or turned
// exactly is divided by the same plane.
#ifndef PORTCULLIS_BSP_CHOOSE_H
#define PORTCULLIS_BSP_CHOOSE_H

#include "pieces.h"

typedef struct plane_candidate {
    uint32_t plane, order;          // order: of its first piece
    uint32_t front, back, spanning; // pieces on each side once it has cut: the spanning count in both
    double area;                    // of the pieces in the plane
    double cost;                    // choose=sah
} plane_candidate;

typedef struct chooser {
    const piece_set *set;
    bsp_wish wish;
    bsp_vector candidates; // plane_candidate
    uint32_t *places;      // a plane: in candidates + 1, or 0; twins share one
    uint32_t plane_count;
    uint64_t classified;   // pieces held against planes so far
    uint64_t effort_most;  // beyond, few candidates are tried
} chooser;

cull_result chooser_make(const cull_host *host, const piece_set *set, bsp_wish wish, chooser *out);
void chooser_free(const cull_host *host, chooser *c);

typedef enum choice { CHOICE_MEMORY, CHOICE_PLANE, CHOICE_CONVEX, CHOICE_GAVE_UP } choice; // gave up: too many planes to hold it against
choice chooser_choose(chooser *c, const uint32_t *pieces, uint32_t count, uint32_t *plane);

#endif
