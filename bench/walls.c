// Walls: see walls.h. Facing is that of the triangles as they are drawn, in double, where positions are exact.
// SPDX-License-Identifier: MIT
#include "walls.h"

#include <math.h>
#include <string.h>

walls walls_of_chain(const cull_descriptor *d, const chain_spec *spec)
{
    static const char *const key = "backface"; // reserved by culler.h for this
    const chain_stage_spec *first = &spec->stages[0];
    const char *value = "0";
    for (uint32_t i = 0; i < d->option_count; ++i)
        if (strcmp(d->options[i].key, key) == 0) value = d->options[i].fallback;
    for (uint32_t i = 0; i < first->option_count; ++i)
        if (strcmp(first->options[i].key, key) == 0) value = first->options[i].value;
    return strcmp(value, "1") == 0 ? WALLS_FRONT_ONLY : WALLS_BOTH_SIDES;
}

typedef struct onlooker {
    double eye[3], forward[3]; // relative to the scene's origin
    double near_m, thin;       // thin: on the picture at distance 1 along forward
} onlooker;

typedef enum wall_side { SIDE_FRONT, SIDE_EDGE, SIDE_BACK, SIDE_NONE } wall_side;

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// Of the triangle's back, `behind` in front of the eye along the normal: its plane is seen as a line, and a corner at some depth lies
// behind / depth beside that line, over the part of the unit normal that lies in the picture.
static int is_thin(const onlooker *o, double (*corners)[3], const double normal[3], double behind)
{
    const double along = dot(normal, o->forward), across = dot(normal, normal) - along * along;
    double nearest = INFINITY;
    for (int i = 0; i < 3; ++i) nearest = fmin(nearest, dot(corners[i], o->forward));
    return across > 0 && behind <= o->thin * fmax(nearest, o->near_m) * sqrt(across);
}

// An eye in the wall's plane sees no back: leaving the wall out would open a seam of the rasterizer's rounding beside it.
static wall_side triangle_side(const scene *s, uint32_t first_index, const onlooker *o)
{
    double at[3][3], from_eye[3][3], u[3], v[3], normal[3];
    for (uint32_t i = 0; i < 3; ++i) {
        const cull_vec3 p = s->positions[s->indices[first_index + i]];
        at[i][0] = (double)p.x, at[i][1] = (double)p.y, at[i][2] = (double)p.z;
        for (int k = 0; k < 3; ++k) from_eye[i][k] = at[i][k] - o->eye[k];
    }
    for (int k = 0; k < 3; ++k) {
        u[k] = at[1][k] - at[0][k];
        v[k] = at[2][k] - at[0][k];
    }
    for (int k = 0; k < 3; ++k) normal[k] = u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
    if (normal[0] == 0 && normal[1] == 0 && normal[2] == 0) return SIDE_NONE;
    const double behind = dot(normal, from_eye[0]);
    if (behind <= 0) return SIDE_FRONT;
    return is_thin(o, from_eye, normal, behind) ? SIDE_EDGE : SIDE_BACK;
}

// The front of any of its triangles is seen; else the back of any.
static wall_side wall_side_of(const scene *s, const scene_item *item, const onlooker *o)
{
    wall_side side = SIDE_NONE;
    for (uint32_t i = 0; i < item->index_count; i += 3) {
        const wall_side one = triangle_side(s, item->first_index + i, o);
        if (one == SIDE_FRONT) return SIDE_FRONT;
        if (one == SIDE_BACK || side == SIDE_NONE) side = one == SIDE_NONE ? side : one;
    }
    return side;
}

static onlooker onlooker_of(const scene *s, const walls_view *v)
{
    view_base base;
    const view_frame frame = {.width_px = v->width_px, .height_px = v->height_px};
    view_base_make(v->camera, &frame, &base);
    onlooker o = {.near_m = v->camera->near_m, .thin = CULL_GUARD_PX * base.pixel_tangent};
    for (int k = 0; k < 3; ++k) {
        o.eye[k] = v->camera->eye[k] - s->whole.origin[k];
        o.forward[k] = -base.back[k];
    }
    return o;
}

void walls_in_front(const scene *s, const walls_view *v, uint32_t *shown, uint32_t *edge_on)
{
    const onlooker o = onlooker_of(s, v);
    const size_t words = (s->item_count + s->mover_count + 31) / 32;
    memset(shown, 0xff, words * sizeof *shown);
    memset(edge_on, 0, words * sizeof *edge_on);
    for (uint32_t i = 0; i < s->item_count; ++i) {
        if ((s->items[i].flags & (CULL_ITEM_WALL | CULL_ITEM_TWO_SIDED)) != CULL_ITEM_WALL) continue;
        const wall_side side = wall_side_of(s, &s->items[i], &o);
        if (side == SIDE_FRONT) continue;
        shown[i / 32] &= ~(1u << (i % 32));
        if (side == SIDE_EDGE) edge_on[i / 32] |= 1u << (i % 32);
    }
}
