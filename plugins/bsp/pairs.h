// Doubles side by side, two at a time: with SSE2, or in plain C.
// SPDX-License-Identifier: MIT
// Invariant: all give the same bits: every operation is one IEEE operation a lane, nothing is fused. Loops over `count` numbers read one
// more where it is odd: arrays have room for it, and masks drop what it says (pair_bits).
#ifndef PORTCULLIS_BSP_PAIRS_H
#define PORTCULLIS_BSP_PAIRS_H

#include <stdint.h>

enum { PAIR = 2 };

#if defined(__SSE2__)
#include <emmintrin.h>
typedef __m128d pair;
static inline pair pair_load(const double *p) { return _mm_loadu_pd(p); }
static inline pair pair_load_floats(const float *p) { return _mm_cvtps_pd(_mm_castsi128_ps(_mm_loadl_epi64((const __m128i *)(const void *)p))); }
static inline void pair_store(double *p, pair a) { _mm_storeu_pd(p, a); }
static inline pair pair_of(double x) { return _mm_set1_pd(x); }
static inline pair pair_add(pair a, pair b) { return _mm_add_pd(a, b); }
static inline pair pair_subtract(pair a, pair b) { return _mm_sub_pd(a, b); }
static inline pair pair_mul(pair a, pair b) { return _mm_mul_pd(a, b); }
static inline pair pair_min(pair a, pair b) { return _mm_min_pd(a, b); }
static inline pair pair_max(pair a, pair b) { return _mm_max_pd(a, b); }
static inline pair pair_size(pair a) { return _mm_andnot_pd(_mm_set1_pd(-0.0), a); }
static inline uint32_t pair_below(pair a, pair b) { return (uint32_t)_mm_movemask_pd(_mm_cmplt_pd(a, b)); } // a bit a lane
static inline uint32_t pair_at_most(pair a, pair b) { return (uint32_t)_mm_movemask_pd(_mm_cmple_pd(a, b)); }
static inline double pair_first(pair a) { return _mm_cvtsd_f64(a); }
static inline double pair_second(pair a) { return _mm_cvtsd_f64(_mm_unpackhi_pd(a, a)); }
#else
typedef struct pair { double v[PAIR]; } pair;
#define PAIR_EACH(first, second)       \
    const pair out = {{first, second}}; \
    return out
static inline pair pair_load(const double *p) { PAIR_EACH(p[0], p[1]); }
static inline pair pair_load_floats(const float *p) { PAIR_EACH((double)p[0], (double)p[1]); }
static inline void pair_store(double *p, pair a) { p[0] = a.v[0], p[1] = a.v[1]; }
static inline pair pair_of(double x) { PAIR_EACH(x, x); }
static inline pair pair_add(pair a, pair b) { PAIR_EACH(a.v[0] + b.v[0], a.v[1] + b.v[1]); }
static inline pair pair_subtract(pair a, pair b) { PAIR_EACH(a.v[0] - b.v[0], a.v[1] - b.v[1]); }
static inline pair pair_mul(pair a, pair b) { PAIR_EACH(a.v[0] * b.v[0], a.v[1] * b.v[1]); }
static inline pair pair_min(pair a, pair b) { PAIR_EACH(a.v[0] < b.v[0] ? a.v[0] : b.v[0], a.v[1] < b.v[1] ? a.v[1] : b.v[1]); }
static inline pair pair_max(pair a, pair b) { PAIR_EACH(a.v[0] > b.v[0] ? a.v[0] : b.v[0], a.v[1] > b.v[1] ? a.v[1] : b.v[1]); }
static inline pair pair_size(pair a) { PAIR_EACH(a.v[0] < 0 ? -a.v[0] : a.v[0], a.v[1] < 0 ? -a.v[1] : a.v[1]); }
static inline uint32_t pair_below(pair a, pair b) { return (a.v[0] < b.v[0] ? 1u : 0u) | (a.v[1] < b.v[1] ? 2u : 0u); }
static inline uint32_t pair_at_most(pair a, pair b) { return (a.v[0] <= b.v[0] ? 1u : 0u) | (a.v[1] <= b.v[1] ? 2u : 0u); }
static inline double pair_first(pair a) { return a.v[0]; }
static inline double pair_second(pair a) { return a.v[1]; }
#undef PAIR_EACH
#endif

static inline uint64_t pair_bits(uint32_t count) // the lowest `count`, which is 1 to 64
{
    return ~(uint64_t)0 >> (64 - count);
}

static inline uint32_t pair_lowest(uint64_t bits) // of bits that are not 0
{
#if defined(__GNUC__)
    return (uint32_t)__builtin_ctzll(bits);
#else
    uint32_t place = 0;
    while (!(bits >> place & 1)) place++;
    return place;
#endif
}

// Round a loop of `count`: the bits whose neighbour before is set.
static inline uint64_t pair_turned(uint64_t bits, uint32_t count)
{
    return (bits << 1 | bits >> (count - 1)) & pair_bits(count);
}

#endif
