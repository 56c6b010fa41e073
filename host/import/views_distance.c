// Distances: see views_distance.h. The closest point of a triangle by its Voronoi regions (Ericson 2004, 5.1.5).
// SPDX-License-Identifier: MIT
#include "views_distance.h"

#include <math.h>

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void minus(const double a[3], const double b[3], double out[3])
{
    for (int k = 0; k < 3; ++k) out[k] = a[k] - b[k];
}

double distance_to_box(const double p[3], const double min[3], const double max[3])
{
    double out[3];
    for (int k = 0; k < 3; ++k) out[k] = fmax(fmax(min[k] - p[k], p[k] - max[k]), 0);
    return sqrt(dot(out, out));
}

// From p to from + s * along + t * across.
static double distance_at(const double from_to_p[3], const double along[3], double s, const double across[3], double t)
{
    double rest[3];
    for (int k = 0; k < 3; ++k) rest[k] = from_to_p[k] - s * along[k] - t * across[k];
    return sqrt(dot(rest, rest));
}

double distance_to_triangle(const double p[3], const double (*triangle)[3])
{
    double ab[3], ac[3], ap[3], bp[3], cp[3];
    minus(triangle[1], triangle[0], ab);
    minus(triangle[2], triangle[0], ac);
    minus(p, triangle[0], ap);
    minus(p, triangle[1], bp);
    minus(p, triangle[2], cp);
    const double d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp), d6 = dot(ac, cp);
    if (d1 <= 0 && d2 <= 0) return sqrt(dot(ap, ap));
    if (d3 >= 0 && d4 <= d3) return sqrt(dot(bp, bp));
    if (d6 >= 0 && d5 <= d6) return sqrt(dot(cp, cp));
    const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return distance_at(ap, ab, d1 / (d1 - d3), ac, 0);
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return distance_at(ap, ab, 0, ac, d2 / (d2 - d6));
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        const double t = (d4 - d3) / (d4 - d3 + (d5 - d6));
        return distance_at(ap, ab, 1 - t, ac, t);
    }
    const double all = va + vb + vc;
    return distance_at(ap, ab, vb / all, ac, vc / all);
}

double distance_along_axis(const double p[3], axis_ray ray, const double (*triangle)[3], double *facing)
{
    const int u = (ray.axis + 1) % 3, v = (ray.axis + 2) % 3;
    double q[3][3], edge[3];
    for (int c = 0; c < 3; ++c) minus(triangle[c], p, q[c]);
    for (int c = 0; c < 3; ++c) edge[c] = q[(c + 1) % 3][u] * q[(c + 2) % 3][v] - q[(c + 1) % 3][v] * q[(c + 2) % 3][u];
    const int all_up = edge[0] >= 0 && edge[1] >= 0 && edge[2] >= 0, all_down = edge[0] <= 0 && edge[1] <= 0 && edge[2] <= 0;
    const double area = edge[0] + edge[1] + edge[2]; // twice, and its sign says which side faces up the axis
    if ((!all_up && !all_down) || area == 0) return INFINITY;
    const double at = (edge[0] * q[0][ray.axis] + edge[1] * q[1][ray.axis] + edge[2] * q[2][ray.axis]) / area * ray.sign;
    *facing = area * ray.sign;
    return at > 0 ? at : INFINITY;
}
