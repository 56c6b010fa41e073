// Edges to lines: the direction without its common divisor, then the place across it, each found in a table of cells and
// told apart exactly; then the vertices of each line sorted.
// SPDX-License-Identifier: MIT
#include "lines.h"

#include <assert.h>
#include <math.h>
#include <string.h>

__extension__ typedef __int128 int128;
__extension__ typedef unsigned __int128 uint128;

// A line's moment about the origin, position x unit direction, is the same at each of its points. Positions are off by
// 2^-26 steps, unit directions by 2^-52 of 2^25 steps, the product's roundings are as small: below 1e-7 steps.
#define MOMENT_CELLS_A_STEP 4.0
#define MOMENT_SLACK 1e-6
// Steps: two places along a line that differ by more than twice the error above differ in truth.
#define ORDER_SLACK 1e-5

typedef struct line_build {
    line_set *l;
    buffer direction_slots, line_slots; // uint32_t + 1
    buffer next_line, cells;            // by line: uint32_t + 1; its moment's hash
    buffer pairs;                       // line_pair, by direction of two planes
} line_build;

typedef struct line_pair { plane_ref a, b; uint32_t direction; } line_pair;

// ---- Directions ----

static int128 to_int128(cull_wide v)
{
    return (int128)(((uint128)v.high << 64) | v.low);
}

static cull_wide from_int128(int128 v)
{
    const cull_wide out = {(uint64_t)(uint128)v, (uint64_t)((uint128)v >> 64)};
    return out;
}

static int128 divisor_of(int128 a, int128 b)
{
    while (b) {
        if ((uint64_t)a == (uint128)a && (uint64_t)b == (uint128)b) return (int128)cull_divisor((uint64_t)a, (uint64_t)b);
        const int128 rest = a % b;
        a = b;
        b = rest;
    }
    return a;
}

static line_direction reduced(const cull_wide_vector *v)
{
    int128 c[3], divisor = 0;
    for (int k = 0; k < 3; ++k) {
        c[k] = to_int128(v->v[k]);
        divisor = divisor_of(c[k] < 0 ? -c[k] : c[k], divisor);
    }
    assert(divisor > 0);
    if (c[0] ? c[0] < 0 : c[1] ? c[1] < 0 : c[2] < 0) divisor = -divisor;
    line_direction d;
    double length = 0, most = 0;
    for (int k = 0; k < 3; ++k) {
        c[k] /= divisor;
        d.exact.v[k] = from_int128(c[k]);
        d.unit[k] = (double)c[k];
        most = fabs(d.unit[k]) > most ? fabs(d.unit[k]) : most;
    }
    for (int k = 0; k < 3; ++k) length += d.unit[k] / most * (d.unit[k] / most);
    for (int k = 0; k < 3; ++k) d.unit[k] = d.unit[k] / most / sqrt(length);
    return d;
}

static uint64_t mix(uint64_t h, uint64_t v)
{
    h = (h ^ v) * 0x9e3779b97f4a7c15u;
    return h ^ h >> 29;
}

static uint64_t direction_hash(const cull_wide_vector *v)
{
    uint64_t h = 1;
    for (int k = 0; k < 3; ++k) h = mix(mix(h, v->v[k].low), v->v[k].high);
    return h;
}

static int directions_equal(const cull_wide_vector *a, const cull_wide_vector *b)
{
    return cull_wide_equal(a->v[0], b->v[0]) && cull_wide_equal(a->v[1], b->v[1]) && cull_wide_equal(a->v[2], b->v[2]);
}

static result find_direction(line_build *b, plane_ref p, plane_ref q, uint32_t *out)
{
    const uint64_t key = p < q ? (uint64_t)(p >> 1) << 32 | q >> 1 : (uint64_t)(q >> 1) << 32 | p >> 1;
    line_pair *pair = (line_pair *)b->pairs.items + (mix(1, key) & (b->pairs.count - 1)); // a cache: the last of its slot
    if (((uint64_t)pair->a << 32 | pair->b) == key && key) {
        *out = pair->direction;
        return RESULT_OK;
    }
    const surface *s = b->l->s;
    const cull_wide_vector cross = cull_normals_cross(plane_table_canonical(s->planes, p), plane_table_canonical(s->planes, q));
    const line_direction d = reduced(&cross);
    const uint32_t *slots = b->direction_slots.items;
    size_t at = direction_hash(&d.exact) & (b->direction_slots.count - 1);
    while (slots[at] && !directions_equal(&((line_direction *)b->l->directions.items)[slots[at] - 1].exact, &d.exact))
        at = (at + 1) & (b->direction_slots.count - 1);
    if (!slots[at]) {
        if (!buffer_append(&b->l->directions, &d, 1)) return RESULT_NO_MEMORY;
        ((uint32_t *)b->direction_slots.items)[at] = (uint32_t)b->l->directions.count;
    }
    *out = slots[at] - 1;
    const line_pair found = {(uint32_t)(key >> 32), (uint32_t)key, *out};
    *pair = found;
    return RESULT_OK;
}

// ---- Lines ----

static size_t moment_slot(const line_build *b, uint32_t direction, const double moment[3], int corner)
{
    uint64_t h = mix(2, direction);
    for (int k = 0; k < 3; ++k) {
        const double at = moment[k] + (corner < 0 ? 0 : corner >> k & 1 ? MOMENT_SLACK : -MOMENT_SLACK);
        h = mix(h, (uint64_t)(int64_t)floor(at * MOMENT_CELLS_A_STEP));
    }
    return h & (b->line_slots.count - 1);
}

static void moment_of(const double p[3], const double u[3], double out[3])
{
    for (int k = 0; k < 3; ++k) out[k] = p[(k + 1) % 3] * u[(k + 2) % 3] - p[(k + 2) % 3] * u[(k + 1) % 3];
}

static result find_line(line_build *b, plane_ref p, plane_ref q, uint32_t vertex, uint32_t *out)
{
    line_set *l = b->l;
    uint32_t direction;
    result r = find_direction(b, p, q, &direction);
    if (r != RESULT_OK) return r;
    double moment[3];
    moment_of(surface_vertex_at(l->s, vertex)->position, ((line_direction *)l->directions.items)[direction].unit, moment);
    size_t before = SIZE_MAX;
    for (int corner = 0; corner < 8; ++corner) {
        const size_t slot = moment_slot(b, direction, moment, corner);
        if (slot == before) continue;
        before = slot;
        for (uint32_t at = ((uint32_t *)b->line_slots.items)[slot]; at; at = ((uint32_t *)b->next_line.items)[at - 1]) {
            const surface_line *line = (surface_line *)l->lines.items + at - 1;
            if (line->direction != direction || surface_side(l->s, vertex, line->a) || surface_side(l->s, vertex, line->b)) continue;
            *out = at - 1;
            return RESULT_OK;
        }
    }
    const surface_line made = {.a = p & ~1u, .b = q & ~1u, .direction = direction};
    uint32_t *slot = (uint32_t *)b->line_slots.items + moment_slot(b, direction, moment, -1);
    if (!buffer_append(&b->next_line, slot, 1) || !buffer_append(&l->lines, &made, 1)) return RESULT_NO_MEMORY;
    *out = (uint32_t)l->lines.count - 1;
    *slot = *out + 1;
    return RESULT_OK;
}

static result find_lines(line_build *b)
{
    line_set *l = b->l;
    for (uint32_t i = 0; i < surface_polygon_count(l->s); ++i) {
        const surface_polygon *p = surface_polygon_at(l->s, i);
        for (uint32_t c = 0; c < p->count; ++c) {
            const surface_corner *corner = surface_corners(l->s, p) + c;
            line_edge e = {.polygon = i, .corner = p->first + c};
            const result r = find_line(b, p->plane, corner->edge, corner->vertex, &e.line);
            if (r != RESULT_OK) return r;
            if (!buffer_append(&l->edges, &e, 1)) return RESULT_NO_MEMORY;
        }
    }
    return RESULT_OK;
}

static result zeroed(buffer *b, size_t count)
{
    void *items = buffer_push(b, count);
    if (!items) return RESULT_NO_MEMORY;
    memset(items, 0, count * b->item_size);
    return RESULT_OK;
}

static result group_edges(line_set *l)
{
    const size_t lines = l->lines.count, edges = l->edges.count;
    uint32_t *first = memory_alloc_zeroed(l->memory, lines + 1, sizeof(*first));
    buffer sorted = buffer_make(l->memory, sizeof(line_edge));
    result r = first && buffer_push(&sorted, edges) ? RESULT_OK : RESULT_NO_MEMORY;
    const line_edge *old = l->edges.items;
    for (size_t i = 0; i < edges && r == RESULT_OK; ++i) first[old[i].line + 1]++;
    for (size_t i = 0; i < lines && r == RESULT_OK; ++i) {
        surface_line *line = (surface_line *)l->lines.items + i;
        line->first_edge = first[i];
        line->edge_count = first[i + 1];
        first[i + 1] += first[i];
    }
    for (size_t i = 0; i < edges && r == RESULT_OK; ++i) {
        const uint32_t at = first[old[i].line]++;
        ((line_edge *)sorted.items)[at] = old[i];
        l->edge_of[old[i].corner] = at;
    }
    memory_free(l->memory, first, lines + 1, sizeof(*first));
    if (r != RESULT_OK) {
        buffer_free(&sorted);
        return r;
    }
    buffer_free(&l->edges);
    l->edges = sorted;
    return RESULT_OK;
}

// ---- Order ----

static double place_along(const line_set *l, const surface_line *line, uint32_t vertex)
{
    const double *p = surface_vertex_at(l->s, vertex)->position, *u = ((line_direction *)l->directions.items)[line->direction].unit;
    return p[0] * u[0] + p[1] * u[1] + p[2] * u[2];
}

static int exact_order(const line_set *l, const surface_line *line, uint32_t a, uint32_t b)
{
    const surface *s = l->s;
    const plane_ref *of_a = surface_vertex_at(s, a)->planes, *of_b = surface_vertex_at(s, b)->planes;
    int i = 0, j = 0;
    while (i < 3 && plane_table_normals_sign(s->planes, line->a, line->b, of_a[i]) == 0) ++i;
    while (j < 3 && plane_table_normals_sign(s->planes, line->a, line->b, of_b[j]) == 0) ++j;
    assert(i < 3 && j < 3);
    const cull_wide_vector cross = cull_normals_cross(plane_table_canonical(s->planes, line->a), plane_table_canonical(s->planes, line->b));
    const int turned = cull_wide_vector_dot_sign(&cross, &((line_direction *)l->directions.items)[line->direction].exact);
    return turned * plane_table_order_along(s->planes, line->a, line->b, of_a[i], of_b[j]);
}

int line_order(const line_set *l, const surface_line *line, uint32_t a, uint32_t b)
{
    if (a == b) return 0;
    const double apart = place_along(l, line, a) - place_along(l, line, b);
    if (apart > ORDER_SLACK) return 1;
    if (apart < -ORDER_SLACK) return -1;
    return exact_order(l, line, a, b);
}

typedef struct line_end { uint32_t vertex, edge; double place; } line_end; // edge: 2 * in line_set.edges + is the end; UINT32_MAX: only touches

static int end_order(const line_set *l, const surface_line *line, const line_end *a, const line_end *b)
{
    const double apart = a->place - b->place;
    if (apart > ORDER_SLACK || apart < -ORDER_SLACK) return apart > 0 ? 1 : -1;
    return a->vertex == b->vertex ? 0 : exact_order(l, line, a->vertex, b->vertex);
}

static void merge_sort(const line_set *l, const surface_line *line, line_end *ends, size_t count, line_end *spare)
{
    for (size_t i = 0; i < count; i += 8) // short ones by insertion
        for (size_t j = i + 1; j < count && j < i + 8; ++j) {
            const line_end moved = ends[j];
            size_t at = j;
            for (; at > i && end_order(l, line, &ends[at - 1], &moved) > 0; --at) ends[at] = ends[at - 1];
            ends[at] = moved;
        }
    for (size_t width = 8; width < count; width *= 2) {
        for (size_t low = 0; low < count; low += 2 * width) {
            const size_t middle = low + width < count ? low + width : count, high = low + 2 * width < count ? low + 2 * width : count;
            size_t i = low, j = middle;
            for (size_t k = low; k < high; ++k)
                spare[k] = j >= high || (i < middle && end_order(l, line, &ends[i], &ends[j]) <= 0) ? ends[i++] : ends[j++];
        }
        memcpy(ends, spare, count * sizeof(*ends));
    }
}

static void gather_ends(const line_set *l, const surface_line *line, line_end *out)
{
    for (uint32_t i = 0; i < line->edge_count; ++i) {
        const uint32_t edge = line->first_edge + i;
        const line_edge *e = (line_edge *)l->edges.items + edge;
        const surface_polygon *p = surface_polygon_at(l->s, e->polygon);
        const uint32_t at = e->corner - p->first, after = at + 1 < p->count ? at + 1 : 0;
        for (uint32_t end = 0; end < 2; ++end) {
            const uint32_t vertex = surface_corners(l->s, p)[end ? after : at].vertex;
            const line_end made = {vertex, 2 * edge + end, place_along(l, line, vertex)};
            out[2 * i + end] = made;
        }
    }
}

static result rank_vertices(line_set *l, surface_line *line, const line_end *ends, size_t count)
{
    line->first_vertex = (uint32_t)l->vertices.count;
    line->vertex_count = 0;
    for (size_t i = 0; i < count; ++i) {
        if (i == 0 || ends[i].vertex != ends[i - 1].vertex) {
            if (!buffer_append(&l->vertices, &ends[i].vertex, 1)) return RESULT_NO_MEMORY;
            line->vertex_count++;
        }
        if (ends[i].edge == UINT32_MAX) continue;
        line_edge *e = (line_edge *)l->edges.items + (ends[i].edge >> 1);
        *(ends[i].edge & 1 ? &e->to : &e->from) = line->vertex_count - 1;
    }
    return RESULT_OK;
}

static result sort_line(line_set *l, surface_line *line, const line_touch *touch, size_t touch_count, buffer *ends)
{
    const size_t own = 2 * (size_t)line->edge_count, count = own + touch_count;
    ends->count = 0;
    line_end *e = buffer_push(ends, 2 * count);
    if (!e) return RESULT_NO_MEMORY;
    gather_ends(l, line, e);
    for (size_t k = 0; k < touch_count; ++k) e[own + k] = (line_end){touch[k].vertex, UINT32_MAX, place_along(l, line, touch[k].vertex)};
    merge_sort(l, line, e, count, e + count);
    return rank_vertices(l, line, e, count);
}

static result sort_lines(line_set *l)
{
    buffer ends = buffer_make(l->memory, sizeof(line_end));
    result r = RESULT_OK;
    for (uint32_t i = 0; i < l->lines.count && r == RESULT_OK; ++i) r = sort_line(l, (surface_line *)l->lines.items + i, NULL, 0, &ends);
    buffer_free(&ends);
    return r;
}

// Touches come by line. A line's vertices stand anew at the end, with those that touch it.
static result sort_touched(line_set *l, const buffer *touches)
{
    buffer ends = buffer_make(l->memory, sizeof(line_end));
    const line_touch *t = touches->items;
    result r = RESULT_OK;
    for (size_t i = 0, end; i < touches->count && r == RESULT_OK; i = end) {
        for (end = i + 1; end < touches->count && t[end].line == t[i].line;) ++end;
        r = sort_line(l, (surface_line *)l->lines.items + t[i].line, t + i, end - i, &ends);
    }
    buffer_free(&ends);
    return r;
}

static result sort_touches(line_set *l, buffer *touches)
{
    const size_t lines = l->lines.count;
    uint32_t *first = memory_alloc_zeroed(l->memory, lines + 1, sizeof(*first));
    buffer sorted = buffer_make(l->memory, sizeof(line_touch));
    result r = first && buffer_push(&sorted, touches->count) ? RESULT_OK : RESULT_NO_MEMORY;
    const line_touch *old = touches->items;
    for (size_t i = 0; i < touches->count && r == RESULT_OK; ++i) first[old[i].line + 1]++;
    for (size_t i = 0; i < lines && r == RESULT_OK; ++i) first[i + 1] += first[i];
    for (size_t i = 0; i < touches->count && r == RESULT_OK; ++i) ((line_touch *)sorted.items)[first[old[i].line]++] = old[i];
    memory_free(l->memory, first, lines + 1, sizeof(*first));
    if (r == RESULT_OK) {
        buffer_free(touches);
        *touches = sorted;
    } else {
        buffer_free(&sorted);
    }
    return r;
}

static size_t slots_for(size_t count)
{
    size_t slots = 64;
    while (slots < count) slots *= 2;
    return slots;
}

result line_set_make(const surface *s, const allocator *memory, line_set *out)
{
    line_set l = {.s = s,
                  .memory = memory,
                  .directions = buffer_make(memory, sizeof(line_direction)),
                  .lines = buffer_make(memory, sizeof(surface_line)),
                  .edges = buffer_make(memory, sizeof(line_edge)),
                  .vertices = buffer_make(memory, sizeof(uint32_t)),
                  .corner_count = s->corners.count};
    line_build b = {.l = &l,
                    .direction_slots = buffer_make(memory, sizeof(uint32_t)),
                    .line_slots = buffer_make(memory, sizeof(uint32_t)),
                    .next_line = buffer_make(memory, sizeof(uint32_t)),
                    .pairs = buffer_make(memory, sizeof(line_pair))};
    const size_t slots = slots_for(2 * s->corners.count);
    l.edge_of = memory_alloc(memory, l.corner_count, sizeof(uint32_t));
    result r = l.edge_of ? RESULT_OK : RESULT_NO_MEMORY;
    if (r == RESULT_OK) r = zeroed(&b.direction_slots, slots);
    if (r == RESULT_OK) r = zeroed(&b.line_slots, slots);
    if (r == RESULT_OK) r = zeroed(&b.pairs, slots);
    if (r == RESULT_OK) r = find_lines(&b);
    if (r == RESULT_OK) r = group_edges(&l);
    if (r == RESULT_OK) r = sort_lines(&l);
    buffer_free(&b.direction_slots);
    buffer_free(&b.line_slots);
    buffer_free(&b.next_line);
    buffer_free(&b.pairs);
    if (r == RESULT_OK) *out = l;
    else line_set_free(&l);
    return r;
}

result line_set_add_touches(line_set *l)
{
    buffer touches = buffer_make(l->memory, sizeof(line_touch));
    result r = line_touches(l, &touches);
    if (r == RESULT_OK) r = sort_touches(l, &touches);
    if (r == RESULT_OK) r = sort_touched(l, &touches);
    buffer_free(&touches);
    return r;
}

void line_set_free(line_set *l)
{
    buffer_free(&l->directions);
    buffer_free(&l->lines);
    buffer_free(&l->edges);
    buffer_free(&l->vertices);
    memory_free(l->memory, l->edge_of, l->corner_count, sizeof(uint32_t));
}
