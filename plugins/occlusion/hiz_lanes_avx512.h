// The words of hiz_lanes.h over AVX-512: one vector.
// SPDX-License-Identifier: MIT
#ifndef OCCLUSION_HIZ_LANES_AVX512_H
#define OCCLUSION_HIZ_LANES_AVX512_H

#include <immintrin.h>

typedef __m512 hiz_f;
typedef __m512i hiz_i;

static inline hiz_f f_load(const float *p) { return _mm512_loadu_ps(p); }
static inline void f_store(float *p, hiz_f a) { _mm512_storeu_ps(p, a); }
static inline void f_store_some(float *p, uint32_t lanes, hiz_f a) { _mm512_mask_storeu_ps(p, (__mmask16)lanes, a); }
static inline hiz_f f_set(float a) { return _mm512_set1_ps(a); }
static inline hiz_f f_add(hiz_f a, hiz_f b) { return _mm512_add_ps(a, b); }
static inline hiz_f f_sub(hiz_f a, hiz_f b) { return _mm512_sub_ps(a, b); }
static inline hiz_f f_mul(hiz_f a, hiz_f b) { return _mm512_mul_ps(a, b); }
static inline hiz_f f_div(hiz_f a, hiz_f b) { return _mm512_div_ps(a, b); }
static inline hiz_f f_min(hiz_f a, hiz_f b) { return _mm512_min_ps(a, b); }
static inline hiz_f f_max(hiz_f a, hiz_f b) { return _mm512_max_ps(a, b); }
static inline hiz_f f_ceil(hiz_f a) { return _mm512_roundscale_ps(a, _MM_FROUND_TO_POS_INF | _MM_FROUND_NO_EXC); }
static inline hiz_f f_floor(hiz_f a) { return _mm512_roundscale_ps(a, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC); }
static inline uint32_t f_above(hiz_f a, hiz_f b) { return _mm512_cmp_ps_mask(a, b, _CMP_GT_OQ); }
static inline uint32_t f_not_below(hiz_f a, hiz_f b) { return _mm512_cmp_ps_mask(a, b, _CMP_NLT_UQ); }
static inline hiz_f f_pick(uint32_t lanes, hiz_f yes, hiz_f no) { return _mm512_mask_blend_ps((__mmask16)lanes, no, yes); }
static inline hiz_f f_gather(const float *from, hiz_i at) { return _mm512_i32gather_ps(at, from, 4); }
static inline hiz_i f_to_i(hiz_f a) { return _mm512_cvttps_epi32(a); }
static inline float f_least(hiz_f a) { return _mm512_reduce_min_ps(a); }

static inline hiz_i i_load(const void *p) { return _mm512_loadu_si512(p); }
static inline hiz_i i_pick(uint32_t lanes, hiz_i yes, hiz_i no) { return _mm512_mask_blend_epi32((__mmask16)lanes, no, yes); }
static inline void i_store(void *p, hiz_i a) { _mm512_storeu_si512(p, a); }
static inline void i_store_some(void *p, uint32_t lanes, hiz_i a) { _mm512_mask_storeu_epi32(p, (__mmask16)lanes, a); }
static inline hiz_i i_set(int32_t a) { return _mm512_set1_epi32(a); }
static inline hiz_i i_add(hiz_i a, hiz_i b) { return _mm512_add_epi32(a, b); }
static inline hiz_i i_sub(hiz_i a, hiz_i b) { return _mm512_sub_epi32(a, b); }
static inline hiz_i i_mul(hiz_i a, hiz_i b) { return _mm512_mullo_epi32(a, b); }
static inline hiz_i i_min(hiz_i a, hiz_i b) { return _mm512_min_epi32(a, b); }
static inline hiz_i i_max(hiz_i a, hiz_i b) { return _mm512_max_epi32(a, b); }
static inline hiz_i i_shift_right(hiz_i a, int by) { return _mm512_srai_epi32(a, (unsigned)by); }
static inline uint32_t i_above(hiz_i a, hiz_i b) { return _mm512_cmpgt_epi32_mask(a, b); }
static inline uint32_t i_negative(hiz_i a) { return _mm512_cmplt_epi32_mask(a, _mm512_setzero_si512()); }

// Of lanes 0 to 7, and 8 to 15.
#define HIZ_HALVES(name, word) \
    static inline void name(hiz_i a, int32_t out[2]) \
    { \
        a = word(a, _mm512_shuffle_i32x4(a, a, 0xb1)); \
        a = word(a, _mm512_shuffle_epi32(a, _MM_PERM_BADC)); \
        a = word(a, _mm512_shuffle_epi32(a, _MM_PERM_CDAB)); \
        out[0] = _mm_cvtsi128_si32(_mm512_castsi512_si128(a)); \
        out[1] = _mm_cvtsi128_si32(_mm512_extracti32x4_epi32(a, 2)); \
    }
HIZ_HALVES(i_least_halves, _mm512_min_epi32)
HIZ_HALVES(i_most_halves, _mm512_max_epi32)
#undef HIZ_HALVES

// Lanes 8 to 15 as 0 to 7 where half is 1.
static inline hiz_i i_half(hiz_i a, int half) { return half ? _mm512_shuffle_i64x2(a, a, 0x4e) : a; }

// Of lanes 0 to 7: pixels low .. end - 1 of each row, eight columns from x on, as bits, a byte a row.
static inline uint64_t i_row_bits(hiz_i low, hiz_i end, int32_t x)
{
    const __m512i base = _mm512_set1_epi32(x), zero = _mm512_setzero_si512(), eight = _mm512_set1_epi32(8), all = _mm512_set1_epi32(0xff);
    const __m512i from = _mm512_min_epi32(_mm512_max_epi32(_mm512_sub_epi32(low, base), zero), eight);
    const __m512i to = _mm512_min_epi32(_mm512_max_epi32(_mm512_sub_epi32(end, base), zero), eight);
    const __m512i bits = _mm512_andnot_si512(_mm512_sllv_epi32(all, to), _mm512_sllv_epi32(all, from));
    return (uint64_t)_mm_cvtsi128_si64(_mm512_cvtepi32_epi8(bits));
}

#endif
