// Sixteen floats or integers side by side, over AVX-512, AVX2 or plain C: the words that the kernels of method=hiz are written in.
// SPDX-License-Identifier: MIT
//
// Invariant: each word does the same IEEE operations in each dialect, so all kernels give the same bits. A file picks the dialect by
// HIZ_AVX512 or HIZ_AVX2 before this line; a set of lanes is the low 16 bits of a uint32_t.
#ifndef OCCLUSION_HIZ_LANES_H
#define OCCLUSION_HIZ_LANES_H

#include <stdint.h>

enum { HIZ_LANES = 16, HIZ_ALL_LANES = 0xffff };

#if defined(HIZ_AVX512)
#include "hiz_lanes_avx512.h"
#elif defined(HIZ_AVX2)
#include "hiz_lanes_avx2.h"
#else
#include "hiz_lanes_plain.h"
#endif

// 0 .. 15 and what follows from it, as data: a vector constant costs a load either way.
static const float hiz_ramp[HIZ_LANES] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};

static inline uint32_t hiz_low_lanes(uint32_t count)
{
    return count >= HIZ_LANES ? (uint32_t)HIZ_ALL_LANES : (1u << count) - 1;
}

#endif
