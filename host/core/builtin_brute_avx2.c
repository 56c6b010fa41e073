// The loop of `brute` for AVX2 with BMI2: 8 boxes a vector.
// SPDX-License-Identifier: MIT
#include "builtin_brute.h"

#if defined(__x86_64__)
#include <immintrin.h>

static inline uint32_t test8(const brute_plane *planes, uint32_t plane_count, uint32_t i)
{
    __m256 inside = _mm256_castsi256_ps(_mm256_set1_epi32(-1));
    for (uint32_t k = 0; k < plane_count; k++) {
        const brute_plane *p = &planes[k];
        const __m256 x = _mm256_mul_ps(_mm256_load_ps(p->x + i), _mm256_set1_ps(p->normal_x));
        const __m256 y = _mm256_mul_ps(_mm256_load_ps(p->y + i), _mm256_set1_ps(p->normal_y));
        const __m256 z = _mm256_mul_ps(_mm256_load_ps(p->z + i), _mm256_set1_ps(p->normal_z));
        const __m256 sum = _mm256_add_ps(_mm256_add_ps(x, y), z);
        inside = _mm256_and_ps(inside, _mm256_cmp_ps(sum, _mm256_set1_ps(p->limit), _CMP_GE_OQ));
    }
    return (uint32_t)_mm256_movemask_ps(inside);
}

static inline uint32_t test16(const brute_plane *planes, uint32_t plane_count, uint32_t i)
{
    return test8(planes, plane_count, i) | test8(planes, plane_count, i + 8) << 8;
}

// The numbers of the set bits, as bytes: the bytes 0 .. 7 that stand where a bit is set, moved together.
static inline uint32_t *put64(uint64_t bits, uint32_t base, uint32_t *out)
{
    for (uint32_t b = 0; b < 64; b += 8) {
        const uint64_t byte = bits >> b & 0xff;
        const uint64_t picked = _pext_u64(UINT64_C(0x0706050403020100), _pdep_u64(byte, UINT64_C(0x0101010101010101)) * 255);
        const __m256i places = _mm256_cvtepu8_epi32(_mm_cvtsi64_si128((long long)picked));
        _mm256_storeu_si256((__m256i *)(void *)out, _mm256_add_epi32(places, _mm256_set1_epi32((int)(base + b))));
        out += _mm_popcnt_u64(byte);
    }
    return out;
}

#include "builtin_brute_body.h"

uint32_t brute_avx2(const brute_job *job, cull_run *runs)
{
    return brute_run(job, runs);
}
#else
typedef int builtin_brute_avx2_is_empty;
#endif
