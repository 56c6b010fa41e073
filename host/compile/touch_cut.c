// Where an edge of one body lies against the inside of another's face, the air before that face is two: the face is cut
// along the edge, so that each part has its own air. Touching along an edge seals, however thin.
// SPDX-License-Identifier: MIT
#include "portals.h"
#include "surface_frame.h"

#define NEAR_STEPS 1e-5 // positions are off by 2^-26 steps

typedef struct touch { uint32_t polygon, ends[2]; plane_ref plane; } touch; // the edge lies on the polygon, and on the plane

typedef struct toucher {
    surface *s;
    surface_frame frame;
    tree_box *boxes; // in it
    box_tree tree;
    buffer near;    // uint32_t: polygons whose boxes touch that of the one at work
    buffer touches; // touch
    buffer next;    // uint32_t: polygon + 1 that was cut off this one
} toucher;

static int is_inside(const surface *s, const surface_polygon *p, const uint32_t ends[2])
{
    const surface_corner *c = surface_corners(s, p);
    for (uint32_t i = 0; i < p->count; ++i) { // most are neighbours
        const uint32_t next = c[i + 1 < p->count ? i + 1 : 0].vertex;
        if ((c[i].vertex == ends[0] && next == ends[1]) || (c[i].vertex == ends[1] && next == ends[0])) return 0;
    }
    if (surface_side(s, ends[0], p->plane) || surface_side(s, ends[1], p->plane)) return 0;
    for (uint32_t i = 0; i < p->count; ++i)
        if (surface_side(s, ends[0], c[i].edge) >= 0 && surface_side(s, ends[1], c[i].edge) >= 0) return 0;
    return 1;
}

static int boxes_touch(const tree_box *a, const tree_box *b)
{
    for (int k = 0; k < 3; ++k)
        if (a->min[k] > b->max[k] || b->min[k] > a->max[k]) return 0;
    return 1;
}

// One walk for all edges of a polygon: walks are most of what this costs.
static result find_near(toucher *t, uint32_t polygon)
{
    const surface *s = t->s;
    const surface_polygon *p = surface_polygon_at(s, polygon);
    tree_box box;
    for (int k = 0; k < 3; ++k) {
        box.min[k] = t->boxes[polygon].min[k] - NEAR_STEPS;
        box.max[k] = t->boxes[polygon].max[k] + NEAR_STEPS;
    }
    t->near.count = 0;
    box_walk walk;
    box_walk_start(&walk, &t->tree, &box);
    for (uint32_t q; box_walk_next(&walk, &q);) {
        const surface_polygon *other = surface_polygon_at(s, q);
        if (q == polygon || other->kind == SURFACE_LIQUID || other->plane >> 1 == p->plane >> 1) continue;
        if (!buffer_append(&t->near, &q, 1)) return RESULT_NO_MEMORY;
    }
    return RESULT_OK;
}

static result find_touches(toucher *t, uint32_t polygon)
{
    const surface *s = t->s;
    const surface_polygon *p = surface_polygon_at(s, polygon);
    const result r = find_near(t, polygon);
    for (uint32_t i = 0; i < p->count && r == RESULT_OK; ++i) {
        touch found = {0, {surface_corners(s, p)[i].vertex, surface_corners(s, p)[i + 1 < p->count ? i + 1 : 0].vertex}, p->plane};
        const tree_box box = surface_frame_edge(&t->frame, s, found.ends, NEAR_STEPS);
        for (size_t n = 0; n < t->near.count; ++n) {
            found.polygon = ((uint32_t *)t->near.items)[n];
            if (!boxes_touch(&t->boxes[found.polygon], &box) || !is_inside(s, surface_polygon_at(s, found.polygon), found.ends)) continue;
            if (!buffer_append(&t->touches, &found, 1)) return RESULT_NO_MEMORY;
        }
    }
    return r;
}

static result cut_touched(toucher *t, const touch *h)
{
    surface *s = t->s;
    for (uint32_t at = h->polygon + 1; at; at = ((uint32_t *)t->next.items)[at - 1]) {
        if (!is_inside(s, surface_polygon_at(s, at - 1), h->ends) || surface_classify(s, at - 1, h->plane) != CUT_BOTH) continue;
        uint32_t back;
        const result r = surface_cut(s, at - 1, h->plane, &back);
        if (r != RESULT_OK) return r;
        uint32_t *next = buffer_push(&t->next, 1);
        if (!next) return RESULT_NO_MEMORY;
        *next = ((uint32_t *)t->next.items)[at - 1];
        ((uint32_t *)t->next.items)[at - 1] = back + 1;
    }
    return RESULT_OK;
}

static result find_and_cut(toucher *t, uint32_t count)
{
    result r = RESULT_OK;
    for (uint32_t i = 0; i < count && r == RESULT_OK; ++i)
        if (surface_polygon_at(t->s, i)->kind != SURFACE_LIQUID) r = find_touches(t, i);
    if (r != RESULT_OK || t->touches.count == 0) return r;
    uint32_t *next = buffer_push(&t->next, count);
    if (!next) return RESULT_NO_MEMORY;
    for (uint32_t i = 0; i < count; ++i) next[i] = 0;
    for (size_t i = 0; i < t->touches.count && r == RESULT_OK; ++i) r = cut_touched(t, (touch *)t->touches.items + i);
    return r;
}

result touch_cut(surface *s)
{
    const uint32_t count = surface_polygon_count(s);
    if (count == 0) return RESULT_OK;
    toucher t = {.s = s,
                 .frame = surface_frame_of(s),
                 .near = buffer_make(s->memory, sizeof(uint32_t)),
                 .touches = buffer_make(s->memory, sizeof(touch)),
                 .next = buffer_make(s->memory, sizeof(uint32_t))};
    t.boxes = memory_alloc(s->memory, count, sizeof(*t.boxes));
    for (uint32_t i = 0; i < count && t.boxes; ++i) t.boxes[i] = surface_frame_polygon(&t.frame, s, i, 0);
    result r = t.boxes ? box_tree_open(t.boxes, count, s->memory, &t.tree) : RESULT_NO_MEMORY;
    if (r == RESULT_OK) {
        r = find_and_cut(&t, count);
        box_tree_close(&t.tree, s->memory);
    }
    memory_free(s->memory, t.boxes, count, sizeof(*t.boxes));
    buffer_free(&t.near);
    buffer_free(&t.touches);
    buffer_free(&t.next);
    return r;
}
