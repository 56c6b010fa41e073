// The thesis's A3: every polygon that crosses a portal is split by it, and portals that cross one another by each other.
// SPDX-License-Identifier: MIT
#include "portals.h"

#include "../core/box_tree.h"

typedef struct cutter {
    surface *s;
    uint32_t old_count; // polygons before any was cut
    buffer next;                      // uint32_t: polygon + 1 that was cut off this one
    tree_box *boxes;
    box_tree tree;
} cutter;

static result add_piece(surface *s, const portal_set *set, size_t number)
{
    const portal_piece *piece = (portal_piece *)set->pieces.items + number;
    const surface_polygon *p = surface_polygon_at(&set->s, piece->polygon);
    surface_polygon like = *p;
    like.source = (uint32_t)number;
    const surface_corner *c = surface_corners(&set->s, p);
    surface_corner *corners = memory_alloc(s->memory, p->count, sizeof(*corners));
    result r = corners ? RESULT_OK : RESULT_NO_MEMORY;
    for (uint32_t i = 0; i < p->count && r == RESULT_OK; ++i) {
        const plane_ref meet[3] = {p->plane, c[i ? i - 1 : p->count - 1].edge, c[i].edge};
        corners[i].edge = c[i].edge;
        r = surface_vertex(s, meet, &corners[i].vertex);
    }
    if (r == RESULT_OK) r = surface_add(s, p->plane, corners, p->count, &like, NULL);
    memory_free(s->memory, corners, p->count, sizeof(*corners));
    return r;
}

static int is_outside_an_edge(const surface *s, const surface_polygon *p, uint32_t v, uint32_t w)
{
    const surface_corner *c = surface_corners(s, p);
    for (uint32_t i = 0; i < p->count; ++i)
        if (surface_side(s, v, c[i].edge) >= 0 && surface_side(s, w, c[i].edge) >= 0) return 1;
    return 0;
}

// The portal has air on both sides, so where it meets a wall an edge of it lies on the wall.
static int meets_wall(const surface *s, const surface_polygon *wall, const surface_polygon *portal)
{
    const surface_corner *c = surface_corners(s, portal);
    for (uint32_t i = 0; i < portal->count; ++i) {
        const uint32_t v = c[i].vertex, w = c[i + 1 < portal->count ? i + 1 : 0].vertex;
        if (surface_side(s, v, wall->plane) || surface_side(s, w, wall->plane)) continue;
        if (!is_outside_an_edge(s, wall, v, w)) return 1;
    }
    return 0;
}

static int is_apart(const surface *s, const surface_polygon *body, const surface_polygon *other)
{
    const surface_corner *edges = surface_corners(s, body), *c = surface_corners(s, other);
    for (uint32_t i = 0; i < body->count; ++i) {
        int in_front = 1;
        for (uint32_t k = 0; k < other->count && in_front; ++k) in_front = surface_side(s, c[k].vertex, edges[i].edge) >= 0;
        if (in_front) return 1;
    }
    return 0;
}

// In the air any two polygons may cross. Cutting one more than needed does no harm.
static int crosses_in_air(const surface *s, uint32_t polygon, uint32_t portal)
{
    const surface_polygon *p = surface_polygon_at(s, polygon), *q = surface_polygon_at(s, portal);
    const cut_result place = surface_classify(s, portal, p->plane);
    return (place == CUT_BOTH || meets_wall(s, p, q)) && !is_apart(s, p, q) && !is_apart(s, q, p);
}

static int is_cut_by(const surface *s, uint32_t polygon, uint32_t portal)
{
    const surface_polygon *p = surface_polygon_at(s, polygon), *q = surface_polygon_at(s, portal);
    if (surface_classify(s, polygon, q->plane) != CUT_BOTH) return 0;
    return p->kind == SURFACE_WALL ? meets_wall(s, p, q) : crosses_in_air(s, polygon, portal);
}

static result cut_by(cutter *c, uint32_t polygon, uint32_t portal)
{
    surface *s = c->s;
    for (uint32_t at = polygon + 1; at; at = ((uint32_t *)c->next.items)[at - 1]) {
        if (!is_cut_by(s, at - 1, portal)) continue;
        uint32_t back;
        const result r = surface_cut(s, at - 1, surface_polygon_at(s, portal)->plane, &back);
        if (r != RESULT_OK) return r;
        uint32_t *next = buffer_push(&c->next, 1);
        if (!next) return RESULT_NO_MEMORY;
        *next = ((uint32_t *)c->next.items)[at - 1];
        ((uint32_t *)c->next.items)[at - 1] = back + 1;
        at = back + 1; // lies behind: isn't cut by this portal again
    }
    return RESULT_OK;
}

static result cut_all(cutter *c)
{
    for (uint32_t portal = 0; portal < c->old_count; ++portal) {
        if (!surface_is_two_sided(surface_polygon_at(c->s, portal)->kind)) continue;
        // The box and plane of the whole piece: it may have been cut itself, and its parts cut the same way.
        const tree_box box = c->boxes[portal];
        box_walk walk;
        box_walk_start(&walk, &c->tree, &box);
        for (uint32_t i; box_walk_next(&walk, &i);) {
            if (i == portal) continue;
            for (uint32_t part = portal + 1; part; part = ((uint32_t *)c->next.items)[part - 1]) {
                const result r = cut_by(c, i, part - 1);
                if (r != RESULT_OK) return r;
            }
        }
    }
    return RESULT_OK;
}

result portal_cut(surface *s, const portal_set *set)
{
    cutter c = {.s = s, .next = buffer_make(s->memory, sizeof(uint32_t))};
    uint32_t sheets = 0;
    result r = RESULT_OK;
    for (size_t i = 0; i < set->pieces.count && r == RESULT_OK; ++i) {
        if (!((portal_piece *)set->pieces.items)[i].is_rejected) r = add_piece(s, set, i);
    }
    c.old_count = surface_polygon_count(s);
    for (uint32_t i = 0; i < c.old_count; ++i) sheets += surface_is_two_sided(surface_polygon_at(s, i)->kind) != 0;
    if (r != RESULT_OK || sheets == 0) return r;
    c.boxes = memory_alloc(s->memory, c.old_count, sizeof(*c.boxes));
    uint32_t *next = buffer_push(&c.next, c.old_count);
    if (!c.boxes || !next) r = RESULT_NO_MEMORY;
    for (uint32_t i = 0; i < c.old_count && r == RESULT_OK; ++i) {
        const surface_polygon *p = surface_polygon_at(s, i);
        next[i] = 0;
        for (int k = 0; k < 3; ++k) c.boxes[i].min[k] = p->min[k] - 1.0, c.boxes[i].max[k] = p->max[k] + 1.0;
    }
    if (r == RESULT_OK) r = box_tree_open(c.boxes, c.old_count, s->memory, &c.tree);
    if (r == RESULT_OK) {
        r = cut_all(&c);
        box_tree_close(&c.tree, s->memory);
    }
    memory_free(s->memory, c.boxes, c.old_count, sizeof(*c.boxes));
    buffer_free(&c.next);
    return r;
}
