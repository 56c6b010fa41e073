// wide_integer.h: signed integers of 128 and 256 bits, as much of them as exact.h needs. Strict C11, reads as C++17.
// SPDX-License-Identifier: MIT
//
// Invariant: two's complement in words of 64 bits, least first; only unsigned arithmetic, so nothing here is undefined.
// Results that don't fit wrap: the bounds of exact.h say where none does.
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
    return v.high >> 63 ? -(int64_t)(~v.low) - 1 : (int64_t)v.low;
}

// Unsigned 64 x 64 -> 128.
static inline cull_wide cull_wide_product_unsigned(uint64_t a, uint64_t b)
{
    const uint64_t a_low = a & 0xffffffffu, a_high = a >> 32, b_low = b & 0xffffffffu, b_high = b >> 32;
    const uint64_t low = a_low * b_low, cross = a_high * b_low + (low >> 32), other = a_low * b_high + (cross & 0xffffffffu);
    const cull_wide out = {(other << 32) | (low & 0xffffffffu), a_high * b_high + (cross >> 32) + (other >> 32)};
    return out;
}

static inline cull_wide cull_wide_product(int64_t a, int64_t b)
{
    cull_wide out = cull_wide_product_unsigned((uint64_t)a, (uint64_t)b);
    out.high -= (a < 0 ? (uint64_t)b : 0) + (b < 0 ? (uint64_t)a : 0);
    return out;
}

static inline cull_wide cull_wide_multiply(cull_wide a, cull_wide b) // the low 128 bits
{
    cull_wide out = cull_wide_product_unsigned(a.low, b.low);
    out.high += a.low * b.high + a.high * b.low;
    return out;
}

static inline cull_wide cull_wide_scale(cull_wide a, int64_t b)
{
    return cull_wide_multiply(a, cull_wide_from(b));
}

// Within 2 * 2^-53 of v's size, when |v| < 2^117: each half rounds at most once, and so does their sum.
static inline double cull_wide_to_double(cull_wide v)
{
    if (cull_wide_fits_int64(v)) return (double)cull_wide_to_int64(v);
    const cull_wide m = cull_wide_magnitude(v);
    const double size = (double)m.high * 18446744073709551616.0 + (double)m.low;
    return v.high >> 63 ? -size : size;
}

// ---- 256 bits ----

static inline int cull_int256_sign(const cull_int256 *v)
{
    if (v->words[3] >> 63) return -1;
    return (v->words[0] | v->words[1] | v->words[2] | v->words[3]) != 0;
}

static inline void cull_int256_add(cull_int256 *sum, const cull_int256 *v)
{
    uint64_t carry = 0;
    for (int i = 0; i < 4; i++) {
        const uint64_t part = sum->words[i] + carry;
        carry = part < carry;
        sum->words[i] = part + v->words[i];
        carry += sum->words[i] < part;
    }
}

static inline void cull_int256_subtract(cull_int256 *sum, const cull_int256 *v)
{
    uint64_t borrow = 0;
    for (int i = 0; i < 4; i++) {
        const uint64_t part = sum->words[i] - borrow, below = part > sum->words[i];
        borrow = below + (part < v->words[i]);
        sum->words[i] = part - v->words[i];
    }
}

static inline cull_int256 cull_int256_product_unsigned(cull_wide a, cull_wide b)
{
    const cull_wide ll = cull_wide_product_unsigned(a.low, b.low), hh = cull_wide_product_unsigned(a.high, b.high);
    const cull_wide lh = cull_wide_product_unsigned(a.low, b.high), hl = cull_wide_product_unsigned(a.high, b.low);
    cull_int256 out = {{ll.low, ll.high, hh.low, hh.high}};
    const cull_int256 one = {{0, lh.low, lh.high, 0}}, two = {{0, hl.low, hl.high, 0}};
    cull_int256_add(&out, &one);
    cull_int256_add(&out, &two);
    return out;
}

// sum += a * b, exact while the sum stays within 255 bits.
static inline void cull_int256_multiply_add(cull_int256 *sum, cull_wide a, cull_wide b)
{
    const cull_int256 product = cull_int256_product_unsigned(cull_wide_magnitude(a), cull_wide_magnitude(b));
    if ((a.high ^ b.high) >> 63) cull_int256_subtract(sum, &product);
    else cull_int256_add(sum, &product);
}

static inline void cull_int256_multiply_subtract(cull_int256 *sum, cull_wide a, cull_wide b)
{
    cull_int256_multiply_add(sum, cull_wide_negate(a), b);
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
