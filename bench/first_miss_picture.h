// The picture of a first miss: missed pixels in magenta over what was drawn, dimmed; a ring round the first of them; in the
// corner farthest from it what was drawn there (framed in magenta) and what is true (in green), magnified.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_BENCH_FIRST_MISS_PICTURE_H
#define PORTCULLIS_BENCH_FIRST_MISS_PICTURE_H

#include <stdint.h>

typedef struct miss_picture {
    uint32_t width_px, height_px, x_px, y_px; // the spot, from the top left
    const uint8_t *drawn, *whole;             // rgba, top row first; whole: drawn with everything
    const uint8_t *missed;                    // by pixel, top row first: 1 where its owner was not drawn
} miss_picture;

void miss_picture_draw(const miss_picture *p, uint8_t *rgba);

#endif
