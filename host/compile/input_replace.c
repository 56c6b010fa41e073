// Giving a brush other planes, when it stays the same brush: see input.h.
// SPDX-License-Identifier: MIT
#include "input.h"

#include <math.h>
#include <string.h>

enum { CORNERS_MOST = 1024 }; // of a brush to be welded: pairs are compared one by one
static const double SURELY_APART = 1.0 / 65536; // steps: far above twice a position's error of 2^-26

static double distance_squared(const double a[3], const double b[3])
{
    double sum = 0;
    for (int k = 0; k < 3; ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
    return sum;
}

static int same_point(const plane_table *t, const shape_corner *a, const shape_corner *b)
{
    for (int k = 0; k < 3; ++k)
        if (plane_table_side(t, a->planes, b->planes[k]) != 0) return 0;
    return 1;
}

uint32_t shape_close_pairs(const brush_shape *s, const plane_table *t, double reach)
{
    const shape_corner *c = s->corners.items;
    uint32_t pairs = 0;
    if (s->corners.count > CORNERS_MOST) return 0;
    for (size_t i = 0; i < s->corners.count; ++i)
        for (size_t j = 0; j < i; ++j) {
            const double far = distance_squared(c[i].position, c[j].position);
            if (far < reach * reach && (far > SURELY_APART * SURELY_APART || !same_point(t, &c[i], &c[j]))) pairs++;
        }
    return pairs;
}

// How far the farthest corner of `from` is from the nearest of `to`.
static double farthest(const brush_shape *from, const brush_shape *to)
{
    const shape_corner *a = from->corners.items, *b = to->corners.items;
    double most = 0;
    for (size_t i = 0; i < from->corners.count; ++i) {
        double least = INFINITY;
        for (size_t j = 0; j < to->corners.count; ++j) least = fmin(least, distance_squared(a[i].position, b[j].position));
        most = fmax(most, least);
    }
    return sqrt(most);
}

static int planes_repeat(const plane_ref *planes, uint32_t count)
{
    for (uint32_t i = 0; i < count; ++i)
        for (uint32_t j = 0; j < i; ++j)
            if (planes[i] >> 1 == planes[j] >> 1) return 1;
    return 0;
}

static result list_changes(input_draft *d, const plane_replacement *r, double move)
{
    compile_brush *brush = (compile_brush *)d->brushes.items + r->brush;
    compile_face *faces = (compile_face *)d->faces.items + brush->first_face;
    const double units = move / d->grid;
    for (uint32_t i = 0; i < brush->face_count; ++i) {
        if (faces[i].plane == r->planes[i]) continue;
        const weld_change change = {r->kind, r->brush, faces[i].line, faces[i].plane, r->planes[i], units};
        if (!buffer_append(&d->changes, &change, 1)) return report_no_memory(d->report, d->path);
        faces[i].plane = r->planes[i];
    }
    d->in->max_move = fmax(d->in->max_move, units);
    brush_shape_bounds(&d->shape, d->in->planes, brush->min, brush->max);
    return RESULT_OK;
}

static int is_wanted(const input_draft *d, const plane_replacement *r, double *move)
{
    const plane_table *t = d->in->planes;
    if (d->shape.faces.count != d->before.faces.count || d->shape.corners.count > CORNERS_MOST) return 0;
    *move = fmax(farthest(&d->before, &d->shape), farthest(&d->shape, &d->before));
    if (!(*move <= d->weld)) return 0;
    const uint32_t had = shape_close_pairs(&d->before, t, d->weld), has = shape_close_pairs(&d->shape, t, d->weld);
    return r->kind == WELD_POINT ? has < had : has <= had;
}

static void swap_shapes(input_draft *d)
{
    const brush_shape swap = d->shape;
    d->shape = d->before;
    d->before = swap;
}

result input_cut_brush(input_draft *d, uint32_t number)
{
    const compile_brush *brush = (const compile_brush *)d->brushes.items + number;
    const compile_face *faces = (const compile_face *)d->faces.items + brush->first_face;
    d->planes.count = 0;
    plane_ref *planes = buffer_push(&d->planes, brush->face_count);
    if (!planes) return report_no_memory(d->report, d->path);
    for (uint32_t i = 0; i < brush->face_count; ++i) planes[i] = faces[i].plane;
    const shape_fault fault = brush_shape_cut(&d->shape, d->in->planes, d->cube, planes, brush->face_count);
    return fault == SHAPE_NO_MEMORY ? report_no_memory(d->report, d->path) : RESULT_OK;
}

// d->shape becomes the brush with those planes and d->before what it was, also where that is refused.
static result cut_anew(input_draft *d, const plane_replacement *r, double *move, replace_verdict *out)
{
    const compile_brush *brush = (const compile_brush *)d->brushes.items + r->brush;
    swap_shapes(d);
    const shape_fault fault = brush_shape_cut(&d->shape, d->in->planes, d->cube, r->planes, brush->face_count);
    if (fault == SHAPE_NO_MEMORY) return report_no_memory(d->report, d->path);
    *out = fault == SHAPE_SOUND && is_wanted(d, r, move) ? REPLACE_DONE : REPLACE_REFUSED;
    return RESULT_OK;
}

static int is_change(const input_draft *d, const plane_replacement *r)
{
    const compile_brush *brush = (const compile_brush *)d->brushes.items + r->brush;
    const compile_face *faces = (const compile_face *)d->faces.items + brush->first_face;
    uint32_t changed = 0;
    for (uint32_t i = 0; i < brush->face_count; ++i) changed += faces[i].plane != r->planes[i];
    return changed && d->shape.corners.count <= CORNERS_MOST && !planes_repeat(r->planes, brush->face_count);
}

result input_try_planes(input_draft *d, const plane_replacement *r, replace_verdict *out)
{
    double move;
    *out = REPLACE_REFUSED;
    if (!is_change(d, r)) return RESULT_OK;
    const result done = cut_anew(d, r, &move, out);
    if (done == RESULT_OK) swap_shapes(d);
    return done;
}

result input_replace_planes(input_draft *d, const plane_replacement *r, replace_verdict *out)
{
    double move;
    *out = REPLACE_REFUSED;
    if (!is_change(d, r)) return RESULT_OK;
    const result done = cut_anew(d, r, &move, out);
    if (done != RESULT_OK) return done;
    if (*out == REPLACE_DONE) return list_changes(d, r, move);
    swap_shapes(d);
    return RESULT_OK;
}
