// Which cells an item's triangles touch, row by row: a triangle and a row are convex, so the cells are one range, whose ends are
// those of the triangle's part in the row. The same set as a separating-axis test of every cell (Gottschalk et al., 1996), in the time of its size.
// SPDX-License-Identifier: MIT
//
// Invariant: ranges are closed, and wide enough: corners are compared exactly, crossings of a row's border are widened by their rounding.
#include "cells.h"

#include <portcullis/box.h>

#include <math.h>

typedef struct flat_point { double x, z; } flat_point;
typedef struct span_x { double low, high; } span_x;

static void span_add(span_x *s, double low, double high)
{
    if (low < s->low) s->low = low;
    if (high > s->high) s->high = high;
}

// Where p to q crosses the line: with t's three roundings, the product's and the sum's it is wrong by less than 2^-50 of |p.x| + |q.x|.
static void span_add_crossing(span_x *s, flat_point p, flat_point q, double line)
{
    if ((p.z < line) == (q.z < line) || p.z == line || q.z == line) return; // a corner on the line is added as a corner
    const double t = (line - p.z) / (q.z - p.z), x = p.x + t * (q.x - p.x), doubt = ldexp(fabs(p.x) + fabs(q.x), -48);
    span_add(s, x - doubt, x + doubt);
}

static void row_touch(const ground *g, const flat_point *corners, cells_touch *touch, const cells_listener *to)
{
    const double low = g->z + touch->row * g->size, high = g->z + (touch->row + 1) * g->size;
    span_x s = {INFINITY, -INFINITY};
    for (int k = 0; k < 3; k++) {
        const flat_point p = corners[k], q = corners[(k + 1) % 3];
        if (p.z >= low && p.z <= high) span_add(&s, p.x, p.x);
        span_add_crossing(&s, p, q, low);
        span_add_crossing(&s, p, q, high);
    }
    if (!(s.low <= s.high)) return; // the row beyond the last border, see ground_touched
    s.low = fmax(s.low, (double)touch->box.min.x);
    s.high = fmin(s.high, (double)touch->box.max.x);
    touch->columns = ground_touched(g->x, g->size, (int32_t)g->columns, s.low, s.high);
    to->touch(to->context, touch);
}

static ground_range rows_of(const ground *g, cull_box box)
{
    return ground_touched(g->z, g->size, (int32_t)g->rows, (double)box.min.z, (double)box.max.z);
}

static void triangle_touch(const ground *g, const cull_vec3 *p[3], const cells_listener *to)
{
    flat_point corners[3];
    cells_touch touch = {.box = cull_box_none()};
    for (int k = 0; k < 3; k++) {
        corners[k] = (flat_point){(double)p[k]->x, (double)p[k]->z};
        touch.box = cull_box_with_point(touch.box, *p[k]);
    }
    const ground_range rows = rows_of(g, touch.box);
    touch.columns = ground_touched(g->x, g->size, (int32_t)g->columns, (double)touch.box.min.x, (double)touch.box.max.x);
    const int is_box = rows.first == rows.last || touch.columns.first == touch.columns.last; // one row or column: all of it is touched
    for (touch.row = rows.first; touch.row <= rows.last; touch.row++) {
        if (is_box) to->touch(to->context, &touch);
        else row_touch(g, corners, &touch, to);
    }
}

static void box_touch(const ground *g, cull_box box, const cells_listener *to)
{
    const ground_range rows = rows_of(g, box);
    cells_touch touch = {.box = box};
    touch.columns = ground_touched(g->x, g->size, (int32_t)g->columns, (double)box.min.x, (double)box.max.x);
    for (touch.row = rows.first; touch.row <= rows.last; touch.row++) to->touch(to->context, &touch);
}

void cells_list_item(const ground *g, const cull_zone *zone, uint32_t item, const cells_listener *to)
{
    const cull_item *it = &zone->items[item];
    if (it->index_count < 3 || (it->flags & CULL_ITEM_BOX)) {
        box_touch(g, cull_box_at(&zone->boxes, item), to);
        return;
    }
    for (uint32_t t = it->first_index; t + 3 <= it->first_index + it->index_count; t += 3) {
        const cull_vec3 *p[3];
        for (uint32_t k = 0; k < 3; k++) p[k] = &zone->positions[zone->indices[t + k]];
        triangle_touch(g, p, to);
    }
}
