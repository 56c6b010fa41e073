// A small depth picture by rays, one through the middle of each pixel: what tests of boxes are answered from.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_CHECK_PICTURE_H
#define PORTCULLIS_HOST_CHECK_PICTURE_H

#include "sight.h"

typedef struct sample_picture {
    const made_scene *scene;
    const made_view *view;
    sight_backs backs;
    double *depth; // VIEW_WIDTH_PX * VIEW_HEIGHT_PX, along the view; NULL: closed
    double *rays;  // three each
} sample_picture;

void sample_picture_open(sample_picture *p, const made_scene *s, const made_view *v, sight_backs backs);
void sample_picture_close(sample_picture *p);
void sample_picture_draw(sample_picture *p, uint32_t item); // movers leave no depth
uint32_t sample_picture_test(const sample_picture *p, const cull_box *box); // pixels; 0: nothing in the box can leave one

#endif
