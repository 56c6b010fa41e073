// Primitives on the grid: boxes, half spaces, hulls of points. See input_primitive.h; round ones: input_round.c.
// SPDX-License-Identifier: MIT
#include "input_round.h"

#include <math.h>
#include <string.h>

static const double STEPS_MOST = CULL_GRID_MOST - 4; // a turned box's far corner may be 3 steps from where it was written
enum { SIMPLE_MOST = 4096, DIRECTION_MOST = 1 << 22 };
static const double SIMPLE_ERROR = 1e-9; // of a direction: less than the 2^-23 that any other is rounded by

primitive primitive_make(const allocator *memory, double steps_per_metre, const builder_transform *place)
{
    return (primitive){.place = *place,
                       .steps_per_metre = steps_per_metre,
                       .planes = buffer_make(memory, sizeof(cull_wide_plane)),
                       .low = {INFINITY, INFINITY, INFINITY},
                       .high = {-INFINITY, -INFINITY, -INFINITY}};
}

void primitive_free(primitive *p)
{
    buffer_free(&p->planes);
}

// ---- Points and directions ----

void primitive_steps(const primitive *p, const double point[3], double out[3])
{
    for (int k = 0; k < 3; ++k) {
        const double *row = p->place.rows[k];
        out[k] = (((row[0] * point[0] + row[1] * point[1]) + row[2] * point[2]) + row[3]) * p->steps_per_metre;
    }
}

void primitive_moved(primitive *p, const double written[3], const int32_t taken[3])
{
    double sum = 0;
    for (int k = 0; k < 3; ++k) sum += (written[k] - taken[k]) * (written[k] - taken[k]);
    p->moved = fmax(p->moved, sqrt(sum));
}

primitive_fault primitive_point(primitive *p, const double point[3], int32_t out[3])
{
    double steps[3];
    primitive_steps(p, point, steps);
    for (int k = 0; k < 3; ++k) {
        if (!(fabs(steps[k]) <= STEPS_MOST)) return PRIMITIVE_BEYOND;
        p->low[k] = fmin(p->low[k], steps[k]);
        p->high[k] = fmax(p->high[k], steps[k]);
        out[k] = (int32_t)nearbyint(steps[k]);
    }
    primitive_moved(p, steps, out);
    return PRIMITIVE_SOUND;
}

// Small whole numbers where the direction is theirs, 22 bits of the largest otherwise.
void primitive_direction(const primitive *p, const double direction[3], int64_t out[3])
{
    double v[3], most = 0;
    for (int k = 0; k < 3; ++k) {
        const double *row = p->place.rows[k];
        v[k] = (row[0] * direction[0] + row[1] * direction[1]) + row[2] * direction[2];
        most = fmax(most, fabs(v[k]));
    }
    out[0] = out[1] = out[2] = 0;
    if (!(most > 0) || !isfinite((v[0] + v[1]) + v[2])) return;
    double scale = DIRECTION_MOST;
    for (int simple = 1; simple <= SIMPLE_MOST; ++simple) {
        double error = 0;
        for (int k = 0; k < 3; ++k) error = fmax(error, fabs(v[k] / most * simple - nearbyint(v[k] / most * simple)));
        if (error > SIMPLE_ERROR) continue;
        scale = simple;
        break;
    }
    for (int k = 0; k < 3; ++k) out[k] = (int64_t)nearbyint(v[k] / most * scale);
}

// ---- Planes ----

primitive_fault primitive_add(primitive *p, const cull_wide_plane *plane)
{
    const cull_wide_plane *had = p->planes.items;
    for (size_t i = 0; i < p->planes.count; ++i)
        if (cull_wide_plane_equal(&had[i], plane)) return PRIMITIVE_SOUND;
    return buffer_append(&p->planes, plane, 1) ? PRIMITIVE_SOUND : PRIMITIVE_NO_MEMORY;
}

primitive_fault primitive_add_through(primitive *p, const int64_t normal[3], const int32_t point[3])
{
    cull_wide_plane plane = {{normal[0], normal[1], normal[2]}, cull_wide_negate(cull_wide_dot_point(normal, point))};
    plane = cull_wide_plane_reduced(plane);
    return primitive_add(p, &plane);
}

primitive_fault primitive_half_space(primitive *p, const double point[3], const double normal[3])
{
    int32_t at[3];
    int64_t n[3];
    const primitive_fault fault = primitive_point(p, point, at);
    primitive_direction(p, normal, n);
    if (fault == PRIMITIVE_SOUND && !n[0] && !n[1] && !n[2]) return PRIMITIVE_FLAT;
    return fault == PRIMITIVE_SOUND ? primitive_add_through(p, n, at) : fault;
}

primitive_fault primitive_half_space_of(primitive *p, const double (*points)[3])
{
    int32_t at[3][3];
    cull_wide_plane plane;
    for (int i = 0; i < 3; ++i) {
        const primitive_fault fault = primitive_point(p, points[i], at[i]);
        if (fault != PRIMITIVE_SOUND) return fault;
    }
    return cull_wide_plane_through(at[0], at[1], at[2], &plane) ? primitive_add(p, &plane) : PRIMITIVE_FLAT;
}

primitive_fault primitive_bound(primitive *p, const double low[3], const double high[3])
{
    for (int k = 0; k < 3; ++k)
        for (int side = 0; side < 2; ++side) {
            const double at = side ? ceil(high[k]) : floor(low[k]), most = CULL_GRID_MOST;
            int64_t normal[3] = {0};
            int32_t point[3] = {0};
            normal[k] = side ? 1 : -1;
            point[k] = (int32_t)fmin(fmax(at, -most), most);
            const primitive_fault fault = primitive_add_through(p, normal, point);
            if (fault != PRIMITIVE_SOUND) return fault;
        }
    return PRIMITIVE_SOUND;
}

// ---- Boxes ----

static void corner_of(const double min[3], const double max[3], int which, double out[3]) // bit an axis
{
    for (int k = 0; k < 3; ++k) out[k] = which >> k & 1 ? max[k] : min[k];
}

// Two parallel faces across edge k.
static primitive_fault add_pair(primitive *p, const int32_t (*at)[3], int k)
{
    cull_wide_plane low;
    const int32_t *far = at[1 << k];
    if (!cull_wide_plane_through(at[0], at[1 << (k + 1) % 3], at[1 << (k + 2) % 3], &low)) return PRIMITIVE_FLAT;
    const int side = cull_side_of_point(&low, far);
    if (side == 0) return PRIMITIVE_FLAT;
    if (side > 0) low = cull_wide_plane_flipped(low);
    const int64_t opposite[3] = {-low.normal[0], -low.normal[1], -low.normal[2]};
    const primitive_fault fault = primitive_add(p, &low);
    return fault == PRIMITIVE_SOUND ? primitive_add_through(p, opposite, far) : fault;
}

// One corner and the three next to it are rounded, the others follow.
primitive_fault primitive_box(primitive *p, const double min[3], const double max[3])
{
    int32_t at[8][3];
    double corner[3], steps[3];
    for (int c = 0; c < 8; ++c) {
        corner_of(min, max, c, corner);
        const double moved = p->moved;
        const primitive_fault fault = primitive_point(p, corner, at[c]);
        if (fault != PRIMITIVE_SOUND) return fault;
        const int follows = (c & (c - 1)) != 0;
        if (!follows) continue;
        for (int k = 0; k < 3; ++k) at[c][k] = at[0][k];
        for (int axis = 0; axis < 3; ++axis)
            for (int k = 0; k < 3; ++k) at[c][k] += c >> axis & 1 ? at[1 << axis][k] - at[0][k] : 0;
        p->moved = moved;
        primitive_steps(p, corner, steps);
        primitive_moved(p, steps, at[c]);
    }
    primitive_fault fault = PRIMITIVE_SOUND;
    for (int k = 0; k < 3 && fault == PRIMITIVE_SOUND; ++k) fault = add_pair(p, (const int32_t(*)[3])at, k);
    return fault;
}

// ---- Hulls ----

// Every three points whose plane has all others on one side. The sides of all: bit 1 in front, bit 2 behind.
static unsigned sides_of(const cull_wide_plane *plane, const int32_t (*at)[3], uint32_t count)
{
    unsigned sides = 0;
    for (uint32_t i = 0; i < count && sides != 3; ++i) {
        const int side = cull_side_of_point(plane, at[i]);
        sides |= side > 0 ? 1u : side < 0 ? 2u : 0u;
    }
    return sides;
}

static primitive_fault try_three(primitive *p, const int32_t (*at)[3], uint32_t count, const uint32_t three[3])
{
    cull_wide_plane plane;
    if (!cull_wide_plane_through(at[three[0]], at[three[1]], at[three[2]], &plane)) return PRIMITIVE_SOUND;
    const unsigned sides = sides_of(&plane, at, count);
    if (sides == 0) return PRIMITIVE_FLAT;
    if (sides == 3) return PRIMITIVE_SOUND;
    if (sides == 1) plane = cull_wide_plane_flipped(plane);
    return primitive_add(p, &plane);
}

primitive_fault primitive_hull(primitive *p, const double (*points)[3], uint32_t count)
{
    int32_t at[HULL_POINTS_MOST][3];
    primitive_fault fault = count <= HULL_POINTS_MOST ? PRIMITIVE_SOUND : PRIMITIVE_BEYOND;
    for (uint32_t i = 0; i < count && fault == PRIMITIVE_SOUND; ++i) fault = primitive_point(p, points[i], at[i]);
    for (uint32_t i = 0; i < count; ++i)
        for (uint32_t j = i + 1; j < count; ++j)
            for (uint32_t k = j + 1; k < count && fault == PRIMITIVE_SOUND; ++k)
                fault = try_three(p, (const int32_t(*)[3])at, count, (const uint32_t[3]){i, j, k});
    return fault == PRIMITIVE_SOUND && p->planes.count < 4 ? PRIMITIVE_FLAT : fault;
}
