// box.h: axis-aligned boxes. Strict C11, reads as C++17. Every result is made of input coordinates: nothing is rounded.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_BOX_H
#define PORTCULLIS_BOX_H

#include "culler.h"

#include <float.h>
#include <stdbool.h>

// Contains nothing; the union of it with a box is that box.
static inline cull_box cull_box_none(void)
{
    const cull_box none = {{FLT_MAX, FLT_MAX, FLT_MAX}, {-FLT_MAX, -FLT_MAX, -FLT_MAX}};
    return none;
}

// Item `i` of boxes in SoA.
static inline cull_box cull_box_at(const cull_boxes *boxes, uint32_t i)
{
    const cull_box box = {{boxes->min_x[i], boxes->min_y[i], boxes->min_z[i]}, {boxes->max_x[i], boxes->max_y[i], boxes->max_z[i]}};
    return box;
}

static inline cull_box cull_box_with_point(cull_box box, cull_vec3 p)
{
    if (p.x < box.min.x) box.min.x = p.x;
    if (p.y < box.min.y) box.min.y = p.y;
    if (p.z < box.min.z) box.min.z = p.z;
    if (p.x > box.max.x) box.max.x = p.x;
    if (p.y > box.max.y) box.max.y = p.y;
    if (p.z > box.max.z) box.max.z = p.z;
    return box;
}

static inline cull_box cull_box_union(cull_box a, cull_box b)
{
    if (b.min.x < a.min.x) a.min.x = b.min.x;
    if (b.min.y < a.min.y) a.min.y = b.min.y;
    if (b.min.z < a.min.z) a.min.z = b.min.z;
    if (b.max.x > a.max.x) a.max.x = b.max.x;
    if (b.max.y > a.max.y) a.max.y = b.max.y;
    if (b.max.z > a.max.z) a.max.z = b.max.z;
    return a;
}

// Borders belong to the box.
static inline bool cull_box_contains(cull_box outer, cull_box inner)
{
    return outer.min.x <= inner.min.x && outer.min.y <= inner.min.y && outer.min.z <= inner.min.z &&
           inner.max.x <= outer.max.x && inner.max.y <= outer.max.y && inner.max.z <= outer.max.z;
}

static inline bool cull_box_contains_point(cull_box box, cull_vec3 p)
{
    return box.min.x <= p.x && p.x <= box.max.x && box.min.y <= p.y && p.y <= box.max.y && box.min.z <= p.z && p.z <= box.max.z;
}

static inline bool cull_box_touches(cull_box a, cull_box b)
{
    return a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y && a.min.z <= b.max.z &&
           b.min.z <= a.max.z;
}

// The largest absolute coordinate: the radius that rounding bounds are stated in.
static inline float cull_box_radius(cull_box box)
{
    const float c[6] = {box.min.x, box.min.y, box.min.z, box.max.x, box.max.y, box.max.z};
    float radius = 0;
    for (int i = 0; i < 6; i++) {
        const float size = c[i] < 0 ? -c[i] : c[i];
        if (size > radius) radius = size;
    }
    return radius;
}

#endif
