// Placements: see json_placement.h.
// SPDX-License-Identifier: MIT
#include "json_placement.h"

#include <math.h>

static const double SCALE_LEAST = 1e-6, SCALE_MOST = 1e6;

builder_transform placement_none(void)
{
    return (builder_transform){{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
}

builder_transform placement_move(const double offset[3])
{
    return (builder_transform){{{1, 0, 0, offset[0]}, {0, 1, 0, offset[1]}, {0, 0, 1, offset[2]}}};
}

builder_transform placement_within(const builder_transform *outer, const builder_transform *inner)
{
    builder_transform out;
    for (int row = 0; row < 3; ++row) {
        const double *r = outer->rows[row];
        for (int column = 0; column < 4; ++column)
            out.rows[row][column] = r[0] * inner->rows[0][column] + r[1] * inner->rows[1][column] + r[2] * inner->rows[2][column];
        out.rows[row][3] += r[3];
    }
    return out;
}

typedef struct angle { double cosine, sine; } angle;

static angle angle_of(double degrees)
{
    static const double radians_per_degree = 0.017453292519943295;
    const double within = remainder(degrees, 360), quarters = nearbyint(within / 90), rest = (within - 90 * quarters) * radians_per_degree;
    const double c = cos(rest), s = sin(rest);
    switch ((int)quarters & 3) {
    case 1: return (angle){-s, c};
    case 2: return (angle){-c, -s};
    case 3: return (angle){s, -c};
    default: return (angle){c, s};
    }
}

static builder_transform turn_about(int axis, double degrees)
{
    const angle a = angle_of(degrees);
    const int next = (axis + 1) % 3, last = (axis + 2) % 3;
    builder_transform out = placement_none();
    out.rows[next][next] = out.rows[last][last] = a.cosine;
    out.rows[next][last] = -a.sine;
    out.rows[last][next] = a.sine;
    return out;
}

result placement_read(const json_node *entry, builder_transform *out)
{
    double at[3] = {0}, turn[3] = {0}, scale = 1;
    result done = node_maybe_vector(entry, "at", at);
    if (done == RESULT_OK) done = node_maybe_vector(entry, "turn", turn);
    if (done == RESULT_OK) done = node_maybe_number(entry, "scale", SCALE_LEAST, SCALE_MOST, &scale);
    if (done != RESULT_OK) return done;
    builder_transform all = placement_none();
    for (int k = 0; k < 3; ++k) all.rows[k][k] = scale;
    for (int axis = 0; axis < 3; ++axis) {
        if (turn[axis] == 0) continue;
        const builder_transform t = turn_about(axis, turn[axis]);
        all = placement_within(&t, &all);
    }
    const builder_transform move = placement_move(at);
    *out = placement_within(&move, &all);
    return RESULT_OK;
}
