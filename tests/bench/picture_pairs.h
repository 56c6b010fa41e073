// Pictures for tests of metrics: smooth, noisy, shifted; RGBA.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_PICTURE_PAIRS_H
#define PORTCULLIS_TESTS_PICTURE_PAIRS_H

#include "tests/common/test.h"

#include <math.h>
#include <string.h>

// cmocka's own rounds both to float.
#define assert_near(have, wanted, by) assert_true(fabs((double)(have) - (double)(wanted)) <= (by))

typedef struct picture_size { uint32_t wide, high; } picture_size;

static inline uint32_t next_random(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return *seed >> 8;
}

// Waves of all colours with an edge through them; dx: shifted by so many pixels.
static inline void fill_waves(uint8_t *rgba, const picture_size *size, double dx)
{
    for (uint32_t y = 0; y < size->high; ++y)
        for (uint32_t x = 0; x < size->wide; ++x) {
            uint8_t *p = rgba + ((size_t)y * size->wide + x) * 4;
            const double at = x + dx, edge = at + 0.5 * y > size->wide * 0.6 ? 60 : 0;
            p[0] = (uint8_t)(90 + 60 * sin(at * 0.31) + edge);
            p[1] = (uint8_t)(100 + 70 * sin(at * 0.07 + y * 0.19) + edge);
            p[2] = (uint8_t)(80 + 75 * cos(y * 0.43 - at * 0.11) + edge);
            p[3] = 255;
        }
}

static inline void fill_noise(uint8_t *rgba, const picture_size *size, uint32_t seed)
{
    for (size_t i = 0; i < (size_t)size->wide * size->high * 4; ++i) rgba[i] = i % 4 == 3 ? 255 : (uint8_t)next_random(&seed);
}

static inline void fill_colour(uint8_t *rgba, const picture_size *size, const uint8_t colour[3])
{
    for (size_t i = 0; i < (size_t)size->wide * size->high; ++i) {
        memcpy(rgba + 4 * i, colour, 3);
        rgba[4 * i + 3] = 255;
    }
}

#endif
