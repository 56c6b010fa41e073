// One face against convex bodies: see csg.h. A body cuts only with those of its planes that bound what the two share, so no
// order of its planes makes a split that isn't needed; a split whose parts all stay is taken back.
// SPDX-License-Identifier: MIT
#include "csg.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define FRAGMENT_MARGIN 0.0009765625 // steps: corner positions are within 2^-25 of a step

typedef struct fragment {
    plane_polygon shape; // in edges
    uint32_t next, node, open_sides;
    double min[3], max[3];
} fragment;

typedef struct cut_node { // of what a face was cut into
    plane_polygon shape;
    uint32_t parent, whole, covered;
} cut_node;

#define NODE_NONE UINT32_MAX

typedef struct needed_plane {
    int64_t length, place;
    plane_ref plane;
    uint32_t at;
} needed_plane;

face_cutter face_cutter_make(const compile_input *in, const brush_bodies *bodies, const map_field *field, const allocator *memory)
{
    return (face_cutter){.planes = in->planes,
                         .bodies = bodies,
                         .field = field,
                         .edges = buffer_make(memory, sizeof(polygon_edge)),
                         .fragments = buffer_make(memory, sizeof(fragment)),
                         .nodes = buffer_make(memory, sizeof(cut_node)),
                         .signs = buffer_make(memory, 1),
                         .cutters = buffer_make(memory, sizeof(plane_ref)),
                         .needed = buffer_make(memory, sizeof(needed_plane)),
                         .candidates = buffer_make(memory, sizeof(csg_candidate))};
}

void face_cutter_free(face_cutter *c)
{
    buffer_free(&c->edges);
    buffer_free(&c->fragments);
    buffer_free(&c->nodes);
    buffer_free(&c->signs);
    buffer_free(&c->cutters);
    buffer_free(&c->needed);
    buffer_free(&c->candidates);
}

static polygon_edge *edges_of(const face_cutter *c, const plane_polygon *p)
{
    return (polygon_edge *)c->edges.items + p->first;
}

static int8_t *room_for_signs(face_cutter *c, uint32_t count)
{
    c->signs.count = 0;
    return buffer_push(&c->signs, count);
}

// ---- What a body shares with a polygon ----

typedef enum overlap { OVERLAP_NONE, OVERLAP_PART, OVERLAP_ALL, OVERLAP_NO_MEMORY } overlap;

// The planes of the body that truly cross the polygon into `cutters`; NONE as soon as one has it all in front.
static overlap find_cutters(face_cutter *c, const plane_polygon *p, uint32_t brush)
{
    const brush_body *body = &c->bodies->of[brush];
    const body_polygon *faces = (const body_polygon *)c->bodies->polygons.items + body->first_polygon;
    int8_t *signs = room_for_signs(c, p->count);
    if (!signs) return OVERLAP_NO_MEMORY;
    c->cutters.count = 0;
    for (uint32_t f = 0; f < body->polygon_count; ++f) {
        const plane_ref by = faces[f].shape.plane;
        if (by >> 1 == p->plane >> 1) continue;
        const polygon_place place = polygon_signs(c->planes, p->plane, edges_of(c, p), p->count, by, signs);
        if (!(place & POLYGON_BEHIND)) return OVERLAP_NONE;
        if (place == POLYGON_ACROSS && !buffer_append(&c->cutters, &by, 1)) return OVERLAP_NO_MEMORY;
    }
    return c->cutters.count ? OVERLAP_PART : OVERLAP_ALL;
}

// After find_cutters: what is behind all of them into *shared.
static overlap clip_to_cutters(face_cutter *c, const plane_polygon *p, plane_polygon *shared)
{
    *shared = *p;
    for (size_t i = 0; i < c->cutters.count; ++i) {
        const plane_ref by = ((const plane_ref *)c->cutters.items)[i];
        int8_t *signs = room_for_signs(c, shared->count);
        if (!signs) return OVERLAP_NO_MEMORY;
        const polygon_place place = polygon_signs(c->planes, p->plane, edges_of(c, shared), shared->count, by, signs);
        if (!(place & POLYGON_BEHIND)) return OVERLAP_NONE;
        const plane_polygon whole = *shared;
        if (place == POLYGON_ACROSS && !polygon_cut(c->planes, &whole, signs, by, &c->edges, (polygon_parts){.behind = shared})) return OVERLAP_NO_MEMORY;
    }
    return OVERLAP_PART;
}

static overlap find_shared(face_cutter *c, const plane_polygon *p, uint32_t brush, plane_polygon *shared)
{
    const overlap found = find_cutters(c, p, brush);
    if (found != OVERLAP_PART) return found;
    return clip_to_cutters(c, p, shared);
}

static int compare_needed(const void *left, const void *right)
{
    const needed_plane *a = left, *b = right;
    if (a->length != b->length) return a->length > b->length ? -1 : 1;
    if (a->place != b->place) return a->place < b->place ? -1 : 1;
    return a->at < b->at ? -1 : 1;
}

// The cutters that bound what is shared, those with the longest border first.
static int find_needed(face_cutter *c, const plane_polygon *shared)
{
    const polygon_edge *edges = edges_of(c, shared);
    const plane_ref *cutters = c->cutters.items;
    c->needed.count = 0;
    for (uint32_t i = 0; i < shared->count; ++i) {
        size_t k = 0;
        while (k < c->cutters.count && cutters[k] != edges[i].plane) ++k;
        if (k == c->cutters.count) continue;
        const double *from = edges[i].start, *to = edges[i + 1 < shared->count ? i + 1 : 0].start;
        const double middle[3] = {0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1]), 0.5 * (from[2] + to[2])};
        double square = 0;
        for (int j = 0; j < 3; ++j) square += (to[j] - from[j]) * (to[j] - from[j]);
        const needed_plane needed = {(int64_t)floor(sqrt(square) * 4 + 0.37), map_field_at(c->field, middle), edges[i].plane, i};
        if (!buffer_append(&c->needed, &needed, 1)) return 0;
    }
    if (c->needed.count > 1) qsort(c->needed.items, c->needed.count, sizeof(needed_plane), compare_needed);
    return 1;
}

// ---- Fragments ----

static void set_box(const face_cutter *c, fragment *f)
{
    const polygon_edge *edges = edges_of(c, &f->shape);
    for (int k = 0; k < 3; ++k) f->min[k] = f->max[k] = edges[0].start[k];
    for (uint32_t i = 1; i < f->shape.count; ++i)
        for (int k = 0; k < 3; ++k) {
            if (edges[i].start[k] < f->min[k]) f->min[k] = edges[i].start[k];
            if (edges[i].start[k] > f->max[k]) f->max[k] = edges[i].start[k];
        }
    for (int k = 0; k < 3; ++k) {
        f->min[k] -= FRAGMENT_MARGIN;
        f->max[k] += FRAGMENT_MARGIN;
    }
}

static int boxes_meet(const fragment *f, const brush_body *body)
{
    for (int k = 0; k < 3; ++k)
        if (f->max[k] < body->min[k] || f->min[k] > body->max[k]) return 0;
    return 1;
}

static int add_fragment(face_cutter *c, const plane_polygon *shape, const fragment *like)
{
    const cut_node node = {*shape, like->node, 1, 0};
    fragment f = {.shape = *shape, .next = like->next, .node = (uint32_t)c->nodes.count, .open_sides = like->open_sides};
    set_box(c, &f);
    return buffer_append(&c->nodes, &node, 1) && buffer_append(&c->fragments, &f, 1);
}

static void lose(face_cutter *c, uint32_t node)
{
    ((cut_node *)c->nodes.items)[node].whole = 0;
}

// The fragment's parts outside the body become fragments, the one inside too if it is not removed.
static int split(face_cutter *c, const fragment *f, const csg_candidate *by)
{
    fragment outside = *f;
    outside.next++;
    plane_polygon inside = f->shape;
    for (size_t i = 0; i < c->needed.count; ++i) {
        const plane_ref plane = ((const needed_plane *)c->needed.items)[i].plane;
        plane_polygon behind, front;
        int8_t *signs = room_for_signs(c, inside.count);
        if (!signs) return 0;
        if (polygon_signs(c->planes, inside.plane, edges_of(c, &inside), inside.count, plane, signs) != POLYGON_ACROSS) continue;
        if (!polygon_cut(c->planes, &inside, signs, plane, &c->edges, (polygon_parts){&behind, &front})) return 0;
        if (!add_fragment(c, &front, &outside)) return 0;
        inside = behind;
    }
    if (by->effect == CSG_REMOVE) {
        lose(c, f->node);
        return 1;
    }
    outside.open_sides &= ~by->sides;
    return add_fragment(c, &inside, &outside);
}

// Would a later candidate of the other effect meet the shared part? If not, what the body decides is what the rest would.
static overlap is_contested(face_cutter *c, const plane_polygon *shared, uint32_t after)
{
    const csg_candidate *candidates = c->candidates.items;
    const size_t edges = c->edges.count;
    overlap found = OVERLAP_NONE;
    for (size_t i = after; i < c->candidates.count && found == OVERLAP_NONE; ++i) {
        plane_polygon ignored;
        if (candidates[i].effect != c->rest) found = find_shared(c, shared, candidates[i].brush, &ignored);
    }
    c->edges.count = edges;
    return found;
}

typedef enum step { STEP_ON, STEP_DONE, STEP_NO_MEMORY } step;

static step meet_all(face_cutter *c, fragment *f, const csg_candidate *by)
{
    if (by->effect == CSG_REMOVE) {
        lose(c, f->node);
        return STEP_DONE;
    }
    f->open_sides &= ~by->sides;
    return f->open_sides ? STEP_ON : STEP_DONE;
}

static step meet(face_cutter *c, fragment *f, const csg_candidate *by)
{
    if (!(by->sides & f->open_sides) || !boxes_meet(f, &c->bodies->of[by->brush])) return STEP_ON;
    overlap found = find_cutters(c, &f->shape, by->brush);
    if (found == OVERLAP_NONE) return STEP_ON;
    if (found == OVERLAP_ALL) return meet_all(c, f, by);
    plane_polygon shared;
    const size_t edges = c->edges.count;
    if (found == OVERLAP_PART) found = clip_to_cutters(c, &f->shape, &shared);
    if (found == OVERLAP_PART && !find_needed(c, &shared)) found = OVERLAP_NO_MEMORY;
    if (found == OVERLAP_PART && c->mixed && by->effect == c->rest) {
        const overlap contested = is_contested(c, &shared, f->next + 1);
        if (contested == OVERLAP_NONE || contested == OVERLAP_NO_MEMORY) found = contested;
    }
    c->edges.count = edges; // what is shared was only looked at
    if (found == OVERLAP_NO_MEMORY) return STEP_NO_MEMORY;
    if (found == OVERLAP_NONE) return STEP_ON;
    return split(c, f, by) ? STEP_DONE : STEP_NO_MEMORY;
}

static step run_fragment(face_cutter *c, fragment f)
{
    for (; f.open_sides && f.next < c->candidates.count; ++f.next) {
        const csg_candidate by = ((const csg_candidate *)c->candidates.items)[f.next];
        const step done = meet(c, &f, &by);
        if (done != STEP_ON) return done;
    }
    if (f.open_sides && c->rest == CSG_REMOVE) lose(c, f.node);
    return STEP_ON;
}

// Children come after their parents: losses rise first, then the largest that lost nothing are taken.
static int emit(face_cutter *c, const body_polygon *face, polygon_soup *out)
{
    cut_node *nodes = c->nodes.items;
    for (size_t i = c->nodes.count; i-- > 1;)
        if (!nodes[i].whole) nodes[nodes[i].parent].whole = 0;
    for (size_t i = 0; i < c->nodes.count; ++i) {
        const cut_node *parent = nodes[i].parent == NODE_NONE ? NULL : &nodes[nodes[i].parent];
        nodes[i].covered = parent && (parent->whole || parent->covered);
        if (!nodes[i].whole || nodes[i].covered) continue;
        body_polygon p = {nodes[i].shape, face->brush, face->face};
        p.shape.first = (uint32_t)out->edges.count;
        if (out->edges.count + p.shape.count > UINT32_MAX) return 0;
        if (!buffer_append(&out->edges, edges_of(c, &nodes[i].shape), p.shape.count) || !buffer_append(&out->polygons, &p, 1)) return 0;
    }
    return 1;
}

result face_cutter_run(face_cutter *c, const body_polygon *face, polygon_soup *out)
{
    c->edges.count = c->fragments.count = c->nodes.count = 0;
    const polygon_edge *edges = (const polygon_edge *)c->bodies->edges.items + face->shape.first;
    const plane_polygon shape = {face->shape.plane, 0, face->shape.count};
    const fragment first = {.node = NODE_NONE, .open_sides = c->open_sides};
    if (!buffer_append(&c->edges, edges, shape.count) || !add_fragment(c, &shape, &first)) return RESULT_NO_MEMORY;
    while (c->fragments.count) {
        const fragment f = ((const fragment *)c->fragments.items)[--c->fragments.count];
        if (run_fragment(c, f) == STEP_NO_MEMORY) return RESULT_NO_MEMORY;
    }
    return emit(c, face, out) ? RESULT_OK : RESULT_NO_MEMORY;
}
