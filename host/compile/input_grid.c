// Decimals to the grid: see input_grid.h. One pass over the digits from the last to the first with a carry, as on paper.
// SPDX-License-Identifier: MIT
#include "input_grid.h"

enum { EXPONENT_MOST = 1000000, PLACES_MOST = 17 };

typedef struct decimal_text {
    const char *digits, *end; // digits and at most one point
    int64_t lowest;           // power of ten of the last digit
    int negative;
} decimal_text;

static int is_digit(char c)
{
    return c >= '0' && c <= '9';
}

static decimal_text read_decimal(const char *at, const char *end)
{
    decimal_text d = {.lowest = 0};
    if (at < end && (*at == '+' || *at == '-')) d.negative = *at++ == '-';
    int point = 0;
    for (d.digits = at; at < end && (is_digit(*at) || *at == '.'); ++at) {
        if (*at == '.') point = 1;
        else if (point) d.lowest--;
    }
    d.end = at;
    if (at >= end || (*at != 'e' && *at != 'E')) return d;
    int64_t exponent = 0;
    int negative = 0;
    if (++at < end && (*at == '+' || *at == '-')) negative = *at++ == '-';
    for (; at < end && is_digit(*at); ++at)
        if (exponent < EXPONENT_MOST) exponent = exponent * 10 + (*at - '0');
    d.lowest += negative ? -exponent : exponent;
    return d;
}

typedef struct rounding {
    int64_t whole;      // of places 0 and up
    int first_fraction; // the digit of place -1
    int below, beyond;  // any digit below that; any above the places that fit
} rounding;

static void put_digit(rounding *r, int64_t place, int digit)
{
    if (place < -1) r->below |= digit != 0;
    else if (place == -1) r->first_fraction = digit;
    else if (place >= PLACES_MOST) r->beyond |= digit != 0;
    else {
        int64_t value = digit;
        for (int64_t i = 0; i < place; ++i) value *= 10;
        r->whole += value; // below 10^17
    }
}

grid_fit grid_round(const char *text, size_t length, uint32_t steps, int64_t *out)
{
    const decimal_text d = read_decimal(text, text + length);
    rounding r = {0};
    int64_t place = d.lowest;
    uint64_t carry = 0;
    for (const char *at = d.end; at > d.digits;) {
        if (*--at == '.') continue;
        carry += (uint64_t)(*at - '0') * steps;
        put_digit(&r, place++, (int)(carry % 10));
        carry /= 10;
    }
    for (; carry; carry /= 10) put_digit(&r, place++, (int)(carry % 10));
    const int over = r.first_fraction > 5 || (r.first_fraction == 5 && (r.below || r.whole % 2));
    const int64_t size = r.beyond ? GRID_BEYOND : r.whole + over;
    *out = d.negative ? -size : size;
    return r.first_fraction || r.below ? GRID_ROUNDED : GRID_ON;
}
