// Numbers: short ones exactly by one multiplication or division (Clinger 1990), the rest by strtod on a bounded copy.
// SPDX-License-Identifier: MIT
// Invariant: the copy holds digits and an exponent, never a decimal point, so no locale can change the answer.
#include "number.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

enum {
    DIGITS_EXACT = 15,      // as many always fit the 53 bits of a double
    POWER_EXACT = 22,       // 10^22 is the largest power of ten that a double holds exactly
    DIGITS_KEPT = 780,      // no double needs more than 767 to be told from its neighbour; the rest is one sticky digit
    EXPONENT_MOST = 100000, // far beyond any double, far below overflow of an int
};

typedef struct decimal {
    const char *digits, *digits_end; // with at most one point among them
    uint64_t mantissa;               // of the first DIGITS_EXACT significant digits
    int significant;                 // digits from the first that is not 0
    int exponent;                    // of ten, for the last digit
    int any;
} decimal;

static int is_digit(char c)
{
    return c >= '0' && c <= '9';
}

static const char *read_digits(const char *at, const char *end, decimal *d)
{
    int point = 0;
    d->digits = at;
    for (; at < end; ++at) {
        if (*at == '.' && !point) {
            point = 1;
            continue;
        }
        if (!is_digit(*at)) break;
        d->any = 1;
        if (point && d->exponent > -EXPONENT_MOST) d->exponent--;
        if (d->significant == 0 && *at == '0') continue;
        if (d->significant < EXPONENT_MOST) d->significant++;
        if (d->significant <= DIGITS_EXACT) d->mantissa = d->mantissa * 10 + (uint64_t)(*at - '0');
    }
    d->digits_end = at;
    return at;
}

static const char *read_exponent(const char *at, const char *end, decimal *d)
{
    if (at >= end || (*at != 'e' && *at != 'E')) return at;
    const char *digit = at + 1;
    int negative = 0, exponent = 0;
    if (digit < end && (*digit == '+' || *digit == '-')) negative = *digit++ == '-';
    if (digit >= end || !is_digit(*digit)) return at;
    for (; digit < end && is_digit(*digit); ++digit)
        if (exponent < EXPONENT_MOST) exponent = exponent * 10 + (*digit - '0');
    d->exponent += negative ? -exponent : exponent;
    return digit;
}

static double convert_long(const decimal *d)
{
    char copy[DIGITS_KEPT + 32];
    int used = 0, skipped = 0, sticky = 0;
    for (const char *at = d->digits; at < d->digits_end; ++at) {
        if (*at == '.' || (used == 0 && *at == '0')) continue;
        if (used < DIGITS_KEPT) {
            copy[used++] = *at;
            continue;
        }
        if (skipped < EXPONENT_MOST) skipped++;
        sticky |= *at != '0';
    }
    int exponent = d->exponent + skipped;
    if (sticky) {
        copy[used++] = '1';
        exponent--;
    }
    if (used == 0) copy[used++] = '0';
    snprintf(copy + used, sizeof copy - (size_t)used, "e%d", exponent);
    return strtod(copy, NULL);
}

static double convert(const decimal *d)
{
    static const double powers[POWER_EXACT + 1] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                                   1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
    if (d->significant > DIGITS_EXACT || d->exponent > POWER_EXACT || d->exponent < -POWER_EXACT) return convert_long(d);
    const double mantissa = (double)d->mantissa;
    return d->exponent < 0 ? mantissa / powers[-d->exponent] : mantissa * powers[d->exponent];
}

const char *number_read(const char *text, const char *end, double *out)
{
    decimal d = {0};
    int negative = 0;
    const char *at = text;
    if (at < end && (*at == '-' || *at == '+')) negative = *at++ == '-';
    at = read_digits(at, end, &d);
    if (!d.any) return NULL;
    at = read_exponent(at, end, &d);
    const double value = convert(&d);
    if (!isfinite(value)) return NULL;
    *out = negative ? -value : value;
    return at;
}
