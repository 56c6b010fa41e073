// Scene builder, the transform of an include: all that comes in goes through one turn, one scale and one move.
// SPDX-License-Identifier: MIT
// Invariant: without a transform, and with the identity, no number is computed anew, so none changes a bit.
#include "scene_builder.h"

#include <math.h>
#include <string.h>

static const double TURN_ERROR_MOST = 1e-9; // of a unit matrix's entries: 10 micrometres over 10 km

static double dot(const double a[3], const double b[3])
{
    return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
}

static int is_identity(const builder_map *m)
{
    static const double one[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    int same = m->scale == 1;
    for (int i = 0; i < 9; ++i) same &= m->turn[i] == one[i];
    for (int k = 0; k < 3; ++k) same &= m->move[k] == 0;
    return same;
}

static int is_turn(const double m[9])
{
    for (int a = 0; a < 3; ++a)
        for (int c = 0; c < 3; ++c)
            if (!(fabs(dot(m + 3 * a, m + 3 * c) - (a == c)) <= TURN_ERROR_MOST)) return 0;
    const double cross[3] = {m[4] * m[8] - m[5] * m[7], m[5] * m[6] - m[3] * m[8], m[3] * m[7] - m[4] * m[6]};
    return dot(m, cross) > 0; // not a mirror
}

result scene_builder_transform(scene_builder *b, const builder_transform *t)
{
    builder_map m = {.is_on = 1};
    double square = 0;
    for (int a = 0; a < 3; ++a) {
        square += dot(t->rows[a], t->rows[a]);
        m.move[a] = t->rows[a][3];
        if (!isfinite(m.move[a])) return RESULT_BAD_INPUT;
    }
    m.scale = sqrt(square / 3);
    if (!(m.scale > 0) || !isfinite(m.scale)) return RESULT_BAD_INPUT;
    for (int a = 0; a < 3; ++a)
        for (int c = 0; c < 3; ++c) m.turn[3 * a + c] = t->rows[a][c] / m.scale;
    if (!is_turn(m.turn)) return RESULT_BAD_INPUT;
    m.is_on = !is_identity(&m);
    b->map = m;
    return RESULT_OK;
}

void scene_builder_transform_end(scene_builder *b)
{
    b->map.is_on = 0;
}

double builder_scale(const scene_builder *b)
{
    return b->map.is_on ? b->map.scale : 1;
}

void builder_direction(const scene_builder *b, const double v[3], double out[3])
{
    double turned[3] = {v[0], v[1], v[2]};
    if (b->map.is_on)
        for (int k = 0; k < 3; ++k) turned[k] = dot(b->map.turn + 3 * k, v);
    memcpy(out, turned, sizeof turned);
}

void builder_offset(const scene_builder *b, const double v[3], double out[3])
{
    builder_direction(b, v, out);
    if (b->map.is_on)
        for (int k = 0; k < 3; ++k) out[k] *= b->map.scale;
}

void builder_point(const scene_builder *b, const double p[3], double out[3])
{
    builder_offset(b, p, out);
    if (b->map.is_on)
        for (int k = 0; k < 3; ++k) out[k] += b->map.move[k];
}

scene_solid_plane builder_plane(const scene_builder *b, const scene_solid_plane *plane)
{
    scene_solid_plane out = *plane;
    if (!b->map.is_on) return out;
    builder_direction(b, plane->normal, out.normal);
    out.distance = plane->distance * b->map.scale + dot(out.normal, b->map.move);
    return out;
}
