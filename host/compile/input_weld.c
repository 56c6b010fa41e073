// Weld of nearly equal planes of different brushes: where walls meant to be one stand a rounding apart, the gap between them
// would be a zone of its own.
// SPDX-License-Identifier: MIT
// Invariant: what may become one is in input_cluster.c; planes are ordered as in input_order.h, never by their place in the
// file; a brush that would change its faces keeps its plane.
#include "input_cluster.h"

#include "../core/box_tree.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PAIRS_AT_FIRST = 1 << 16, PAIRS_MOST = 1 << 20 };
static const double TURN_MOST = 1.0 / 128; // sine between two normals: the weld over a face of four units; larger is meant
static const double APART_MOST = 2;        // welds between two planes: either may go by one

typedef struct unit_plane { double normal[3], offset; } unit_plane;

typedef struct weld {
    input_draft *draft;
    buffer units;    // unit_plane, of all planes
    buffer boxes;    // tree_box, of all brushes
    buffer pairs;    // near_pair
    size_t room;     // as many pairs before they are gone through for repeats
    int given_up;    // more than PAIRS_MOST: this is no level, and a weld would take for ever
    buffer to;       // plane_ref by plane: see plane_clusters_find
    buffer planes;   // plane_ref: of one brush
} weld;

// ---- Which planes are near ----

static int is_welded(const compile_brush *b)
{
    return b->role == BRUSH_STRUCTURE || b->role == BRUSH_LIQUID;
}

// How far two planes are from each other, at most, anywhere in the box; infinite when they are not near to parallel. The
// difference of two heights is linear, so it is greatest in a corner.
static double apart_in(const unit_plane *a, const unit_plane *b, const double min[3], const double max[3])
{
    const double along = a->normal[0] * b->normal[0] + a->normal[1] * b->normal[1] + a->normal[2] * b->normal[2];
    if (fabs(along) < 0.999) return INFINITY;
    const double sign = along < 0 ? -1 : 1;
    double turn = 0, middle = a->offset - sign * b->offset, spread = 0;
    for (int k = 0; k < 3; ++k) {
        const double off = a->normal[k] - sign * b->normal[k];
        turn += off * off;
        middle += off * (min[k] + max[k]) / 2;
        spread += fabs(off) * (max[k] - min[k]) / 2;
    }
    return turn > TURN_MOST * TURN_MOST ? INFINITY : fabs(middle) + spread;
}

static int compare_by_number(const void *left, const void *right)
{
    const near_pair *a = left, *b = right;
    if (a->a != b->a) return a->a < b->a ? -1 : 1;
    if (a->b != b->b) return a->b < b->b ? -1 : 1;
    return a->apart < b->apart ? -1 : a->apart > b->apart; // the last of equal ones is the farthest
}

static size_t once_each(near_pair *pairs, size_t count)
{
    size_t kept = 0;
    for (size_t i = 0; i < count; ++i)
        if (i + 1 == count || pairs[i].a != pairs[i + 1].a || pairs[i].b != pairs[i + 1].b) pairs[kept++] = pairs[i];
    return kept;
}

// Pairs that are there several times count once. 0: there are too many all the same.
static int make_room(weld *w)
{
    if (w->pairs.count < w->room) return 1;
    qsort(w->pairs.items, w->pairs.count, sizeof(near_pair), compare_by_number);
    w->pairs.count = once_each(w->pairs.items, w->pairs.count);
    w->room = 2 * w->pairs.count > PAIRS_AT_FIRST ? 2 * w->pairs.count : PAIRS_AT_FIRST;
    return w->pairs.count < PAIRS_MOST;
}

static result compare_brushes(weld *w, const compile_brush *a, const compile_brush *b)
{
    const input_draft *d = w->draft;
    const compile_face *faces = d->faces.items;
    const unit_plane *units = w->units.items;
    double min[3], max[3];
    for (int k = 0; k < 3; ++k) {
        min[k] = fmax(a->min[k], b->min[k]) - d->weld;
        max[k] = fmin(a->max[k], b->max[k]) + d->weld;
        if (min[k] > max[k]) return RESULT_OK;
    }
    for (uint32_t i = 0; i < a->face_count; ++i)
        for (uint32_t j = 0; j < b->face_count; ++j) {
            const uint32_t p = faces[a->first_face + i].plane >> 1, q = faces[b->first_face + j].plane >> 1;
            if (p == q) continue;
            const near_pair pair = {p < q ? p : q, p < q ? q : p, apart_in(&units[p], &units[q], min, max)};
            if (pair.apart <= APART_MOST * d->weld && !buffer_append(&w->pairs, &pair, 1)) return RESULT_NO_MEMORY;
        }
    return RESULT_OK;
}

static result measure_planes(weld *w)
{
    const uint32_t count = plane_table_count(w->draft->in->planes);
    unit_plane *units = buffer_push(&w->units, count);
    if (!units) return RESULT_NO_MEMORY;
    for (uint32_t i = 0; i < count; ++i) {
        const cull_row *row = plane_table_row(w->draft->in->planes, 2 * i);
        const double length = sqrt(row->n[0] * row->n[0] + row->n[1] * row->n[1] + row->n[2] * row->n[2]);
        for (int k = 0; k < 3; ++k) units[i].normal[k] = row->n[k] / length;
        units[i].offset = row->offset / length;
    }
    return RESULT_OK;
}

static result find_pairs(weld *w)
{
    const compile_brush *brushes = w->draft->brushes.items;
    const uint32_t count = (uint32_t)w->draft->brushes.count;
    tree_box *boxes = buffer_push(&w->boxes, count);
    if (!boxes) return RESULT_NO_MEMORY;
    for (uint32_t i = 0; i < count; ++i)
        for (int k = 0; k < 3; ++k) {
            boxes[i].min[k] = brushes[i].min[k] - w->draft->weld;
            boxes[i].max[k] = brushes[i].max[k] + w->draft->weld;
        }
    box_tree tree;
    result done = box_tree_open(boxes, count, w->boxes.memory, &tree);
    if (done != RESULT_OK) return done;
    for (uint32_t i = 0; i < count && done == RESULT_OK; ++i) {
        if (!is_welded(&brushes[i])) continue;
        box_walk walk;
        uint32_t other;
        box_walk_start(&walk, &tree, &boxes[i]);
        while (done == RESULT_OK && !w->given_up && box_walk_next(&walk, &other)) {
            if (other <= i || !is_welded(&brushes[other])) continue;
            done = compare_brushes(w, &brushes[i], &brushes[other]);
            w->given_up = !make_room(w);
        }
    }
    box_tree_close(&tree, w->boxes.memory);
    return done;
}

// ---- One plane for each ----

static plane_ref welded(const weld *w, plane_ref plane)
{
    const plane_ref to = plane >> 1 < w->to.count ? ((const plane_ref *)w->to.items)[plane >> 1] : PLANE_NONE;
    if (to == PLANE_NONE) return plane;
    const cull_wide_plane before = plane_table_get(w->draft->in->planes, plane), after = plane_table_get(w->draft->in->planes, to);
    return cull_normals_dot_sign(&before, &after) < 0 ? plane_ref_flipped(to) : to;
}

// All planes of the brush at once; where it refuses that, one by one.
static result weld_brush(weld *w, uint32_t number)
{
    const compile_brush *b = (const compile_brush *)w->draft->brushes.items + number;
    const compile_face *faces = (const compile_face *)w->draft->faces.items + b->first_face;
    w->planes.count = 0;
    plane_ref *planes = buffer_push(&w->planes, b->face_count);
    if (!planes) return RESULT_NO_MEMORY;
    uint32_t changed = 0;
    for (uint32_t i = 0; i < b->face_count; ++i) {
        planes[i] = welded(w, faces[i].plane);
        changed += planes[i] != faces[i].plane;
    }
    if (!changed) return RESULT_OK;
    replace_verdict verdict;
    const plane_replacement r = {number, planes, WELD_PLANE};
    result done = input_cut_brush(w->draft, number);
    if (done == RESULT_OK) done = input_replace_planes(w->draft, &r, &verdict);
    if (done != RESULT_OK || verdict == REPLACE_DONE || changed == 1) return done;
    for (uint32_t one = 0; one < b->face_count && done == RESULT_OK; ++one) {
        for (uint32_t i = 0; i < b->face_count; ++i) planes[i] = i == one ? welded(w, faces[i].plane) : faces[i].plane;
        if (planes[one] != faces[one].plane) done = input_replace_planes(w->draft, &r, &verdict);
    }
    return done;
}

static result weld_all(weld *w)
{
    result done = measure_planes(w);
    if (done == RESULT_OK) done = find_pairs(w);
    if (w->given_up)
        report_warning(w->draft->report, w->draft->path, 0, "over %d pairs of nearly equal planes; none is welded", PAIRS_MOST);
    if (done == RESULT_OK && (w->pairs.count == 0 || w->given_up)) return done;
    if (done != RESULT_OK) return done;
    qsort(w->pairs.items, w->pairs.count, sizeof(near_pair), compare_by_number);
    w->pairs.count = once_each(w->pairs.items, w->pairs.count);
    done = plane_clusters_find(w->draft, w->pairs.items, w->pairs.count, &w->to);
    const compile_brush *brushes = w->draft->brushes.items;
    for (uint32_t i = 0; i < w->draft->brushes.count && done == RESULT_OK; ++i)
        if (is_welded(&brushes[i])) done = weld_brush(w, i);
    return done;
}

result input_weld_planes(input_draft *d)
{
    const allocator *memory = d->faces.memory;
    weld w = {.draft = d,
              .units = buffer_make(memory, sizeof(unit_plane)),
              .boxes = buffer_make(memory, sizeof(tree_box)),
              .pairs = buffer_make(memory, sizeof(near_pair)),
              .room = PAIRS_AT_FIRST,
              .to = buffer_make(memory, sizeof(plane_ref)),
              .planes = buffer_make(memory, sizeof(plane_ref))};
    const uint32_t errors = d->report->errors;
    const result done = d->brushes.count ? weld_all(&w) : RESULT_OK;
    buffer *const all[] = {&w.units, &w.boxes, &w.pairs, &w.to, &w.planes};
    for (size_t i = 0; i < sizeof all / sizeof *all; ++i) buffer_free(all[i]);
    return done != RESULT_OK && d->report->errors == errors ? report_no_memory(d->report, d->path) : done;
}
