// Shapes of generated scenes: blocks, walls with openings, smooth surfaces. See generate_obj.h.
// SPDX-License-Identifier: MIT
#include "generate_obj.h"

#include <assert.h>
#include <math.h>

static int32_t number_of(double metres) // to the nearest, halves up
{
    return (int32_t)floor(metres * METRE + 0.5);
}

block block_at(double x, double z, double y, double wide, double deep, double high)
{
    return (block){.min = {number_of(x - wide / 2), number_of(y), number_of(z - deep / 2)},
                   .max = {number_of(x + wide / 2), number_of(y + high), number_of(z + deep / 2)}};
}

void cuts_add(cuts *c, int32_t at)
{
    uint32_t i = 0;
    while (i < c->count && c->at[i] < at) i++;
    if (i < c->count && c->at[i] == at) return;
    assert(c->count < CUTS_MOST);
    if (c->count == CUTS_MOST) return;
    for (uint32_t k = c->count++; k > i; --k) c->at[k] = c->at[k - 1];
    c->at[i] = at;
}

// The point (u, v) of a side, moved `inwards` into the block.
static place side_place(const block *b, side s, int32_t u, int32_t v, int32_t inwards)
{
    switch (s) {
    case SIDE_MIN_X: return (place){b->min.x + inwards, v, u};
    case SIDE_MAX_X: return (place){b->max.x - inwards, v, u};
    case SIDE_MIN_Y: return (place){u, b->min.y + inwards, v};
    case SIDE_MAX_Y: return (place){u, b->max.y - inwards, v};
    case SIDE_MIN_Z: return (place){u, v, b->min.z + inwards};
    default: return (place){u, v, b->max.z - inwards};
    }
}

// u x v points to -x, -y, +z: does a rectangle u0v0 u1v0 u1v1 u0v1 face that way?
static int turns_forward(side s, facing f)
{
    const int outward_is_forward = s == SIDE_MIN_X || s == SIDE_MIN_Y || s == SIDE_MAX_Z;
    return (f == FACING_OUT) == outward_is_forward;
}

static void quad_write(obj_writer *w, place a, place b, place c, place d, int forward)
{
    const place straight[4] = {a, b, c, d}, turned[4] = {a, d, c, b};
    obj_polygon(w, forward ? straight : turned, 4);
}

static void rectangle_write(obj_writer *w, const panel *p, rectangle q, int32_t inwards)
{
    const block *b = p->body;
    quad_write(w, side_place(b, p->side, q.u0, q.v0, inwards), side_place(b, p->side, q.u1, q.v0, inwards),
               side_place(b, p->side, q.u1, q.v1, inwards), side_place(b, p->side, q.u0, q.v1, inwards),
               turns_forward(p->side, p->facing));
}

static int in_an_opening(const panel *p, rectangle q)
{
    for (uint32_t i = 0; i < p->opening_count; ++i) {
        const rectangle *o = &p->openings[i];
        if (q.u0 >= o->u0 && q.u1 <= o->u1 && q.v0 >= o->v0 && q.v1 <= o->v1) return 1;
    }
    return 0;
}

void obj_panel(obj_writer *w, const panel *p)
{
    for (uint32_t v = 0; v + 1 < p->v->count; ++v)
        for (uint32_t u = 0; u + 1 < p->u->count; ++u) {
            const rectangle q = {p->u->at[u], p->v->at[v], p->u->at[u + 1], p->v->at[v + 1]};
            if (!in_an_opening(p, q)) rectangle_write(w, p, q, 0);
        }
}

// One strip of a reveal, from (u0, v0) to (u1, v1) on the rim, in the sense that turns round the opening.
static void strip_write(obj_writer *w, const panel *p, rectangle rim, int32_t inwards)
{
    const block *b = p->body;
    quad_write(w, side_place(b, p->side, rim.u0, rim.v0, 0), side_place(b, p->side, rim.u1, rim.v1, 0),
               side_place(b, p->side, rim.u1, rim.v1, inwards), side_place(b, p->side, rim.u0, rim.v0, inwards),
               !turns_forward(p->side, p->facing));
}

void obj_reveal(obj_writer *w, const panel *p, uint32_t i, int32_t depth)
{
    const rectangle o = p->openings[i];
    const int32_t inwards = p->facing == FACING_OUT ? depth : -depth; // the solid lies outside of a room
    for (uint32_t k = 0; k + 1 < p->u->count; ++k) {
        const int32_t from = p->u->at[k], to = p->u->at[k + 1];
        if (from < o.u0 || to > o.u1) continue;
        strip_write(w, p, (rectangle){to, o.v0, from, o.v0}, inwards);
        strip_write(w, p, (rectangle){from, o.v1, to, o.v1}, inwards);
    }
    for (uint32_t k = 0; k + 1 < p->v->count; ++k) {
        const int32_t from = p->v->at[k], to = p->v->at[k + 1];
        if (from < o.v0 || to > o.v1) continue;
        strip_write(w, p, (rectangle){o.u0, from, o.u0, to}, inwards);
        strip_write(w, p, (rectangle){o.u1, to, o.u1, from}, inwards);
    }
}

void obj_pane(obj_writer *w, const panel *p, uint32_t i, int32_t depth)
{
    rectangle_write(w, p, p->openings[i], p->facing == FACING_OUT ? depth : -depth);
}

void obj_block(obj_writer *w, const block *b)
{
    for (side s = SIDE_MIN_X; s <= SIDE_MAX_Z; ++s) {
        const int on_x = s == SIDE_MIN_X || s == SIDE_MAX_X, on_y = s == SIDE_MIN_Y || s == SIDE_MAX_Y;
        const panel p = {.body = b, .side = s, .facing = FACING_OUT};
        const rectangle q = {on_x ? b->min.z : b->min.x, on_y ? b->min.z : b->min.y, on_x ? b->max.z : b->max.x,
                             on_y ? b->max.z : b->max.y};
        rectangle_write(w, &p, q, 0);
    }
}

static place surface_place(const surface *s, uint32_t i, uint32_t k, spot at)
{
    const double u = (double)(i % s->around) / s->around;
    const double v = (double)(s->is_ring ? k % s->along : k) / s->along;
    const spot p = s->point(s->shape, u, v);
    return (place){number_of(p.x + at.x), number_of(p.y + at.y), number_of(p.z + at.z)};
}

void obj_surface(obj_writer *w, const surface *s, spot at)
{
    for (uint32_t k = 0; k < s->along; ++k)
        for (uint32_t i = 0; i < s->around; ++i) {
            const place a = surface_place(s, i, k, at), b = surface_place(s, i, k + 1, at);
            const place c = surface_place(s, i + 1, k + 1, at), d = surface_place(s, i + 1, k, at);
            obj_polygon(w, (const place[3]){a, b, c}, 3);
            obj_polygon(w, (const place[3]){a, c, d}, 3);
        }
}
