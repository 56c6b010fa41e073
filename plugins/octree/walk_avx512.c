// The kernels for AVX-512: a block is a vector.
// SPDX-License-Identifier: MIT
#if defined(__x86_64__)
#include <immintrin.h>
#define CULL_BLOCK_LANES 16
#include "walk.h"

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

static inline void put_all_or_none(uint32_t bits, uint32_t *out)
{
    _mm512_storeu_si512(out, _mm512_maskz_set1_epi32((__mmask16)bits, ALL_ITEMS));
}

static inline void ends_to_counts(uint32_t *changes, uint32_t run_count)
{
    for (uint32_t i = 0; i < run_count; i += 8) {
        const __m512i pairs = _mm512_loadu_si512(changes + 2 * (size_t)i);
        _mm512_storeu_si512(changes + 2 * (size_t)i, _mm512_sub_epi32(pairs, _mm512_slli_epi64(pairs, 32)));
    }
}

#include "walk_reorder.h"

#include "walk_judge.h"
#include "walk_body.h"
#include "walk_segments_body.h"
#include "walk_many_body.h"

const walk_kernel walk_avx512 = {"avx512", walk_any};
#else
typedef int walk_avx512_is_empty;
#endif
