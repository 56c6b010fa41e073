// Repeatable random numbers for automatic views: splitmix64 (Steele, Lea, Flood 2014), seeded by constants only.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_VIEWS_RANDOM_H
#define PORTCULLIS_HOST_VIEWS_RANDOM_H

#include <stdint.h>

typedef struct random_stream { uint64_t state; } random_stream;

static inline uint64_t random_bits(random_stream *r)
{
    uint64_t z = r->state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}

static inline double random_unit(random_stream *r) // 0 <= x < 1
{
    return (double)(random_bits(r) >> 11) * 0x1p-53;
}

static inline double random_between(random_stream *r, double low, double high)
{
    return low + random_unit(r) * (high - low);
}

static inline uint32_t random_below(random_stream *r, uint32_t count)
{
    return (uint32_t)(random_unit(r) * count);
}

#endif
