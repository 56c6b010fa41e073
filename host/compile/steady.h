// Sizes and places for orders alone, rounded far coarser than doubles err: a turned, mirrored or moved map gives the same.
// SPDX-License-Identifier: MIT
// Invariant: no geometry is decided here: any order is right.
#ifndef PORTCULLIS_HOST_STEADY_H
#define PORTCULLIS_HOST_STEADY_H

#include <math.h>
#include <stdint.h>

// Of a size: 2^20 steps a doubling; what is not positive comes last of all.
static inline int64_t steady_log(double x)
{
    return x > 0 ? llround(log2(x) * 1048576) : INT64_MIN / 2;
}

// Middles of many things, weighed by size, its square and its cube: a symmetric pair is told apart by what is not.
enum { STEADY_CENTRES = 3 };
typedef struct steady_centres { double sums[STEADY_CENTRES][3], weights[STEADY_CENTRES]; } steady_centres;

static inline void steady_centres_add(steady_centres *c, double size, const double middle[3])
{
    double weight = 1;
    for (int i = 0; i < STEADY_CENTRES; ++i) {
        c->weights[i] += weight *= size;
        for (int k = 0; k < 3; ++k) c->sums[i][k] += weight * middle[k];
    }
}

// How far a place is from each centre: squared, and rounded.
static inline void steady_places(const steady_centres *c, const double at[3], int64_t out[STEADY_CENTRES])
{
    for (int i = 0; i < STEADY_CENTRES; ++i) {
        double square = 0;
        for (int k = 0; k < 3; ++k) {
            const double off = at[k] - (c->weights[i] > 0 ? c->sums[i][k] / c->weights[i] : 0);
            square += off * off;
        }
        out[i] = steady_log(square);
    }
}

// Below 0: a comes first, the far one.
static inline int steady_places_compare(const int64_t a[STEADY_CENTRES], const int64_t b[STEADY_CENTRES])
{
    for (int i = 0; i < STEADY_CENTRES; ++i)
        if (a[i] != b[i]) return a[i] > b[i] ? -1 : 1;
    return 0;
}

#endif
