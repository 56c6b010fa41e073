// The kernels for the baseline of the CPU's kind.
// SPDX-License-Identifier: MIT
#include "walk.h"

static inline uint32_t *put_places(uint32_t bits, uint32_t base, uint32_t *out)
{
    for (; bits; bits &= bits - 1) *out++ = base + (uint32_t)__builtin_ctz(bits);
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

#include "walk_judge.h"
#include "walk_body.h"
#include "walk_direct_body.h"
#include "walk_many_body.h"

const walk_kernel walk_plain = {"plain", walk_any};
