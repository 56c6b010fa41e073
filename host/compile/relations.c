// Relation table of brushes: pairs whose boxes meet, from a box tree, then corners against face planes. See relations.h.
// SPDX-License-Identifier: MIT
#include "relations.h"

#include "../core/box_tree.h"

#include <stdlib.h>
#include <string.h>

typedef enum body_side { BODY_BEHIND, BODY_ACROSS, BODY_ON_FRONT, BODY_FRONT } body_side; // of a plane; behind: or on it

static body_side side_of_body(const plane_table *t, const brush_bodies *b, const brush_body *body, plane_ref plane)
{
    const body_corner *corners = (const body_corner *)b->corners.items + body->first_corner;
    int behind = 0, on = 0, front = 0;
    for (uint32_t i = 0; i < body->corner_count; ++i) {
        const int side = plane_table_side_at(t, corners[i].meet, corners[i].position, plane);
        behind |= side < 0;
        on |= side == 0;
        front |= side > 0;
        if (behind && front) return BODY_ACROSS;
    }
    return front ? (on ? BODY_ON_FRONT : BODY_FRONT) : BODY_BEHIND;
}

// The side farthest out of `of`'s faces on which `body` lies: BODY_BEHIND when it is inside all.
static body_side against_faces(const plane_table *t, const brush_bodies *b, const brush_body *body, const brush_body *of)
{
    const body_polygon *faces = (const body_polygon *)b->polygons.items + of->first_polygon;
    body_side worst = BODY_BEHIND;
    for (uint32_t f = 0; f < of->polygon_count; ++f) {
        const body_side side = side_of_body(t, b, body, faces[f].shape.plane);
        if (side > worst) worst = side;
        if (side == BODY_FRONT) break;
    }
    return worst;
}

static brush_relation relation_of(const plane_table *t, const brush_bodies *b, uint32_t first, uint32_t second)
{
    const brush_body *p = &b->of[first], *q = &b->of[second];
    const body_side p_in_q = against_faces(t, b, p, q);
    if (p_in_q == BODY_FRONT) return RELATION_APART;
    const body_side q_in_p = against_faces(t, b, q, p);
    if (q_in_p == BODY_FRONT) return RELATION_APART;
    if (p_in_q == BODY_ON_FRONT || q_in_p == BODY_ON_FRONT) return RELATION_TOUCHING;
    if (q_in_p == BODY_BEHIND) return RELATION_CONTAINS;
    return p_in_q == BODY_BEHIND ? RELATION_INSIDE : RELATION_CROSSING;
}

static int compare_numbers(const void *a, const void *b)
{
    const uint32_t p = *(const uint32_t *)a, q = *(const uint32_t *)b;
    return (p > q) - (p < q);
}

typedef struct pair_search {
    const plane_table *planes;
    const brush_bodies *bodies;
    const uint32_t *brush_of; // of a box
    buffer near, pairs;       // uint32_t, brush_pair
} pair_search;

static result add_pairs(pair_search *s, const box_tree *tree, uint32_t box)
{
    const uint32_t a = s->brush_of[box];
    s->near.count = 0;
    box_walk walk;
    box_walk_start(&walk, tree, &tree->boxes[box]);
    for (uint32_t other; box_walk_next(&walk, &other);)
        if (other > box && !buffer_append(&s->near, &s->brush_of[other], 1)) return RESULT_NO_MEMORY;
    uint32_t *near = s->near.items;
    if (s->near.count > 1) qsort(near, s->near.count, sizeof *near, compare_numbers);
    for (size_t i = 0; i < s->near.count; ++i) {
        const brush_pair pair = {a, near[i], relation_of(s->planes, s->bodies, a, near[i])};
        if (pair.relation != RELATION_APART && !buffer_append(&s->pairs, &pair, 1)) return RESULT_NO_MEMORY;
    }
    return s->pairs.count < UINT32_MAX ? RESULT_OK : RESULT_NO_MEMORY;
}

static result fill_table(pair_search *s, const tree_box *boxes, uint32_t count, const allocator *memory, relation_table *out)
{
    box_tree tree;
    const result opened = box_tree_open(boxes, count, memory, &tree);
    if (opened != RESULT_OK) return opened;
    result done = RESULT_OK;
    uint32_t brush = 0;
    for (uint32_t box = 0; done == RESULT_OK && box < count; ++box) {
        for (; brush <= s->brush_of[box]; ++brush) out->first_of[brush] = (uint32_t)s->pairs.count;
        done = add_pairs(s, &tree, box);
    }
    for (; done == RESULT_OK && brush <= s->bodies->brush_count; ++brush) out->first_of[brush] = (uint32_t)s->pairs.count;
    box_tree_close(&tree, memory);
    if (done != RESULT_OK) return done;
    out->pair_count = (uint32_t)s->pairs.count;
    out->pairs = memory_alloc(memory, out->pair_count, sizeof *out->pairs);
    if (!out->pairs) return RESULT_NO_MEMORY;
    if (out->pair_count) memcpy(out->pairs, s->pairs.items, out->pair_count * sizeof *out->pairs);
    return RESULT_OK;
}

result relation_table_make(const plane_table *planes, const brush_bodies *bodies, const allocator *memory, relation_table *out)
{
    const uint32_t n = bodies->brush_count;
    *out = (relation_table){0};
    out->first_of = memory_alloc(memory, (size_t)n + 1, sizeof *out->first_of);
    tree_box *boxes = memory_alloc(memory, n, sizeof *boxes);
    uint32_t *brush_of = memory_alloc(memory, n, sizeof *brush_of);
    result done = RESULT_NO_MEMORY;
    if (out->first_of && boxes && brush_of) {
        uint32_t count = 0;
        for (uint32_t b = 0; b < n; ++b) {
            const brush_body *body = &bodies->of[b];
            if (body->polygon_count == 0) continue;
            memcpy(boxes[count].min, body->min, sizeof body->min);
            memcpy(boxes[count].max, body->max, sizeof body->max);
            brush_of[count++] = b;
        }
        pair_search search = {planes, bodies, brush_of, buffer_make(memory, sizeof(uint32_t)), buffer_make(memory, sizeof(brush_pair))};
        done = fill_table(&search, boxes, count, memory, out);
        buffer_free(&search.near);
        buffer_free(&search.pairs);
    }
    memory_free(memory, boxes, n, sizeof *boxes);
    memory_free(memory, brush_of, n, sizeof *brush_of);
    if (done != RESULT_OK) relation_table_free(out, bodies, memory);
    return done;
}

void relation_table_free(relation_table *t, const brush_bodies *bodies, const allocator *memory)
{
    if (t->first_of) memory_free(memory, t->first_of, (size_t)bodies->brush_count + 1, sizeof *t->first_of);
    memory_free(memory, t->pairs, t->pair_count, sizeof *t->pairs);
    *t = (relation_table){0};
}
