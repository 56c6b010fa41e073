// The 1998 report's own forms, kept to be compared with: they lose. Its border of the view is Bresenham's thin line (8-connected), which drops
// cells that the view only clips; its order is one straight slope for the whole view, which is wrong where the view crosses an axis of the eye.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_IMAGECACHE_FORMS_H
#define PORTCULLIS_IMAGECACHE_FORMS_H

#include "footprint.h"

// By row of the ground: the cells between the border's ends; low above high: none.
typedef struct forms_border {
    int32_t low[1 << GROUND_LEVELS_MOST], high[1 << GROUND_LEVELS_MOST];
} forms_border;

// LOSES CELLS: lines from corner cell to corner cell, and what lies between them in a row.
void forms_border_of(const ground *g, const footprint *f, forms_border *out);

static inline int forms_border_keeps(const forms_border *b, ground_cell c)
{
    return b->low[c.j] <= c.i && c.i <= b->high[c.j];
}

// INVERTS: rings about this cell are straight lines of one slope over all of the ground, m = -1 where the view looks along sx * sz > 0, else +1.
ground_cell forms_slope_eye(const ground *g, const double forward[3]);

#endif
