// Cylinders and cones on the grid. The corners of one ring are rounded to grid points; a side goes through two of them and
// along the axis (a whole direction) or through the apex (a grid point), so the caps need no corners of their own.
// SPDX-License-Identifier: MIT
// Invariant: sides that meet share the line of their corner exactly, and no corner lies in front of another side.
#include "input_round.h"

#include <math.h>
#include <string.h>

typedef enum round_kind { ROUND_CYLINDER, ROUND_CONE } round_kind;
typedef struct ring {
    int32_t at[SEGMENTS_MOST][3]; // counterclockwise seen from the top
    uint32_t count;
    int32_t base[3], top[3];
    int64_t axis[3]; // whole direction from base to top
    round_kind kind;
} ring;

// ---- Corners as written ----

static double dot(const double a[3], const double b[3])
{
    return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
}

static int set_length(double v[3], double length)
{
    const double now = sqrt(dot(v, v));
    if (!(now > 0) || !isfinite(now)) return 0;
    for (int k = 0; k < 3; ++k) v[k] *= length / now;
    return 1;
}

// u, v, axis: right-handed, of unit length; u towards the coordinate axis that the body's own is farthest from.
static int frame_of(const round_body *b, double u[3], double v[3])
{
    double axis[3];
    int least = 0;
    for (int k = 0; k < 3; ++k) axis[k] = b->top[k] - b->base[k];
    if (!set_length(axis, 1)) return 0;
    for (int k = 1; k < 3; ++k)
        if (fabs(axis[k]) < fabs(axis[least])) least = k;
    for (int k = 0; k < 3; ++k) u[k] = (k == least) - axis[least] * axis[k];
    if (!set_length(u, 1)) return 0;
    for (int k = 0; k < 3; ++k) v[k] = axis[(k + 1) % 3] * u[(k + 2) % 3] - axis[(k + 2) % 3] * u[(k + 1) % 3];
    return 1;
}

// By quarters, so that corners on the axes lie there.
static void circle(uint32_t i, uint32_t segments, double *cosine, double *sine)
{
    static const double HALF_PI = 1.57079632679489661923;
    const uint32_t quarter = 4 * i / segments;
    const double rest = (double)(4 * i - quarter * segments) / segments * HALF_PI, c = cos(rest), s = sin(rest);
    *cosine = quarter == 0 ? c : quarter == 1 ? -s : quarter == 2 ? -c : s;
    *sine = quarter == 0 ? s : quarter == 1 ? c : quarter == 2 ? -s : -c;
}

static primitive_fault round_corners(primitive *p, const round_body *b, ring *r)
{
    double u[3], v[3], corner[3], across[3], c, s;
    if (!frame_of(b, u, v)) return PRIMITIVE_FLAT;
    primitive_fault fault = PRIMITIVE_SOUND;
    for (uint32_t i = 0; i < b->segments && fault == PRIMITIVE_SOUND; ++i) {
        circle(i, b->segments, &c, &s);
        for (int k = 0; k < 3; ++k) corner[k] = b->base[k] + b->radius * (c * u[k] + s * v[k]);
        for (int k = 0; k < 3; ++k) across[k] = corner[k] + (b->top[k] - b->base[k]);
        int32_t unused[3];
        if (r->kind == ROUND_CYLINDER) {
            const double moved = p->moved;
            fault = primitive_point(p, across, unused); // must lie on the grid too; where it comes to lie the planes say
            p->moved = moved;
        }
        if (fault == PRIMITIVE_SOUND) fault = primitive_point(p, corner, r->at[i]);
    }
    r->count = b->segments;
    return fault;
}

// ---- Sides ----

static int side_plane(const ring *r, uint32_t from, uint32_t to, cull_wide_plane *out)
{
    const int32_t *a = r->at[from], *b = r->at[to];
    if (r->kind == ROUND_CONE) return cull_wide_plane_through(a, b, r->top, out);
    int64_t e[3], n[3];
    for (int k = 0; k < 3; ++k) e[k] = (int64_t)b[k] - a[k];
    for (int k = 0; k < 3; ++k) n[k] = e[(k + 1) % 3] * r->axis[(k + 2) % 3] - e[(k + 2) % 3] * r->axis[(k + 1) % 3];
    if (!n[0] && !n[1] && !n[2]) return 0;
    *out = (cull_wide_plane){{n[0], n[1], n[2]}, cull_wide_negate(cull_wide_dot_point(n, a))};
    *out = cull_wide_plane_reduced(*out);
    return 1;
}

// The corner after the side from `from` to `to` lies strictly behind it.
static int is_convex_at(const ring *r, uint32_t from, uint32_t to, uint32_t next)
{
    cull_wide_plane side;
    return side_plane(r, from, to, &side) && cull_side_of_point(&side, r->at[next]) < 0;
}

static void drop_corner(ring *r, uint32_t i)
{
    memmove(r->at[i], r->at[i + 1], (r->count - i - 1) * sizeof r->at[0]);
    r->count--;
}

// Corners that rounding has put onto or behind the line of their neighbours go: what is left is the hull of all, for they
// stand round the axis in order.
static void make_convex(ring *r)
{
    for (uint32_t i = 0, kept = 0; r->count >= 3 && kept < r->count;) {
        const uint32_t before = (i + r->count - 1) % r->count, after = (i + 1) % r->count;
        if (is_convex_at(r, before, i, after)) {
            kept++;
            i = after;
            continue;
        }
        drop_corner(r, i);
        kept = 0;
        i = i < r->count ? i : 0;
        if (r->count) i = (i + r->count - 1) % r->count;
    }
}

static primitive_fault add_sides(primitive *p, const ring *r)
{
    for (uint32_t i = 0; i < r->count; ++i) {
        cull_wide_plane side;
        if (!side_plane(r, i, (i + 1) % r->count, &side) || cull_side_of_point(&side, r->base) >= 0) return PRIMITIVE_FLAT;
        const primitive_fault fault = primitive_add(p, &side);
        if (fault != PRIMITIVE_SOUND) return fault;
    }
    return r->count >= 3 ? PRIMITIVE_SOUND : PRIMITIVE_FLAT;
}

static primitive_fault add_base(primitive *p, const ring *r)
{
    const int64_t down[3] = {-r->axis[0], -r->axis[1], -r->axis[2]};
    const cull_wide_plane base = {{down[0], down[1], down[2]}, cull_wide_negate(cull_wide_dot_point(down, r->base))};
    if (cull_side_of_point(&base, r->top) >= 0) return PRIMITIVE_FLAT;
    return primitive_add_through(p, down, r->base);
}

static primitive_fault add_round(primitive *p, const round_body *b, round_kind kind)
{
    ring r = {.kind = kind};
    double axis[3];
    for (int k = 0; k < 3; ++k) axis[k] = b->top[k] - b->base[k];
    primitive_direction(p, axis, r.axis);
    primitive_fault fault = primitive_point(p, b->base, r.base);
    if (fault == PRIMITIVE_SOUND) fault = primitive_point(p, b->top, r.top);
    if (fault == PRIMITIVE_SOUND) fault = round_corners(p, b, &r);
    if (fault != PRIMITIVE_SOUND) return fault;
    make_convex(&r);
    fault = add_sides(p, &r);
    if (fault == PRIMITIVE_SOUND) fault = add_base(p, &r);
    return fault == PRIMITIVE_SOUND && kind == ROUND_CYLINDER ? primitive_add_through(p, r.axis, r.top) : fault;
}

primitive_fault primitive_cylinder(primitive *p, const round_body *b)
{
    return add_round(p, b, ROUND_CYLINDER);
}

primitive_fault primitive_cone(primitive *p, const round_body *b)
{
    return add_round(p, b, ROUND_CONE);
}
