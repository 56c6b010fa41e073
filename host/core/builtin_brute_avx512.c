// The loop of `brute` for AVX-512: 16 boxes a vector, masks, compressed stores.
// SPDX-License-Identifier: MIT
#include "builtin_brute.h"

#if defined(__x86_64__)
#include <immintrin.h>

static inline uint32_t test16(const brute_plane *planes, uint32_t plane_count, uint32_t i)
{
    __mmask16 inside = 0xffff;
    for (uint32_t k = 0; k < plane_count; k++) {
        const brute_plane *p = &planes[k];
        const __m512 x = _mm512_mul_ps(_mm512_load_ps(p->x + i), _mm512_set1_ps(p->normal_x));
        const __m512 y = _mm512_mul_ps(_mm512_load_ps(p->y + i), _mm512_set1_ps(p->normal_y));
        const __m512 z = _mm512_mul_ps(_mm512_load_ps(p->z + i), _mm512_set1_ps(p->normal_z));
        const __m512 sum = _mm512_add_ps(_mm512_add_ps(x, y), z);
        inside = _mm512_mask_cmp_ps_mask(inside, sum, _mm512_set1_ps(p->limit), _CMP_GE_OQ);
    }
    return inside;
}

static inline uint32_t *put64(uint64_t bits, uint32_t base, uint32_t *out)
{
    const __m512i ramp = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    for (uint32_t b = 0; b < 64; b += 16) {
        const __mmask16 m = (__mmask16)(bits >> b & 0xffff);
        const __m512i places = _mm512_add_epi32(ramp, _mm512_set1_epi32((int)(base + b)));
        // Compressed in a register and stored whole: a compressing store is slow on some CPUs.
        _mm512_storeu_si512(out, _mm512_maskz_compress_epi32(m, places));
        out += _mm_popcnt_u32(m);
    }
    return out;
}

#include "builtin_brute_body.h"

uint32_t brute_avx512(const brute_job *job, cull_run *runs)
{
    return brute_run(job, runs);
}
#else
typedef int builtin_brute_avx512_is_empty;
#endif
