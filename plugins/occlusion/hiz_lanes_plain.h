// The words of hiz_lanes.h in plain C: the oracle of the other two.
// SPDX-License-Identifier: MIT
#ifndef OCCLUSION_HIZ_LANES_PLAIN_H
#define OCCLUSION_HIZ_LANES_PLAIN_H

#include <math.h>
#include <string.h>

typedef struct hiz_f { float at[16]; } hiz_f;
typedef struct hiz_i { int32_t at[16]; } hiz_i;

#define HIZ_EACH(type, name, word) \
    static inline type name(type x, type y) \
    { \
        type r; \
        for (int k = 0; k < 16; k++) r.at[k] = word; \
        return r; \
    }
HIZ_EACH(hiz_f, f_add, x.at[k] + y.at[k])
HIZ_EACH(hiz_f, f_sub, x.at[k] - y.at[k])
HIZ_EACH(hiz_f, f_mul, x.at[k] * y.at[k])
HIZ_EACH(hiz_f, f_div, x.at[k] / y.at[k])
HIZ_EACH(hiz_f, f_min, x.at[k] < y.at[k] ? x.at[k] : y.at[k]) // of a NaN the second, as SSE has it
HIZ_EACH(hiz_f, f_max, x.at[k] > y.at[k] ? x.at[k] : y.at[k])
HIZ_EACH(hiz_i, i_add, (int32_t)((uint32_t)x.at[k] + (uint32_t)y.at[k]))
HIZ_EACH(hiz_i, i_sub, (int32_t)((uint32_t)x.at[k] - (uint32_t)y.at[k]))
HIZ_EACH(hiz_i, i_mul, (int32_t)((uint32_t)x.at[k] * (uint32_t)y.at[k]))
HIZ_EACH(hiz_i, i_min, x.at[k] < y.at[k] ? x.at[k] : y.at[k])
HIZ_EACH(hiz_i, i_max, x.at[k] > y.at[k] ? x.at[k] : y.at[k])
#undef HIZ_EACH

#define HIZ_EACH(type, name, word) \
    static inline uint32_t name(type x, type y) \
    { \
        uint32_t lanes = 0; \
        for (int k = 0; k < 16; k++) lanes |= (uint32_t)(word) << k; \
        return lanes; \
    }
HIZ_EACH(hiz_f, f_above, x.at[k] > y.at[k])
HIZ_EACH(hiz_f, f_not_below, !(x.at[k] < y.at[k]))
HIZ_EACH(hiz_i, i_above, x.at[k] > y.at[k])
#undef HIZ_EACH

static inline hiz_f f_load(const float *p)
{
    hiz_f r;
    memcpy(r.at, p, sizeof r.at);
    return r;
}
static inline void f_store(float *p, hiz_f x) { memcpy(p, x.at, sizeof x.at); }
static inline void f_store_some(float *p, uint32_t lanes, hiz_f x)
{
    for (int k = 0; k < 16; k++)
        if (lanes >> k & 1) p[k] = x.at[k];
}
static inline hiz_f f_set(float a)
{
    hiz_f r;
    for (int k = 0; k < 16; k++) r.at[k] = a;
    return r;
}
static inline hiz_f f_ceil(hiz_f x)
{
    for (int k = 0; k < 16; k++) x.at[k] = ceilf(x.at[k]);
    return x;
}
static inline hiz_f f_floor(hiz_f x)
{
    for (int k = 0; k < 16; k++) x.at[k] = floorf(x.at[k]);
    return x;
}
static inline hiz_f f_pick(uint32_t lanes, hiz_f yes, hiz_f no)
{
    for (int k = 0; k < 16; k++) no.at[k] = lanes >> k & 1 ? yes.at[k] : no.at[k];
    return no;
}
static inline hiz_i f_to_i(hiz_f x) // what int32_t cannot hold comes to the least one, as SSE has it
{
    hiz_i r;
    for (int k = 0; k < 16; k++) r.at[k] = x.at[k] >= -2147483648.0f && x.at[k] < 2147483648.0f ? (int32_t)x.at[k] : INT32_MIN;
    return r;
}
static inline hiz_f f_gather(const float *from, hiz_i at)
{
    hiz_f r;
    for (int k = 0; k < 16; k++) r.at[k] = from[at.at[k]];
    return r;
}
static inline float f_least(hiz_f x)
{
    float least = x.at[0];
    for (int k = 1; k < 16; k++) least = x.at[k] < least ? x.at[k] : least;
    return least;
}

static inline hiz_i i_load(const void *p)
{
    hiz_i r;
    memcpy(r.at, p, sizeof r.at);
    return r;
}
static inline void i_store(void *p, hiz_i x) { memcpy(p, x.at, sizeof x.at); }
static inline void i_store_some(void *p, uint32_t lanes, hiz_i x)
{
    for (int k = 0; k < 16; k++)
        if (lanes >> k & 1) memcpy((int32_t *)p + k, &x.at[k], sizeof x.at[k]);
}
static inline hiz_i i_set(int32_t a)
{
    hiz_i r;
    for (int k = 0; k < 16; k++) r.at[k] = a;
    return r;
}
static inline hiz_i i_pick(uint32_t lanes, hiz_i yes, hiz_i no)
{
    for (int k = 0; k < 16; k++) no.at[k] = lanes >> k & 1 ? yes.at[k] : no.at[k];
    return no;
}
static inline hiz_i i_shift_right(hiz_i x, int by) // of what is not negative
{
    for (int k = 0; k < 16; k++) x.at[k] = x.at[k] >> by;
    return x;
}
static inline uint32_t i_negative(hiz_i x)
{
    uint32_t lanes = 0;
    for (int k = 0; k < 16; k++) lanes |= (uint32_t)(x.at[k] < 0) << k;
    return lanes;
}

// Of lanes 0 to 7, and 8 to 15.
static inline void i_least_halves(hiz_i a, int32_t out[2])
{
    for (int h = 0; h < 2; h++) {
        out[h] = a.at[8 * h];
        for (int k = 8 * h + 1; k < 8 * h + 8; k++) out[h] = a.at[k] < out[h] ? a.at[k] : out[h];
    }
}
static inline void i_most_halves(hiz_i a, int32_t out[2])
{
    for (int h = 0; h < 2; h++) {
        out[h] = a.at[8 * h];
        for (int k = 8 * h + 1; k < 8 * h + 8; k++) out[h] = a.at[k] > out[h] ? a.at[k] : out[h];
    }
}

// Lanes 8 to 15 as 0 to 7 where half is 1.
static inline hiz_i i_half(hiz_i x, int half)
{
    for (int k = 0; half && k < 8; k++) x.at[k] = x.at[k + 8];
    return x;
}

// Of lanes 0 to 7: pixels low .. end - 1 of each row, eight columns from x on, as bits, a byte a row.
static inline uint64_t i_row_bits(hiz_i low, hiz_i end, int32_t x)
{
    uint64_t bits = 0;
    for (int k = 0; k < 8; k++) {
        const int32_t from = low.at[k] - x, to = end.at[k] - x;
        const uint32_t above = 0xffu << (from < 0 ? 0 : from > 8 ? 8 : from), beyond = 0xffu << (to < 0 ? 0 : to > 8 ? 8 : to);
        bits |= (uint64_t)(above & ~beyond & 0xffu) << (k * 8);
    }
    return bits;
}

#endif
