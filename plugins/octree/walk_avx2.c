// The kernels for AVX2 with BMI2: two vectors a block.
// SPDX-License-Identifier: MIT
#include "walk_plane.h"

#if defined(__x86_64__)
#include <immintrin.h>

static inline __m256 within(const float *x, const float *y, const float *z, const walk_plane *p)
{
    const __m256 sx = _mm256_mul_ps(_mm256_load_ps(x), _mm256_set1_ps(p->x));
    const __m256 sy = _mm256_mul_ps(_mm256_load_ps(y), _mm256_set1_ps(p->y));
    const __m256 sz = _mm256_mul_ps(_mm256_load_ps(z), _mm256_set1_ps(p->z));
    const __m256 sum = _mm256_add_ps(_mm256_add_ps(sx, sy), sz);
    return _mm256_cmp_ps(sum, _mm256_set1_ps(p->limit), _CMP_GE_OQ);
}

static inline uint32_t bits_of(__m256 low, __m256 high)
{
    return (uint32_t)_mm256_movemask_ps(low) | (uint32_t)_mm256_movemask_ps(high) << 8;
}

static inline uint32_t block_touch(const float *block, const walk_plane *planes, uint32_t which)
{
    __m256 low = _mm256_castsi256_ps(_mm256_set1_epi32(-1)), high = low;
    for (; which; which &= which - 1) {
        const walk_plane *p = &planes[__builtin_ctz(which)];
        const float *x = block + p->inner_x, *y = block + p->inner_y, *z = block + p->inner_z;
        low = _mm256_and_ps(low, within(x, y, z, p));
        high = _mm256_and_ps(high, within(x + 8, y + 8, z + 8, p));
    }
    return bits_of(low, high);
}

static inline void block_split(const float *block, const walk_plane *planes, uint32_t which, walk_split *out)
{
    __m256i cut_low = _mm256_setzero_si256(), cut_high = cut_low;
    out->touching = block_touch(block, planes, which);
    for (; which; which &= which - 1) {
        const walk_plane *p = &planes[__builtin_ctz(which)];
        const __m256i plane_bit = _mm256_set1_epi32((int)(which & -which));
        const float *x = block + p->outer_x, *y = block + p->outer_y, *z = block + p->outer_z;
        cut_low = _mm256_or_si256(cut_low, _mm256_andnot_si256(_mm256_castps_si256(within(x, y, z, p)), plane_bit));
        cut_high = _mm256_or_si256(cut_high, _mm256_andnot_si256(_mm256_castps_si256(within(x + 8, y + 8, z + 8, p)), plane_bit));
    }
    _mm256_store_si256((__m256i *)(void *)out->planes, cut_low);
    _mm256_store_si256((__m256i *)(void *)(out->planes + 8), cut_high);
    const __m256i zero = _mm256_setzero_si256();
    out->cut = 0xffffu ^ bits_of(_mm256_castsi256_ps(_mm256_cmpeq_epi32(cut_low, zero)),
                                 _mm256_castsi256_ps(_mm256_cmpeq_epi32(cut_high, zero)));
}

static inline __m256 facing8(const float *f, const float eye[4], float reach)
{
    const __m256 x = _mm256_mul_ps(_mm256_load_ps(f), _mm256_set1_ps(eye[0]));
    const __m256 y = _mm256_mul_ps(_mm256_load_ps(f + 16), _mm256_set1_ps(eye[1]));
    const __m256 z = _mm256_mul_ps(_mm256_load_ps(f + 32), _mm256_set1_ps(eye[2]));
    const __m256 offset = _mm256_mul_ps(_mm256_load_ps(f + 48), _mm256_set1_ps(eye[3]));
    const __m256 doubt = _mm256_mul_ps(_mm256_load_ps(f + 64), _mm256_set1_ps(reach));
    const __m256 sum = _mm256_add_ps(_mm256_add_ps(_mm256_add_ps(x, y), z), _mm256_add_ps(offset, doubt));
    return _mm256_cmp_ps(sum, _mm256_setzero_ps(), _CMP_GE_OQ);
}

static inline uint32_t block_facing(const float *faces, const float eye[4], float reach)
{
    return bits_of(facing8(faces, eye, reach), facing8(faces + 8, eye, reach));
}

// The numbers of the set bits, as bytes: the bytes 0 .. 7 that stand where a bit is set, moved together.
static inline __m256i numbers_of(uint32_t bits)
{
    const uint64_t picked = _pext_u64(UINT64_C(0x0706050403020100), _pdep_u64(bits, UINT64_C(0x0101010101010101)) * 255);
    return _mm256_cvtepu8_epi32(_mm_cvtsi64_si128((long long)picked));
}

static inline uint32_t *put_places8(uint32_t bits, uint32_t base, uint32_t *out)
{
    _mm256_storeu_si256((__m256i *)(void *)out, _mm256_add_epi32(numbers_of(bits), _mm256_set1_epi32((int)base)));
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
    _mm256_storeu_si256((__m256i *)(void *)out, _mm256_permutevar8x32_epi32(all, numbers_of(bits)));
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
