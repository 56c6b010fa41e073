// The kernels for AVX-512: a block is a vector.
// SPDX-License-Identifier: MIT
#include "walk_plane.h"

#if defined(__x86_64__)
#include <immintrin.h>

static inline __m512 height(const float *x, const float *y, const float *z, const walk_plane *p)
{
    const __m512 sx = _mm512_mul_ps(_mm512_load_ps(x), _mm512_set1_ps(p->x));
    const __m512 sy = _mm512_mul_ps(_mm512_load_ps(y), _mm512_set1_ps(p->y));
    const __m512 sz = _mm512_mul_ps(_mm512_load_ps(z), _mm512_set1_ps(p->z));
    return _mm512_add_ps(_mm512_add_ps(sx, sy), sz);
}

static inline uint32_t block_touch(const float *block, const walk_plane *planes, uint32_t which)
{
    __mmask16 touching = 0xffff;
    for (; which; which &= which - 1) {
        const walk_plane *p = &planes[__builtin_ctz(which)];
        const __m512 sum = height(block + p->inner_x, block + p->inner_y, block + p->inner_z, p);
        touching = _mm512_mask_cmp_ps_mask(touching, sum, _mm512_set1_ps(p->limit), _CMP_GE_OQ);
    }
    return touching;
}

static inline void block_split(const float *block, const walk_plane *planes, uint32_t which, walk_split *out)
{
    __mmask16 touching = 0xffff;
    __m512i cut = _mm512_setzero_si512();
    for (; which; which &= which - 1) {
        const walk_plane *p = &planes[__builtin_ctz(which)];
        const __m512 limit = _mm512_set1_ps(p->limit);
        const __m512 inner = height(block + p->inner_x, block + p->inner_y, block + p->inner_z, p);
        const __m512 outer = height(block + p->outer_x, block + p->outer_y, block + p->outer_z, p);
        touching = _mm512_mask_cmp_ps_mask(touching, inner, limit, _CMP_GE_OQ);
        const __mmask16 is_cut = _mm512_cmp_ps_mask(outer, limit, _CMP_NGE_UQ);
        cut = _mm512_mask_or_epi32(cut, is_cut, cut, _mm512_set1_epi32((int)(which & -which)));
    }
    out->touching = touching;
    out->cut = _mm512_test_epi32_mask(cut, cut);
    _mm512_store_si512(out->planes, cut);
}

static inline uint32_t block_facing(const float *f, const float eye[4], float reach)
{
    const __m512 x = _mm512_mul_ps(_mm512_load_ps(f), _mm512_set1_ps(eye[0]));
    const __m512 y = _mm512_mul_ps(_mm512_load_ps(f + 16), _mm512_set1_ps(eye[1]));
    const __m512 z = _mm512_mul_ps(_mm512_load_ps(f + 32), _mm512_set1_ps(eye[2]));
    const __m512 offset = _mm512_mul_ps(_mm512_load_ps(f + 48), _mm512_set1_ps(eye[3]));
    const __m512 doubt = _mm512_mul_ps(_mm512_load_ps(f + 64), _mm512_set1_ps(reach));
    const __m512 sum = _mm512_add_ps(_mm512_add_ps(_mm512_add_ps(x, y), z), _mm512_add_ps(offset, doubt));
    return _mm512_cmp_ps_mask(sum, _mm512_setzero_ps(), _CMP_GE_OQ);
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
