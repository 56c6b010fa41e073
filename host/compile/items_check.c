// The independent checks of what was made: edges that nothing closes, vertices inside of edges, both by other means than
// the stages that see to them: a table of directed edges, and every vertex near an edge against the edge's two planes.
// SPDX-License-Identifier: MIT
// Invariant: an edge is closed when as many triangles run along it one way as the other; decisions are exact.
#include "items.h"

#include <math.h>
#include <stdlib.h>

// ---- A table of edges ----

typedef struct edge_use { uint32_t low, high; int32_t balance; uint32_t in_use; } edge_use;
typedef struct edge_table { edge_use *slots; size_t size; } edge_table;

static size_t slots_for(size_t edges)
{
    size_t size = 64;
    while (size < 2 * edges) size *= 2;
    return size;
}

static edge_use *edge_find(const edge_table *t, uint32_t a, uint32_t b)
{
    const uint32_t low = a < b ? a : b, high = a < b ? b : a;
    uint64_t hash = ((uint64_t)high << 32 | low) * UINT64_C(0x9e3779b97f4a7c15);
    size_t at = (hash ^ hash >> 32) & (t->size - 1);
    while (t->slots[at].in_use && (t->slots[at].low != low || t->slots[at].high != high)) at = (at + 1) & (t->size - 1);
    t->slots[at].low = low;
    t->slots[at].high = high;
    return &t->slots[at];
}

static void edge_add(const edge_table *t, uint32_t from, uint32_t to)
{
    if (from == to) return;
    edge_use *e = edge_find(t, from, to);
    e->in_use = 1;
    e->balance += from < to ? 1 : -1;
}

static int is_liquid(const check_input *c, const compile_polygon *p)
{
    return c->job->in->brushes[p->brush].role == BRUSH_LIQUID;
}

// Polygons that are no items close the others by their loops.
static result count_open(const check_input *c, uint32_t *out)
{
    const compile_mesh *m = c->job->zones->mesh;
    const uint32_t *same = c->rounded->same_as;
    edge_table t = {.size = slots_for(3 * c->triangle_count + m->loop_count)};
    t.slots = memory_alloc_zeroed(c->job->memory, t.size, sizeof *t.slots);
    if (!t.slots) return RESULT_NO_MEMORY;
    for (size_t i = 0; i < c->triangle_count; ++i)
        for (int k = 0; k < 3; ++k) edge_add(&t, same[c->triangles[3 * i + (size_t)k]], same[c->triangles[3 * i + (size_t)((k + 1) % 3)]]);
    for (uint32_t i = 0; i < m->polygon_count; ++i) {
        const compile_polygon *p = &m->polygons[i];
        if (c->is_item[i] || is_liquid(c, p)) continue;
        for (uint32_t k = 0; k < p->vertex_count; ++k)
            edge_add(&t, same[m->loop[p->first_vertex + k]], same[m->loop[p->first_vertex + (k + 1) % p->vertex_count]]);
    }
    *out = 0;
    for (size_t i = 0; i < t.size; ++i) *out += (uint32_t)abs(t.slots[i].balance);
    memory_free(c->job->memory, t.slots, t.size, sizeof *t.slots);
    return RESULT_OK;
}

// ---- Vertices in cells ----

typedef struct vertex_cells {
    double low[3], size;  // of a cell, steps
    int32_t count[3];
    uint32_t *first, *vertices; // by cell, and one more
    size_t cells;
} vertex_cells;

static int32_t cell_along(const vertex_cells *g, int axis, double at)
{
    const double cell = floor((at - g->low[axis]) / g->size);
    return cell < 0 ? 0 : cell > g->count[axis] - 1 ? g->count[axis] - 1 : (int32_t)cell;
}

static size_t cell_of(const vertex_cells *g, const int32_t at[3])
{
    return ((size_t)at[2] * (size_t)g->count[1] + (size_t)at[1]) * (size_t)g->count[0] + (size_t)at[0];
}

static void size_cells(const compile_mesh *m, vertex_cells *g)
{
    double high[3] = {0}, volume = 1;
    for (uint32_t v = 0; v < m->vertex_count; ++v)
        for (int k = 0; k < 3; ++k) {
            const double at = m->vertices[v].position[k];
            if (!v || at < g->low[k]) g->low[k] = at;
            if (!v || at > high[k]) high[k] = at;
        }
    for (int k = 0; k < 3; ++k) volume *= high[k] - g->low[k] + 1;
    g->size = cbrt(volume / (m->vertex_count + 1.0)) + 1;
    for (;; g->size *= 2) { // flat scenes have long rows
        double cells = 1;
        for (int k = 0; k < 3; ++k) {
            g->count[k] = (int32_t)((high[k] - g->low[k]) / g->size) + 1;
            cells *= g->count[k];
        }
        g->cells = (size_t)cells;
        if (cells <= 8.0 * m->vertex_count + 64) return;
    }
}

static size_t cell_of_vertex(const vertex_cells *g, const compile_vertex *v)
{
    int32_t at[3];
    for (int k = 0; k < 3; ++k) at[k] = cell_along(g, k, v->position[k]);
    return cell_of(g, at);
}

static result fill_cells(const compile_mesh *m, const allocator *memory, vertex_cells *g)
{
    size_cells(m, g);
    g->first = memory_alloc_zeroed(memory, g->cells + 2, sizeof *g->first);
    g->vertices = memory_alloc(memory, m->vertex_count, sizeof *g->vertices);
    if (!g->first || !g->vertices) return RESULT_NO_MEMORY;
    for (uint32_t v = 0; v < m->vertex_count; ++v) g->first[cell_of_vertex(g, &m->vertices[v]) + 2]++;
    for (size_t c = 1; c < g->cells + 2; ++c) g->first[c] += g->first[c - 1];
    for (uint32_t v = 0; v < m->vertex_count; ++v) g->vertices[g->first[cell_of_vertex(g, &m->vertices[v]) + 1]++] = v;
    return RESULT_OK;
}

// ---- Vertices inside of edges ----

typedef struct edge_line {
    const plane_table *planes;
    const compile_mesh *mesh;
    plane_ref holds[2];
    uint32_t ends[2];
    int axis; // along which it is longest
} edge_line;

static plane_ref crossing(const edge_line *e, uint32_t vertex)
{
    const compile_vertex *v = &e->mesh->vertices[vertex];
    int i = 0;
    while (i < 2 && plane_table_normals_sign(e->planes, e->holds[0], e->holds[1], v->planes[i]) == 0) ++i;
    return v->planes[i];
}

static int is_between(const edge_line *e, uint32_t vertex)
{
    static const double SURE = 1.0 / 1024; // steps; a position is within 2^-16 of its point
    const double *p = e->mesh->vertices[vertex].position, *a = e->mesh->vertices[e->ends[0]].position, *b = e->mesh->vertices[e->ends[1]].position;
    const double low = fmin(a[e->axis], b[e->axis]), high = fmax(a[e->axis], b[e->axis]), at = p[e->axis];
    if (at < low - SURE || at > high + SURE) return 0;
    if (at > low + SURE && at < high - SURE) return 1;
    const plane_ref own = crossing(e, vertex);
    return plane_table_order_along(e->planes, e->holds[0], e->holds[1], own, crossing(e, e->ends[0])) *
               plane_table_order_along(e->planes, e->holds[0], e->holds[1], own, crossing(e, e->ends[1])) < 0;
}

static uint32_t count_in_cell(const edge_line *e, const vertex_cells *g, size_t cell)
{
    uint32_t count = 0;
    for (uint32_t i = g->first[cell]; i < g->first[cell + 1]; ++i) {
        const uint32_t vertex = g->vertices[i];
        const compile_vertex *v = &e->mesh->vertices[vertex];
        if (vertex == e->ends[0] || vertex == e->ends[1]) continue;
        if (plane_table_side_at(e->planes, v->planes, v->position, e->holds[0]) || plane_table_side_at(e->planes, v->planes, v->position, e->holds[1])) continue;
        count += is_between(e, vertex) != 0;
    }
    return count;
}

// Slab by slab along the axis, the cells that the edge may touch there.
static uint32_t count_on_edge(const edge_line *e, const vertex_cells *g)
{
    const double *a = e->mesh->vertices[e->ends[0]].position, *b = e->mesh->vertices[e->ends[1]].position;
    const double *low = a[e->axis] < b[e->axis] ? a : b, *high = low == a ? b : a, way = high[e->axis] - low[e->axis];
    const int32_t last = cell_along(g, e->axis, high[e->axis] + 1);
    uint32_t count = 0;
    for (int32_t slab = cell_along(g, e->axis, low[e->axis] - 1); slab <= last; ++slab) {
        const double begin = g->low[e->axis] + slab * g->size - 1, end = begin + g->size + 2;
        const double from = way > 0 ? fmax(0, fmin(1, (begin - low[e->axis]) / way)) : 0, to = way > 0 ? fmax(0, fmin(1, (end - low[e->axis]) / way)) : 1;
        int32_t first[3], most[3], at[3];
        for (int k = 0; k < 3; ++k) {
            const double p = low[k] + from * (high[k] - low[k]), q = low[k] + to * (high[k] - low[k]);
            first[k] = k == e->axis ? slab : cell_along(g, k, fmin(p, q) - 1);
            most[k] = k == e->axis ? slab : cell_along(g, k, fmax(p, q) + 1);
        }
        for (at[2] = first[2]; at[2] <= most[2]; ++at[2])
            for (at[1] = first[1]; at[1] <= most[1]; ++at[1])
                for (at[0] = first[0]; at[0] <= most[0]; ++at[0]) count += count_in_cell(e, g, cell_of(g, at));
    }
    return count;
}

static uint32_t count_on_polygon(const check_input *c, const compile_polygon *p, const vertex_cells *g, const edge_table *seen)
{
    const compile_mesh *m = c->job->zones->mesh;
    uint32_t count = 0;
    for (uint32_t k = 0; k < p->vertex_count; ++k) {
        edge_line e = {c->job->in->planes, m, {p->plane, m->edge_planes[p->first_vertex + k]}, {m->loop[p->first_vertex + k], m->loop[p->first_vertex + (k + 1) % p->vertex_count]}, 0};
        edge_use *use = edge_find(seen, e.ends[0], e.ends[1]);
        if (use->in_use) continue;
        use->in_use = 1;
        const double *a = m->vertices[e.ends[0]].position, *b = m->vertices[e.ends[1]].position;
        for (int i = 1; i < 3; ++i)
            if (fabs(b[i] - a[i]) > fabs(b[e.axis] - a[e.axis])) e.axis = i;
        count += count_on_edge(&e, g);
    }
    return count;
}

static result count_t_junctions(const check_input *c, uint32_t *out)
{
    const compile_mesh *m = c->job->zones->mesh;
    vertex_cells g = {.size = 1};
    edge_table seen = {.size = slots_for(m->loop_count)};
    seen.slots = memory_alloc_zeroed(c->job->memory, seen.size, sizeof *seen.slots);
    result done = seen.slots ? fill_cells(m, c->job->memory, &g) : RESULT_NO_MEMORY;
    *out = 0;
    for (uint32_t i = 0; i < m->polygon_count && done == RESULT_OK; ++i) *out += count_on_polygon(c, &m->polygons[i], &g, &seen);
    memory_free(c->job->memory, seen.slots, seen.size, sizeof *seen.slots);
    memory_free(c->job->memory, g.first, g.cells + 2, sizeof *g.first);
    memory_free(c->job->memory, g.vertices, m->vertex_count, sizeof *g.vertices);
    return done;
}

// ---- Triangles without area ----

static int is_flat(const scene *s, const uint32_t t[3])
{
    const cull_vec3 a = s->positions[t[0]], b = s->positions[t[1]], c = s->positions[t[2]];
    const double u[3] = {(double)b.x - (double)a.x, (double)b.y - (double)a.y, (double)b.z - (double)a.z};
    const double v[3] = {(double)c.x - (double)a.x, (double)c.y - (double)a.y, (double)c.z - (double)a.z};
    return u[1] * v[2] == u[2] * v[1] && u[2] * v[0] == u[0] * v[2] && u[0] * v[1] == u[1] * v[0];
}

static uint32_t count_flat(const scene *s, uint32_t item)
{
    uint32_t count = 0;
    for (uint32_t i = s->items[item].first_index; i < s->items[item].first_index + s->items[item].index_count; i += 3) count += is_flat(s, s->indices + i) != 0;
    return count;
}

uint32_t items_flat_triangles(const item_job *j, const scene *s)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < s->item_count; ++i) count += s->items[i].flags & CULL_ITEM_WALL ? count_flat(s, i) : 0;
    for (uint32_t e = 0; e < j->in->entity_count; ++e) count += j->mover_of[e] == SCENE_NONE ? 0 : count_flat(s, s->item_count + j->mover_of[e]);
    return count;
}

result items_check(const check_input *c, compile_checks *out)
{
    const result done = count_open(c, &out->open_edges);
    return done == RESULT_OK ? count_t_junctions(c, &out->t_junctions_left) : done;
}
