// A coarse picture of how near the boxes of what is drawn stand, to guess whether the box round several hidden things is hidden as
// well. A wrong guess costs tests, never a pixel.
// SPDX-License-Identifier: MIT
#ifndef OCCLUSION_CHC_PICTURE_H
#define OCCLUSION_CHC_PICTURE_H

#include "cover.h"

enum { PICTURE_COLUMNS = COVER_COLUMNS, PICTURE_ROWS = COVER_ROWS };

typedef struct chc_picture {
    cover grid;         // for outlines
    float eye[3];
    float ray[3][3];    // of a cell's centre: ray[0] + column * ray[1] + row * ray[2], at distance 1 along the view
    uint32_t is_blind;  // a view without perspective: hides nothing
    float nearness[PICTURE_ROWS][PICTURE_COLUMNS]; // one by the distance along the view; 0: nothing
} chc_picture;

void picture_begin(chc_picture *p, const cull_view *view);
void picture_mark(chc_picture *p, const cull_box *box);
// Nearer boxes stand before not all cells of it; all of them; those round it as well.
typedef enum picture_verdict { PICTURE_OPEN, PICTURE_NARROW, PICTURE_HIDDEN, PICTURE_VERDICTS } picture_verdict;
picture_verdict picture_look(const chc_picture *p, const cull_box *box);

#endif
