// Merge: see merge.h. Half-edges with twins by a hash of their two vertices, and a heap of twins, the longest first.
// SPDX-License-Identifier: MIT
#include "merge.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define NO_EDGE UINT32_MAX

typedef struct half_edge {
    uint32_t vertex; // where it starts
    plane_ref plane;
    uint32_t next, prev, twin, polygon, chain; // chain: next of the same hash
} half_edge;            // polygon NO_EDGE: gone

typedef struct merging {
    body_polygon from;
    uint32_t group, edge, count; // edge NO_EDGE: taken by another
    double area;
} merging;

typedef struct merge_step {
    int64_t length, area, place;
    double middle[3];
    uint32_t edge, twin;
} merge_step;

typedef struct merge_state {
    const merge_input *in;
    merging *polygons;
    buffer edges, heap; // half_edge, merge_step
    uint32_t *heads, mask;
} merge_state;

static half_edge *edge_at(const merge_state *s, uint32_t e)
{
    return (half_edge *)s->edges.items + e;
}

static uint32_t end_of(const merge_state *s, uint32_t e)
{
    return edge_at(s, edge_at(s, e)->next)->vertex;
}

static const double *place_of(const merge_state *s, uint32_t vertex)
{
    return s->in->vertices[vertex].position;
}

// ---- Groups ----

typedef struct group_key {
    uint32_t plane, kind, role, polygon;
} group_key;

static int same_group(const group_key *a, const group_key *b)
{
    return a->plane == b->plane && a->kind == b->kind && a->role == b->role;
}

static int compare_groups(const void *left, const void *right)
{
    const group_key *a = left, *b = right;
    if (a->plane != b->plane) return a->plane < b->plane ? -1 : 1;
    if (a->kind != b->kind) return a->kind < b->kind ? -1 : 1;
    if (a->role != b->role) return a->role < b->role ? -1 : 1;
    return a->polygon < b->polygon ? -1 : 1;
}

static int make_groups(merge_state *s, const allocator *memory)
{
    const size_t n = s->in->soup->polygons.count;
    const body_polygon *polygons = s->in->soup->polygons.items;
    group_key *keys = memory_alloc(memory, n, sizeof *keys);
    if (!keys) return 0;
    for (uint32_t p = 0; p < n; ++p)
        keys[p] = (group_key){polygons[p].shape.plane, s->in->class_of[polygons[p].face], s->in->in->brushes[polygons[p].brush].role, p};
    if (n > 1) qsort(keys, n, sizeof *keys, compare_groups);
    uint32_t group = 0;
    for (size_t i = 0; i < n; ++i) {
        if (i && !same_group(&keys[i - 1], &keys[i])) ++group;
        s->polygons[keys[i].polygon].group = group;
    }
    memory_free(memory, keys, n, sizeof *keys);
    return 1;
}

// ---- Twins ----

static uint32_t slot_of(const merge_state *s, uint32_t from, uint32_t to, uint32_t group)
{
    uint64_t h = ((uint64_t)from << 32 | to) * 0x9e3779b97f4a7c15u;
    h = (h ^ h >> 29 ^ group) * 0xbf58476d1ce4e5b9u;
    return (uint32_t)(h >> 32) & s->mask;
}

static uint32_t find_edge(const merge_state *s, uint32_t from, uint32_t to, uint32_t group)
{
    for (uint32_t e = s->heads[slot_of(s, from, to, group)]; e != NO_EDGE; e = edge_at(s, e)->chain) {
        const half_edge *h = edge_at(s, e);
        if (h->polygon != NO_EDGE && h->vertex == from && end_of(s, e) == to && s->polygons[h->polygon].group == group) return e;
    }
    return NO_EDGE;
}

static void list_edge(merge_state *s, uint32_t e)
{
    half_edge *h = edge_at(s, e);
    const uint32_t slot = slot_of(s, h->vertex, end_of(s, e), s->polygons[h->polygon].group);
    h->chain = s->heads[slot];
    s->heads[slot] = e;
}

// ---- The heap: long borders first, then large unions, then by place ----

static int is_before(const merge_step *a, const merge_step *b)
{
    if (a->length != b->length) return a->length > b->length;
    if (a->area != b->area) return a->area > b->area;
    if (a->place != b->place) return a->place < b->place;
    for (int k = 0; k < 3; ++k)
        if (a->middle[k] != b->middle[k]) return a->middle[k] < b->middle[k];
    return a->edge < b->edge;
}

static int push_step(merge_state *s, const merge_step *step)
{
    if (!buffer_push(&s->heap, 1)) return 0;
    merge_step *heap = s->heap.items;
    size_t at = s->heap.count - 1;
    for (; at > 0 && is_before(step, &heap[(at - 1) / 2]); at = (at - 1) / 2) heap[at] = heap[(at - 1) / 2];
    heap[at] = *step;
    return 1;
}

static merge_step pop_step(merge_state *s)
{
    merge_step *heap = s->heap.items;
    const merge_step top = heap[0], last = heap[--s->heap.count];
    const size_t n = s->heap.count;
    size_t at = 0;
    for (size_t child; (child = 2 * at + 1) < n; at = child) {
        if (child + 1 < n && is_before(&heap[child + 1], &heap[child])) ++child;
        if (!is_before(&heap[child], &last)) break;
        heap[at] = heap[child];
    }
    if (n) heap[at] = last;
    return top;
}

// The pair of twins may merge, or may again: a step for the heap. Nothing without a twin.
static int offer(merge_state *s, uint32_t e)
{
    const half_edge *h = edge_at(s, e);
    if (h->twin == NO_EDGE) return 1;
    const double *from = place_of(s, h->vertex), *to = place_of(s, end_of(s, e));
    const uint32_t p = h->polygon, q = edge_at(s, h->twin)->polygon;
    merge_step step = {.edge = e < h->twin ? e : h->twin, .twin = e < h->twin ? h->twin : e};
    double square = 0;
    for (int k = 0; k < 3; ++k) {
        square += (to[k] - from[k]) * (to[k] - from[k]);
        step.middle[k] = 0.5 * (from[k] + to[k]);
    }
    step.length = (int64_t)floor(sqrt(square) * 4 + 0.37);
    step.area = (int64_t)floor((s->polygons[p].area + s->polygons[q].area) / 16 + 0.37);
    step.place = map_field_at(s->in->field, step.middle);
    return push_step(s, &step);
}

// ---- Merging ----

typedef enum bend { BEND_REFLEX, BEND_STRAIGHT, BEND_CONVEX } bend;

// Of the loop that comes along `in` and goes on along `out`.
static bend bend_of(const merge_state *s, uint32_t in, uint32_t out)
{
    const compile_vertex *v = &s->in->vertices[end_of(s, out)];
    const int side = plane_table_side_at(s->in->in->planes, v->planes, v->position, edge_at(s, in)->plane);
    return side > 0 ? BEND_REFLEX : side < 0 ? BEND_CONVEX : BEND_STRAIGHT;
}

static void link_edges(merge_state *s, uint32_t in, uint32_t out)
{
    edge_at(s, in)->next = out;
    edge_at(s, out)->prev = in;
}

static void drop_edge(merge_state *s, uint32_t e)
{
    half_edge *h = edge_at(s, e);
    if (h->twin != NO_EDGE) edge_at(s, h->twin)->twin = NO_EDGE;
    h->twin = h->polygon = NO_EDGE;
}

// Two edges in a line become one, a new one, that may have a twin of its own.
static int join_straight(merge_state *s, uint32_t in, uint32_t out)
{
    half_edge joined = *edge_at(s, in);
    const uint32_t e = (uint32_t)s->edges.count, next = edge_at(s, out)->next, prev = joined.prev, end = edge_at(s, next)->vertex;
    joined.twin = NO_EDGE;
    if (s->edges.count >= NO_EDGE || !buffer_append(&s->edges, &joined, 1)) return 0;
    drop_edge(s, in);
    drop_edge(s, out);
    link_edges(s, prev, e);
    link_edges(s, e, next);
    merging *polygon = &s->polygons[joined.polygon];
    polygon->edge = e;
    polygon->count--;
    const uint32_t twin = find_edge(s, end, joined.vertex, polygon->group);
    list_edge(s, e);
    if (twin == NO_EDGE) return 1;
    edge_at(s, e)->twin = twin;
    edge_at(s, twin)->twin = e;
    return 1;
}

static int close_end(merge_state *s, uint32_t in, uint32_t out, bend how)
{
    link_edges(s, in, out);
    if (how == BEND_CONVEX) return offer(s, in) && offer(s, out);
    const uint32_t joined = (uint32_t)s->edges.count;
    return join_straight(s, in, out) && offer(s, joined);
}

// The larger one's name stays.
static void take_over(merge_state *s, uint32_t keep, uint32_t gone, uint32_t first_of_gone)
{
    for (uint32_t e = edge_at(s, first_of_gone)->next; e != first_of_gone; e = edge_at(s, e)->next) edge_at(s, e)->polygon = keep;
    s->polygons[keep].area += s->polygons[gone].area;
    s->polygons[keep].count += s->polygons[gone].count - 2;
    s->polygons[gone].edge = NO_EDGE;
}

static int merge_pair(merge_state *s, uint32_t e, uint32_t t)
{
    const half_edge a = *edge_at(s, e), b = *edge_at(s, t);
    const bend first = bend_of(s, a.prev, b.next), second = bend_of(s, b.prev, a.next);
    if (first == BEND_REFLEX || second == BEND_REFLEX) return 1;
    const double p = s->polygons[a.polygon].area, q = s->polygons[b.polygon].area;
    const int swap = q > p || (q == p && b.polygon < a.polygon);
    take_over(s, swap ? b.polygon : a.polygon, swap ? a.polygon : b.polygon, swap ? e : t);
    drop_edge(s, e);
    edge_at(s, t)->polygon = NO_EDGE;
    s->polygons[swap ? b.polygon : a.polygon].edge = a.next;
    return close_end(s, a.prev, b.next, first) && close_end(s, b.prev, a.next, second);
}

static int merge_all(merge_state *s)
{
    for (uint32_t e = 0; e < s->edges.count; ++e)
        if (edge_at(s, e)->twin != NO_EDGE && edge_at(s, e)->twin > e && !offer(s, e)) return 0;
    while (s->heap.count) {
        const merge_step step = pop_step(s);
        const half_edge *h = edge_at(s, step.edge);
        if (h->polygon == NO_EDGE || h->twin != step.twin) continue;
        if (!merge_pair(s, step.edge, step.twin)) return 0;
    }
    return 1;
}

// ---- In and out ----

static int read_soup(merge_state *s)
{
    const polygon_soup *soup = s->in->soup;
    const body_polygon *polygons = soup->polygons.items;
    for (uint32_t p = 0; p < soup->polygons.count; ++p) {
        const plane_polygon *shape = &polygons[p].shape;
        const polygon_edge *from = (const polygon_edge *)soup->edges.items + shape->first;
        const uint32_t first = (uint32_t)s->edges.count;
        half_edge *to = buffer_push(&s->edges, shape->count);
        if (!to) return 0;
        for (uint32_t i = 0; i < shape->count; ++i)
            to[i] = (half_edge){from[i].vertex, from[i].plane,      first + (i + 1 < shape->count ? i + 1 : 0), first + (i ? i - 1 : shape->count - 1),
                                NO_EDGE,        p, NO_EDGE};
        s->polygons[p].from = polygons[p];
        s->polygons[p].edge = first;
        s->polygons[p].count = shape->count;
        s->polygons[p].area = polygon_area(from, shape->count);
    }
    for (uint32_t e = 0; e < s->edges.count; ++e) {
        const uint32_t twin = find_edge(s, end_of(s, e), edge_at(s, e)->vertex, s->polygons[edge_at(s, e)->polygon].group);
        list_edge(s, e);
        if (twin == NO_EDGE) continue;
        edge_at(s, e)->twin = twin;
        edge_at(s, twin)->twin = e;
    }
    return 1;
}

static int write_soup(const merge_state *s, polygon_soup *out)
{
    for (size_t p = 0; p < s->in->soup->polygons.count; ++p) {
        const merging *m = &s->polygons[p];
        if (m->edge == NO_EDGE) continue;
        body_polygon polygon = m->from;
        polygon.shape.first = (uint32_t)out->edges.count;
        polygon.shape.count = m->count;
        polygon_edge *to = buffer_push(&out->edges, m->count);
        if (!to || !buffer_append(&out->polygons, &polygon, 1)) return 0;
        uint32_t e = m->edge;
        for (uint32_t i = 0; i < m->count; ++i, e = edge_at(s, e)->next) {
            const half_edge *h = edge_at(s, e);
            to[i] = (polygon_edge){.plane = h->plane, .vertex = h->vertex};
            memcpy(to[i].start, place_of(s, h->vertex), sizeof to[i].start);
        }
    }
    return 1;
}

result merge_polygons(const merge_input *m, const allocator *memory, polygon_soup *out)
{
    const size_t n = m->soup->polygons.count;
    size_t slots = 1024;
    while (slots < m->soup->edges.count * 2 && slots < (size_t)1 << 31) slots *= 2;
    *out = (polygon_soup){buffer_make(memory, sizeof(body_polygon)), buffer_make(memory, sizeof(polygon_edge))};
    merge_state s = {.in = m,
                     .polygons = memory_alloc(memory, n, sizeof *s.polygons),
                     .edges = buffer_make(memory, sizeof(half_edge)),
                     .heap = buffer_make(memory, sizeof(merge_step)),
                     .heads = memory_alloc(memory, slots, sizeof(uint32_t)),
                     .mask = (uint32_t)(slots - 1)};
    int good = s.polygons && s.heads;
    if (good) memset(s.heads, 0xff, slots * sizeof(uint32_t));
    good = good && make_groups(&s, memory) && read_soup(&s) && merge_all(&s) && write_soup(&s, out);
    memory_free(memory, s.polygons, n, sizeof *s.polygons);
    memory_free(memory, s.heads, slots, sizeof(uint32_t));
    buffer_free(&s.edges);
    buffer_free(&s.heap);
    if (good) return RESULT_OK;
    polygon_soup_free(out);
    return RESULT_NO_MEMORY;
}
