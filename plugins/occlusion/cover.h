// A coarse picture of what this step draws, in bits: only to guess which of the entries still open is in front, so that each
// round draws one layer and tests the next against it. A wrong guess costs a round or an item, never a pixel.
// SPDX-License-Identifier: MIT
#ifndef OCCLUSION_COVER_H
#define OCCLUSION_COVER_H

#include <portcullis/culler.h>

enum { COVER_COLUMNS = 320, COVER_ROWS = 192, COVER_WORDS = COVER_COLUMNS / 64 };

typedef struct cover {
    uint64_t rows[COVER_ROWS][COVER_WORDS];
    float clip[12];       // rows x, y and w of clip_from_zone, in cells
    uint32_t columns, row_count; // cells that the picture has
} cover;

// The outline of a box, as a span of cells a row: those whose centres it holds. What holds none is a point: the cell that it lies in.
typedef struct cover_outline {
    int first_row, end_row, is_point, cells;
    int low[COVER_ROWS], end[COVER_ROWS]; // columns, of rows first_row .. end_row - 1
} cover_outline;

void cover_begin(cover *c, const cull_view *view);
typedef enum cover_state { COVER_OPEN, COVER_SMALL, COVER_FULL, COVER_UNKNOWN } cover_state; // UNKNOWN: reaches behind the eye
// FULL: every cell whose centre the box's outline holds is covered. SMALL: open, and of few cells.
cover_state cover_look(const cover *c, const cull_box *box);
void cover_mark(cover *c, const cull_box *box);
int cover_outline_of(const cover *c, const cull_box *box, cover_outline *out); // 0: it reaches behind the eye

#endif
