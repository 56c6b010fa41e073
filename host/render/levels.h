// Coarser triangles for captures: the scene's, simplified once (simplify.h), in the order of a layout's places.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_RENDER_LEVELS_H
#define PORTCULLIS_RENDER_LEVELS_H

#include "gl.h"

// One level in a layout's order.
struct layout_level {
    GLuint vertices, elements;
    uint32_t *first_index; // of each place; one more at the end
    double away_m;         // no point is drawn farther from its place
};

void levels_release(renderer *g);            // of the scene
void levels_close_layout(render_layout *l);  // its captures draw all triangles from now on
// The coarsest that a capture may be drawn with in this frame; NULL: the scene itself.
const layout_level *levels_find(const render_layout *l, double detail_m);

#endif
