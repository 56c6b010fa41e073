// Weld of corners within one brush: those that an editor's rounding has torn apart become one grid point again, and faces
// that meet in it get the plane through it and two more of their corners.
// SPDX-License-Identifier: MIT
// Invariant: a group's corners are all within the weld of each other, never a chain; the order is by place, not by file.
#include "input.h"
#include "input_order.h"

#include <math.h>
#include <stdlib.h>

enum { ROUNDS_MOST = 8 };
static const double SAME_AREA = 1e-12; // of an area's square: what doubles err by

typedef struct near_group {
    double middle[3]; // sum of its corners, then the grid point
    uint32_t count;
    int wide; // its corners are not all the same point
} near_group;

typedef struct snap {
    input_draft *draft;
    place_order place;
    buffer order;  // placed: corners by place
    buffer group;  // uint32_t: of each corner; UINT32_MAX none
    buffer groups; // near_group
    buffer places; // uint32_t: the nearest group of each corner of the shape
    buffer planes; // plane_ref
} snap;

typedef struct placed { double position[3]; const place_order *order; } placed;

static int compare_corners(const void *left, const void *right)
{
    const placed *a = left, *b = right;
    return compare_places(a->order, a->position, b->position);
}

static int within(const double a[3], const double b[3], double reach)
{
    double sum = 0;
    for (int k = 0; k < 3; ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
    return sum < reach * reach;
}

// Corners in order of place; each joins the first group all of which it is near to.
static result find_groups(snap *s, const placed *sorted, size_t count)
{
    s->group.count = s->groups.count = 0;
    uint32_t *group = buffer_push(&s->group, count);
    if (!group) return RESULT_NO_MEMORY;
    for (size_t i = 0; i < count; ++i) {
        uint32_t to = 0;
        for (; to < s->groups.count; ++to) {
            int near = 1;
            for (size_t j = 0; j < i && near; ++j) near = group[j] != to || within(sorted[i].position, sorted[j].position, s->draft->weld);
            if (near) break;
        }
        static const near_group none = {{0, 0, 0}, 0, 0};
        if (to == s->groups.count && !buffer_append(&s->groups, &none, 1)) return RESULT_NO_MEMORY;
        group[i] = to;
        near_group *g = (near_group *)s->groups.items + to;
        for (int k = 0; k < 3; ++k) {
            g->wide |= g->count && fabs(g->middle[k] / g->count - sorted[i].position[k]) > 1e-6; // steps; only a hint
            g->middle[k] += sorted[i].position[k];
        }
        g->count++;
    }
    near_group *groups = s->groups.items;
    for (size_t g = 0; g < s->groups.count; ++g)
        for (int k = 0; k < 3; ++k) groups[g].middle[k] = nearbyint(steady(groups[g].middle[k] / groups[g].count));
    return RESULT_OK;
}

static uint32_t nearest_group(const snap *s, const double position[3])
{
    const near_group *groups = s->groups.items;
    uint32_t best = 0;
    double least = INFINITY;
    for (uint32_t g = 0; g < s->groups.count; ++g) {
        double sum = 0;
        for (int k = 0; k < 3; ++k) sum += (groups[g].middle[k] - position[k]) * (groups[g].middle[k] - position[k]);
        if (sum >= least) continue;
        least = sum;
        best = g;
    }
    return best;
}

static result place_corners(snap *s)
{
    const brush_shape *shape = &s->draft->shape;
    const shape_corner *c = shape->corners.items;
    s->places.count = 0;
    uint32_t *places = buffer_push(&s->places, shape->corners.count);
    if (!places) return RESULT_NO_MEMORY;
    for (size_t i = 0; i < shape->corners.count; ++i) places[i] = nearest_group(s, c[i].position);
    return RESULT_OK;
}

static const near_group *group_of(const snap *s, size_t corner)
{
    return (const near_group *)s->groups.items + ((const uint32_t *)s->places.items)[corner];
}

static void to_point(const near_group *g, int32_t out[3])
{
    for (int k = 0; k < 3; ++k) out[k] = (int32_t)g->middle[k];
}

// The plane through `fixed` and two more of the face's corners, the largest such triangle; PLANE_NONE: there is none.
static plane_ref refit(snap *s, const shape_face *face, const near_group *fixed)
{
    int32_t at[3], first[3], second[3];
    cull_wide_plane best = {{0, 0, 0}, {0, 0}};
    double most = 0;
    to_point(fixed, at);
    for (uint32_t i = 0; i < face->corner_count; ++i)
        for (uint32_t j = i + 1; j < face->corner_count; ++j) {
            to_point(group_of(s, face->first_corner + i), first);
            to_point(group_of(s, face->first_corner + j), second);
            double u[3], v[3], area = 0;
            for (int k = 0; k < 3; ++k) {
                u[k] = (double)first[k] - at[k];
                v[k] = (double)second[k] - at[k];
            }
            for (int k = 0; k < 3; ++k) {
                const double part = u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
                area += part * part;
            }
            cull_wide_plane made;
            if (area < most * (1 - SAME_AREA) || !cull_wide_plane_through(at, first, second, &made)) continue;
            if (area <= most * (1 + SAME_AREA) && most > 0 && compare_plane_places(&s->place, &made, &best) >= 0) continue;
            most = area;
            best = made;
        }
    return most > 0 ? plane_table_add(s->draft->in->planes, &best) : PLANE_NONE;
}

// The group to be snapped that the face meets: `only`, or with NULL the first by place that is more than one point.
static const near_group *group_at(const snap *s, const shape_face *face, const near_group *only)
{
    const near_group *first = NULL;
    for (uint32_t i = 0; i < face->corner_count; ++i) {
        const near_group *g = group_of(s, face->first_corner + i);
        if (g == only || (!only && g->wide && (!first || g < first))) first = g;
    }
    return first;
}

// All faces that meet in the group through its grid point; those that have no two other corners to go through keep theirs.
// NULL: all groups at once.
static result snap_group(snap *s, uint32_t brush, const near_group *only, replace_verdict *out)
{
    const plane_table *t = s->draft->in->planes;
    const shape_face *faces = s->draft->shape.faces.items;
    const compile_brush *b = (const compile_brush *)s->draft->brushes.items + brush;
    const compile_face *had = (const compile_face *)s->draft->faces.items + b->first_face;
    s->planes.count = 0;
    plane_ref *planes = buffer_push(&s->planes, b->face_count);
    if (!planes) return RESULT_NO_MEMORY;
    for (uint32_t i = 0; i < b->face_count; ++i) {
        planes[i] = had[i].plane;
        const near_group *g = group_at(s, &faces[i], only);
        int32_t at[3];
        if (g) to_point(g, at);
        if (!g || (only && plane_table_side_of_point(t, at, planes[i]) == 0)) continue;
        const plane_ref made = refit(s, &faces[i], g);
        if (made == PLANE_NONE) continue;
        const cull_wide_plane before = plane_table_get(t, planes[i]), after = plane_table_get(t, made);
        planes[i] = cull_normals_dot_sign(&before, &after) < 0 ? plane_ref_flipped(made) : made;
    }
    const plane_replacement r = {brush, planes, WELD_POINT};
    return input_replace_planes(s->draft, &r, out);
}

// One group that can be snapped is, and the rest looked at anew.
static result snap_once(snap *s, uint32_t brush, replace_verdict *out)
{
    *out = REPLACE_REFUSED;
    brush_shape *shape = &s->draft->shape;
    if (shape_close_pairs(shape, s->draft->in->planes, s->draft->weld) == 0) return RESULT_OK;
    s->order.count = 0;
    placed *sorted = buffer_push(&s->order, shape->corners.count);
    if (!sorted) return RESULT_NO_MEMORY;
    for (size_t i = 0; i < shape->corners.count; ++i) {
        const double *p = ((const shape_corner *)shape->corners.items)[i].position;
        sorted[i] = (placed){{p[0], p[1], p[2]}, &s->place};
    }
    qsort(sorted, shape->corners.count, sizeof *sorted, compare_corners);
    if (find_groups(s, sorted, shape->corners.count) != RESULT_OK || place_corners(s) != RESULT_OK) return RESULT_NO_MEMORY;
    result done = snap_group(s, brush, NULL, out);
    const near_group *groups = s->groups.items;
    for (size_t g = 0; g < s->groups.count && *out == REPLACE_REFUSED && done == RESULT_OK; ++g) {
        if (groups[g].wide) done = snap_group(s, brush, &groups[g], out);
    }
    return done;
}

result input_snap_corners(input_draft *d)
{
    const allocator *memory = d->faces.memory;
    snap s = {.draft = d,
              .place = place_order_of(d->brushes.items, d->brushes.count),
              .order = buffer_make(memory, sizeof(placed)),
              .group = buffer_make(memory, sizeof(uint32_t)),
              .groups = buffer_make(memory, sizeof(near_group)),
              .places = buffer_make(memory, sizeof(uint32_t)),
              .planes = buffer_make(memory, sizeof(plane_ref))};
    result done = RESULT_OK;
    const uint32_t errors = d->report->errors;
    const uint32_t *close = d->close.items;
    for (size_t b = 0; b < d->close.count && done == RESULT_OK; ++b) {
        replace_verdict verdict = REPLACE_DONE;
        done = input_cut_brush(d, close[b]);
        for (int i = 0; i < ROUNDS_MOST && done == RESULT_OK && verdict == REPLACE_DONE; ++i) done = snap_once(&s, close[b], &verdict);
    }
    buffer *const all[] = {&s.order, &s.group, &s.groups, &s.places, &s.planes};
    for (size_t i = 0; i < sizeof all / sizeof *all; ++i) buffer_free(all[i]);
    return done != RESULT_OK && d->report->errors == errors ? report_no_memory(d->report, d->path) : done;
}
