// plane.h: planes, boxes against them, and the guard band that moves a volume's planes outward before anyone culls by them.
// Strict C11, reads as C++17.
// SPDX-License-Identifier: MIT
//
// Invariant: rounding is monotone, so ((x*nx + y*ny) + z*nz) + offset, computed in this order everywhere, never falls when a
// coordinate moves along the normal. A box inside another is therefore never judged better than it or kept where the
// other is dropped: a tree over boxes finds the same set as a loop over them, bit for bit.
#ifndef PORTCULLIS_PLANE_H
#define PORTCULLIS_PLANE_H

#include "box.h"

#include <math.h>
#include <string.h>

// The signed distance of a point, positive inside.
static inline float cull_plane_height(cull_plane plane, cull_vec3 p)
{
    return ((plane.normal.x * p.x + plane.normal.y * p.y) + plane.normal.z * p.z) + plane.offset;
}

// The corner of the box that lies farthest along the direction.
static inline cull_vec3 cull_box_corner(cull_box box, cull_vec3 direction)
{
    const cull_vec3 corner = {direction.x >= 0 ? box.max.x : box.min.x, direction.y >= 0 ? box.max.y : box.min.y,
                              direction.z >= 0 ? box.max.z : box.min.z};
    return corner;
}

// Some point of the box is inside.
static inline bool cull_plane_touches(cull_plane plane, cull_box box)
{
    return cull_plane_height(plane, cull_box_corner(box, plane.normal)) >= 0;
}

// Every point of the box is inside.
static inline bool cull_plane_contains(cull_plane plane, cull_box box)
{
    const cull_vec3 against = {-plane.normal.x, -plane.normal.y, -plane.normal.z};
    return cull_plane_height(plane, cull_box_corner(box, against)) >= 0;
}

// No plane has the box outside. A box near an edge of the volume may pass though it touches no point of it.
static inline bool cull_volume_touches(const cull_volume *volume, cull_box box)
{
    for (uint32_t i = 0; i < volume->plane_count; i++)
        if (!cull_plane_touches(volume->planes[i], box)) return false;
    return true;
}

static inline bool cull_volume_contains(const cull_volume *volume, cull_box box)
{
    for (uint32_t i = 0; i < volume->plane_count; i++)
        if (!cull_plane_contains(volume->planes[i], box)) return false;
    return true;
}

// For who explains: how a box stands in the volume that comes nearest to keeping it, and the plane that holds it off most there.
typedef struct cull_standing {
    float height; // of the box's innermost corner over that plane, metres; below 0: outside of every volume
    uint32_t volume, plane;
} cull_standing;
static inline cull_standing cull_standing_of(const cull_volume *volumes, uint32_t count, cull_box box)
{
    cull_standing best = {-INFINITY, 0, 0};
    for (uint32_t v = 0; v < count; v++) {
        cull_standing worst = {INFINITY, v, 0};
        for (uint32_t k = 0; k < volumes[v].plane_count; k++) {
            const cull_plane p = volumes[v].planes[k];
            const float height = cull_plane_height(p, cull_box_corner(box, p.normal));
            if (!(height < worst.height)) continue;
            worst.height = height;
            worst.plane = k;
        }
        if (worst.height > best.height) best = worst;
    }
    return best;
}

// ---- The guard band: the only distances by which anything is moved "to be safe" ----

#define CULL_GUARD_PX (1.0 / 64)                // side planes move out by this many pixels: rasterizers snap vertices
#define CULL_GUARD_DISTANCE (1.0 / 1048576)     // boxes widen by this share of their distance to the eye (2^-20): float matrices
#define CULL_GUARD_ROUNDING (4.004 / 16777216)  // of |normal|_1 * radius (4 * 2^-24, and 1/1000 for double rounding), see below
#define CULL_GUARD_UNDERFLOW 1e-37              // metres: products that leave float's normal range

// The view that planes are guarded for, in one zone.
typedef struct cull_guard {
    double eye[3], forward[3]; // relative to the zone's origin; forward is a unit vector
    double pixel_tangent;      // height (or width, the larger) of a pixel, at distance 1 along forward
    double reach;              // the largest distance of a point of the picture, at distance 1 along forward
    double radius;             // the largest absolute coordinate of any box that will be judged
} cull_guard;

// The least float above a finite one below FLT_MAX.
static inline float cull_float_above(float f)
{
    uint32_t bits;
    memcpy(&bits, &f, sizeof bits);
    if (f > 0) bits++;
    else if (f < 0) bits--;
    else bits = 1;
    memcpy(&f, &bits, sizeof f);
    return f;
}

// A direction as a plane has it: made once, it serves planes of all zones.
typedef struct cull_facing {
    cull_vec3 normal;
    double inverse; // of the length that it had
    double slack;   // metres per metre of radius, see cull_plane_outward
} cull_facing;

static inline cull_facing cull_facing_of(const double normal[3])
{
    const double length = sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    const double inverse = 1 / length, x = normal[0] * inverse, y = normal[1] * inverse, z = normal[2] * inverse;
    const cull_facing facing = {{(float)x, (float)y, (float)z}, inverse, CULL_GUARD_ROUNDING * (fabs(x) + fabs(y) + fabs(z))};
    return facing;
}

static inline cull_plane cull_facing_at(const cull_facing *facing, double offset, double radius)
{
    const double slack = facing->slack * radius + CULL_GUARD_UNDERFLOW;
    const double exact = offset * facing->inverse + slack, most = (double)FLT_MAX;
    const double wanted = exact > most ? most : exact < -most ? -most : exact;
    float up = (float)wanted;
    if ((double)up < wanted) up = cull_float_above(up);
    const cull_plane plane = {facing->normal, up};
    return plane;
}

// normal . p + offset >= 0 rounded to float such that a plain float evaluation at p (|coordinates| <= radius), in any order
// of the sums, fused or not, is >= 0 wherever the exact value is. normal need not be a unit vector.
//
// Why 4 * 2^-24 * |normal|_1 * radius is enough, with u = 2^-24 and S = |nx x| + |ny y| + |nz z| <= |normal|_1 * radius:
// only points of tiny value are in danger, and the sign of a float sum is that of the exact sum of its operands, so the last
// addition is free. The three products cost u S. The two other sums each hold some of the four terms; the rest of the terms
// sum to the opposite (the value is tiny) and one of the two groups is without the offset, so a sum is at most S and
// costs u S. Rounding the normal costs u S. Together 4 u S: at most 0.87 * 2^-21 * radius. The offset is rounded up.
static inline cull_plane cull_plane_outward(const double normal[3], double offset, double radius)
{
    const cull_facing facing = cull_facing_of(normal);
    return cull_facing_at(&facing, offset, radius);
}

// THE guard band. The plane normal . (p - eye) + distance >= 0, normal a unit vector, distance 0 (through the eye: the
// side of a picture, the edge of a portal) or positive (the far plane), such that no point of the picture is ever lost.
//
// A plane through the eye is a line on the picture; adding m * forward to its normal moves the line out by m tangents.
// m holds the pixel part, and for boxes widened by g times their distance r, whose corners move by up to
// sqrt(3) g r, sqrt(3) g times the reach: for a point q of the picture at depth 1, r <= reach, corners too.
typedef struct cull_guarded { // what of the plane is the same in all zones of a view
    cull_facing facing;
    double out[3], ahead; // the normal, moved; the distance, widened
} cull_guarded;

// Of the guard: forward, pixel_tangent, reach.
static inline cull_guarded cull_guard_direction(const cull_guard *guard, const double normal[3], double distance)
{
    const double *forward = guard->forward;
    const double widening = 1.7320508075688772 * CULL_GUARD_DISTANCE * (1 + 1.0 / 262144) * guard->reach;
    const double along = normal[0] * forward[0] + normal[1] * forward[1] + normal[2] * forward[2];
    const double rest = 1 - along * along, across = sqrt(rest > 0 ? rest : 0); // tangents that the line moves at, per unit of normal
    const double moved = distance > 0 ? 0 : CULL_GUARD_PX * guard->pixel_tangent * across + widening;
    cull_guarded to;
    for (int i = 0; i < 3; i++) to.out[i] = normal[i] + moved * forward[i];
    to.facing = cull_facing_of(to.out);
    to.ahead = distance * (1 + widening);
    return to;
}

// The eye and radius of the zone.
static inline cull_plane cull_guarded_at(const cull_guarded *g, const double eye[3], double radius)
{
    const double offset = g->ahead - (g->out[0] * eye[0] + g->out[1] * eye[1] + g->out[2] * eye[2]);
    return cull_facing_at(&g->facing, offset, radius);
}

static inline cull_plane cull_guard_plane(const cull_guard *guard, const double normal[3], double distance)
{
    const cull_guarded g = cull_guard_direction(guard, normal, distance);
    return cull_guarded_at(&g, guard->eye, guard->radius);
}

#endif
