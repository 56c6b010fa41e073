// Zones made of walls on a grid: see tree_fixture.h.
// SPDX-License-Identifier: MIT
#include "tree_fixture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static int loop_plane(const grid_loop *loop, cull_exact_plane *out) // 0: the points lie on one line
{
    cull_wide_plane wide;
    for (uint32_t i = 1; i + 1 < loop->count; i++)
        if (cull_wide_plane_through(loop->p[0], loop->p[i], loop->p[i + 1], &wide)) return cull_exact_plane_from_wide(&wide, out);
    return 0;
}

uint32_t grid_wall(hand_zone *z, const grid_loop *loop)
{
    cull_vec3 points[8];
    for (uint32_t i = 0; i < loop->count; i++)
        points[i] = (cull_vec3){(float)loop->p[i][0] / STEPS_PER_METRE, (float)loop->p[i][1] / STEPS_PER_METRE, (float)loop->p[i][2] / STEPS_PER_METRE};
    const uint32_t item = hand_zone_wall(z, points, loop->count, 0), plane = z->walls[item].plane;
    if (!loop_plane(loop, &z->exact[plane])) z->exact[plane] = (cull_exact_plane){{0, 1, 0}, -loop->p[0][1]};
    for (uint32_t p = 0; p < plane; p++) {
        if (memcmp(&z->exact[p], &z->exact[plane], sizeof *z->exact) != 0) continue;
        z->walls[item].plane = p;
        z->zone.plane_count--;
        break;
    }
    return item;
}

void grid_end(hand_zone *z, zone_kind kind)
{
    hand_zone_end(z);
    z->zone.exact_planes = kind == ZONE_EXACT && z->zone.plane_count ? z->exact : NULL;
    z->zone.grid_steps_per_metre = z->zone.exact_planes ? STEPS_PER_METRE : 0;
}

uint32_t grid_plan(hand_zone *z, const int32_t w[4], int32_t height)
{
    const grid_loop loop = {{{w[0], 0, w[1]}, {w[2], 0, w[3]}, {w[2], height, w[3]}, {w[0], height, w[1]}}, 4}; // floor: x and z, y up
    return grid_wall(z, &loop);
}

void grid_box(hand_zone *z, const int32_t low[3], const int32_t high[3], hand_face faces)
{
    for (int axis = 0; axis < 3; axis++) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        for (int side = 0; side < 2; side++) {
            grid_loop loop = {.count = 4};
            for (int corner = 0; corner < 4; corner++) { // (u, v) counterclockwise seen along -axis
                const int at = (side == 1) == (faces == FACE_OUT) ? corner : 3 - corner;
                int32_t *p = loop.p[at];
                p[axis] = side ? high[axis] : low[axis];
                p[u] = corner == 1 || corner == 2 ? high[u] : low[u];
                p[v] = corner >= 2 ? high[v] : low[v];
            }
            grid_wall(z, &loop);
        }
    }
}

static int32_t step_of(float metres)
{
    const double steps = (double)metres * STEPS_PER_METRE;
    if (steps != floor(steps)) abort();
    return (int32_t)steps;
}

static void point_move(const grid_motion *motion, const int32_t from[3], int32_t to[3])
{
    for (int row = 0; row < 3; row++) {
        int32_t sum = 0;
        for (int k = 0; k < 3; k++) sum += motion->matrix[row][k] * from[k];
        if (sum % motion->divisor) abort();
        to[row] = sum / motion->divisor + motion->move[row];
    }
}

void grid_moved(const hand_zone *from, const grid_motion *motion, zone_kind kind, hand_zone *out)
{
    hand_zone_open(out, from->items_most, from->vertices_most);
    for (uint32_t i = 0; i < from->zone.item_count; i++) {
        const cull_wall *wall = &from->walls[i];
        grid_loop loop = {.count = wall->vertex_count};
        if (wall->vertex_count == 0 || wall->vertex_count > 8) abort();
        for (uint32_t k = 0; k < wall->vertex_count; k++) {
            const cull_vec3 p = from->positions[from->wall_vertices[wall->first_vertex + k]];
            const int32_t at[3] = {step_of(p.x), step_of(p.y), step_of(p.z)};
            point_move(motion, at, loop.p[k]);
        }
        grid_wall(out, &loop);
    }
    grid_end(out, kind);
}
