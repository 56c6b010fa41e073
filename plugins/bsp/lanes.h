// Floats side by side: eight with AVX2, four with SSE2 or in plain C, as the file that includes this is compiled.
// SPDX-License-Identifier: MIT
// Invariant: all give the same bits: every operation is one IEEE operation a lane, nothing is fused.
#ifndef PORTCULLIS_BSP_LANES_H
#define PORTCULLIS_BSP_LANES_H

#include <stdint.h>

#if defined(__AVX2__)
#include <immintrin.h>
enum { LANES = 8 };
typedef __m256 lanes;
static inline lanes lanes_load(const float *p) { return _mm256_loadu_ps(p); }
static inline lanes lanes_of(float x) { return _mm256_set1_ps(x); }
static inline lanes lanes_add(lanes a, lanes b) { return _mm256_add_ps(a, b); }
static inline lanes lanes_mul(lanes a, lanes b) { return _mm256_mul_ps(a, b); }
static inline lanes lanes_max(lanes a, lanes b) { return _mm256_max_ps(a, b); }
static inline lanes lanes_min(lanes a, lanes b) { return _mm256_min_ps(a, b); }
static inline uint32_t lanes_negative(lanes a) { return (uint32_t)_mm256_movemask_ps(_mm256_cmp_ps(a, _mm256_setzero_ps(), _CMP_LT_OQ)); }
#elif defined(__x86_64__)
#include <emmintrin.h>
enum { LANES = 4 };
typedef __m128 lanes;
static inline lanes lanes_load(const float *p) { return _mm_loadu_ps(p); }
static inline lanes lanes_of(float x) { return _mm_set1_ps(x); }
static inline lanes lanes_add(lanes a, lanes b) { return _mm_add_ps(a, b); }
static inline lanes lanes_mul(lanes a, lanes b) { return _mm_mul_ps(a, b); }
static inline lanes lanes_max(lanes a, lanes b) { return _mm_max_ps(a, b); }
static inline lanes lanes_min(lanes a, lanes b) { return _mm_min_ps(a, b); }
static inline uint32_t lanes_negative(lanes a) { return (uint32_t)_mm_movemask_ps(_mm_cmplt_ps(a, _mm_setzero_ps())); }
#else
enum { LANES = 4 };
typedef struct lanes { float v[LANES]; } lanes;
#define LANES_EACH(expression)                               \
    lanes out;                                               \
    for (int i = 0; i < LANES; i++) out.v[i] = (expression); \
    return out
static inline lanes lanes_load(const float *p) { LANES_EACH(p[i]); }
static inline lanes lanes_of(float x) { LANES_EACH(x); }
static inline lanes lanes_add(lanes a, lanes b) { LANES_EACH(a.v[i] + b.v[i]); }
static inline lanes lanes_mul(lanes a, lanes b) { LANES_EACH(a.v[i] * b.v[i]); }
static inline lanes lanes_max(lanes a, lanes b) { LANES_EACH(a.v[i] > b.v[i] ? a.v[i] : b.v[i]); }
static inline lanes lanes_min(lanes a, lanes b) { LANES_EACH(a.v[i] < b.v[i] ? a.v[i] : b.v[i]); }
static inline uint32_t lanes_negative(lanes a)
{
    uint32_t bits = 0;
    for (int i = 0; i < LANES; i++) bits |= (a.v[i] < 0 ? 1u : 0u) << i;
    return bits;
}
#undef LANES_EACH
#endif

#define LANES_ALL ((1u << LANES) - 1)
enum { LANES_MOST = 8 }; // what arrays are padded for

// ((x*nx + y*ny) + z*nz) + offset, the order of plane.h.
static inline lanes lanes_height(lanes x, lanes y, lanes z, lanes offset)
{
    return lanes_add(lanes_add(lanes_add(x, y), z), offset);
}

static inline uint32_t lowest_bit(uint32_t bits) // of bits that are not 0
{
#if defined(__GNUC__)
    return (uint32_t)__builtin_ctz(bits);
#else
    uint32_t place = 0;
    while (!(bits >> place & 1)) place++;
    return place;
#endif
}

#endif
