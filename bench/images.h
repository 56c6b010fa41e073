// Pictures of what a strategy draws, and of what it misses: in magenta, over a dimmed shaded picture.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_BENCH_IMAGES_H
#define PORTCULLIS_BENCH_IMAGES_H

#include "strategy.h"

typedef enum picture_kind { PICTURE_DRAWN, PICTURE_ERROR } picture_kind;
typedef enum picture_caption { CAPTION_NONE, CAPTION_COUNTS } picture_caption; // COUNTS: the strategy and what it drew, in letters
typedef struct picture_request {
    uint32_t view;
    render_mode mode; // of PICTURE_DRAWN
    picture_kind kind;
    render_scissor scissor;
    picture_caption caption;
} picture_request;

typedef struct image_name {
    const char *strategy, *kind; // any text; a word such as "view"
    uint32_t view;
} image_name;
// A picture of the bench's size, top row first, as STRATEGY-KIND-VIEW.png in the folder of its images.
result image_write(const bench_request *q, const image_name *name, const uint8_t *rgba, report *r);
// Culls and draws one view into rgba (width * height * 4, top row first). The strategy must have a renderer. t may be
// NULL but for PICTURE_ERROR. *out_missed: pixels in magenta.
result picture_of(strategy *s, truth *t, const picture_request *q, report *r, uint8_t *rgba, uint64_t *out_missed);
// bench --images: NAME-view-N.png of the path's middle view, NAME-missed-N.png of the worst one where something is missed.
result bench_images(strategy *s, truth *t, const bench_row *row, report *r);

#endif
