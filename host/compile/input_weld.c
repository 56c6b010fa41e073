// Weld of nearly equal planes of different brushes: where walls meant to be one stand a rounding apart, the gap between them
// would be a zone of its own.
// SPDX-License-Identifier: MIT
// Invariant: in a cluster every plane is near every other (complete linkage), so nothing drifts along a chain; planes are
// ordered by their numbers, never by their place in the file; a brush that would change its faces keeps its plane.
#include "input.h"

#include "../core/box_tree.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CLUSTER_MOST = 32, PAIRS_AT_FIRST = 1 << 16, PAIRS_MOST = 1 << 20 };
static const double TURN_MOST = 1.0 / 1024; // sine between two normals: 1/256 of a unit over a face of four; larger is meant

typedef struct unit_plane { double normal[3], offset; } unit_plane;

typedef struct near_pair {
    uint32_t a, b; // planes, not references; a < b
    double apart;  // steps, the most that any two brushes have
} near_pair;

typedef struct cluster {
    uint32_t planes[CLUSTER_MOST], count;
} cluster;

typedef struct weld {
    input_draft *draft;
    buffer units;    // unit_plane, of all planes
    buffer boxes;    // tree_box, of all brushes
    buffer pairs;    // near_pair
    size_t room;     // as many pairs before they are gone through for repeats
    int given_up;    // more than PAIRS_MOST: this is no level, and a weld would take for ever
    buffer clusters; // cluster; empty ones are merged into others
    buffer number;   // uint32_t: cluster + 1 of each plane, 0 none
    buffer planes;   // plane_ref: of one brush
} weld;

static const cull_wide_plane *plane_at(const weld *w, uint32_t plane)
{
    return plane_table_canonical(w->draft->in->planes, 2 * plane);
}

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
            if (pair.apart <= d->weld && !buffer_append(&w->pairs, &pair, 1)) return RESULT_NO_MEMORY;
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

// ---- Clusters ----

static int same_pair(const void *left, const void *right)
{
    const near_pair *a = left, *b = right;
    if (a->a != b->a) return a->a < b->a ? -1 : 1;
    return a->b < b->b ? -1 : a->b > b->b;
}

static int is_near(const near_pair *pairs, size_t count, uint32_t a, uint32_t b)
{
    const near_pair key = {a < b ? a : b, a < b ? b : a, 0};
    return bsearch(&key, pairs, count, sizeof key, same_pair) != NULL;
}

static int compare_planes(const cull_wide_plane *a, const cull_wide_plane *b)
{
    for (int k = 0; k < 3; ++k)
        if (a->normal[k] != b->normal[k]) return a->normal[k] < b->normal[k] ? -1 : 1;
    return cull_wide_sign(cull_wide_subtract(a->offset, b->offset));
}

typedef struct link { // a pair to be linked, with what it is ordered by
    double apart;
    cull_wide_plane low, high;
    uint32_t a, b;
} link;

static int compare_links(const void *left, const void *right)
{
    const link *a = left, *b = right;
    if (a->apart != b->apart) return a->apart < b->apart ? -1 : 1;
    const int low = compare_planes(&a->low, &b->low);
    return low ? low : compare_planes(&a->high, &b->high);
}

static cluster *cluster_of(weld *w, uint32_t plane)
{
    uint32_t *number = w->number.items;
    if (!number[plane]) {
        const cluster made = {{plane}, 1};
        if (!buffer_append(&w->clusters, &made, 1)) return NULL;
        number[plane] = (uint32_t)w->clusters.count;
    }
    return (cluster *)w->clusters.items + (number[plane] - 1);
}

static result join(weld *w, const near_pair *pairs, size_t count, const link *l)
{
    if (!cluster_of(w, l->a) || !cluster_of(w, l->b)) return RESULT_NO_MEMORY;
    cluster *to = cluster_of(w, l->a), *from = cluster_of(w, l->b);
    if (to == from || to->count + from->count > CLUSTER_MOST) return RESULT_OK;
    for (uint32_t i = 0; i < to->count; ++i)
        for (uint32_t j = 0; j < from->count; ++j)
            if (!is_near(pairs, count, to->planes[i], from->planes[j])) return RESULT_OK;
    uint32_t *number = w->number.items;
    for (uint32_t j = 0; j < from->count; ++j) {
        number[from->planes[j]] = number[l->a];
        to->planes[to->count++] = from->planes[j];
    }
    from->count = 0;
    return RESULT_OK;
}

static result find_clusters(weld *w)
{
    near_pair *pairs = w->pairs.items;
    qsort(pairs, w->pairs.count, sizeof *pairs, compare_by_number);
    const size_t count = w->pairs.count = once_each(pairs, w->pairs.count);
    const uint32_t planes = plane_table_count(w->draft->in->planes);
    uint32_t *number = buffer_push(&w->number, planes);
    buffer links = buffer_make(w->pairs.memory, sizeof(link));
    link *l = buffer_push(&links, count);
    result done = number && l ? RESULT_OK : RESULT_NO_MEMORY;
    if (number) memset(number, 0, planes * sizeof *number);
    for (size_t i = 0; i < count && done == RESULT_OK; ++i) {
        const cull_wide_plane *a = plane_at(w, pairs[i].a), *b = plane_at(w, pairs[i].b);
        const int forward = compare_planes(a, b) < 0;
        l[i] = (link){pairs[i].apart, forward ? *a : *b, forward ? *b : *a, pairs[i].a, pairs[i].b};
    }
    if (done == RESULT_OK) qsort(l, count, sizeof *l, compare_links);
    for (size_t i = 0; i < count && done == RESULT_OK; ++i) done = join(w, pairs, count, &l[i]);
    buffer_free(&links);
    return done;
}

// ---- One plane for each ----

static uint32_t bits_of(const cull_wide_plane *p)
{
    uint32_t bits = 0;
    for (int k = 0; k < 3; ++k)
        for (uint64_t m = cull_magnitude(p->normal[k]); m; m >>= 1) bits++;
    const cull_wide size = cull_wide_magnitude(p->offset);
    for (uint64_t m = size.high; m; m >>= 1) bits++;
    for (uint64_t m = size.low; m; m >>= 1) bits++;
    return bits;
}

static uint32_t representative(const weld *w, const cluster *c)
{
    uint32_t best = c->planes[0];
    for (uint32_t i = 1; i < c->count; ++i) {
        const cull_wide_plane *one = plane_at(w, c->planes[i]), *other = plane_at(w, best);
        const uint32_t bits = bits_of(one), least = bits_of(other);
        if (bits < least || (bits == least && compare_planes(one, other) < 0)) best = c->planes[i];
    }
    return best;
}

// Clusters' first planes become their representatives: what follows only reads those.
static void choose(weld *w)
{
    cluster *clusters = w->clusters.items;
    for (size_t i = 0; i < w->clusters.count; ++i)
        if (clusters[i].count) clusters[i].planes[0] = representative(w, &clusters[i]);
}

static plane_ref welded(const weld *w, plane_ref plane)
{
    const uint32_t number = ((const uint32_t *)w->number.items)[plane >> 1];
    if (!number) return plane;
    const plane_ref to = 2 * ((const cluster *)w->clusters.items)[number - 1].planes[0];
    if (to >> 1 == plane >> 1) return plane;
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
    if (done == RESULT_OK) done = find_clusters(w);
    if (done == RESULT_OK) choose(w);
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
              .clusters = buffer_make(memory, sizeof(cluster)),
              .number = buffer_make(memory, sizeof(uint32_t)),
              .planes = buffer_make(memory, sizeof(plane_ref))};
    const uint32_t errors = d->report->errors;
    const result done = d->brushes.count ? weld_all(&w) : RESULT_OK;
    buffer *const all[] = {&w.units, &w.boxes, &w.pairs, &w.clusters, &w.number, &w.planes};
    for (size_t i = 0; i < sizeof all / sizeof *all; ++i) buffer_free(all[i]);
    return done != RESULT_OK && d->report->errors == errors ? report_no_memory(d->report, d->path) : done;
}
