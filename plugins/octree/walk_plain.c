// The kernels in plain C: what the compiler makes of the baseline.
// SPDX-License-Identifier: MIT
#include "walk.h"

static inline uint32_t *put_places(uint32_t bits, uint32_t base, uint32_t *out)
{
    for (; bits; bits &= bits - 1) *out++ = base + (uint32_t)__builtin_ctz(bits);
    return out;
}

static inline uint32_t *put_firsts(uint32_t bits, const uint32_t *firsts, uint32_t *out)
{
    for (; bits; bits &= bits - 1) *out++ = firsts[__builtin_ctz(bits)];
    return out;
}

static inline void put_all_or_none(uint32_t bits, uint32_t *out)
{
    for (uint32_t i = 0; i < CULL_BLOCK_WIDTH; i++) out[i] = bits >> i & 1 ? ALL_ITEMS : 0;
}

static inline uint32_t pick(uint32_t bits, uint32_t mask)
{
    uint32_t out = 0;
    for (uint32_t place = 0; mask; mask &= mask - 1) out |= (bits >> cull_lowest_bit(mask) & 1) << place++;
    return out;
}

static inline void ends_to_counts(uint32_t *changes, uint32_t run_count)
{
    for (uint32_t i = 0; i < run_count; i++) changes[2 * (size_t)i + 1] -= changes[2 * (size_t)i];
}

static inline uint32_t reorder(uint32_t bits, uint64_t order)
{
    uint32_t out = 0;
    for (uint32_t i = 0; i < CULL_BLOCK_WIDTH; i++) out |= (bits >> (order >> 4 * i & 15) & 1) << i;
    return out;
}

#include "walk_body.h"
#include "walk_many_body.h"

const walk_kernel walk_plain = {"plain", walk_any};
