// The kernels for AVX2 with BMI2: two vectors a block.
// SPDX-License-Identifier: MIT
#if defined(__x86_64__)
#include <immintrin.h>
#define CULL_BLOCK_LANES 8
#include "walk.h"

static inline uint32_t *put_places8(uint32_t bits, uint32_t base, uint32_t *out)
{
    _mm256_storeu_si256((__m256i *)(void *)out, _mm256_add_epi32(cull_block_numbers8(bits), _mm256_set1_epi32((int)base)));
    return out + _mm_popcnt_u32(bits);
}

static inline uint32_t *put_places(uint32_t bits, uint32_t base, uint32_t *out)
{
    if (!bits) return out;
    return put_places8(bits >> 8, base + 8, put_places8(bits & 0xff, base, out));
}

static inline uint32_t *put_firsts8(uint32_t bits, const uint32_t *firsts, uint32_t *out)
{
    const __m256i all = _mm256_loadu_si256((const __m256i *)(const void *)firsts);
    _mm256_storeu_si256((__m256i *)(void *)out, _mm256_permutevar8x32_epi32(all, cull_block_numbers8(bits)));
    return out + _mm_popcnt_u32(bits);
}

static inline uint32_t *put_firsts(uint32_t bits, const uint32_t *firsts, uint32_t *out)
{
    if (!bits) return out;
    return put_firsts8(bits >> 8, firsts + 8, put_firsts8(bits & 0xff, firsts, out));
}

static inline void put_all_or_none(uint32_t bits, uint32_t *out)
{
    const __m256i low = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128), high = _mm256_slli_epi32(low, 8), all = _mm256_set1_epi32((int)bits);
    const __m256i items = _mm256_set1_epi32(ALL_ITEMS);
    _mm256_storeu_si256((__m256i *)(void *)out, _mm256_and_si256(_mm256_cmpeq_epi32(_mm256_and_si256(all, low), low), items));
    _mm256_storeu_si256((__m256i *)(void *)(out + 8), _mm256_and_si256(_mm256_cmpeq_epi32(_mm256_and_si256(all, high), high), items));
}

static inline void ends_to_counts(uint32_t *changes, uint32_t run_count)
{
    for (uint32_t i = 0; i < run_count; i += 4) {
        __m256i *const four = (__m256i *)(void *)(changes + 2 * (size_t)i);
        const __m256i pairs = _mm256_loadu_si256(four);
        _mm256_storeu_si256(four, _mm256_sub_epi32(pairs, _mm256_slli_epi64(pairs, 32)));
    }
}

#include "walk_reorder.h"

#include "walk_judge.h"
#include "walk_body.h"
#include "walk_segments_body.h"
#include "walk_many_body.h"

const walk_kernel walk_avx2 = {"avx2", walk_any};
#else
typedef int walk_avx2_is_empty;
#endif
