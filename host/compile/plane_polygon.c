// Polygons made of planes: see plane_polygon.h. Clipping keeps or inserts plane references; corners are classified exactly.
// SPDX-License-Identifier: MIT
#include "plane_polygon.h"

#include <math.h>
#include <string.h>

polygon_place polygon_signs(const plane_table *t, plane_ref polygon, const polygon_edge *edges, uint32_t count, plane_ref by, int8_t *signs)
{
    unsigned place = POLYGON_ON;
    for (uint32_t i = 0; i < count; ++i) {
        plane_ref meet[3];
        polygon_corner(polygon, edges, count, i, meet);
        const int side = plane_table_side_at(t, meet, edges[i].start, by);
        signs[i] = (int8_t)side;
        place |= side > 0 ? POLYGON_FRONT : side < 0 ? POLYGON_BEHIND : POLYGON_ON;
    }
    return (polygon_place)place;
}

// Where edge `at` passes to the other side of `by`.
static polygon_edge crossing(const plane_table *t, plane_ref polygon, const polygon_edge *edges, uint32_t at, plane_ref by)
{
    polygon_edge out = {.plane = by};
    const plane_ref meet[3] = {polygon, edges[at].plane, by};
    plane_table_position(t, meet, out.start);
    return out;
}

typedef struct cut_state {
    polygon_edge into, back; // where the loop leaves and enters the side behind
    const int8_t *signs;
    uint32_t count;
} cut_state;

// The part whose corners have the sign `side`; `cut` is the new edge's plane with that part behind it.
static uint32_t copy_part(const polygon_edge *from, const cut_state *c, int side, plane_ref cut, polygon_edge *out)
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < c->count; ++i) {
        const uint32_t next = i + 1 < c->count ? i + 1 : 0;
        const int here = c->signs[i] * side, there = c->signs[next] * side;
        if (here <= 0 && there <= 0) continue;
        out[n] = from[i];
        if (here < 0) memcpy(out[n].start, side < 0 ? c->back.start : c->into.start, sizeof out[n].start);
        ++n;
        if (there > 0) continue;
        out[n] = (polygon_edge){.plane = cut};
        memcpy(out[n].start, there == 0 ? from[next].start : side < 0 ? c->into.start : c->back.start, sizeof out[n].start);
        ++n;
    }
    return n;
}

int polygon_cut(const plane_table *t, const plane_polygon *p, const int8_t *signs, plane_ref by, buffer *edges, polygon_parts out)
{
    const size_t room = (size_t)p->count + 2, base = edges->count;
    if (base + 2 * room > UINT32_MAX || !buffer_push(edges, 2 * room)) return 0;
    polygon_edge *all = edges->items, *to = all + base;
    const polygon_edge *from = all + p->first;
    cut_state c = {.signs = signs, .count = p->count};
    for (uint32_t i = 0; i < p->count; ++i) {
        const int here = signs[i], there = signs[i + 1 < p->count ? i + 1 : 0];
        if (here < 0 && there > 0) c.into = crossing(t, p->plane, from, i, by);
        if (here > 0 && there < 0) c.back = crossing(t, p->plane, from, i, by);
    }
    const plane_ref plane = p->plane;
    uint32_t used = 0;
    if (out.behind) {
        used = copy_part(from, &c, -1, by, to);
        *out.behind = (plane_polygon){plane, (uint32_t)base, used};
    }
    if (out.front) {
        const uint32_t count = copy_part(from, &c, 1, plane_ref_flipped(by), to + used);
        *out.front = (plane_polygon){plane, (uint32_t)base + used, count};
        used += count;
    }
    edges->count = base + used;
    return 1;
}

double polygon_area(const polygon_edge *edges, uint32_t count)
{
    double sum[3] = {0, 0, 0};
    for (uint32_t i = 1; i + 1 < count; ++i) {
        double u[3], v[3];
        for (int k = 0; k < 3; ++k) {
            u[k] = edges[i].start[k] - edges[0].start[k];
            v[k] = edges[i + 1].start[k] - edges[0].start[k];
        }
        for (int k = 0; k < 3; ++k) sum[k] += u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
    }
    return 0.5 * sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
}
