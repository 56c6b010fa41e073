// A visit's volume made ready: its planes side by side, and boxes against them.
// SPDX-License-Identifier: MIT
// Invariant: the answers are those of plane.h's cull_plane_touches and cull_plane_contains, bit for bit: rounding is monotone, so
// the larger of two rounded products is the product with the corner that cull_box_corner takes.
#ifndef PORTCULLIS_BSP_VOLUME_H
#define PORTCULLIS_BSP_VOLUME_H

#include "lanes.h"

#include <portcullis/culler.h>

typedef struct bsp_volume {
    _Alignas(64) float x[CULL_MAX_PLANES], y[CULL_MAX_PLANES], z[CULL_MAX_PLANES], offset[CULL_MAX_PLANES];
    uint32_t count, all; // planes; a bit for each
} bsp_volume;

static inline void volume_ready(const cull_volume *in, bsp_volume *out)
{
    out->count = in->plane_count;
    out->all = in->plane_count ? UINT32_MAX >> (CULL_MAX_PLANES - in->plane_count) : 0;
    for (uint32_t k = 0; k < in->plane_count; k++) {
        out->x[k] = in->planes[k].normal.x;
        out->y[k] = in->planes[k].normal.y;
        out->z[k] = in->planes[k].normal.z;
        out->offset[k] = in->planes[k].offset;
    }
    for (uint32_t k = in->plane_count; k % LANES_MOST; k++) out->x[k] = out->y[k] = out->z[k] = out->offset[k] = 0; // no bit of `all`
}

typedef enum volume_fate { VOLUME_OUTSIDE, VOLUME_TOUCHES } volume_fate;

// OUTSIDE: one plane among `which` has all of the box outside. *out_cuts: those that have a part of it outside.
static inline volume_fate volume_cuts(const bsp_volume *v, uint32_t which, const float min[3], const float max[3], uint32_t *out_cuts)
{
    const lanes low_x = lanes_of(min[0]), low_y = lanes_of(min[1]), low_z = lanes_of(min[2]);
    const lanes high_x = lanes_of(max[0]), high_y = lanes_of(max[1]), high_z = lanes_of(max[2]);
    uint32_t cuts = 0;
    for (uint32_t k = 0; k < v->count; k += LANES) {
        const uint32_t here = which >> k & LANES_ALL;
        if (!here) continue;
        const lanes x = lanes_load(v->x + k), y = lanes_load(v->y + k), z = lanes_load(v->z + k), offset = lanes_load(v->offset + k);
        const lanes ax = lanes_mul(low_x, x), bx = lanes_mul(high_x, x), ay = lanes_mul(low_y, y), by = lanes_mul(high_y, y);
        const lanes az = lanes_mul(low_z, z), bz = lanes_mul(high_z, z);
        const lanes inner = lanes_height(lanes_max(ax, bx), lanes_max(ay, by), lanes_max(az, bz), offset);
        const lanes outer = lanes_height(lanes_min(ax, bx), lanes_min(ay, by), lanes_min(az, bz), offset);
        if (lanes_negative(inner) & here) return VOLUME_OUTSIDE;
        cuts |= (lanes_negative(outer) & here) << k;
    }
    *out_cuts = cuts;
    return VOLUME_TOUCHES;
}

#endif
