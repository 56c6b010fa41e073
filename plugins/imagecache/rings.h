// Cells of a footprint by rings about the eye's cell, |i - ie| + |j - je| = d: front to back for rising d, back to front for falling d.
// A ring's cells of one quadrant are one interval, whose ends step by whole numbers and a remainder from ring to ring (Bresenham, 1965).
// SPDX-License-Identifier: MIT
//
// Invariant: along any ray from the eye d never falls and rises at each border crossed, since signs of the ray's dx, dz are fixed (1998
// report); so no cell comes before one that hides it, whatever the order within a ring. It holds for an eye outside the ground too.
// Invariant: the cells are exactly those that footprint_keeps, each once; nothing is sorted, and the cost is that of rings and cells.
#ifndef PORTCULLIS_IMAGECACHE_RINGS_H
#define PORTCULLIS_IMAGECACHE_RINGS_H

#include "footprint.h"

typedef enum rings_direction { RINGS_NEAR_FIRST, RINGS_FAR_FIRST } rings_direction;

enum {
    RINGS_QUADRANTS = 4,
    RINGS_LANES = FOOTPRINT_POINTS + 6, // edges, the box's sides, and the quadrant's own two
};

// floor(n / d) for n that rises by the same amount from ring to ring.
typedef struct rings_lane { int64_t value, rest, value_step, rest_step, divisor; } rings_lane;

// Places 1 .. d of the ring in a quadrant: cell (i0 + ai * place + bi * d, j0 + ...).
typedef struct rings_quadrant {
    rings_lane lanes[RINGS_LANES]; // the first `lower_count` say minus the least place, the others the greatest
    uint32_t lower_count, lane_count;
    int32_t ring, ring_last; // the next one and the last, in the order asked for
    int32_t ai, aj, bi, bj;
} rings_quadrant;

typedef struct rings {
    rings_quadrant quadrants[RINGS_QUADRANTS];
    ground_cell eye;
    int32_t ring, ring_last, step;
    enum { RINGS_EYE_CELL_OUT, RINGS_EYE_CELL_KEPT } eye_cell;
} rings;

// `count` cells from `first`, each (di, dj) on from the one before.
typedef struct rings_span {
    ground_cell first;
    int32_t di, dj;
    uint32_t count;
} rings_span;

typedef struct rings_ring {
    rings_span spans[RINGS_QUADRANTS];
    uint32_t span_count; // at least 1
    int32_t distance;    // d
} rings_ring;

// eye: any cell whose indices are at most 2^GROUND_LEVELS_MOST beyond the ground, see ground_eye.
void rings_start(const footprint *f, ground_cell eye, rings_direction direction, rings *out);
int rings_next(rings *r, rings_ring *out); // 0: that was all

#endif
