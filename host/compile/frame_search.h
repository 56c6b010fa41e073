// Parts of the search for a turned frame: see turned_frame.h.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_FRAME_SEARCH_H
#define PORTCULLIS_HOST_FRAME_SEARCH_H

#include "turned_frame.h"

typedef struct frame_points {
    const int32_t (*at)[3]; // grid steps
    size_t count;
    uint32_t grid, reference; // steps a unit; a point near the middle of all, taken for one of the frame's
    double reach;             // of the farthest from that, steps
} frame_points;

typedef struct rough_frame { // a rotation and the frame's points, in doubles
    double turn[3][3];
    double shift[3]; // parts of a unit, about the reference
    uint32_t parts;
} rough_frame;

// Points within the tolerance of the frame's.
uint32_t turned_frame_explains(const turned_frame *f, const int32_t (*points)[3], size_t count);
// frame_fit.c: turn and shift fitted to all points, from near the reference outward. turn: within 1/256 of a right one. 0: they
// lie on no such grid.
int rough_frame_fit(const frame_points *p, rough_frame *f);
// The simplest rational rotation that takes no point of the map farther than a quarter of a step. 0: none is simple enough.
int rough_frame_rational(const frame_points *p, const rough_frame *f, turned_frame *out);

#endif
