// Random numbers for generated scenes: xoshiro256** seeded by splitmix64 (Blackman and Vigna, 2018).
// SPDX-License-Identifier: MIT
// Invariant: only integer arithmetic and exact divisions, so every compiler draws the same scene.
#ifndef PORTCULLIS_BENCH_GENERATE_RANDOM_H
#define PORTCULLIS_BENCH_GENERATE_RANDOM_H

#include <stdint.h>

typedef struct random_stream { uint64_t state[4]; } random_stream;

static inline uint64_t random_mix(uint64_t *state)
{
    uint64_t z = *state += 0x9E3779B97F4A7C15u;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
}

// Streams of different seeds or different keys have nothing in common.
static inline random_stream random_make(uint64_t seed, uint64_t key)
{
    uint64_t state = seed;
    const uint64_t mixed_seed = random_mix(&state);
    state = key ^ mixed_seed;
    random_stream r;
    for (int i = 0; i < 4; ++i) r.state[i] = random_mix(&state);
    return r;
}

static inline uint64_t random_rotate(uint64_t x, int bits)
{
    return (x << bits) | (x >> (64 - bits));
}

static inline uint64_t random_bits(random_stream *r)
{
    uint64_t *s = r->state;
    const uint64_t value = random_rotate(s[1] * 5, 7) * 9, shifted = s[1] << 17;
    s[2] ^= s[0];
    s[3] ^= s[1];
    s[1] ^= s[2];
    s[0] ^= s[3];
    s[2] ^= shifted;
    s[3] = random_rotate(s[3], 45);
    return value;
}

// 0 .. count - 1; count at least 1, less than 2^32. The bias is below count / 2^32.
static inline uint32_t random_below(random_stream *r, uint32_t count)
{
    return (uint32_t)(((random_bits(r) >> 32) * count) >> 32);
}

// least .. most, both included; most - least below 2^31
static inline int32_t random_between(random_stream *r, int32_t least, int32_t most)
{
    return least + (int32_t)random_below(r, (uint32_t)(most - least) + 1);
}

static inline double random_unit(random_stream *r) // 0 <= u < 1
{
    return (double)(random_bits(r) >> 11) * 0x1p-53;
}

#endif
