// Masks of children brought together or into another order, for CPUs with BMI2. Included by sources that have included <immintrin.h>.
// SPDX-License-Identifier: MIT

static inline uint32_t pick(uint32_t bits, uint32_t mask)
{
    return _pext_u32(bits, mask);
}

static inline __m128i nibbles_apart(uint64_t nibbles) // 16 bytes
{
    const uint64_t low = UINT64_C(0x0f0f0f0f0f0f0f0f);
    return _mm_unpacklo_epi8(_mm_cvtsi64_si128((long long)(nibbles & low)), _mm_cvtsi64_si128((long long)(nibbles >> 4 & low)));
}

static inline uint32_t reorder(uint32_t bits, uint64_t order)
{
    const uint64_t ones = UINT64_C(0x0101010101010101);
    const __m128i bytes = _mm_set_epi64x((long long)(_pdep_u64(bits >> 8, ones) * 255), (long long)(_pdep_u64(bits & 0xff, ones) * 255));
    return (uint32_t)_mm_movemask_epi8(_mm_shuffle_epi8(bytes, nibbles_apart(order)));
}
