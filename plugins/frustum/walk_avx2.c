// The kernels for AVX2 with BMI2: two vectors a block.
// SPDX-License-Identifier: MIT
#if defined(__x86_64__)
#include <immintrin.h>
#define CULL_BLOCK_LANES 8
#include "walk.h"

static inline uint32_t *put8(uint32_t bits, uint32_t base, uint32_t shift, uint32_t *out)
{
    const __m256i places = _mm256_sll_epi32(cull_block_numbers8(bits), _mm_cvtsi32_si128((int)shift));
    _mm256_storeu_si256((__m256i *)(void *)out, _mm256_add_epi32(places, _mm256_set1_epi32((int)base)));
    return out + _mm_popcnt_u32(bits);
}

static inline uint32_t *put16(uint32_t bits, uint32_t base, uint32_t shift, uint32_t *out)
{
    if (!bits) return out;
    out = put8(bits & 0xff, base, shift, out);
    return put8(bits >> 8, base + (8u << shift), shift, out);
}

#include "walk_body.h"
#include "walk_small_body.h"

const walk_kernel walk_avx2 = {"avx2", walk_volume, walk_facing, walk_small};
#else
typedef int walk_avx2_is_empty;
#endif
