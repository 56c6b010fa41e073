// See loop_bent.h.
// SPDX-License-Identifier: MIT
#include "loop_bent.h"

#include <math.h>

static void minus(cull_vec3 a, cull_vec3 b, double out[3])
{
    out[0] = (double)a.x - (double)b.x, out[1] = (double)a.y - (double)b.y, out[2] = (double)a.z - (double)b.z;
}

static double dot(const double a[3], const double b[3])
{
    return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
}

// Of the corner from the line through p along e: outward in the plane, and off the plane either way, by more than `most`.
static int strays(const double e[3], const double d[3], const double normal[3], double most)
{
    const double square = dot(e, e), along = dot(d, e) / square, limit = most * sqrt(square);
    double in = 0, off[3];
    for (int k = 0; k < 3; k++) {
        in += (normal[(k + 1) % 3] * e[(k + 2) % 3] - normal[(k + 2) % 3] * e[(k + 1) % 3]) * d[k];
        off[k] = d[k] - along * e[k];
    }
    return !(in >= -limit) || !(fabs(dot(off, normal)) <= most);
}

int loop_is_bent(const cull_vec3 *points, uint32_t count, const double normal[3], double most)
{
    for (uint32_t i = 0; i < count; i++) {
        double e[3], d[3];
        minus(points[i + 1 < count ? i + 1 : 0], points[i], e);
        if (e[0] == 0 && e[1] == 0 && e[2] == 0) continue; // no line: it has everything inside
        for (uint32_t k = 0; k < count; k++) {
            minus(points[k], points[i], d);
            if (strays(e, d, normal, most)) return 1;
        }
    }
    return 0;
}
