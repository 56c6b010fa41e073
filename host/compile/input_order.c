// Orders of the weld: see input_order.h. The centre is a mean of whole numbers, so that the order of summing leaves no trace.
// SPDX-License-Identifier: MIT
#include "input_order.h"

#include <math.h>

static const double PARTS = 1024; // of a step: a position errs by less than 2^-26 steps

double steady(double steps)
{
    return nearbyint(steps * PARTS) / PARTS;
}

// Brushes weigh as their faces, squared: a symmetric map is seldom symmetric in that too.
place_order place_order_of(const compile_brush *brushes, size_t count)
{
    __extension__ typedef __int128 int128;
    int128 sums[3] = {0}, weight = 0;
    for (size_t i = 0; i < count; ++i) {
        const int64_t weigh = (int64_t)brushes[i].face_count * brushes[i].face_count;
        weight += weigh;
        for (int k = 0; k < 3; ++k) sums[k] += (int128)weigh * ((int64_t)brushes[i].min[k] + brushes[i].max[k]);
    }
    place_order o = {{0, 0, 0}};
    for (int k = 0; k < 3 && weight; ++k) o.centre[k] = (double)sums[k] / (double)weight / 2;
    return o;
}

static int compare_doubles(double a, double b)
{
    return a < b ? -1 : a > b;
}

double place_distance(const place_order *o, const double at[3])
{
    double square = 0;
    for (int k = 0; k < 3; ++k) square += (at[k] - o->centre[k]) * (at[k] - o->centre[k]);
    return steady(sqrt(square));
}

int compare_places(const place_order *o, const double a[3], const double b[3])
{
    int order = compare_doubles(place_distance(o, a), place_distance(o, b));
    for (int k = 0; k < 3 && !order; ++k) order = compare_doubles(steady(a[k]), steady(b[k]));
    return order;
}

static double distance(const place_order *o, const cull_wide_plane *p)
{
    double length = 0, at = cull_wide_to_double(p->offset);
    for (int k = 0; k < 3; ++k) {
        length += (double)p->normal[k] * (double)p->normal[k];
        at += (double)p->normal[k] * o->centre[k];
    }
    return steady(fabs(at) / sqrt(length));
}

static void sort_magnitudes(const cull_wide_plane *p, uint64_t out[3])
{
    for (int k = 0; k < 3; ++k) {
        const uint64_t size = cull_magnitude(p->normal[k]);
        int at = k;
        for (; at > 0 && out[at - 1] > size; --at) out[at] = out[at - 1];
        out[at] = size;
    }
}

int compare_plane_places(const place_order *o, const cull_wide_plane *a, const cull_wide_plane *b)
{
    const int order = compare_doubles(distance(o, a), distance(o, b));
    if (order) return order;
    uint64_t one[3], other[3];
    sort_magnitudes(a, one);
    sort_magnitudes(b, other);
    for (int k = 0; k < 3; ++k)
        if (one[k] != other[k]) return one[k] < other[k] ? -1 : 1;
    for (int k = 0; k < 3; ++k)
        if (a->normal[k] != b->normal[k]) return a->normal[k] < b->normal[k] ? -1 : 1;
    return cull_wide_sign(cull_wide_subtract(a->offset, b->offset));
}
