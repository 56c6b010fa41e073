// The words of hiz_lanes.h over AVX2: two vectors of eight.
// SPDX-License-Identifier: MIT
#ifndef OCCLUSION_HIZ_LANES_AVX2_H
#define OCCLUSION_HIZ_LANES_AVX2_H

#include <immintrin.h>

typedef struct hiz_f { __m256 a, b; } hiz_f;
typedef struct hiz_i { __m256i a, b; } hiz_i;

#define HIZ_EACH(name, word) \
    static inline hiz_f name(hiz_f x, hiz_f y) { const hiz_f r = {word(x.a, y.a), word(x.b, y.b)}; return r; }
HIZ_EACH(f_add, _mm256_add_ps)
HIZ_EACH(f_sub, _mm256_sub_ps)
HIZ_EACH(f_mul, _mm256_mul_ps)
HIZ_EACH(f_div, _mm256_div_ps)
HIZ_EACH(f_min, _mm256_min_ps)
HIZ_EACH(f_max, _mm256_max_ps)
#undef HIZ_EACH
#define HIZ_EACH(name, word) \
    static inline hiz_i name(hiz_i x, hiz_i y) { const hiz_i r = {word(x.a, y.a), word(x.b, y.b)}; return r; }
HIZ_EACH(i_add, _mm256_add_epi32)
HIZ_EACH(i_sub, _mm256_sub_epi32)
HIZ_EACH(i_mul, _mm256_mullo_epi32)
HIZ_EACH(i_min, _mm256_min_epi32)
HIZ_EACH(i_max, _mm256_max_epi32)
#undef HIZ_EACH

static inline uint32_t lanes_of(__m256 a, __m256 b)
{
    return (uint32_t)_mm256_movemask_ps(a) | (uint32_t)_mm256_movemask_ps(b) << 8;
}

static inline __m256i lanes_wide(uint32_t lanes)
{
    const __m256i bits = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
    return _mm256_cmpeq_epi32(_mm256_and_si256(_mm256_set1_epi32((int)lanes), bits), bits);
}

static inline hiz_f f_load(const float *p) { const hiz_f r = {_mm256_loadu_ps(p), _mm256_loadu_ps(p + 8)}; return r; }
static inline void f_store(float *p, hiz_f x)
{
    _mm256_storeu_ps(p, x.a);
    _mm256_storeu_ps(p + 8, x.b);
}
static inline void f_store_some(float *p, uint32_t lanes, hiz_f x)
{
    _mm256_maskstore_ps(p, lanes_wide(lanes), x.a);
    _mm256_maskstore_ps(p + 8, lanes_wide(lanes >> 8), x.b);
}
static inline hiz_f f_set(float a) { const hiz_f r = {_mm256_set1_ps(a), _mm256_set1_ps(a)}; return r; }
static inline hiz_f f_ceil(hiz_f x) { const hiz_f r = {_mm256_ceil_ps(x.a), _mm256_ceil_ps(x.b)}; return r; }
static inline hiz_f f_floor(hiz_f x) { const hiz_f r = {_mm256_floor_ps(x.a), _mm256_floor_ps(x.b)}; return r; }
static inline uint32_t f_above(hiz_f x, hiz_f y) { return lanes_of(_mm256_cmp_ps(x.a, y.a, _CMP_GT_OQ), _mm256_cmp_ps(x.b, y.b, _CMP_GT_OQ)); }
static inline uint32_t f_not_below(hiz_f x, hiz_f y)
{
    return lanes_of(_mm256_cmp_ps(x.a, y.a, _CMP_NLT_UQ), _mm256_cmp_ps(x.b, y.b, _CMP_NLT_UQ));
}
static inline hiz_f f_pick(uint32_t lanes, hiz_f yes, hiz_f no)
{
    const hiz_f r = {_mm256_blendv_ps(no.a, yes.a, _mm256_castsi256_ps(lanes_wide(lanes))),
                     _mm256_blendv_ps(no.b, yes.b, _mm256_castsi256_ps(lanes_wide(lanes >> 8)))};
    return r;
}
static inline hiz_f f_gather(const float *from, hiz_i at)
{
    const hiz_f r = {_mm256_i32gather_ps(from, at.a, 4), _mm256_i32gather_ps(from, at.b, 4)};
    return r;
}
static inline hiz_i f_to_i(hiz_f x) { const hiz_i r = {_mm256_cvttps_epi32(x.a), _mm256_cvttps_epi32(x.b)}; return r; }
static inline float f_least(hiz_f x)
{
    const __m256 m = _mm256_min_ps(x.a, x.b);
    const __m128 h = _mm_min_ps(_mm256_castps256_ps128(m), _mm256_extractf128_ps(m, 1));
    const __m128 q = _mm_min_ps(h, _mm_movehl_ps(h, h));
    return _mm_cvtss_f32(_mm_min_ss(q, _mm_shuffle_ps(q, q, 1)));
}

static inline hiz_i i_load(const void *p)
{
    const __m256i *v = p;
    const hiz_i r = {_mm256_loadu_si256(v), _mm256_loadu_si256(v + 1)};
    return r;
}
static inline void i_store(void *p, hiz_i x)
{
    __m256i *v = p;
    _mm256_storeu_si256(v, x.a);
    _mm256_storeu_si256(v + 1, x.b);
}
static inline void i_store_some(void *p, uint32_t lanes, hiz_i x)
{
    int *v = p;
    _mm256_maskstore_epi32(v, lanes_wide(lanes), x.a);
    _mm256_maskstore_epi32(v + 8, lanes_wide(lanes >> 8), x.b);
}
static inline hiz_i i_set(int32_t a) { const hiz_i r = {_mm256_set1_epi32(a), _mm256_set1_epi32(a)}; return r; }
static inline hiz_i i_pick(uint32_t lanes, hiz_i yes, hiz_i no)
{
    const hiz_i r = {_mm256_blendv_epi8(no.a, yes.a, lanes_wide(lanes)), _mm256_blendv_epi8(no.b, yes.b, lanes_wide(lanes >> 8))};
    return r;
}
static inline hiz_i i_shift_right(hiz_i x, int by) { const hiz_i r = {_mm256_srai_epi32(x.a, by), _mm256_srai_epi32(x.b, by)}; return r; }
static inline uint32_t i_above(hiz_i x, hiz_i y)
{
    return lanes_of(_mm256_castsi256_ps(_mm256_cmpgt_epi32(x.a, y.a)), _mm256_castsi256_ps(_mm256_cmpgt_epi32(x.b, y.b)));
}
static inline uint32_t i_negative(hiz_i x) { return lanes_of(_mm256_castsi256_ps(x.a), _mm256_castsi256_ps(x.b)); }

// Of lanes 0 to 7, and 8 to 15.
#define HIZ_HALVES(name, half, word) \
    static inline int32_t half(__m256i a) \
    { \
        __m128i h = word(_mm256_castsi256_si128(a), _mm256_extracti128_si256(a, 1)); \
        h = word(h, _mm_shuffle_epi32(h, 0x4e)); \
        return _mm_cvtsi128_si32(word(h, _mm_shuffle_epi32(h, 0xb1))); \
    } \
    static inline void name(hiz_i a, int32_t out[2]) \
    { \
        out[0] = half(a.a); \
        out[1] = half(a.b); \
    }
HIZ_HALVES(i_least_halves, i_least_half, _mm_min_epi32)
HIZ_HALVES(i_most_halves, i_most_half, _mm_max_epi32)
#undef HIZ_HALVES

// Lanes 8 to 15 as 0 to 7 where half is 1.
static inline hiz_i i_half(hiz_i x, int half)
{
    if (half) x.a = x.b;
    return x;
}

// Of lanes 0 to 7: pixels low .. end - 1 of each row, eight columns from x on, as bits, a byte a row.
static inline uint64_t i_row_bits(hiz_i low, hiz_i end, int32_t x)
{
    const __m256i base = _mm256_set1_epi32(x), zero = _mm256_setzero_si256(), eight = _mm256_set1_epi32(8), all = _mm256_set1_epi32(0xff);
    const __m256i from = _mm256_min_epi32(_mm256_max_epi32(_mm256_sub_epi32(low.a, base), zero), eight);
    const __m256i to = _mm256_min_epi32(_mm256_max_epi32(_mm256_sub_epi32(end.a, base), zero), eight);
    const __m256i bits = _mm256_and_si256(all, _mm256_andnot_si256(_mm256_sllv_epi32(all, to), _mm256_sllv_epi32(all, from)));
    const __m128i pairs = _mm_packus_epi32(_mm256_castsi256_si128(bits), _mm256_extracti128_si256(bits, 1));
    return (uint64_t)_mm_cvtsi128_si64(_mm_packus_epi16(pairs, pairs));
}

#endif
