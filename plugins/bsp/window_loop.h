// Loops of points on the picture plane, counterclockwise, multiples of 2^-36: exact turns and hulls.
// SPDX-License-Identifier: MIT
//
// Invariant: what loop_turn says is never wrong, so no hull drops a point that lies outside it by however little.
#ifndef PORTCULLIS_BSP_WINDOW_LOOP_H
#define PORTCULLIS_BSP_WINDOW_LOOP_H

#include <stdint.h>
#include <string.h>

enum { LOOP_MOST = 68, LOOP_STEP = 4, LOOP_ROOM = LOOP_MOST + LOOP_STEP }; // two windows' corners, and what a bent one may gain

typedef struct loop { double u[LOOP_ROOM], v[LOOP_ROOM]; uint32_t count; } loop;
typedef struct loop_point { double u, v; } loop_point;

// By whole steps, which costs less than a call: the LOOP_STEP - 1 numbers behind the last are read, and overwritten with anything.
static inline void loop_copy(const double *from_u, const double *from_v, uint32_t count, double *to_u, double *to_v)
{
    for (uint32_t i = 0; i < count; i += LOOP_STEP) {
        memcpy(to_u + i, from_u + i, LOOP_STEP * sizeof *to_u);
        memcpy(to_v + i, from_v + i, LOOP_STEP * sizeof *to_v);
    }
}

// The first corner stands behind the last once more.
static inline void loop_close(loop *l)
{
    l->u[l->count] = l->u[0];
    l->v[l->count] = l->v[0];
}

int loop_turn(loop_point a, loop_point b, loop_point c); // 1: to the left, -1: to the right, 0: all on one line
double loop_area(const double *u, const double *v, uint32_t count);
void loop_tidy(loop *l); // corners on one spot become one
// Takes in the points of `more`. 0: they all lay inside, nothing changed. Counts are at most 34 each. `hull` is closed, before and after.
int loop_hull(loop *hull, const loop *more);
uint64_t loop_sides_out(const loop *closed, loop_point p); // of at most 64: a bit for each edge that has the point outside, exactly

#endif
