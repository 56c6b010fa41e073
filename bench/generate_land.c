// The land round a scene of houses: see generate_land.h.
// SPDX-License-Identifier: MIT
// Invariant: one grid of lines through everything, so the ground has no T-junctions; level where houses stand.
#include "generate_land.h"

#include <math.h>

enum { LINES_MOST = 320, NEAR_STEP = 75 * METRE / 10, FAR_STEP = 20 * METRE };

typedef struct lines { int32_t at[LINES_MOST]; uint32_t count; } lines;

static void line_add(lines *l, int32_t at)
{
    uint32_t i = 0;
    while (i < l->count && l->at[i] < at) i++;
    if ((i < l->count && l->at[i] == at) || l->count == LINES_MOST) return;
    for (uint32_t k = l->count++; k > i; --k) l->at[k] = l->at[k - 1];
    l->at[i] = at;
}

static double beyond(double at, double half) // metres outside of what is level
{
    return fabs(at) > half ? fabs(at) - half : 0;
}

// A valley: beyond what is near the ground rises to all sides, steeper and steeper, so that what stands there is seen over what is nearer.
static double slopes_height(double x, double z)
{
    const double slope = 0.2, near_m = (double)LAND_NEAR / METRE, out_x = beyond(x, near_m), out_z = beyond(z, near_m);
    const double out = sqrt(out_x * out_x + out_z * out_z);
    return slope * out * out / (out + near_m);
}

double land_height(const land *l, double x, double z)
{
    const double rise_m = 75, hill_m = 5;
    const double out_x = beyond(x, (double)l->flat_x / METRE), out_z = beyond(z, (double)l->flat_z / METRE);
    const double t = fmin(1, sqrt(out_x * out_x + out_z * out_z) / rise_m), fade = t * t * (3 - 2 * t);
    const double wave = turn_sine(x / 83 + z / 211) + turn_sine(z / 67 - x / 157) + 0.6 * turn_sine(x / 41 + z / 53);
    return fade * (hill_m * wave + hill_m) + slopes_height(x, z);
}

static place ground_place(const land *l, int32_t x, int32_t z)
{
    return (place){x, (int32_t)floor(land_height(l, (double)x / METRE, (double)z / METRE) * METRE + 0.5), z};
}

static int is_hole(const land *l, int32_t x, int32_t z) // the least corner of a cell
{
    for (uint32_t i = 0; i < l->hole_count; ++i)
        if (x >= l->holes[i].min.x && x < l->holes[i].max.x && z >= l->holes[i].min.z && z < l->holes[i].max.z) return 1;
    return 0;
}

static const char *material_of(const land *l, int32_t x, int32_t z)
{
    const int32_t step = 20 * METRE;
    const int on_street = x >= -l->road_end && x < l->road_end;
    if (on_street && z >= -l->road_half && z < l->road_half) return "road";
    if (on_street && z >= -l->pavement_half && z < l->pavement_half) return "pavement_stone";
    const uint32_t patch = (uint32_t)((x + LAND_NEAR) / step * 7 + (z + LAND_NEAR) / step * 3);
    return patch % 5 ? "grass" : "grass_3";
}

static void cell_write(obj_writer *w, const land *l, const int32_t x[2], const int32_t z[2])
{
    const place a = ground_place(l, x[0], z[0]), b = ground_place(l, x[0], z[1]), c = ground_place(l, x[1], z[1]), d = ground_place(l, x[1], z[0]);
    obj_material(w, material_of(l, x[0], z[0]));
    if (a.y == b.y && b.y == c.y && c.y == d.y) {
        obj_polygon(w, (const place[4]){a, b, c, d}, 4);
        return;
    }
    obj_polygon(w, (const place[3]){a, b, c}, 3);
    obj_polygon(w, (const place[3]){a, c, d}, 3);
}

static void grid_lines(const land *l, lines *out)
{
    for (int32_t at = -LAND_NEAR; at <= LAND_NEAR; at += NEAR_STEP) line_add(out, at);
    for (int32_t at = LAND_NEAR; at < l->half;) {
        at = at + FAR_STEP < l->half ? at + FAR_STEP : l->half;
        line_add(out, at);
        line_add(out, -at);
    }
}

void land_write(obj_writer *w, const land *l)
{
    lines x = {0}, z = {0};
    grid_lines(l, &x);
    grid_lines(l, &z);
    for (uint32_t i = 0; i < l->hole_count; ++i) {
        line_add(&x, l->holes[i].min.x);
        line_add(&x, l->holes[i].max.x);
        line_add(&z, l->holes[i].min.z);
        line_add(&z, l->holes[i].max.z);
    }
    line_add(&x, -l->road_end);
    line_add(&x, l->road_end);
    line_add(&z, -l->road_half);
    line_add(&z, l->road_half);
    line_add(&z, -l->pavement_half);
    line_add(&z, l->pavement_half);
    obj_object(w, "land");
    for (uint32_t k = 0; k + 1 < z.count; ++k)
        for (uint32_t i = 0; i + 1 < x.count; ++i)
            if (!is_hole(l, x.at[i], z.at[k])) cell_write(w, l, &x.at[i], &z.at[k]);
}
