// The kernels for AVX-512: a block is a vector.
// SPDX-License-Identifier: MIT
#if defined(__x86_64__)
#include <immintrin.h>
#define CULL_BLOCK_LANES 16
#include "walk.h"

static inline __m512 bottom_row(const index_bottom *b, uint32_t at, int axis)
{
    const __m512 steps = _mm512_cvtepi32_ps(_mm512_cvtepu8_epi32(_mm_loadu_si128((const __m128i *)(const void *)(b->steps + at))));
    return _mm512_add_ps(_mm512_set1_ps(b->origin[axis]), _mm512_mul_ps(_mm512_set1_ps(b->step[axis]), steps));
}

static inline __m512 bottom_sum(const index_bottom *b, const cull_block_plane *p, uint32_t x, uint32_t y, uint32_t z)
{
    const __m512 sx = _mm512_mul_ps(bottom_row(b, x, 0), _mm512_set1_ps(p->x)), sy = _mm512_mul_ps(bottom_row(b, y, 1), _mm512_set1_ps(p->y));
    return _mm512_add_ps(_mm512_add_ps(sx, sy), _mm512_mul_ps(bottom_row(b, z, 2), _mm512_set1_ps(p->z)));
}

static inline void bottom_split(const index_bottom *b, const cull_block_plane *planes, uint32_t which, cull_block_split *out)
{
    __mmask16 touching = 0xffff;
    __m512i cut = _mm512_setzero_si512();
    for (; which; which &= which - 1) {
        const cull_block_plane *p = &planes[cull_lowest_bit(which)];
        const __m512 limit = _mm512_set1_ps(p->limit);
        touching = _mm512_mask_cmp_ps_mask(touching, bottom_sum(b, p, p->inner_x, p->inner_y, p->inner_z), limit, _CMP_NLT_UQ);
        const __mmask16 is_cut = _mm512_cmp_ps_mask(bottom_sum(b, p, p->outer_x, p->outer_y, p->outer_z), limit, _CMP_NGE_UQ);
        cut = _mm512_mask_or_epi32(cut, is_cut, cut, _mm512_set1_epi32((int)(which & -which)));
    }
    out->touching = touching;
    out->cut = _mm512_test_epi32_mask(cut, cut);
    _mm512_store_si512(out->planes, cut);
}

// Compressed in a register and stored whole: a compressing store is slow on some CPUs.
static inline uint32_t *put_vector(uint32_t bits, __m512i from, uint32_t *out)
{
    _mm512_storeu_si512(out, _mm512_maskz_compress_epi32((__mmask16)bits, from));
    return out + _mm_popcnt_u32(bits);
}

static inline uint32_t *put_places(uint32_t bits, uint32_t base, uint32_t *out)
{
    const __m512i ramp = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    return put_vector(bits, _mm512_add_epi32(ramp, _mm512_set1_epi32((int)base)), out);
}

static inline uint32_t *put_firsts(uint32_t bits, const uint32_t *firsts, uint32_t *out)
{
    return put_vector(bits, _mm512_load_si512(firsts), out);
}

#include "walk_reorder.h"

#include "walk_body.h"
#include "walk_many_body.h"

const walk_kernel walk_avx512 = {"avx512", walk_any};
#else
typedef int walk_avx512_is_empty;
#endif
