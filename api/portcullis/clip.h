// clip.h: convex polygons cut by planes, in double (Sutherland and Hodgman, Reentrant Polygon Clipping, 1974).
// Strict C11, reads as C++17.
// SPDX-License-Identifier: MIT
//
// Invariant: a cut point is computed from the inside end of its edge to the outside end, whatever way the loop runs, so two
// polygons that share an edge get the same point, bit for bit.
#ifndef PORTCULLIS_CLIP_H
#define PORTCULLIS_CLIP_H

#include <stdint.h>

typedef struct cull_point { double x, y, z; } cull_point;
typedef struct cull_cut { double x, y, z, offset; } cull_cut; // inside: x*p.x + y*p.y + z*p.z + offset >= 0; any length

static inline double cull_cut_height(cull_cut cut, cull_point p)
{
    return ((cut.x * p.x + cut.y * p.y) + cut.z * p.z) + cut.offset;
}

static inline cull_point cull_cut_between(cull_point inside, double height, cull_point outside, double depth)
{
    const double t = height / (height - depth); // height >= 0 > depth
    const cull_point p = {inside.x + t * (outside.x - inside.x), inside.y + t * (outside.y - inside.y),
                          inside.z + t * (outside.z - inside.z)};
    return p;
}

// Writes the part inside the cut to `out`, which must not be `in` and has room for count + 1 points (a convex loop gains at
// most one; of a loop that rounding has bent, at most capacity points are kept by the caller giving 2 * count). Returns
// the points written: 0 when nothing is inside. Points on the plane stay.
static inline uint32_t cull_polygon_clip(const cull_point *in, uint32_t count, cull_cut cut, cull_point *out, uint32_t capacity)
{
    uint32_t written = 0;
    const double first = count > 0 ? cull_cut_height(cut, in[0]) : 0;
    double ha = first;
    for (uint32_t i = 0; i < count; i++) {
        const cull_point a = in[i], b = in[i + 1 < count ? i + 1 : 0];
        const double hb = i + 1 < count ? cull_cut_height(cut, b) : first;
        if (ha >= 0 && written < capacity) out[written++] = a;
        if (ha > 0 && hb < 0 && written < capacity) out[written++] = cull_cut_between(a, ha, b, hb);
        if (ha < 0 && hb > 0 && written < capacity) out[written++] = cull_cut_between(b, hb, a, ha);
        ha = hb;
    }
    return written;
}

// The same where the points' heights above the cut are known.
static inline uint32_t cull_polygon_clip_at(const cull_point *in, const double *heights, uint32_t count, cull_point *out, uint32_t capacity)
{
    uint32_t written = 0;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t next = i + 1 < count ? i + 1 : 0;
        const double ha = heights[i], hb = heights[next];
        if (ha >= 0 && written < capacity) out[written++] = in[i];
        if (ha > 0 && hb < 0 && written < capacity) out[written++] = cull_cut_between(in[i], ha, in[next], hb);
        if (ha < 0 && hb > 0 && written < capacity) out[written++] = cull_cut_between(in[next], hb, in[i], ha);
    }
    return written;
}

#endif
