// The ground of a zone parted into cells: see ground.h.
// SPDX-License-Identifier: MIT
#include "ground.h"

#include <math.h>

// Sides are whole multiples of a power of two q, 2^15 to 2^16 of them, and so is the corner: borders are multiples of q. Cells are no smaller
// than 2^-24 of the largest coordinate (float cannot tell points apart that are nearer), so a border is at most 2^41 q: exact in double.
ground ground_of(cull_box box, uint32_t level)
{
    const double low_x = (double)box.min.x, low_z = (double)box.min.z, wide = (double)box.max.x - low_x, deep = (double)box.max.z - low_z;
    const double extent = fmax(wide, deep);
    const double radius = fmax(fmax(fabs(low_x), fabs((double)box.max.x)), fmax(fabs(low_z), fabs((double)box.max.z)));
    // 2^-14 more, so that 2^level cells still cover the box after its corner was moved down to a multiple of q.
    const double wanted = fmax(ldexp(extent * (1 + 1.0 / 16384), -(int)level), fmax(ldexp(radius, -24), 1e-30));
    int exponent;
    (void)frexp(wanted, &exponent);
    const double q = ldexp(1, exponent - 16);
    ground g = {.size = ceil(wanted / q) * q, .x = floor(low_x / q) * q, .z = floor(low_z / q) * q, .level = level};
    const int32_t most = (int32_t)1 << level;
    g.low = (double)box.min.y;
    g.high = (double)box.max.y;
    g.columns = (uint32_t)ground_index(g.x, g.size, most, (double)box.max.x) + 1;
    g.rows = (uint32_t)ground_index(g.z, g.size, most, (double)box.max.z) + 1;
    return g;
}

int32_t ground_index(double start, double size, int32_t count, double at)
{
    const double guess = floor((at - start) / size);
    if (!(guess >= -1)) return -1;
    if (guess > count) return count;
    int32_t i = (int32_t)guess;
    while (i > -1 && at < start + i * size) i--; // the quotient was rounded: borders are exact
    while (i < count && at >= start + (i + 1) * size) i++;
    return i;
}

ground_range ground_touched(double start, double size, int32_t count, double low, double high)
{
    ground_range r = {ground_index(start, size, count, low), ground_index(start, size, count, high)};
    if (r.first > 0 && low == start + r.first * size) r.first--;
    if (r.first < 0) r.first = 0;
    if (r.last > count - 1) r.last = count - 1;
    if (r.first > r.last) r.first = r.last; // low beyond the last border by nothing but that border itself
    return r;
}

static int32_t eye_index(double start, double size, int32_t count, double at, double w)
{
    if (w > 0) return ground_index(start, size, count, at / w);
    return at > 0 ? count : at < 0 ? -1 : 0;
}

ground_cell ground_eye(const ground *g, const double eye[4])
{
    const ground_cell c = {eye_index(g->x, g->size, (int32_t)g->columns, eye[0], eye[3]), eye_index(g->z, g->size, (int32_t)g->rows, eye[2], eye[3])};
    return c;
}

static uint32_t spread(uint32_t v) // bit k to bit 2k
{
    v = (v | v << 8) & 0x00ff00ffu;
    v = (v | v << 4) & 0x0f0f0f0fu;
    v = (v | v << 2) & 0x33333333u;
    return (v | v << 1) & 0x55555555u;
}

static uint32_t gather(uint32_t v)
{
    v &= 0x55555555u;
    v = (v | v >> 1) & 0x33333333u;
    v = (v | v >> 2) & 0x0f0f0f0fu;
    v = (v | v >> 4) & 0x00ff00ffu;
    return (v | v >> 8) & 0x0000ffffu;
}

uint32_t ground_morton(ground_cell c)
{
    return spread((uint32_t)c.i) | spread((uint32_t)c.j) << 1;
}

ground_cell ground_of_morton(uint32_t code)
{
    const ground_cell c = {(int32_t)gather(code), (int32_t)gather(code >> 1)};
    return c;
}
