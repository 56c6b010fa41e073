// wide_integer.h: signed integers of 128 and 256 bits, as much of them as exact.h needs. Strict C11, reads as C++17.
// SPDX-License-Identifier: MIT
//
// Invariant: two's complement in words of 64 bits, least first; only unsigned arithmetic, so nothing here is undefined.
// Results that don't fit wrap: the bounds of exact.h say where none does.
// A host whose compiler has an unsigned type of 128 bits may define CULL_UINT128 as its name before it includes this: the
// same results by the machine's own products, in half the time.
#ifndef PORTCULLIS_WIDE_INTEGER_H
#define PORTCULLIS_WIDE_INTEGER_H

#include <stdbool.h>
#include <stdint.h>

typedef struct cull_wide { uint64_t low, high; } cull_wide;     // 128 bits
typedef struct cull_int256 { uint64_t words[4]; } cull_int256;

static inline uint64_t cull_magnitude(int64_t v)
{
    return v < 0 ? 0 - (uint64_t)v : (uint64_t)v;
}

// ---- 128 bits ----

static inline int64_t cull_signed(uint64_t v) // of two's complement; compilers make nothing of it
{
    return v >> 63 ? -(int64_t)(~v) - 1 : (int64_t)v;
}

static inline cull_wide cull_wide_from(int64_t v)
{
    const cull_wide out = {(uint64_t)v, v < 0 ? UINT64_MAX : 0};
    return out;
}

static inline int cull_wide_sign(cull_wide v)
{
    return v.high >> 63 ? -1 : (v.high | v.low) != 0;
}

static inline bool cull_wide_equal(cull_wide a, cull_wide b)
{
    return a.low == b.low && a.high == b.high;
}

#ifdef CULL_UINT128
static inline CULL_UINT128 cull_uint128(cull_wide v)
{
    return ((CULL_UINT128)v.high << 64) | v.low;
}

static inline cull_wide cull_wide_of_uint128(CULL_UINT128 v)
{
    const cull_wide out = {(uint64_t)v, (uint64_t)(v >> 64)};
    return out;
}

static inline cull_wide cull_wide_add(cull_wide a, cull_wide b)
{
    return cull_wide_of_uint128(cull_uint128(a) + cull_uint128(b));
}

static inline cull_wide cull_wide_subtract(cull_wide a, cull_wide b)
{
    return cull_wide_of_uint128(cull_uint128(a) - cull_uint128(b));
}
#else
static inline cull_wide cull_wide_add(cull_wide a, cull_wide b)
{
    const uint64_t low = a.low + b.low;
    const cull_wide out = {low, a.high + b.high + (low < a.low)};
    return out;
}

static inline cull_wide cull_wide_subtract(cull_wide a, cull_wide b)
{
    const cull_wide out = {a.low - b.low, a.high - b.high - (a.low < b.low)};
    return out;
}
#endif

static inline cull_wide cull_wide_negate(cull_wide v)
{
    const cull_wide out = {0 - v.low, 0 - v.high - (v.low != 0)};
    return out;
}

static inline cull_wide cull_wide_magnitude(cull_wide v) // as an unsigned number
{
    return v.high >> 63 ? cull_wide_negate(v) : v;
}

static inline bool cull_wide_fits_int64(cull_wide v)
{
    return v.high == (v.low >> 63 ? UINT64_MAX : 0);
}

static inline int64_t cull_wide_to_int64(cull_wide v) // that fits
{
    return cull_signed(v.low);
}

// Unsigned 64 x 64 -> 128.
static inline cull_wide cull_wide_product_unsigned(uint64_t a, uint64_t b)
{
#ifdef CULL_UINT128
    return cull_wide_of_uint128((CULL_UINT128)a * b);
#else
    const uint64_t a_low = a & 0xffffffffu, a_high = a >> 32, b_low = b & 0xffffffffu, b_high = b >> 32;
    const uint64_t low = a_low * b_low, cross = a_high * b_low + (low >> 32), other = a_low * b_high + (cross & 0xffffffffu);
    const cull_wide out = {(other << 32) | (low & 0xffffffffu), a_high * b_high + (cross >> 32) + (other >> 32)};
    return out;
#endif
}

static inline uint64_t cull_mask_negative(uint64_t high) // all ones or nothing: signs of products are random, branches on them cost
{
    return 0 - (high >> 63);
}

static inline cull_wide cull_wide_product(int64_t a, int64_t b)
{
    cull_wide out = cull_wide_product_unsigned((uint64_t)a, (uint64_t)b);
    out.high -= (cull_mask_negative((uint64_t)a) & (uint64_t)b) + (cull_mask_negative((uint64_t)b) & (uint64_t)a);
    return out;
}

static inline cull_wide cull_wide_multiply(cull_wide a, cull_wide b) // the low 128 bits
{
    cull_wide out = cull_wide_product_unsigned(a.low, b.low);
    out.high += a.low * b.high + a.high * b.low;
    return out;
}

static inline cull_wide cull_wide_scale(cull_wide a, int64_t b) // the low 128 bits
{
    cull_wide out = cull_wide_product_unsigned(a.low, (uint64_t)b);
    out.high += a.high * (uint64_t)b - (cull_mask_negative((uint64_t)b) & a.low);
    return out;
}

// Within 2 * 2^-53 of v's size, when |v| < 2^115: of two signed halves, each rounds at most once, and so does their sum.
static inline double cull_wide_to_double(cull_wide v)
{
    return (double)cull_signed(v.high + (v.low >> 63)) * 18446744073709551616.0 + (double)cull_signed(v.low);
}

// ---- 256 bits ----

static inline int cull_int256_sign(const cull_int256 *v)
{
    if (v->words[3] >> 63) return -1;
    return (v->words[0] | v->words[1] | v->words[2] | v->words[3]) != 0;
}

static inline cull_int256 cull_int256_of(cull_wide low, cull_wide high)
{
    const cull_int256 out = {{low.low, low.high, high.low, high.high}};
    return out;
}

static inline cull_wide cull_int256_half(const cull_int256 *v, int half) // 0: the low one
{
    const cull_wide out = {v->words[2 * half], v->words[2 * half + 1]};
    return out;
}

static inline bool cull_wide_below(cull_wide a, cull_wide b) // as unsigned numbers
{
#ifdef CULL_UINT128
    return cull_uint128(a) < cull_uint128(b);
#else
    return (a.high < b.high) | ((a.high == b.high) & (a.low < b.low));
#endif
}

static inline void cull_int256_add(cull_int256 *sum, const cull_int256 *v)
{
    const cull_wide part = cull_int256_half(v, 0), low = cull_wide_add(cull_int256_half(sum, 0), part), carry = {cull_wide_below(low, part), 0};
    *sum = cull_int256_of(low, cull_wide_add(cull_wide_add(cull_int256_half(sum, 1), cull_int256_half(v, 1)), carry));
}

static inline void cull_int256_subtract(cull_int256 *sum, const cull_int256 *v)
{
    const cull_wide part = cull_int256_half(v, 0), from = cull_int256_half(sum, 0), borrow = {cull_wide_below(from, part), 0};
    *sum = cull_int256_of(cull_wide_subtract(from, part), cull_wide_subtract(cull_wide_subtract(cull_int256_half(sum, 1), cull_int256_half(v, 1)), borrow));
}

// Signed 128 x 128 -> 256. The unsigned product takes a negative factor for 2^128 more than it is.
static inline cull_int256 cull_int256_product(cull_wide a, cull_wide b)
{
    const cull_wide ll = cull_wide_product_unsigned(a.low, b.low), lh = cull_wide_product_unsigned(a.low, b.high);
    const cull_wide hl = cull_wide_product_unsigned(a.high, b.low), hh = cull_wide_product_unsigned(a.high, b.high);
    const cull_wide ll_high = {ll.high, 0}, middle = cull_wide_add(lh, ll_high), middle_low = {middle.low, 0}, middle_high = {middle.high, 0};
    const cull_wide other = cull_wide_add(hl, middle_low), other_high = {other.high, 0}, low = {ll.low, other.low};
    const uint64_t a_mask = cull_mask_negative(a.high), b_mask = cull_mask_negative(b.high);
    const cull_wide of_a = {b.low & a_mask, b.high & a_mask}, of_b = {a.low & b_mask, a.high & b_mask};
    const cull_wide high = cull_wide_add(hh, cull_wide_add(middle_high, other_high));
    return cull_int256_of(low, cull_wide_subtract(high, cull_wide_add(of_a, of_b)));
}

// Signed 128 x 64 -> 192.
static inline cull_int256 cull_int256_scaled(cull_wide a, int64_t b)
{
    const cull_wide low = cull_wide_product_unsigned(a.low, (uint64_t)b), carry = {low.high, 0};
    const uint64_t a_mask = cull_mask_negative(a.high), b_mask = cull_mask_negative((uint64_t)b);
    const cull_wide of_a = {0, (uint64_t)b & a_mask}, of_b = {a.low & b_mask, a.high & b_mask};
    const cull_wide high = cull_wide_subtract(cull_wide_add(cull_wide_product_unsigned(a.high, (uint64_t)b), carry), cull_wide_add(of_a, of_b));
    const cull_int256 out = {{low.low, high.low, high.high, cull_mask_negative(high.high)}};
    return out;
}

static inline void cull_int256_scale_add(cull_int256 *sum, cull_wide a, int64_t b) // sum += a * b
{
    const cull_int256 product = cull_int256_scaled(a, b);
    cull_int256_add(sum, &product);
}

static inline void cull_int256_scale_subtract(cull_int256 *sum, cull_wide a, int64_t b)
{
    const cull_int256 product = cull_int256_scaled(a, b);
    cull_int256_subtract(sum, &product);
}

// sum += a * b, exact while the sum stays within 255 bits.
static inline void cull_int256_multiply_add(cull_int256 *sum, cull_wide a, cull_wide b)
{
    const cull_int256 product = cull_int256_product(a, b);
    cull_int256_add(sum, &product);
}

static inline void cull_int256_multiply_subtract(cull_int256 *sum, cull_wide a, cull_wide b)
{
    const cull_int256 product = cull_int256_product(a, b);
    cull_int256_subtract(sum, &product);
}

// Within 3 * 2^-53 of v's size: what lies below the highest two words that count is less than 2^-64 of them, the lower of
// the two rounds once, and so does the sum.
static inline double cull_int256_to_double(const cull_int256 *v)
{
    static const double scale[4] = {1.0, 18446744073709551616.0, 340282366920938463463374607431768211456.0,
                                    6277101735386680763835789423207666416102355444464034512896.0};
    cull_int256 size = {{0, 0, 0, 0}};
    const bool negative = v->words[3] >> 63;
    if (negative) cull_int256_subtract(&size, v);
    else size = *v;
    int top = 3;
    while (top > 0 && size.words[top] == 0) top--;
    double out = (double)size.words[top] * scale[top];
    if (top > 0) out += (double)size.words[top - 1] * scale[top - 1];
    return negative ? -out : out;
}

#endif
