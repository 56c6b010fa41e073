// The faces of walls, for backface=1: from where a wall certainly shows only its back.
// SPDX-License-Identifier: MIT
// Invariant: a wall is dropped only where normal . eye + offset + doubt * |eye| < 0, and then the eye is behind every triangle
// that is drawn for it, as its rounded vertices have it.
#include "shapes.h"

#include <math.h>

// Of each term of the test: at most six roundings in float and one of the eye itself, at 2^-24 each.
static const double FACE_ROUNDING = 8.0 / 16777216;

typedef struct face { double normal[3], offset; } face;

// 0 for a triangle of no area: it leaves no pixel.
static int triangle_face(const cull_zone *zone, const uint32_t *corners, face *out)
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

static double larger(double a, double b)
{
    return a > b ? a : b;
}

// How far the wall's triangles lie off its plane: rounding bends them, slivers most. doubt is per metre of the eye's largest
// coordinate, offset an absolute distance.
static void wall_doubt(const cull_zone *zone, const cull_item *item, const cull_plane *plane, double *out_offset, double *out_doubt)
{
    const double n[3] = {(double)plane->normal.x, (double)plane->normal.y, (double)plane->normal.z};
    double offset = 0, doubt = 0;
    for (uint32_t i = 0; i + 3 <= item->index_count; i += 3) {
        face f;
        if (!triangle_face(zone, zone->indices + item->first_index + i, &f)) continue;
        doubt = larger(doubt, (fabs(f.normal[0] - n[0]) + fabs(f.normal[1] - n[1])) + fabs(f.normal[2] - n[2]));
        offset = larger(offset, fabs(f.offset - (double)plane->offset));
    }
    *out_offset = offset * (1 + FACE_ROUNDING) + FACE_ROUNDING * fabs((double)plane->offset);
    *out_doubt = doubt * (1 + FACE_ROUNDING) + FACE_ROUNDING * ((fabs(n[0]) + fabs(n[1])) + fabs(n[2]));
}

static float float_up(double value)
{
    const float rounded = (float)value;
    return (double)rounded < value ? nextafterf(rounded, INFINITY) : rounded;
}

void face_fill(const cull_zone *zone, uint32_t item, bsp_face *out)
{
    const uint32_t flags = zone->items[item].flags;
    for (int i = 0; i < 3; i++) out->normal[i] = 0;
    out->offset = out->doubt = 0; // 0 < 0: never dropped
    if (!(flags & CULL_ITEM_WALL) || (flags & CULL_ITEM_TWO_SIDED) || zone->walls[item].vertex_count == 0) return;
    const cull_plane *plane = &zone->planes[zone->walls[item].plane];
    double offset, doubt;
    wall_doubt(zone, &zone->items[item], plane, &offset, &doubt);
    out->normal[0] = plane->normal.x;
    out->normal[1] = plane->normal.y;
    out->normal[2] = plane->normal.z;
    out->offset = float_up((double)plane->offset + offset);
    out->doubt = float_up(doubt);
}
