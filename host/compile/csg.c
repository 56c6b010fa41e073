// The surface of all brushes: see csg.h. For each brush its neighbours, the last to change a point first; for each of its faces those that matter.
// SPDX-License-Identifier: MIT
#include "csg.h"

#include <stdlib.h>
#include <string.h>

typedef struct neighbour {
    uint32_t brush, size;
    uint32_t group; // liquids, then phases from the last down to the brush's own as one, for they all take away, then each
    brush_relation relation;
} neighbour;

typedef struct surface_maker {
    const csg_stage *stage;
    face_cutter cutter;
    neighbour *neighbours; // by brush
    uint32_t *first_of;    // brush_count + 1
    polygon_soup *out;
} surface_maker;

static int is_liquid(const csg_stage *s, uint32_t brush)
{
    return s->in->brushes[brush].role == BRUSH_LIQUID;
}

// Bodies of one group have one effect, so they may come in any order: the large first, which leave less to cut.
static int compare_neighbours(const void *left, const void *right)
{
    const neighbour *a = left, *b = right;
    if (a->group != b->group) return a->group < b->group ? -1 : 1;
    return (a->size > b->size) - (a->size < b->size);
}

static neighbour neighbour_of(const csg_stage *s, uint32_t to, uint32_t brush, brush_relation relation)
{
    const uint32_t own = is_liquid(s, to) ? UINT32_MAX : s->rank[to].phase, phase = s->rank[brush].phase;
    const uint32_t group = is_liquid(s, brush) ? 0 : phase >= own ? 1 : UINT32_MAX - phase;
    return (neighbour){brush, s->rank[brush].size, group, relation};
}

// Liquids cut nothing but liquids.
static int matters(const csg_stage *s, uint32_t to, uint32_t brush)
{
    return is_liquid(s, to) || !is_liquid(s, brush);
}

static int make_neighbours(surface_maker *m, const allocator *memory)
{
    const csg_stage *s = m->stage;
    const relation_table *r = s->relations;
    const uint32_t n = s->in->brush_count;
    m->first_of = memory_alloc_zeroed(memory, (size_t)n + 2, sizeof *m->first_of);
    m->neighbours = memory_alloc(memory, 2 * (size_t)r->pair_count, sizeof *m->neighbours);
    if (!m->first_of || !m->neighbours || r->pair_count > UINT32_MAX / 2) return 0;
    uint32_t *at = m->first_of + 1; // at[b]: where the next neighbour of b goes; in the end first_of[b + 1]
    for (uint32_t p = 0; p < r->pair_count; ++p) {
        at[r->pairs[p].a + 1] += (uint32_t)matters(s, r->pairs[p].a, r->pairs[p].b);
        at[r->pairs[p].b + 1] += (uint32_t)matters(s, r->pairs[p].b, r->pairs[p].a);
    }
    for (uint32_t b = 0; b < n; ++b) at[b + 1] += at[b];
    for (uint32_t p = 0; p < r->pair_count; ++p) {
        const brush_pair *pair = &r->pairs[p];
        if (matters(s, pair->a, pair->b)) m->neighbours[at[pair->a]++] = neighbour_of(s, pair->a, pair->b, pair->relation);
        if (matters(s, pair->b, pair->a)) m->neighbours[at[pair->b]++] = neighbour_of(s, pair->b, pair->a, pair->relation);
    }
    for (uint32_t b = 0; b < n; ++b) {
        const uint32_t count = m->first_of[b + 1] - m->first_of[b];
        if (count > 1) qsort(m->neighbours + m->first_of[b], count, sizeof *m->neighbours, compare_neighbours);
    }
    return 1;
}

// The sides of the face's plane on which the body lies, should it meet the face at all; 0: it can't.
static uint32_t sides_covered(const brush_bodies *b, const neighbour *n, plane_ref plane)
{
    const brush_body *body = &b->of[n->brush];
    const body_polygon *faces = (const body_polygon *)b->polygons.items + body->first_polygon;
    for (uint32_t f = 0; f < body->polygon_count; ++f)
        if (faces[f].shape.plane >> 1 == plane >> 1) return faces[f].shape.plane == plane ? CSG_BACK : CSG_FRONT;
    return n->relation == RELATION_TOUCHING ? 0 : CSG_BACK | CSG_FRONT;
}

enum { NO_EFFECT = -1 };

// A face stays where before its brush both sides were what the brush changes, and after it no side changed back.
static int effect_on_structure(const csg_stage *s, uint32_t brush, const neighbour *n, uint32_t sides)
{
    const int same = s->in->brushes[n->brush].kind == s->in->brushes[brush].kind;
    if (s->rank[n->brush].rank < s->rank[brush].rank) return same ? CSG_REMOVE : CSG_KEEP;
    return sides & (same ? CSG_FRONT : CSG_BACK) ? CSG_REMOVE : NO_EFFECT;
}

static int has_visible_face_on(const csg_stage *s, uint32_t brush, plane_ref plane)
{
    const brush_body *body = &s->bodies->of[brush];
    const body_polygon *faces = (const body_polygon *)s->bodies->polygons.items + body->first_polygon;
    for (uint32_t f = 0; f < body->polygon_count; ++f)
        if (faces[f].shape.plane >> 1 == plane >> 1) return s->in->faces[faces[f].face].material != COMPILE_NOTHING;
    return 0;
}

// A liquid's face stays where both of its sides are open, in other liquids too: raw brushes show it there. Of two faces in
// one place, which are seen from both sides, one stays.
static int effect_on_liquid(const csg_stage *s, const body_polygon *face, const neighbour *n, uint32_t *sides)
{
    if (!is_liquid(s, n->brush)) return s->in->brushes[n->brush].kind == BRUSH_ADD ? CSG_REMOVE : CSG_KEEP;
    if (s->rank[n->brush].rank > s->rank[face->brush].rank || !has_visible_face_on(s, n->brush, face->shape.plane)) return NO_EFFECT;
    *sides = CSG_BACK | CSG_FRONT;
    return CSG_REMOVE;
}

static int boxes_meet(const double min[3], const double max[3], const brush_body *body)
{
    for (int k = 0; k < 3; ++k)
        if (max[k] < body->min[k] || min[k] > body->max[k]) return 0;
    return 1;
}

static void box_of(const polygon_edge *edges, uint32_t count, double min[3], double max[3])
{
    for (int k = 0; k < 3; ++k) min[k] = max[k] = edges[0].start[k];
    for (uint32_t i = 1; i < count; ++i)
        for (int k = 0; k < 3; ++k) {
            if (edges[i].start[k] < min[k]) min[k] = edges[i].start[k];
            if (edges[i].start[k] > max[k]) max[k] = edges[i].start[k];
        }
}

static result find_candidates(surface_maker *m, const body_polygon *face)
{
    const csg_stage *s = m->stage;
    face_cutter *c = &m->cutter;
    const int liquid = is_liquid(s, face->brush);
    c->candidates.count = 0;
    c->rest = s->in->brushes[face->brush].kind == BRUSH_SUBTRACT && !liquid ? CSG_REMOVE : CSG_KEEP;
    c->open_sides = CSG_BACK | CSG_FRONT;
    double min[3], max[3];
    box_of((const polygon_edge *)s->bodies->edges.items + face->shape.first, face->shape.count, min, max);
    size_t used = 0, others = 0; // up to the last that does what the rest would not
    for (uint32_t i = m->first_of[face->brush]; i < m->first_of[face->brush + 1]; ++i) {
        const neighbour *n = &m->neighbours[i];
        if (!boxes_meet(min, max, &s->bodies->of[n->brush])) continue; // a body's box has room to spare
        uint32_t sides = sides_covered(s->bodies, n, face->shape.plane);
        if (!sides) continue;
        const int effect = liquid ? effect_on_liquid(s, face, n, &sides) : effect_on_structure(s, face->brush, n, sides);
        if (effect == NO_EFFECT) continue;
        const csg_candidate candidate = {n->brush, sides, (csg_effect)effect};
        if (!buffer_append(&c->candidates, &candidate, 1)) return RESULT_NO_MEMORY;
        if (candidate.effect == c->rest) continue;
        used = c->candidates.count;
        ++others;
    }
    c->candidates.count = used;
    c->mixed = others < used;
    return RESULT_OK;
}

// The same loop seen from the other side.
static void turn_round(polygon_soup *soup, size_t first)
{
    for (size_t p = first; p < soup->polygons.count; ++p) {
        plane_polygon *shape = &((body_polygon *)soup->polygons.items)[p].shape;
        polygon_edge *edges = (polygon_edge *)soup->edges.items + shape->first;
        const uint32_t n = shape->count;
        shape->plane = plane_ref_flipped(shape->plane);
        for (uint32_t i = 0; i < n / 2; ++i) {
            const polygon_edge e = edges[i];
            edges[i] = edges[n - 1 - i];
            edges[n - 1 - i] = e;
        }
        // Each edge now starts where the one before it in the new order did.
        double last[3];
        memcpy(last, edges[n - 1].start, sizeof last);
        for (uint32_t i = n - 1; i > 0; --i) memcpy(edges[i].start, edges[i - 1].start, sizeof last);
        memcpy(edges[0].start, last, sizeof last);
    }
}

static result add_brush(surface_maker *m, uint32_t brush)
{
    const csg_stage *s = m->stage;
    const brush_body *body = &s->bodies->of[brush];
    const size_t before = m->out->polygons.count;
    for (uint32_t f = 0; f < body->polygon_count; ++f) {
        const body_polygon *face = (const body_polygon *)s->bodies->polygons.items + body->first_polygon + f;
        result done = find_candidates(m, face);
        if (done == RESULT_OK) done = face_cutter_run(&m->cutter, face, m->out);
        if (done != RESULT_OK) return done;
    }
    if (s->in->brushes[brush].kind == BRUSH_SUBTRACT && !is_liquid(s, brush)) turn_round(m->out, before);
    return RESULT_OK;
}

result csg_surface(const csg_stage *stage, const allocator *memory, polygon_soup *out)
{
    const uint32_t n = stage->in->brush_count;
    *out = (polygon_soup){buffer_make(memory, sizeof(body_polygon)), buffer_make(memory, sizeof(polygon_edge))};
    surface_maker m = {.stage = stage, .cutter = face_cutter_make(stage->in, stage->bodies, stage->field, memory), .out = out};
    result done = make_neighbours(&m, memory) ? RESULT_OK : RESULT_NO_MEMORY;
    for (uint32_t b = 0; done == RESULT_OK && b < n; ++b) done = add_brush(&m, b);
    memory_free(memory, m.first_of, (size_t)n + 2, sizeof *m.first_of);
    memory_free(memory, m.neighbours, 2 * (size_t)stage->relations->pair_count, sizeof *m.neighbours);
    face_cutter_free(&m.cutter);
    if (done != RESULT_OK) polygon_soup_free(out);
    return done;
}

void polygon_soup_free(polygon_soup *s)
{
    if (!s->polygons.memory) return;
    buffer_free(&s->polygons);
    buffer_free(&s->edges);
    *s = (polygon_soup){0};
}
