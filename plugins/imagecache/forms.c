// The 1998 report's border and order: see forms.h.
// SPDX-License-Identifier: MIT
#include "forms.h"

#include <stdlib.h>

static void border_add(forms_border *b, int32_t i, int32_t j)
{
    if (i < b->low[j]) b->low[j] = i;
    if (i > b->high[j]) b->high[j] = i;
}

// Bresenham, Algorithm for computer control of a digital plotter, 1965: one error term for both axes.
static void border_line(forms_border *b, ground_cell p, ground_cell q)
{
    const int32_t di = abs(q.i - p.i), dj = -abs(q.j - p.j), si = p.i < q.i ? 1 : -1, sj = p.j < q.j ? 1 : -1;
    int32_t error = di + dj;
    for (;;) {
        border_add(b, p.i, p.j);
        if (p.i == q.i && p.j == q.j) return;
        const int32_t twice = 2 * error;
        if (twice >= dj) error += dj, p.i += si;
        if (twice <= di) error += di, p.j += sj;
    }
}

static ground_cell cell_of(const ground *g, footprint_point p)
{
    ground_cell c = {p.x / FOOTPRINT_UNITS, p.z / FOOTPRINT_UNITS};
    if (c.i >= (int32_t)g->columns) c.i = (int32_t)g->columns - 1;
    if (c.j >= (int32_t)g->rows) c.j = (int32_t)g->rows - 1;
    return c;
}

void forms_border_of(const ground *g, const footprint *f, forms_border *out)
{
    for (uint32_t j = 0; j < g->rows; j++) {
        out->low[j] = INT32_MAX;
        out->high[j] = -1;
    }
    for (uint32_t k = 0; k < f->point_count; k++) {
        const footprint_point p = f->points[k], q = f->points[k + 1 < f->point_count ? k + 1 : 0];
        border_line(out, cell_of(g, p), cell_of(g, q));
    }
}

ground_cell forms_slope_eye(const ground *g, const double forward[3])
{
    const ground_cell corner = {forward[0] >= 0 ? -1 : (int32_t)g->columns, forward[2] >= 0 ? -1 : (int32_t)g->rows};
    return corner;
}
