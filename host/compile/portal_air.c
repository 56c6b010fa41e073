// Convex less convex in one plane, cut along the edge that leaves most uncut, and the brushes' order of adding and taking.
// SPDX-License-Identifier: MIT
#include "input_order.h"
#include "portals.h"

#include <math.h>

typedef enum air_side { AIR_FRONT, AIR_BEHIND } air_side; // of the polygon's plane
typedef enum air_state { STATE_AIR, STATE_SOLID } air_state;
typedef struct air_piece { uint32_t polygon; air_state state; } air_piece;

static const double UNLIKELY_TIE = 1.37; // whole areas are not half way between two floats then

typedef struct air_clip {
    surface *s;
    buffer *pieces;           // air_piece
    const plane_ref *planes;  // of the body that is taken away, those on the polygon's plane left out
    uint32_t plane_count;
    place_order order;
    air_state to;             // what lies inside the body becomes
} air_clip;

// Square steps, rounded: to choose among cuts that are all right.
static double area_in_front(const surface *s, uint32_t polygon, plane_ref by)
{
    const surface_polygon *p = surface_polygon_at(s, polygon);
    const surface_corner *c = surface_corners(s, p);
    const cull_wide_plane plane = plane_table_get(s->planes, by);
    double sum[3] = {0, 0, 0}, first[3] = {0, 0, 0}, last[3] = {0, 0, 0};
    int have = 0;
    for (uint32_t i = 0; i < p->count; ++i) {
        const double *a = surface_vertex_at(s, c[i].vertex)->position, *b = surface_vertex_at(s, c[i + 1 < p->count ? i + 1 : 0].vertex)->position;
        double h[2] = {cull_wide_to_double(plane.offset), cull_wide_to_double(plane.offset)};
        for (int k = 0; k < 3; ++k) h[0] += (double)plane.normal[k] * a[k], h[1] += (double)plane.normal[k] * b[k];
        for (int turn = 0; turn < 2; ++turn) {
            if (turn == 0 ? h[0] < 0 : (h[0] < 0) == (h[1] < 0)) continue;
            const double t = turn == 0 ? 0 : h[0] / (h[0] - h[1]);
            double at[3];
            for (int k = 0; k < 3; ++k) at[k] = a[k] + (b[k] - a[k]) * t;
            for (int k = 0; k < 3 && have; ++k) {
                const int m = (k + 1) % 3, n = (k + 2) % 3;
                sum[k] += (last[m] - first[m]) * (at[n] - first[n]) - (last[n] - first[n]) * (at[m] - first[m]);
            }
            for (int k = 0; k < 3; ++k) last[k] = at[k], first[k] = have ? first[k] : at[k];
            have = 1;
        }
    }
    return sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
}

// 1: `out` is the plane to cut by next; 0: the polygon lies inside; -1: it doesn't touch the inside.
static int next_plane(const air_clip *c, uint32_t polygon, plane_ref *out)
{
    double most = -1;
    for (uint32_t i = 0; i < c->plane_count; ++i) {
        const cut_result place = surface_classify(c->s, polygon, c->planes[i]);
        if (place == CUT_FRONT) return -1;
        if (place != CUT_BOTH) continue;
        const double area = (float)(area_in_front(c->s, polygon, c->planes[i]) * UNLIKELY_TIE); // far coarser than it errs
        if (area < most) continue;
        const cull_wide_plane *plane = plane_table_canonical(c->s->planes, c->planes[i]);
        if (area == most && compare_plane_places(&c->order, plane, plane_table_canonical(c->s->planes, *out)) >= 0) continue;
        most = area;
        *out = c->planes[i];
    }
    return most >= 0;
}

static result copy_polygon(surface *s, uint32_t polygon, uint32_t *out)
{
    surface_polygon copy = *surface_polygon_at(s, polygon);
    if (!buffer_append(&s->polygons, &copy, 1)) return RESULT_NO_MEMORY;
    *out = surface_polygon_count(s) - 1;
    return RESULT_OK;
}

static result take_body(air_clip *c, size_t piece)
{
    const size_t before = c->pieces->count;
    const air_piece old = ((air_piece *)c->pieces->items)[piece];
    uint32_t rest;
    result r = copy_polygon(c->s, old.polygon, &rest);
    int next = 1;
    while (r == RESULT_OK) {
        plane_ref by = PLANE_NONE;
        next = next_plane(c, rest, &by);
        if (next <= 0) break;
        const air_piece outside = {rest, old.state}; // the front part keeps the polygon's number
        r = surface_cut(c->s, rest, by, &rest);
        if (r == RESULT_OK && !buffer_append(c->pieces, &outside, 1)) r = RESULT_NO_MEMORY;
    }
    if (r != RESULT_OK) return r;
    if (next < 0) {
        c->pieces->count = before; // none of it is inside: nothing was to be cut
        return RESULT_OK;
    }
    const air_piece inside = {rest, c->to};
    ((air_piece *)c->pieces->items)[piece] = inside;
    return RESULT_OK;
}

// The planes of the brush, without one on the polygon's; 0: the brush lies on the other side of it.
static int body_planes(const compile_input *in, uint32_t brush, plane_ref own, air_side side, plane_ref *planes, uint32_t *count)
{
    const compile_brush *b = &in->brushes[brush];
    *count = 0;
    for (uint32_t f = 0; f < b->face_count; ++f) {
        const plane_ref plane = in->faces[b->first_face + f].plane;
        if (plane >> 1 != own >> 1) planes[(*count)++] = plane;
        else if ((plane == own) == (side == AIR_FRONT)) return 0;
    }
    return 1;
}

static int boxes_touch(const surface_polygon *p, const compile_brush *b)
{
    for (int k = 0; k < 3; ++k)
        if (p->min[k] > b->max[k] + 1.0 || p->max[k] < b->min[k] - 1.0) return 0;
    return 1;
}

static result clip_side(air_clip *c, const compile_input *in, plane_ref own, air_side side, const uint32_t *brushes, uint32_t count)
{
    uint32_t most = 0;
    for (uint32_t i = 0; i < count; ++i) most = in->brushes[brushes[i]].face_count > most ? in->brushes[brushes[i]].face_count : most;
    plane_ref *planes = memory_alloc(c->s->memory, most, sizeof(*planes));
    result r = planes ? RESULT_OK : RESULT_NO_MEMORY;
    c->planes = planes;
    for (uint32_t i = 0; i < count && r == RESULT_OK; ++i) {
        const compile_brush *b = &in->brushes[brushes[i]];
        if (!body_planes(in, brushes[i], own, side, planes, &c->plane_count)) continue;
        const air_state from = b->kind == BRUSH_ADD ? STATE_AIR : STATE_SOLID;
        c->to = b->kind == BRUSH_ADD ? STATE_SOLID : STATE_AIR;
        for (size_t k = c->pieces->count; k-- > 0 && r == RESULT_OK;) {
            const air_piece *piece = (air_piece *)c->pieces->items + k;
            if (piece->state == from && boxes_touch(surface_polygon_at(c->s, piece->polygon), b)) r = take_body(c, k);
        }
    }
    memory_free(c->s->memory, planes, most, sizeof(*planes));
    return r;
}

static void keep_air(buffer *pieces)
{
    air_piece *p = pieces->items;
    size_t kept = 0;
    for (size_t i = 0; i < pieces->count; ++i)
        if (p[i].state == STATE_AIR) p[kept++] = p[i];
    pieces->count = kept;
}

result portal_air(surface *s, const compile_input *in, uint32_t polygon, const uint32_t *brushes, uint32_t count, buffer *out)
{
    buffer pieces = buffer_make(s->memory, sizeof(air_piece));
    const air_piece whole = {polygon, STATE_AIR};
    const plane_ref own = surface_polygon_at(s, polygon)->plane;
    air_clip c = {.s = s, .pieces = &pieces, .order = place_order_of(in->brushes, in->brush_count)};
    result r = buffer_append(&pieces, &whole, 1) ? RESULT_OK : RESULT_NO_MEMORY;
    for (int side = 0; side < 2 && r == RESULT_OK; ++side) {
        r = clip_side(&c, in, own, side ? AIR_BEHIND : AIR_FRONT, brushes, count);
        keep_air(&pieces);
    }
    for (size_t i = 0; i < pieces.count && r == RESULT_OK; ++i)
        if (!buffer_append(out, &((air_piece *)pieces.items)[i].polygon, 1)) r = RESULT_NO_MEMORY;
    buffer_free(&pieces);
    return r;
}

result portal_without(surface *s, uint32_t polygon, uint32_t other, buffer *out)
{
    const surface_polygon body = *surface_polygon_at(s, other);
    buffer pieces = buffer_make(s->memory, sizeof(air_piece));
    const air_piece whole = {polygon, STATE_AIR};
    plane_ref *planes = memory_alloc(s->memory, body.count, sizeof(*planes));
    result r = planes && buffer_append(&pieces, &whole, 1) ? RESULT_OK : RESULT_NO_MEMORY;
    for (uint32_t i = 0; i < body.count && r == RESULT_OK; ++i) planes[i] = surface_corners(s, &body)[i].edge;
    air_clip c = {.s = s, .pieces = &pieces, .planes = planes, .plane_count = body.count, .to = STATE_SOLID};
    if (r == RESULT_OK) r = take_body(&c, 0);
    keep_air(&pieces);
    for (size_t i = 0; i < pieces.count && r == RESULT_OK; ++i)
        if (!buffer_append(out, &((air_piece *)pieces.items)[i].polygon, 1)) r = RESULT_NO_MEMORY;
    memory_free(s->memory, planes, body.count, sizeof(*planes));
    buffer_free(&pieces);
    return r;
}
