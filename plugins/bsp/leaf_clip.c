// One item against one volume: see leaf_clip.h. First each vertex's place (Cohen and Sutherland's outcodes), and only where those do not
// settle it the polygon itself (Sutherland and Hodgman, Reentrant Polygon Clipping, 1974).
// SPDX-License-Identifier: MIT
#include "leaf_clip.h"

// One polygon of a shape.
typedef struct loop {
    const bsp_lane *lanes;
    uint32_t vertex_count, lane_count;
} loop;

static cull_point vertex_at(const bsp_lane *lanes, uint32_t i)
{
    const bsp_lane *l = &lanes[i / 4];
    const cull_point p = {(double)l->x[i % 4], (double)l->y[i % 4], (double)l->z[i % 4]};
    return p;
}

static uint32_t clip_against(const cull_point *in, uint32_t count, const clip_request *q, uint32_t k, cull_point *out)
{
    const bsp_volume *v = q->volume;
    const cull_cut cut = {(double)v->x[k], (double)v->y[k], (double)v->z[k], (double)v->offset[k]};
    return cull_polygon_clip(in, count, cut, out, q->room.capacity);
}

// `cuts`: the planes that some vertex lies outside of.
static clip_fate clip_polygon(const clip_request *q, const loop *l, uint32_t cuts, uint32_t *out_plane)
{
    cull_point *from = q->room.points[0], *to = q->room.points[1];
    uint32_t count = l->vertex_count;
    for (uint32_t i = 0; i < count; i++) from[i] = vertex_at(l->lanes, i);
    for (; cuts; cuts &= cuts - 1) {
        *out_plane = lowest_bit(cuts);
        count = clip_against(from, count, q, *out_plane, to);
        if (!count) return CLIP_NOTHING;
        if (count == q->room.capacity) return CLIP_KEPT; // a loop bent so far that points may be missing
        cull_point *const spare = from;
        from = to;
        to = spare;
    }
    return CLIP_KEPT;
}

// Bits of four vertices that lie outside plane k.
static inline uint32_t lane_outside(const bsp_volume *v, uint32_t k, const bsp_lane *lane)
{
    uint32_t bits = 0;
    for (int i = 0; i < 4; i += LANES) {
        const lanes x = lanes_mul(lanes_load(lane->x + i), lanes_of(v->x[k])), y = lanes_mul(lanes_load(lane->y + i), lanes_of(v->y[k]));
        const lanes z = lanes_mul(lanes_load(lane->z + i), lanes_of(v->z[k]));
        bits |= lanes_negative(lanes_height(x, y, z, lanes_of(v->offset[k]))) << i;
    }
    return bits & 15; // eight lanes read on into what follows
}

static inline clip_fate clip_loop(const clip_request *q, const loop *l, uint32_t *out_plane)
{
    uint32_t cuts = 0, beyond = q->which; // planes with some vertex outside, with every one
    for (uint32_t i = 0; i < l->lane_count; i++) {
        uint32_t somewhere = 0; // vertices outside any plane
        for (uint32_t rest = q->which; rest; rest &= rest - 1) {
            const uint32_t outside = lane_outside(q->volume, lowest_bit(rest), &l->lanes[i]), bit = rest & (0u - rest);
            somewhere |= outside;
            if (outside) cuts |= bit;
            if (outside != 15) beyond &= ~bit;
        }
        if (somewhere != 15) return CLIP_KEPT; // a vertex is inside all of them
    }
    if (beyond) {
        *out_plane = lowest_bit(beyond);
        return CLIP_BEYOND;
    }
    return clip_polygon(q, l, cuts, out_plane);
}

// BEYOND, where one plane has all of it outside; NOTHING, where it takes several.
static clip_fate clip_triangles(const clip_request *q, const bsp_shape *s, uint32_t *out_plane)
{
    uint32_t beyond = q->which;
    for (uint32_t i = 0; i < s->head.lane_count; i++) {
        const loop triangle = {&s->lanes[i], 3, 1};
        if (clip_loop(q, &triangle, out_plane) == CLIP_KEPT) return CLIP_KEPT;
        for (uint32_t rest = beyond; rest; rest &= rest - 1)
            if (lane_outside(q->volume, lowest_bit(rest), &s->lanes[i]) != 15) beyond &= ~(rest & (0u - rest));
    }
    if (!beyond) return CLIP_NOTHING;
    *out_plane = lowest_bit(beyond);
    return CLIP_BEYOND;
}

static clip_fate clip_box(const clip_request *q, const bsp_lane *box, uint32_t *out_plane)
{
    uint32_t cuts;
    if (volume_cuts(q->volume, q->which, box->x, box->y, &cuts) == VOLUME_TOUCHES) return CLIP_KEPT;
    for (uint32_t rest = q->which; rest; rest &= rest - 1) {
        *out_plane = lowest_bit(rest);
        if (volume_cuts(q->volume, rest & (0u - rest), box->x, box->y, &cuts) == VOLUME_OUTSIDE) break;
    }
    return CLIP_BEYOND;
}

clip_fate clip_shape(const clip_request *q, const bsp_shape *s, uint32_t *out_plane)
{
    const loop whole = {s->lanes, s->head.vertex_count, s->head.lane_count};
    if (s->head.kind == SHAPE_LOOP) return clip_loop(q, &whole, out_plane);
    return s->head.kind == SHAPE_BOX ? clip_box(q, s->lanes, out_plane) : clip_triangles(q, s, out_plane);
}
