// Axes that turn with the surface: see surface_frame.h. Which polygon is the largest decides about speed alone.
// SPDX-License-Identifier: MIT
#include "surface_frame.h"

#include <math.h>
#include <string.h>

static const double RIGHT_ANGLE = 1e-9; // cosine

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void unit_normal(const surface *s, const surface_polygon *p, double out[3])
{
    const cull_row *row = plane_table_row(s->planes, p->plane);
    const double length = sqrt(dot(row->n, row->n));
    for (int k = 0; k < 3; ++k) out[k] = row->n[k] / length;
}

static double area_of(const surface *s, const surface_polygon *p)
{
    const surface_corner *c = surface_corners(s, p);
    const double *o = surface_vertex_at(s, c[0].vertex)->position;
    double sum[3] = {0, 0, 0};
    for (uint32_t i = 1; i + 1 < p->count; ++i) {
        const double *a = surface_vertex_at(s, c[i].vertex)->position, *b = surface_vertex_at(s, c[i + 1].vertex)->position;
        for (int k = 0; k < 3; ++k) {
            const int m = (k + 1) % 3, n = (k + 2) % 3;
            sum[k] += (a[m] - o[m]) * (b[n] - o[n]) - (a[n] - o[n]) * (b[m] - o[m]);
        }
    }
    return dot(sum, sum);
}

// The normal of the largest polygon, at right angles to `to` unless that is NULL; 0: there is none.
static int largest(const surface *s, const double to[3], double out[3])
{
    double most = 0;
    for (uint32_t i = 0; i < surface_polygon_count(s); ++i) {
        const surface_polygon *p = surface_polygon_at(s, i);
        double normal[3];
        unit_normal(s, p, normal);
        if (to && fabs(dot(normal, to)) > RIGHT_ANGLE) continue;
        const double area = area_of(s, p);
        if (area <= most) continue;
        most = area;
        memcpy(out, normal, sizeof normal);
    }
    return most > 0;
}

surface_frame surface_frame_of(const surface *s)
{
    const surface_frame scene = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    surface_frame f = scene;
    if (!largest(s, NULL, f.axes[0]) || !largest(s, f.axes[0], f.axes[1])) return scene;
    for (int k = 0; k < 3; ++k) {
        const int m = (k + 1) % 3, n = (k + 2) % 3;
        f.axes[2][k] = f.axes[0][m] * f.axes[1][n] - f.axes[0][n] * f.axes[1][m];
    }
    return f;
}

static void widen(tree_box *box, const surface_frame *f, const surface *s, uint32_t vertex, double margin)
{
    const double *p = surface_vertex_at(s, vertex)->position;
    for (int k = 0; k < 3; ++k) {
        const double at = dot(f->axes[k], p);
        if (at - margin < box->min[k]) box->min[k] = at - margin;
        if (at + margin > box->max[k]) box->max[k] = at + margin;
    }
}

static tree_box nothing(void)
{
    return (tree_box){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
}

tree_box surface_frame_vertex(const surface_frame *f, const surface *s, uint32_t vertex, double margin)
{
    tree_box box = nothing();
    widen(&box, f, s, vertex, margin);
    return box;
}

tree_box surface_frame_edge(const surface_frame *f, const surface *s, const uint32_t ends[2], double margin)
{
    tree_box box = nothing();
    for (int i = 0; i < 2; ++i) widen(&box, f, s, ends[i], margin);
    return box;
}

tree_box surface_frame_polygon(const surface_frame *f, const surface *s, uint32_t polygon, double margin)
{
    const surface_polygon *p = surface_polygon_at(s, polygon);
    tree_box box = nothing();
    for (uint32_t i = 0; i < p->count; ++i) widen(&box, f, s, surface_corners(s, p)[i].vertex, margin);
    return box;
}
