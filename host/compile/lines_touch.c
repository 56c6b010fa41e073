// Vertices that lie inside an edge of a line on which none of their own edges runs: the tip of a cone against a wall's
// edge. They belong to the line like the others, or a T-junction would be left.
// SPDX-License-Identifier: MIT
#include "lines.h"

#include "../core/box_tree.h"

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

static void make_boxes(const line_set *l, tree_box *boxes)
{
    for (size_t i = 0; i < l->edges.count; ++i) {
        uint32_t ends[2];
        edge_ends(l->s, (line_edge *)l->edges.items + i, ends);
        const double *a = surface_vertex_at(l->s, ends[0])->position, *b = surface_vertex_at(l->s, ends[1])->position;
        for (int k = 0; k < 3; ++k) {
            boxes[i].min[k] = (a[k] < b[k] ? a[k] : b[k]) - NEAR_STEPS;
            boxes[i].max[k] = (a[k] < b[k] ? b[k] : a[k]) + NEAR_STEPS;
        }
    }
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

static result search(const line_set *l, const box_tree *tree, const uint32_t *first, const uint32_t *lines_at, buffer *out)
{
    for (uint32_t v = 0; v < l->s->vertices.count; ++v) {
        if (first[v] == first[v + 1]) continue; // of no polygon in use
        const double *p = surface_vertex_at(l->s, v)->position;
        const tree_box at = {{p[0], p[1], p[2]}, {p[0], p[1], p[2]}};
        box_walk walk;
        box_walk_start(&walk, tree, &at);
        for (uint32_t i; box_walk_next(&walk, &i);) {
            const line_edge *e = (line_edge *)l->edges.items + i;
            if (has_own_edge(e->line, first, lines_at, v) || !touches(l, e, v)) continue;
            const line_touch found = {e->line, v};
            const line_touch *last = out->count ? (line_touch *)out->items + out->count - 1 : NULL;
            if (last && last->line == found.line && last->vertex == found.vertex) continue;
            if (!buffer_append(out, &found, 1)) return RESULT_NO_MEMORY;
        }
    }
    return RESULT_OK;
}

result line_touches(const line_set *l, buffer *out)
{
    const size_t edges = l->edges.count, vertices = l->s->vertices.count;
    if (edges == 0) return RESULT_OK;
    tree_box *boxes = memory_alloc(l->memory, edges, sizeof(*boxes));
    uint32_t *first = memory_alloc_zeroed(l->memory, vertices + 2, sizeof(*first));
    uint32_t *lines_at = memory_alloc(l->memory, 2 * edges, sizeof(*lines_at));
    box_tree tree;
    result r = boxes && first && lines_at ? RESULT_OK : RESULT_NO_MEMORY;
    if (r == RESULT_OK) {
        make_boxes(l, boxes);
        lines_by_vertex(l, first, lines_at);
        r = box_tree_open(boxes, (uint32_t)edges, l->memory, &tree);
        if (r == RESULT_OK) {
            r = search(l, &tree, first, lines_at, out);
            box_tree_close(&tree, l->memory);
        }
    }
    memory_free(l->memory, boxes, edges, sizeof(*boxes));
    memory_free(l->memory, first, vertices + 2, sizeof(*first));
    memory_free(l->memory, lines_at, 2 * edges, sizeof(*lines_at));
    return r;
}
