// Search for the frame of a turned map: pairs of the directions that most faces have, at a right angle, are taken for its axes;
// a grid of whole units is fitted to all points, and the simplest rational rotation that does it is the frame's.
// SPDX-License-Identifier: MIT
// Invariant: faces are taken by their size, then by their numbers, never by their place in the file.
#include "frame_search.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { FACES_LEAST = 48, FACETS_MOST = 256, DIRECTIONS_MOST = 6, PARTS_MOST = 8, REFERENCES = 3, REFERENCE_STEP_UNITS = 256 };
static const double SAME_DIRECTION = 1.0 / 256, RIGHT_ANGLE = 1.0 / 256; // sines: a step over a unit, the least face's width
static const double EXPLAINED_LEAST = 15.0 / 16;

typedef struct facet {
    double normal[3], width; // unit; twice the area over the longest side, steps
    uint32_t is_taken;
} facet;

typedef struct direction { double way[3]; } direction;

typedef struct frame_search {
    const int32_t (*given)[3]; // three a face
    size_t given_count;
    frame_points points; // in their own order, each once: sums of them come out the same whatever the file's
    buffer places;       // int32_t[3]
    double middle[3]; // of them
    buffer facets;    // facet
    direction directions[DIRECTIONS_MOST];
    int direction_count;
} frame_search;

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int k = 0; k < 3; ++k) out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

// ---- What there is ----

// Few points off whole units: the map was drawn as it stands.
static int is_turned(const frame_search *s)
{
    size_t off = 0;
    const int32_t grid = (int32_t)s->points.grid;
    for (size_t i = 0; i < s->given_count; ++i) off += s->given[i][0] % grid || s->given[i][1] % grid || s->given[i][2] % grid;
    return s->given_count >= 3 * FACES_LEAST && off > s->given_count / 2;
}

static int compare_places(const void *left, const void *right)
{
    const int32_t *a = left, *b = right;
    for (int k = 0; k < 3; ++k)
        if (a[k] != b[k]) return a[k] < b[k] ? -1 : 1;
    return 0;
}

static result take_places(frame_search *s)
{
    int32_t(*all)[3] = buffer_append(&s->places, s->given, s->given_count);
    if (!all) return RESULT_NO_MEMORY;
    qsort(all, s->given_count, sizeof *all, compare_places);
    size_t kept = 0;
    for (size_t i = 0; i < s->given_count; ++i)
        if (i == 0 || compare_places(all[i], all[kept - 1]) != 0) memmove(all[kept++], all[i], sizeof *all);
    s->points.at = (const int32_t(*)[3])s->places.items;
    s->points.count = kept;
    return RESULT_OK;
}

static double far_squared(const int32_t p[3], const double from[3])
{
    double sum = 0;
    for (int k = 0; k < 3; ++k) sum += (p[k] - from[k]) * (p[k] - from[k]);
    return sum;
}

static void find_middle(frame_search *s)
{
    const frame_points *p = &s->points;
    int64_t sums[3] = {0, 0, 0}; // whole: the same in any order
    for (size_t i = 0; i < p->count; ++i)
        for (int k = 0; k < 3; ++k) sums[k] += p->at[i][k];
    for (int k = 0; k < 3; ++k) s->middle[k] = (double)sums[k] / (double)p->count;
}

// The point nearest to the middle of all that is some way from it: the next one, should this not be one of the grid's.
static void set_reference(frame_search *s, int number)
{
    frame_points *p = &s->points;
    double least = INFINITY, most = 0;
    const double way = (double)number * REFERENCE_STEP_UNITS * p->grid;
    for (size_t i = 0; i < p->count; ++i) {
        const double far = far_squared(p->at[i], s->middle);
        if (far >= least || far < way * way) continue;
        least = far;
        p->reference = (uint32_t)i;
    }
    const int32_t *o = p->at[p->reference];
    const double from[3] = {o[0], o[1], o[2]};
    for (size_t i = 0; i < p->count; ++i) most = fmax(most, far_squared(p->at[i], from));
    p->reach = sqrt(most);
}

static int compare_facets(const void *left, const void *right)
{
    const facet *a = left, *b = right;
    if (a->width != b->width) return a->width > b->width ? -1 : 1;
    for (int k = 0; k < 3; ++k)
        if (a->normal[k] != b->normal[k]) return a->normal[k] < b->normal[k] ? -1 : 1;
    return 0;
}

static result take_facets(frame_search *s)
{
    for (size_t i = 0; i + 2 < s->given_count; i += 3) {
        const int32_t(*p)[3] = s->given + i;
        double sides[3][3], longest = 0;
        for (int e = 0; e < 3; ++e) {
            for (int k = 0; k < 3; ++k) sides[e][k] = (double)p[(e + 1) % 3][k] - p[e][k];
            longest = fmax(longest, sqrt(dot(sides[e], sides[e])));
        }
        facet made = {.is_taken = 0};
        cross(sides[0], sides[1], made.normal);
        const double area = sqrt(dot(made.normal, made.normal));
        if (!(area > 0)) continue;
        made.width = area / longest;
        for (int k = 0; k < 3; ++k) made.normal[k] /= area;
        if (made.width >= s->points.grid && !buffer_append(&s->facets, &made, 1)) return RESULT_NO_MEMORY;
    }
    if (s->facets.count) qsort(s->facets.items, s->facets.count, sizeof(facet), compare_facets);
    if (s->facets.count > FACETS_MOST) s->facets.count = FACETS_MOST;
    return RESULT_OK;
}

// ---- Directions ----

static int are_along(const facet *a, const facet *b)
{
    double off[3];
    cross(a->normal, b->normal, off);
    return dot(off, off) < SAME_DIRECTION * SAME_DIRECTION;
}

// The facet with the most others along it, of those that no direction has; the sum of them by the square of their width.
static int find_direction(frame_search *s, direction *out)
{
    facet *all = s->facets.items;
    size_t best = 0, most = 1;
    for (size_t i = 0; i < s->facets.count; ++i) {
        size_t count = 0;
        for (size_t j = 0; j < s->facets.count && !all[i].is_taken; ++j) count += !all[j].is_taken && are_along(&all[i], &all[j]);
        if (count <= most) continue;
        most = count;
        best = i;
    }
    if (most < 2) return 0;
    const facet of = all[best];
    double sum[3] = {0, 0, 0};
    for (size_t j = 0; j < s->facets.count; ++j) {
        if (all[j].is_taken || !are_along(&of, &all[j])) continue;
        all[j].is_taken = 1;
        const double weight = all[j].width * all[j].width * (dot(of.normal, all[j].normal) < 0 ? -1 : 1);
        for (int k = 0; k < 3; ++k) sum[k] += weight * all[j].normal[k];
    }
    const double length = sqrt(dot(sum, sum));
    for (int k = 0; k < 3; ++k) out->way[k] = sum[k] / length;
    return 1;
}

// ---- A frame of two of them ----

static int is_by_axes(const turned_frame *f)
{
    return f->scale == 1;
}

// 1: it explains nearly all points. *by_axes: there is one, but it is the grid as written.
static int try_parts(const frame_search *s, const rough_frame *axes, turned_frame *out, int *by_axes)
{
    for (uint32_t parts = 1; parts <= PARTS_MOST && !*by_axes; parts *= 2) {
        rough_frame rough = *axes;
        rough.parts = parts;
        if (!rough_frame_fit(&s->points, &rough) || !rough_frame_rational(&s->points, &rough, out)) continue;
        *by_axes = is_by_axes(out);
        out->points_explained = turned_frame_explains(out, s->given, s->given_count);
        if (!*by_axes && out->points_explained >= EXPLAINED_LEAST * (double)s->given_count) return 1;
    }
    return 0;
}

static int try_axes(frame_search *s, const direction *a, const direction *b, turned_frame *out)
{
    if (fabs(dot(a->way, b->way)) > RIGHT_ANGLE) return 0;
    rough_frame axes = {.parts = 1};
    double third[3];
    int by_axes = 0;
    cross(a->way, b->way, third);
    for (int k = 0; k < 3; ++k) {
        axes.turn[k][0] = a->way[k];
        axes.turn[k][1] = b->way[k];
        axes.turn[k][2] = third[k];
    }
    for (int r = 0; r < REFERENCES && !by_axes; ++r) {
        set_reference(s, r);
        if (try_parts(s, &axes, out, &by_axes)) return 1;
    }
    return 0;
}

static frame_verdict find_frame(frame_search *s, turned_frame *out)
{
    for (s->direction_count = 0; s->direction_count < DIRECTIONS_MOST; ++s->direction_count) {
        direction *made = &s->directions[s->direction_count];
        if (!find_direction(s, made)) break;
        for (int i = 0; i < s->direction_count; ++i)
            if (try_axes(s, &s->directions[i], made, out)) return FRAME_FOUND;
    }
    return FRAME_NONE;
}

result turned_frame_find(const int32_t (*points)[3], size_t count, uint32_t grid, const allocator *memory, turned_frame *out, frame_verdict *verdict)
{
    frame_search s = {.given = points,
                      .given_count = count,
                      .points = {.grid = grid},
                      .places = buffer_make(memory, sizeof(int32_t[3])),
                      .facets = buffer_make(memory, sizeof(facet))};
    *verdict = FRAME_NONE;
    if (!is_turned(&s)) return RESULT_OK;
    result done = take_places(&s);
    if (done == RESULT_OK) done = take_facets(&s);
    if (done == RESULT_OK) {
        find_middle(&s);
        *verdict = find_frame(&s, out);
    }
    buffer_free(&s.places);
    buffer_free(&s.facets);
    return done;
}
