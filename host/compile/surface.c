// Shared vertices found by the cell of their position and told apart by exact sides; cuts of convex polygons.
// SPDX-License-Identifier: MIT
#include "surface.h"

#include <assert.h>
#include <math.h>
#include <string.h>

// Cells of a quarter step. A position is off by at most 2^-50 of 2^24 steps a coordinate, 2^-26: a point nearer than
// CELL_SLACK (steps) to a border is looked for on both sides of it.
#define CELLS_A_STEP 4.0
#define CELL_SLACK 1e-6

surface surface_make(plane_table *planes, const allocator *memory)
{
    const surface s = {.planes = planes,
                       .memory = memory,
                       .vertices = buffer_make(memory, sizeof(compile_vertex)),
                       .corners = buffer_make(memory, sizeof(surface_corner)),
                       .polygons = buffer_make(memory, sizeof(surface_polygon)),
                       .slots = buffer_make(memory, sizeof(uint32_t)),
                       .next = buffer_make(memory, sizeof(uint32_t))};
    return s;
}

void surface_free(surface *s)
{
    buffer_free(&s->vertices);
    buffer_free(&s->corners);
    buffer_free(&s->polygons);
    buffer_free(&s->slots);
    buffer_free(&s->next);
}

int surface_side(const surface *s, uint32_t vertex, plane_ref of)
{
    const compile_vertex *v = surface_vertex_at(s, vertex);
    for (int i = 0; i < 3; ++i)
        if (v->planes[i] >> 1 == of >> 1) return 0;
    return plane_table_side_at(s->planes, v->planes, v->position, of);
}

static uint32_t cell_slot(const int64_t cell[3], size_t slots)
{
    uint64_t h = 0;
    for (int k = 0; k < 3; ++k) h = (h ^ (uint64_t)cell[k]) * 0x9e3779b97f4a7c15u, h ^= h >> 29;
    return (uint32_t)(h & (slots - 1));
}

static void cell_of(const double position[3], double nudge, int corner, int64_t out[3])
{
    for (int k = 0; k < 3; ++k) out[k] = (int64_t)floor((position[k] + (corner >> k & 1 ? nudge : -nudge)) * CELLS_A_STEP);
}

static void link_vertex(surface *s, uint32_t v)
{
    int64_t cell[3];
    cell_of(surface_vertex_at(s, v)->position, 0, 0, cell);
    uint32_t *slot = (uint32_t *)s->slots.items + cell_slot(cell, s->slots.count);
    ((uint32_t *)s->next.items)[v] = *slot;
    *slot = v + 1;
}

static result grow_slots(surface *s)
{
    const size_t count = s->slots.count ? s->slots.count * 2 : 1024;
    if (!buffer_push(&s->slots, count - s->slots.count)) return RESULT_NO_MEMORY;
    memset(s->slots.items, 0, count * sizeof(uint32_t));
    for (uint32_t v = 0; v < s->vertices.count; ++v) link_vertex(s, v);
    return RESULT_OK;
}

static int is_at(const surface *s, uint32_t vertex, const plane_ref meet[3])
{
    return surface_side(s, vertex, meet[0]) == 0 && surface_side(s, vertex, meet[1]) == 0 && surface_side(s, vertex, meet[2]) == 0;
}

static int near_by(const double a[3], const double b[3])
{
    return fabs(a[0] - b[0]) < CELL_SLACK && fabs(a[1] - b[1]) < CELL_SLACK && fabs(a[2] - b[2]) < CELL_SLACK;
}

static int find_vertex(const surface *s, const plane_ref meet[3], const double position[3], uint32_t *out)
{
    int64_t seen[8][3];
    for (int corner = 0; corner < 8; ++corner) {
        cell_of(position, CELL_SLACK, corner, seen[corner]);
        int again = 0;
        for (int before = 0; before < corner; ++before) again |= memcmp(seen[before], seen[corner], sizeof(seen[0])) == 0;
        if (again) continue;
        for (uint32_t v = ((uint32_t *)s->slots.items)[cell_slot(seen[corner], s->slots.count)]; v; v = ((uint32_t *)s->next.items)[v - 1]) {
            if (!near_by(surface_vertex_at(s, v - 1)->position, position) || !is_at(s, v - 1, meet)) continue;
            *out = v - 1;
            return 1;
        }
    }
    return 0;
}

static void sort_three(plane_ref p[3])
{
    for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2 - i; ++j)
            if (p[j] > p[j + 1]) {
                const plane_ref swap = p[j];
                p[j] = p[j + 1];
                p[j + 1] = swap;
            }
}

result surface_vertex(surface *s, const plane_ref meet[3], uint32_t *out)
{
    compile_vertex made;
    for (int i = 0; i < 3; ++i) made.planes[i] = meet[i] & ~1u;
    sort_three(made.planes);
    const int meets = plane_table_position(s->planes, made.planes, made.position);
    assert(meets);
    (void)meets;
    if (s->vertices.count >= s->slots.count) {
        const result r = grow_slots(s);
        if (r != RESULT_OK) return r;
    }
    if (find_vertex(s, made.planes, made.position, out)) return RESULT_OK;
    if (!buffer_push(&s->next, 1)) return RESULT_NO_MEMORY;
    if (!buffer_append(&s->vertices, &made, 1)) {
        s->next.count--;
        return RESULT_NO_MEMORY;
    }
    *out = (uint32_t)s->vertices.count - 1;
    link_vertex(s, *out);
    return RESULT_OK;
}

static void make_box(const surface *s, surface_polygon *p)
{
    const surface_corner *c = surface_corners(s, p);
    for (int k = 0; k < 3; ++k) {
        p->min[k] = INFINITY;
        p->max[k] = -INFINITY;
        for (uint32_t i = 0; i < p->count; ++i) {
            const double at = surface_vertex_at(s, c[i].vertex)->position[k];
            p->min[k] = at < p->min[k] ? at : p->min[k];
            p->max[k] = at > p->max[k] ? at : p->max[k];
        }
    }
}

result surface_add(surface *s, plane_ref plane, const surface_corner *corners, uint32_t count, const surface_polygon *like, uint32_t *out)
{
    surface_polygon p = *like;
    p.plane = plane;
    p.first = (uint32_t)s->corners.count;
    p.count = count;
    if (!buffer_append(&s->corners, corners, count)) return RESULT_NO_MEMORY;
    make_box(s, &p);
    if (!buffer_append(&s->polygons, &p, 1)) return RESULT_NO_MEMORY;
    if (out) *out = (uint32_t)s->polygons.count - 1;
    return RESULT_OK;
}

cut_result surface_classify(const surface *s, uint32_t polygon, plane_ref by)
{
    const surface_polygon *p = surface_polygon_at(s, polygon);
    const surface_corner *c = surface_corners(s, p);
    if (p->plane >> 1 == by >> 1) return CUT_ON;
    int front = 0, back = 0;
    for (uint32_t i = 0; i < p->count && !(front && back); ++i) {
        const int side = surface_side(s, c[i].vertex, by);
        front |= side > 0;
        back |= side < 0;
    }
    return front && back ? CUT_BOTH : front ? CUT_FRONT : back ? CUT_BACK : CUT_ON;
}

// The part of the loop on one side of `by` (turned so that it is the front), into the corners from `to` on; the count.
static result half_loop(surface *s, const surface_polygon *p, plane_ref by, surface_corner *to, uint32_t *count)
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < p->count; ++i) {
        const surface_corner here = surface_corners(s, p)[i], next = surface_corners(s, p)[i + 1 < p->count ? i + 1 : 0];
        const int side = surface_side(s, here.vertex, by), after = surface_side(s, next.vertex, by);
        if (side >= 0) {
            const surface_corner kept = {here.vertex, side == 0 && after < 0 ? plane_ref_flipped(by) : here.edge};
            to[n++] = kept;
        }
        if (side * after >= 0) continue;
        const plane_ref meet[3] = {p->plane, here.edge, by};
        surface_corner made = {0, side > 0 ? plane_ref_flipped(by) : here.edge};
        const result r = surface_vertex(s, meet, &made.vertex);
        if (r != RESULT_OK) return r;
        to[n++] = made;
    }
    *count = n;
    return RESULT_OK;
}

result surface_cut(surface *s, uint32_t polygon, plane_ref by, uint32_t *back)
{
    surface_polygon old = *surface_polygon_at(s, polygon);
    const size_t most = old.count + 2;
    surface_corner *parts = memory_alloc(s->memory, 2 * most, sizeof(*parts));
    uint32_t counts[2] = {0, 0};
    if (!parts) return RESULT_NO_MEMORY;
    result r = half_loop(s, &old, by, parts, &counts[0]);
    if (r == RESULT_OK) r = half_loop(s, &old, plane_ref_flipped(by), parts + most, &counts[1]);
    assert(r != RESULT_OK || (counts[0] >= 3 && counts[0] <= most && counts[1] >= 3 && counts[1] <= most));
    if (r == RESULT_OK) r = surface_add(s, old.plane, parts + most, counts[1], &old, back);
    if (r == RESULT_OK && !buffer_append(&s->corners, parts, counts[0])) r = RESULT_NO_MEMORY;
    if (r == RESULT_OK) {
        old.first = (uint32_t)(s->corners.count - counts[0]);
        old.count = counts[0];
        make_box(s, &old);
        *surface_polygon_at(s, polygon) = old;
    }
    memory_free(s->memory, parts, 2 * most, sizeof(*parts));
    return r;
}
