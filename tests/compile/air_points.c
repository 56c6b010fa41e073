// Points in air: see air_points.h. By brute force over all triangles of the compiled scene's walls, seven ways.
// SPDX-License-Identifier: MIT
#include "air_points.h"

#include "host/import/views_space.h"

#include <math.h>
#include <stdlib.h>

enum { WAYS = 7 };

struct air_points {
    const scene *compiled;
    free_space *space;
    double origin[3], clearance;
};

air_points *air_points_open(const scene *raw, const scene *compiled, double clearance)
{
    air_points *a = calloc(1, sizeof *a);
    if (!a) return NULL;
    *a = (air_points){.compiled = compiled, .clearance = clearance};
    for (int k = 0; k < 3; ++k) a->origin[k] = raw->whole.origin[k];
    if (free_space_open(raw, a->origin, allocator_heap(), &a->space) == RESULT_OK) return a;
    free(a);
    return NULL;
}

void air_points_close(air_points *a)
{
    if (a) free_space_close(a->space);
    free(a);
}

// Moeller and Trumbore. Above 0 where the ray meets the triangle's front, below 0 its back, 0: not at all.
static double hit(const double p[3], const double ray[3], const double corner[3][3], double nearest)
{
    double u[3], v[3], from[3];
    for (int k = 0; k < 3; ++k) u[k] = corner[1][k] - corner[0][k], v[k] = corner[2][k] - corner[0][k], from[k] = p[k] - corner[0][k];
    const double h[3] = {ray[1] * v[2] - ray[2] * v[1], ray[2] * v[0] - ray[0] * v[2], ray[0] * v[1] - ray[1] * v[0]};
    const double det = (u[0] * h[0] + u[1] * h[1]) + u[2] * h[2];
    if (det == 0) return 0;
    const double a = ((from[0] * h[0] + from[1] * h[1]) + from[2] * h[2]) / det;
    if (!(a >= 0 && a <= 1)) return 0;
    const double q[3] = {from[1] * u[2] - from[2] * u[1], from[2] * u[0] - from[0] * u[2], from[0] * u[1] - from[1] * u[0]};
    const double b = ((ray[0] * q[0] + ray[1] * q[1]) + ray[2] * q[2]) / det;
    if (!(b >= 0 && a + b <= 1)) return 0;
    const double at = ((v[0] * q[0] + v[1] * q[1]) + v[2] * q[2]) / det;
    return at > 0 && at < nearest ? (det > 0 ? at : -at) : 0;
}

// Whether the ray comes through the item's box, which is padded.
static int meets_box(const cull_boxes *b, uint32_t i, const double p[3], const double ray[3])
{
    const double low[3] = {(double)b->min_x[i], (double)b->min_y[i], (double)b->min_z[i]};
    const double high[3] = {(double)b->max_x[i], (double)b->max_y[i], (double)b->max_z[i]};
    double from = 0, to = INFINITY;
    for (int k = 0; k < 3; ++k) {
        const double one = (low[k] - p[k]) / ray[k], two = (high[k] - p[k]) / ray[k]; // no way lies along an axis
        from = fmax(from, fmin(one, two));
        to = fmin(to, fmax(one, two));
    }
    return from <= to;
}

static int sees_a_front(const scene *s, const double p[3], const double ray[3])
{
    double nearest = INFINITY;
    int front = 0;
    for (uint32_t i = 0; i < s->item_count; ++i) {
        if (!(s->items[i].flags & CULL_ITEM_WALL) || s->items[i].flags & (CULL_ITEM_TWO_SIDED | CULL_ITEM_SEE_THROUGH)) continue;
        if (!meets_box(&s->boxes, i, p, ray)) continue;
        const uint32_t first = s->items[i].first_index;
        for (uint32_t t = first; t < first + s->items[i].index_count; t += 3) {
            double corner[3][3];
            for (uint32_t c = 0; c < 3; ++c) {
                const cull_vec3 v = s->positions[s->indices[t + c]];
                corner[c][0] = (double)v.x, corner[c][1] = (double)v.y, corner[c][2] = (double)v.z;
            }
            const double at = hit(p, ray, (const double(*)[3])corner, nearest);
            if (at == 0) continue;
            nearest = fabs(at);
            front = at > 0;
        }
    }
    return front;
}

point_place air_points_place(const air_points *a, const double world[3])
{
    static const double ways[WAYS][3] = {{1, 0.013, 0.007},    {-1, 0.011, -0.017}, {0.019, 1, 0.003},  {-0.005, -1, 0.023},
                                         {0.029, -0.031, 1}, {0.009, 0.027, -1},  {0.61, 0.53, -0.57}}; // skew to what maps hold
    double p[3], from_compiled[3];
    for (int k = 0; k < 3; ++k) p[k] = world[k] - a->origin[k], from_compiled[k] = world[k] - a->compiled->whole.origin[k];
    if (!(free_space_clearance(a->space, p, a->clearance, SPACE_SOLIDS | SPACE_TRIANGLES) >= a->clearance)) return POINT_SOLID;
    int fronts = 0, others = 0;
    for (int w = 0; w < WAYS && 2 * fronts < WAYS && 2 * others < WAYS; ++w) {
        const int front = sees_a_front(a->compiled, from_compiled, ways[w]);
        fronts += front;
        others += !front;
    }
    return fronts > others ? POINT_AIR : POINT_VOID;
}
