// The kernels in plain C: what the compiler makes of the baseline.
// SPDX-License-Identifier: MIT
#include "walk.h"

static inline uint32_t *put16(uint32_t bits, uint32_t base, uint32_t shift, uint32_t *out)
{
    for (; bits; bits &= bits - 1) *out++ = base + ((uint32_t)__builtin_ctz(bits) << shift);
    return out;
}

#include "walk_body.h"
#include "walk_small_body.h"

const walk_kernel walk_plain = {"plain", walk_volume, walk_facing, walk_small};
