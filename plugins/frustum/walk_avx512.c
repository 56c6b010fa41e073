// The kernels for AVX-512: a block is a vector.
// SPDX-License-Identifier: MIT
#if defined(__x86_64__)
#include <immintrin.h>
#define CULL_BLOCK_LANES 16
#include "walk.h"

// Compressed in a register and stored whole: a compressing store is slow on some CPUs.
static inline uint32_t *put16(uint32_t bits, uint32_t base, uint32_t shift, uint32_t *out)
{
    const __m512i ramp = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    const __m512i places = _mm512_add_epi32(_mm512_sll_epi32(ramp, _mm_cvtsi32_si128((int)shift)), _mm512_set1_epi32((int)base));
    _mm512_storeu_si512(out, _mm512_maskz_compress_epi32((__mmask16)bits, places));
    return out + _mm_popcnt_u32(bits);
}

#include "walk_body.h"
#include "walk_small_body.h"

const walk_kernel walk_avx512 = {"avx512", walk_volume, walk_facing, walk_small};
#else
typedef int walk_avx512_is_empty;
#endif
