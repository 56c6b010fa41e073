// face.h: from where a wall certainly shows only its back, for an option `backface` (culler.h). Strict C11, reads as C++17.
// SPDX-License-Identifier: MIT
//
// Invariant: a wall is dropped only where normal . eye + offset + doubt * |eye| < 0 in float, |eye| its largest coordinate, and then
// the eye is behind every triangle that is drawn for it, as its rounded vertices have it.
#ifndef PORTCULLIS_FACE_H
#define PORTCULLIS_FACE_H

#include "culler.h"

#include <float.h>
#include <math.h>

typedef struct cull_face { float normal[3], offset, doubt; } cull_face; // of zeros: never dropped

// Of each term of the test: at most six roundings in float and one of the eye itself, at 2^-24 each.
#define CULL_FACE_ROUNDING (8.0 / 16777216)

typedef struct cull_triangle_face { double normal[3], offset; } cull_triangle_face;

// 0 for a triangle of no area: it leaves no pixel.
static inline int cull_triangle_face_of(const cull_zone *zone, const uint32_t *corners, cull_triangle_face *out)
{
    const cull_vec3 a = zone->positions[corners[0]], b = zone->positions[corners[1]], c = zone->positions[corners[2]];
    const double u[3] = {(double)b.x - (double)a.x, (double)b.y - (double)a.y, (double)b.z - (double)a.z};
    const double v[3] = {(double)c.x - (double)a.x, (double)c.y - (double)a.y, (double)c.z - (double)a.z};
    const double n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    const double length = sqrt((n[0] * n[0] + n[1] * n[1]) + n[2] * n[2]);
    if (!(length > 0)) return 0;
    for (int i = 0; i < 3; i++) out->normal[i] = n[i] / length;
    out->offset = -((out->normal[0] * (double)a.x + out->normal[1] * (double)a.y) + out->normal[2] * (double)a.z);
    return 1;
}

// How far the wall's triangles lie off its plane: rounding bends them, slivers most. doubt is per metre of the eye's largest
// coordinate, offset an absolute distance.
static inline void cull_wall_doubt(const cull_zone *zone, const cull_item *item, const cull_plane *plane, double *out_offset, double *out_doubt)
{
    const double n[3] = {(double)plane->normal.x, (double)plane->normal.y, (double)plane->normal.z};
    double offset = 0, doubt = 0;
    for (uint32_t i = 0; i + 3 <= item->index_count; i += 3) {
        cull_triangle_face f;
        if (!cull_triangle_face_of(zone, zone->indices + item->first_index + i, &f)) continue;
        doubt = fmax(doubt, (fabs(f.normal[0] - n[0]) + fabs(f.normal[1] - n[1])) + fabs(f.normal[2] - n[2]));
        offset = fmax(offset, fabs(f.offset - (double)plane->offset));
    }
    *out_offset = offset * (1 + CULL_FACE_ROUNDING) + CULL_FACE_ROUNDING * fabs((double)plane->offset);
    *out_doubt = doubt * (1 + CULL_FACE_ROUNDING) + CULL_FACE_ROUNDING * ((fabs(n[0]) + fabs(n[1])) + fabs(n[2]));
}

static inline float cull_float_up(double value)
{
    const float rounded = (float)value;
    return (double)rounded < value ? nextafterf(rounded, FLT_MAX) : rounded;
}

// Of an item of the zone; zeros where it is no wall, or its back counts too.
static inline cull_face cull_face_of(const cull_zone *zone, uint32_t item)
{
    cull_face out = {{0, 0, 0}, 0, 0};
    const uint32_t flags = zone->items[item].flags;
    if (!(flags & CULL_ITEM_WALL) || (flags & CULL_ITEM_TWO_SIDED) || zone->walls[item].vertex_count == 0) return out;
    const cull_plane *plane = &zone->planes[zone->walls[item].plane];
    double offset, doubt;
    cull_wall_doubt(zone, &zone->items[item], plane, &offset, &doubt);
    out.normal[0] = plane->normal.x;
    out.normal[1] = plane->normal.y;
    out.normal[2] = plane->normal.z;
    out.offset = cull_float_up((double)plane->offset + offset);
    out.doubt = cull_float_up(doubt);
    return out;
}

#endif
