// Vertices that lie inside an edge of a line on which none of their own edges runs: the tip of a cone against a wall's
// edge. They belong to the line like the others, or a T-junction would be left.
// SPDX-License-Identifier: MIT
#include "lines.h"
#include "surface_frame.h"

#include <math.h>

#define NEAR_STEPS 1e-5 // positions are off by 2^-26 steps: what is farther from a line is not on it

static const surface_corner *edge_ends(const surface *s, const line_edge *e, uint32_t ends[2])
{
    const surface_polygon *p = surface_polygon_at(s, e->polygon);
    const surface_corner *c = surface_corners(s, p);
    const uint32_t at = e->corner - p->first;
    ends[0] = c[at].vertex;
    ends[1] = c[at + 1 < p->count ? at + 1 : 0].vertex;
    return c + at;
}

static int is_in_box(const double p[3], const double min[3], const double max[3])
{
    for (int k = 0; k < 3; ++k)
        if (p[k] < min[k] - NEAR_STEPS || p[k] > max[k] + NEAR_STEPS) return 0;
    return 1;
}

static int is_near_edge(const line_set *l, const line_edge *e, uint32_t vertex)
{
    uint32_t ends[2];
    edge_ends(l->s, e, ends);
    const double *a = surface_vertex_at(l->s, ends[0])->position, *b = surface_vertex_at(l->s, ends[1])->position;
    double min[3], max[3];
    for (int k = 0; k < 3; ++k) {
        min[k] = a[k] < b[k] ? a[k] : b[k];
        max[k] = a[k] < b[k] ? b[k] : a[k];
    }
    return is_in_box(surface_vertex_at(l->s, vertex)->position, min, max);
}

// A slanted polygon's box holds much that is nowhere near it.
static int is_near_plane(const surface *s, plane_ref plane, uint32_t vertex)
{
    const cull_row *row = plane_table_row(s->planes, plane);
    const double *p = surface_vertex_at(s, vertex)->position;
    return fabs(row->n[0] * p[0] + row->n[1] * p[1] + row->n[2] * p[2] + row->offset) <= 4 * NEAR_STEPS * row->most;
}

static int is_near_line(const line_set *l, const line_edge *e, uint32_t end, uint32_t vertex)
{
    const double *p = surface_vertex_at(l->s, vertex)->position, *a = surface_vertex_at(l->s, end)->position;
    const double *u = ((line_direction *)l->directions.items)[((surface_line *)l->lines.items)[e->line].direction].unit;
    for (int k = 0; k < 3; ++k) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        if (fabs((p[i] - a[i]) * u[j] - (p[j] - a[j]) * u[i]) > NEAR_STEPS) return 0;
    }
    return 1;
}

static int touches(const line_set *l, const line_edge *e, uint32_t vertex)
{
    uint32_t ends[2];
    edge_ends(l->s, e, ends);
    if (vertex == ends[0] || vertex == ends[1] || !is_near_line(l, e, ends[0], vertex)) return 0;
    const surface_line *line = (surface_line *)l->lines.items + e->line;
    if (surface_side(l->s, vertex, line->a) || surface_side(l->s, vertex, line->b)) return 0;
    return line_order(l, line, vertex, ends[0]) * line_order(l, line, vertex, ends[1]) < 0;
}

// Of the edge's line an edge ends in the vertex: then the line has it anyway.
static int has_own_edge(uint32_t line, const uint32_t *first, const uint32_t *lines_at, uint32_t vertex)
{
    for (uint32_t i = first[vertex]; i < first[vertex + 1]; ++i)
        if (lines_at[i] == line) return 1;
    return 0;
}

static void lines_by_vertex(const line_set *l, uint32_t *first, uint32_t *lines_at)
{
    const size_t vertices = l->s->vertices.count;
    for (int pass = 0; pass < 2; ++pass) {
        for (size_t i = 0; i < l->edges.count; ++i) {
            const line_edge *e = (line_edge *)l->edges.items + i;
            uint32_t ends[2];
            edge_ends(l->s, e, ends);
            for (int k = 0; k < 2; ++k) {
                if (pass == 0) first[ends[k] + 2]++;
                else lines_at[first[ends[k] + 1]++] = e->line;
            }
        }
        if (pass == 0)
            for (size_t v = 2; v < vertices + 2; ++v) first[v] += first[v - 1];
    }
}

static result add_touch(buffer *out, size_t of_vertex, line_touch found) // of_vertex: where this vertex' touches begin
{
    const line_touch *known = out->items;
    for (size_t i = of_vertex; i < out->count; ++i)
        if (known[i].line == found.line) return RESULT_OK;
    return buffer_append(out, &found, 1) ? RESULT_OK : RESULT_NO_MEMORY;
}

typedef struct touch_search {
    const line_set *l;
    surface_frame frame;
    tree_box *boxes; // of polygons: a quarter as many as edges
    box_tree tree;
    uint32_t *first, *lines_at; // see lines_by_vertex
    buffer *out;
} touch_search;

static result search_polygon(const touch_search *t, uint32_t polygon, uint32_t vertex, size_t of_vertex)
{
    const line_set *l = t->l;
    const surface_polygon *p = surface_polygon_at(l->s, polygon);
    if (!is_near_plane(l->s, p->plane, vertex)) return RESULT_OK;
    for (uint32_t c = 0; c < p->count; ++c) {
        const line_edge *e = (line_edge *)l->edges.items + l->edge_of[p->first + c];
        if (!is_near_edge(l, e, vertex) || has_own_edge(e->line, t->first, t->lines_at, vertex) || !touches(l, e, vertex)) continue;
        const result r = add_touch(t->out, of_vertex, (line_touch){e->line, vertex});
        if (r != RESULT_OK) return r;
    }
    return RESULT_OK;
}

static result search(const touch_search *t)
{
    result r = RESULT_OK;
    for (uint32_t v = 0; v < t->l->s->vertices.count; ++v) {
        if (t->first[v] == t->first[v + 1]) continue; // of no polygon in use
        const tree_box at = surface_frame_vertex(&t->frame, t->l->s, v, 0);
        const size_t of_vertex = t->out->count;
        box_walk walk;
        box_walk_start(&walk, &t->tree, &at);
        for (uint32_t i; r == RESULT_OK && box_walk_next(&walk, &i);) r = search_polygon(t, i, v, of_vertex);
        if (r != RESULT_OK) return r;
    }
    return r;
}

static void make_boxes(const surface_frame *f, const surface *s, tree_box *boxes)
{
    for (uint32_t i = 0; i < surface_polygon_count(s); ++i) boxes[i] = surface_frame_polygon(f, s, i, NEAR_STEPS);
}

result line_touches(const line_set *l, buffer *out)
{
    const size_t edges = l->edges.count, vertices = l->s->vertices.count;
    const uint32_t polygons = surface_polygon_count(l->s);
    if (edges == 0) return RESULT_OK;
    touch_search t = {.l = l, .frame = surface_frame_of(l->s), .out = out};
    t.boxes = memory_alloc(l->memory, polygons, sizeof(*t.boxes));
    t.first = memory_alloc_zeroed(l->memory, vertices + 2, sizeof(*t.first));
    t.lines_at = memory_alloc(l->memory, 2 * edges, sizeof(*t.lines_at));
    result r = t.boxes && t.first && t.lines_at ? RESULT_OK : RESULT_NO_MEMORY;
    if (r == RESULT_OK) {
        make_boxes(&t.frame, l->s, t.boxes);
        lines_by_vertex(l, t.first, t.lines_at);
        r = box_tree_open(t.boxes, polygons, l->memory, &t.tree);
        if (r == RESULT_OK) {
            r = search(&t);
            box_tree_close(&t.tree, l->memory);
        }
    }
    memory_free(l->memory, t.boxes, polygons, sizeof(*t.boxes));
    memory_free(l->memory, t.first, vertices + 2, sizeof(*t.first));
    memory_free(l->memory, t.lines_at, 2 * edges, sizeof(*t.lines_at));
    return r;
}
