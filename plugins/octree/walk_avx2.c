// The kernels for AVX2 with BMI2: two vectors a block.
// SPDX-License-Identifier: MIT
#if defined(__x86_64__)
#include <immintrin.h>
#define CULL_BLOCK_LANES 8
#include "walk.h"

static inline __m256 bottom_row(const index_bottom *b, uint32_t at, int axis)
{
    const __m256 steps = _mm256_cvtepi32_ps(_mm256_cvtepu8_epi32(_mm_loadl_epi64((const __m128i *)(const void *)(b->steps + at))));
    return _mm256_add_ps(_mm256_set1_ps(b->origin[axis]), _mm256_mul_ps(_mm256_set1_ps(b->step[axis]), steps));
}

static inline __m256 bottom_sum(const index_bottom *b, const cull_block_plane *p, uint32_t x, uint32_t y, uint32_t z)
{
    const __m256 sx = _mm256_mul_ps(bottom_row(b, x, 0), _mm256_set1_ps(p->x)), sy = _mm256_mul_ps(bottom_row(b, y, 1), _mm256_set1_ps(p->y));
    return _mm256_add_ps(_mm256_add_ps(sx, sy), _mm256_mul_ps(bottom_row(b, z, 2), _mm256_set1_ps(p->z)));
}

// Children half .. half + 7.
static inline void bottom_split8(const index_bottom *b, const cull_block_plane *planes, uint32_t which, uint32_t half, cull_block_split *out)
{
    __m256i cut = _mm256_setzero_si256();
    __m256 touching = _mm256_castsi256_ps(_mm256_cmpeq_epi32(cut, cut));
    for (; which; which &= which - 1) {
        const cull_block_plane *p = &planes[cull_lowest_bit(which)];
        const __m256i plane_bit = _mm256_set1_epi32((int)(which & -which));
        const __m256 limit = _mm256_set1_ps(p->limit);
        const __m256 inner = bottom_sum(b, p, p->inner_x + half, p->inner_y + half, p->inner_z + half);
        const __m256 outer = bottom_sum(b, p, p->outer_x + half, p->outer_y + half, p->outer_z + half);
        touching = _mm256_and_ps(touching, _mm256_cmp_ps(inner, limit, _CMP_NLT_UQ));
        cut = _mm256_or_si256(cut, _mm256_and_si256(_mm256_castps_si256(_mm256_cmp_ps(outer, limit, _CMP_NGE_UQ)), plane_bit));
    }
    const __m256 is_whole = _mm256_castsi256_ps(_mm256_cmpeq_epi32(cut, _mm256_setzero_si256()));
    _mm256_store_si256((__m256i *)(void *)(out->planes + half), cut);
    out->touching |= (uint32_t)_mm256_movemask_ps(touching) << half;
    out->cut |= ((uint32_t)_mm256_movemask_ps(is_whole) ^ 0xff) << half;
}

static inline void bottom_split(const index_bottom *b, const cull_block_plane *planes, uint32_t which, cull_block_split *out)
{
    out->touching = out->cut = 0;
    bottom_split8(b, planes, which, 0, out);
    bottom_split8(b, planes, which, 8, out);
}

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

#include "walk_reorder.h"

#include "walk_body.h"
#include "walk_many_body.h"

const walk_kernel walk_avx2 = {"avx2", walk_any};
#else
typedef int walk_avx2_is_empty;
#endif
