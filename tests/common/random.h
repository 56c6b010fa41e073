// Repeatable random numbers for tests: splitmix64, the same on every machine.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_RANDOM_H
#define PORTCULLIS_TESTS_RANDOM_H

#include <math.h>
#include <stdint.h>

static inline uint64_t random_bits(uint64_t *state)
{
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}

// In [0, count); count at least 1.
static inline uint32_t random_below(uint64_t *state, uint32_t count)
{
    return (uint32_t)(random_bits(state) % count);
}

// In [low, high), a multiple of (high - low) / 2^32.
static inline double random_between(uint64_t *state, double low, double high)
{
    return low + (high - low) * ((double)(random_bits(state) >> 32) / 4294967296.0);
}

// In [0, 1).
static inline double random_unit(uint64_t *state)
{
    return random_between(state, 0, 1);
}

static inline void random_direction(uint64_t *state, double out[3]) // unit
{
    double square;
    do {
        for (int i = 0; i < 3; i++) out[i] = random_between(state, -1, 1);
        square = out[0] * out[0] + out[1] * out[1] + out[2] * out[2];
    } while (square > 1 || square < 1e-4);
    for (int i = 0; i < 3; i++) out[i] /= sqrt(square);
}

#endif
