// The first wrong pixel of a path: which view, which item, why, and from where on the path it shows again.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_BENCH_FIRST_MISS_H
#define PORTCULLIS_BENCH_FIRST_MISS_H

#include "strategy.h"

typedef enum miss_kind {
    MISS_NONE,
    MISS_PIXEL,      // the item owns the pixel and was not drawn
    MISS_NO_PIXEL,   // the item is seen, leaves no depth, and was not drawn: translucent. x_px, y_px: the middle of its box
} miss_kind;

typedef enum miss_repeats { // when the path is walked once more from `from` on
    MISS_REPEATS,
    MISS_REPEATS_NOT, // the culler remembers what it should not, or time decides
} miss_repeats;

typedef struct first_miss {
    miss_kind kind;
    miss_repeats repeats;
    uint32_t view, item;         // item: global id
    uint32_t x_px, y_px;         // from the top left
    uint32_t item_pixels;        // that the item owns
    uint64_t pixels, items, broken; // missed in the view; broken: items that a chain had promised
    uint32_t from;               // the view at which the shortest walk found that shows it again starts; `view`: no history is needed
    uint32_t views_looked_at, views_blind; // blind: nothing is seen in them, so nothing can be missed
    char *why;                   // of world_explain, why_size bytes with the closing zero
    size_t why_size;
    uint8_t *rgba;               // width * height * 4 of the request, top row first: see first_miss_picture.h
} first_miss;

// [main] The request's first strategy walks its path from that view on until it misses something. Free with first_miss_free.
result first_miss_find(const bench_request *q, uint32_t from, report *r, first_miss *out);
void first_miss_free(const bench_request *q, first_miss *m);

#endif
