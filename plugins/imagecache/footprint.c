// The footprint of a volume on the ground: see footprint.h.
// SPDX-License-Identifier: MIT
#include "footprint.h"

#include <math.h>

// x * u + z * v + y * h + d >= 0 with u, v in cells from the ground's corner and h in metres; `size`: at least the sum of its terms' absolute values
// over the ground, so that evaluating it in double costs less than size * 2^-50.
typedef struct slab { double x, y, z, d, size; } slab;

typedef struct spot { double u, v; } spot;
typedef struct outline {
    spot spots[FOOTPRINT_POINTS];
    uint32_t count;
} outline;

static slab slab_of(const ground *g, cull_plane plane)
{
    const double nx = (double)plane.normal.x, ny = (double)plane.normal.y, nz = (double)plane.normal.z, d = (double)plane.offset;
    const double side = g->size * (double)(g->columns > g->rows ? g->columns : g->rows), tall = fmax(fabs(g->low), fabs(g->high));
    slab s = {nx * g->size, ny, nz * g->size, d + nx * g->x + nz * g->z, 0};
    s.size = fabs(d) + fabs(nx * g->x) + fabs(nz * g->z) + (fabs(nx) + fabs(nz)) * side + fabs(ny) * tall;
    return s;
}

// What of both is left when y goes: a has y above 0, b below. Weights are positive, so each point of both is a point of the sum.
static slab slab_without_y(const slab *a, const slab *b)
{
    const double s = -b->y, t = a->y;
    const slab sum = {s * a->x + t * b->x, 0, s * a->z + t * b->z, s * a->d + t * b->d, s * a->size + t * b->size};
    return sum;
}

static double height_at(const slab *s, spot at)
{
    return s->x * at.u + s->z * at.v + s->d;
}

// Keeps what of the outline lies inside (Sutherland and Hodgman, 1974). The plane was moved out by far more than the rounding of its heights,
// so what a wrong sign or a badly placed crossing cuts off lies outside of the plane itself.
static void outline_cut(outline *o, const slab *s)
{
    outline cut = {.count = 0};
    double heights[FOOTPRINT_POINTS];
    uint32_t outside = 0;
    for (uint32_t i = 0; i < o->count; i++) {
        heights[i] = height_at(s, o->spots[i]);
        outside += heights[i] < 0;
    }
    if (outside == 0) return;
    for (uint32_t i = 0; i < o->count; i++) {
        const uint32_t next = i + 1 < o->count ? i + 1 : 0;
        const double h = heights[i], k = heights[next];
        if (cut.count + 2 > FOOTPRINT_POINTS) return; // too many: goes without this cut
        if (h >= 0) cut.spots[cut.count++] = o->spots[i];
        if ((h < 0) == (k < 0)) continue;
        const double t = h / (h - k), a = 1 - t;
        cut.spots[cut.count++] = (spot){a * o->spots[i].u + t * o->spots[next].u, a * o->spots[i].v + t * o->spots[next].v};
    }
    *o = cut;
}

// s has no y. Moved out by 2^-44 of its terms: 16 times what all of the sums before and in outline_cut can round by.
static void outline_within(outline *o, const slab *s)
{
    slab moved = *s;
    moved.d += ldexp(s->size, -44);
    const double scale = fmax(fabs(s->x), fabs(s->z));
    if (scale == 0) {
        if (moved.d < 0) o->count = 0;
        return;
    }
    outline_cut(o, &moved);
}

static outline outline_of(const ground *g, const cull_volume *volume)
{
    const double u = (double)g->columns, v = (double)g->rows;
    const double tall = fmax(fabs(g->low), fabs(g->high));
    outline o = {{{0, 0}, {u, 0}, {u, v}, {0, v}}, 4};
    slab up[CULL_MAX_PLANES + 1], down[CULL_MAX_PLANES + 1];
    uint32_t ups = 0, downs = 0;
    up[ups++] = (slab){0, 1, 0, -g->low, 2 * tall};
    down[downs++] = (slab){0, -1, 0, g->high, 2 * tall};
    const uint32_t planes = volume->plane_count < CULL_MAX_PLANES ? volume->plane_count : CULL_MAX_PLANES;
    for (uint32_t i = 0; i < planes; i++) {
        const slab s = slab_of(g, volume->planes[i]);
        if (s.y > 0) up[ups++] = s;
        else if (s.y < 0) down[downs++] = s;
        else outline_within(&o, &s);
    }
    for (uint32_t a = 0; a < ups; a++)
        for (uint32_t b = a == 0 ? 1 : 0; b < downs; b++) { // low against high says nothing
            const slab s = slab_without_y(&up[a], &down[b]);
            outline_within(&o, &s);
        }
    return o;
}

// ---- Integers from here on ----

static int comes_before(footprint_point a, footprint_point b)
{
    return a.x < b.x || (a.x == b.x && a.z < b.z);
}

static int64_t turn(footprint_point a, footprint_point b, footprint_point c) // above 0: counterclockwise
{
    return (int64_t)(b.x - a.x) * (c.z - a.z) - (int64_t)(b.z - a.z) * (c.x - a.x);
}

static uint32_t chain_add(footprint_point *hull, uint32_t count, uint32_t least, footprint_point p)
{
    while (count >= least + 2 && turn(hull[count - 2], hull[count - 1], p) <= 0) count--;
    hull[count++] = p;
    return count;
}

// The hull of rounded points: rounding may have bent the outline in. points is sorted.
static uint32_t hull_of(footprint_point *points, uint32_t count, footprint_point *hull)
{
    for (uint32_t i = 1; i < count; i++) { // few, and nearly sorted twice
        const footprint_point p = points[i];
        uint32_t k = i;
        for (; k > 0 && comes_before(p, points[k - 1]); k--) points[k] = points[k - 1];
        points[k] = p;
    }
    uint32_t kept = 0;
    for (uint32_t i = 0; i < count; i++)
        if (i == 0 || comes_before(points[kept - 1], points[i])) points[kept++] = points[i];
    if (kept < 3) {
        for (uint32_t i = 0; i < kept; i++) hull[i] = points[i];
        return kept;
    }
    uint32_t n = 0;
    for (uint32_t i = 0; i < kept; i++) n = chain_add(hull, n, 0, points[i]);
    const uint32_t lower = n - 1;
    for (uint32_t i = kept - 1; i-- > 0;) n = chain_add(hull, n, lower, points[i]);
    return n - 1; // the first stands at the end again
}

// The proof that no cell is lost. A point p of the volume on the ground is a mean of the outline's spots; each was rounded by half a unit a
// coordinate, and its doubles are wrong by less than 2^-20 of a unit: with the same weights, p lies within one unit a coordinate of a point r of the
// hull of rounded points. The line of an edge is A x + B z + C, A, B, C whole; it is >= 0 at r, so at least -(|A| + |B|) at p. In a closed
// cell that holds p it is largest at one corner: (i + 1 where A > 0, j + 1 where B > 0), and there at least as large as at p. So the cell
// passes A x + B z + C + |A| + |B| >= 0 at that corner. Corners are multiples of 256 units: dividing all by 256, the constant rounded down,
// leaves the sign of a whole number's comparison with 0 as it was. Along axes the same unit widens the box of the points.
static void edge_add(footprint *f, footprint_point p, footprint_point q)
{
    const int64_t a = (int64_t)p.z - q.z, b = (int64_t)q.x - p.x;
    if (a == 0 || b == 0) return; // along an axis: the box is as good
    const int64_t wide = (a < 0 ? -a : a) + (b < 0 ? -b : b);
    const int64_t corner = FOOTPRINT_UNITS * ((a > 0 ? a : 0) + (b > 0 ? b : 0));
    const int64_t c = wide + corner - a * p.x - b * p.z, units = FOOTPRINT_UNITS;
    const int64_t whole = c >= 0 ? c / units : -((-c + units - 1) / units);
    f->edges[f->edge_count++] = (footprint_edge){a, b, whole};
}

static ground_range range_of(int32_t low, int32_t high, uint32_t count) // units; closed cells within a unit
{
    const int32_t units = FOOTPRINT_UNITS, last = (int32_t)count - 1;
    const int32_t first = low < 1 ? 0 : (low - 1) / units, end = (high + 1) / units;
    const ground_range r = {first < last ? first : last, end < last ? end : last};
    return r;
}

void footprint_of(const ground *g, const cull_volume *volume, footprint *out)
{
    const outline o = outline_of(g, volume);
    footprint_point points[FOOTPRINT_POINTS], hull[2 * FOOTPRINT_POINTS];
    out->point_count = out->edge_count = 0;
    if (o.count == 0) return;
    footprint_point low = {INT32_MAX, INT32_MAX}, high = {0, 0};
    for (uint32_t i = 0; i < o.count; i++) { // within the ground, as a mean of its corners is: never clamped
        const footprint_point p = {(int32_t)floor(o.spots[i].u * FOOTPRINT_UNITS + 0.5), (int32_t)floor(o.spots[i].v * FOOTPRINT_UNITS + 0.5)};
        points[i] = p;
        if (p.x < low.x) low.x = p.x;
        if (p.z < low.z) low.z = p.z;
        if (p.x > high.x) high.x = p.x;
        if (p.z > high.z) high.z = p.z;
    }
    out->point_count = hull_of(points, o.count, hull);
    for (uint32_t i = 0; i < out->point_count; i++) out->points[i] = hull[i];
    out->columns = range_of(low.x, high.x, g->columns);
    out->rows = range_of(low.z, high.z, g->rows);
    if (out->point_count < 2) return;
    for (uint32_t i = 0; i < out->point_count; i++) edge_add(out, hull[i], hull[i + 1 < out->point_count ? i + 1 : 0]);
}
