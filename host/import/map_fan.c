// Face loops to fans: no corner on a straight line, no triangle without area.
// SPDX-License-Identifier: MIT
#include "map_brush.h"

#include <math.h>

static void edge(const brush_vertex *from, const brush_vertex *to, double out[3])
{
    for (int k = 0; k < 3; ++k) out[k] = to->position[k] - from->position[k];
}

static double twice_area(const double u[3], const double v[3])
{
    const double x = u[1] * v[2] - u[2] * v[1], y = u[2] * v[0] - u[0] * v[2], z = u[0] * v[1] - u[1] * v[0];
    return sqrt(x * x + y * y + z * z);
}

// How far b stands from the line through a and c; 0 as well where the loop turns back on itself.
static double bend(const brush_vertex *a, const brush_vertex *b, const brush_vertex *c)
{
    double along[3], across[3];
    edge(a, c, along);
    edge(a, b, across);
    const double length = sqrt(along[0] * along[0] + along[1] * along[1] + along[2] * along[2]);
    return length > 0 ? twice_area(along, across) / length : 0;
}

static double thinnest(const brush_vertex *v, const uint32_t *corners, uint32_t count, uint32_t start)
{
    double least = INFINITY;
    for (uint32_t i = 1; i + 1 < count; ++i) {
        double a[3], b[3];
        edge(&v[corners[start]], &v[corners[(start + i) % count]], a);
        edge(&v[corners[start]], &v[corners[(start + i + 1) % count]], b);
        least = fmin(least, twice_area(a, b));
    }
    return least;
}

static void reverse(uint32_t *items, uint32_t count)
{
    for (uint32_t i = 0; i < count / 2; ++i) {
        const uint32_t swap = items[i];
        items[i] = items[count - 1 - i];
        items[count - 1 - i] = swap;
    }
}

static void rotate(uint32_t *items, uint32_t count, uint32_t start)
{
    reverse(items, start);
    reverse(items + start, count - start);
    reverse(items, count);
}

static uint32_t drop_straight(const brush_vertex *v, uint32_t *corners, uint32_t count, double flat)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < count; ++i) {
        const uint32_t before = kept ? corners[kept - 1] : corners[count - 1], after = i + 1 < count ? corners[i + 1] : corners[0];
        if (bend(&v[before], &v[corners[i]], &v[after]) > flat) corners[kept++] = corners[i];
    }
    return kept;
}

uint32_t brush_loop_for_fan(const brush_vertex *v, uint32_t *corners, uint32_t count, double flat)
{
    uint32_t kept = drop_straight(v, corners, count, flat);
    for (uint32_t again = kept; kept >= 3; kept = again) { // what goes at the seam may straighten a corner passed already
        again = drop_straight(v, corners, kept, flat);
        if (again == kept) break;
    }
    if (kept < 3) return 0;
    uint32_t best = 0;
    double widest = -1;
    for (uint32_t start = 0; start < kept; ++start) {
        const double width = thinnest(v, corners, kept, start);
        if (width > widest * (1 + 1e-9)) { // not by rounding: moved brushes are fanned alike
            widest = width;
            best = start;
        }
    }
    rotate(corners, kept, best);
    return widest > 0 ? kept : 0;
}
