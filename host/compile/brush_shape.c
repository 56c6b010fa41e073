// Polyhedra of brushes: see brush_shape.h. Each face is a square of the cube round the grid, cut by each other plane.
// SPDX-License-Identifier: MIT
#include "brush_shape.h"

#include <math.h>

brush_shape brush_shape_make(const allocator *memory)
{
    return (brush_shape){.corners = buffer_make(memory, sizeof(shape_corner)),
                         .faces = buffer_make(memory, sizeof(shape_face)),
                         .loop = buffer_make(memory, sizeof(shape_corner)),
                         .other = buffer_make(memory, sizeof(shape_corner))};
}

void brush_shape_free(brush_shape *s)
{
    buffer_free(&s->corners);
    buffer_free(&s->faces);
    buffer_free(&s->loop);
    buffer_free(&s->other);
}

int brush_shape_cube(plane_table *t, plane_ref cube[6])
{
    for (int i = 0; i < 6; ++i) {
        cull_wide_plane p = {{0, 0, 0}, cull_wide_from(-2 * (int64_t)CULL_GRID_MOST)};
        p.normal[i / 2] = i % 2 ? -1 : 1; // fronts outside: first the high side of an axis, then the low one
        cube[i] = plane_table_add(t, &p);
        if (cube[i] == PLANE_NONE) return 0;
    }
    return 1;
}

// ---- One face ----

static int push_corner(const plane_table *t, buffer *loop, const shape_corner *c)
{
    shape_corner *to = buffer_push(loop, 1);
    if (!to) return 0;
    *to = *c;
    plane_table_position(t, c->planes, to->position);
    return 1;
}

void brush_shape_square(const plane_table *t, const plane_ref cube[6], plane_ref plane, plane_ref edges[4])
{
    const cull_wide_plane p = plane_table_get(t, plane);
    int axis = 0;
    for (int i = 1; i < 3; ++i)
        if (cull_magnitude(p.normal[i]) > cull_magnitude(p.normal[axis])) axis = i;
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    const plane_ref up[4] = {cube[2 * a], cube[2 * b], cube[2 * a + 1], cube[2 * b + 1]}; // counterclockwise seen from the axis' end
    for (int i = 0; i < 4; ++i) edges[i] = up[p.normal[axis] > 0 ? i : (4 - i) % 4];
}

// The square may stand out at the cube's two other sides.
static int start_loop(brush_shape *s, const plane_table *t, const plane_ref cube[6], plane_ref face)
{
    plane_ref edges[4];
    brush_shape_square(t, cube, face, edges);
    s->loop.count = 0;
    for (int i = 0; i < 4; ++i) {
        const shape_corner c = {.planes = {face, edges[(i + 3) % 4], edges[i]}, .edge = edges[i]};
        if (!push_corner(t, &s->loop, &c)) return 0;
    }
    return 1;
}

static int keep_corner(buffer *loop, const shape_corner *c, plane_ref edge)
{
    shape_corner *kept = buffer_append(loop, c, 1);
    if (kept) kept->edge = edge;
    return kept != NULL;
}

// The new edge stands last where the loop's first corner is on the plane and the edge from it is cut off.
static shape_fault copy_inside(brush_shape *s, const plane_table *t, plane_ref face, plane_ref by)
{
    const size_t count = s->loop.count;
    const shape_corner *c = s->loop.items;
    const int turned = c[0].side == 0 && c[1].side > 0;
    s->other.count = 0;
    for (size_t i = turned ? 1 : 0; i < count; ++i) {
        const int side = c[i].side, next_side = c[i + 1 < count ? i + 1 : 0].side;
        if (side <= 0 && !keep_corner(&s->other, &c[i], side == 0 && next_side > 0 ? by : c[i].edge)) return SHAPE_NO_MEMORY;
        if (side * next_side < 0) {
            const shape_corner made = {.planes = {face, c[i].edge, by}, .edge = side < 0 ? by : c[i].edge};
            if (!push_corner(t, &s->other, &made)) return SHAPE_NO_MEMORY;
        }
    }
    return !turned || keep_corner(&s->other, &c[0], by) ? SHAPE_SOUND : SHAPE_NO_MEMORY;
}

static shape_fault cut_loop(brush_shape *s, const plane_table *t, plane_ref face, plane_ref by)
{
    shape_corner *c = s->loop.items;
    int inside = 0, outside = 0;
    for (size_t i = 0; i < s->loop.count; ++i) {
        c[i].side = plane_table_side_at(t, c[i].planes, c[i].position, by);
        inside |= c[i].side < 0;
        outside |= c[i].side > 0;
    }
    if (!inside) return SHAPE_EMPTY;
    if (!outside) return SHAPE_SOUND;
    const shape_fault fault = copy_inside(s, t, face, by);
    const buffer swap = s->loop;
    s->loop = s->other;
    s->other = swap;
    return fault;
}

shape_fault brush_shape_face(brush_shape *s, const plane_table *t, const plane_ref cube[6], const plane_ref *planes, uint32_t count, uint32_t face)
{
    if (!start_loop(s, t, cube, planes[face])) return SHAPE_NO_MEMORY;
    for (uint32_t i = 0; i < count; ++i) {
        if (i == face || (i > face && planes[i] == planes[face])) continue;
        const shape_fault fault = cut_loop(s, t, planes[face], planes[i]);
        if (fault != SHAPE_SOUND) return fault;
    }
    const shape_corner *c = s->loop.items;
    for (size_t i = 0; i < s->loop.count; ++i)
        for (int k = 0; k < 6; ++k)
            if (c[i].edge >> 1 == cube[k] >> 1) return SHAPE_OPEN;
    return SHAPE_SOUND;
}

static shape_fault add_face(brush_shape *s, const plane_table *t, const plane_ref cube[6], const plane_ref *planes, uint32_t count, uint32_t face)
{
    const shape_fault fault = brush_shape_face(s, t, cube, planes, count, face);
    if (fault != SHAPE_SOUND && fault != SHAPE_OPEN) return fault;
    const shape_face made = {face, (uint32_t)s->corners.count, (uint32_t)s->loop.count};
    return buffer_append(&s->faces, &made, 1) && buffer_append(&s->corners, s->loop.items, s->loop.count) ? fault : SHAPE_NO_MEMORY;
}

// A plane off the grid has no area within it: its square is empty behind the others, or stands out of the cube.
shape_fault brush_shape_cut(brush_shape *s, const plane_table *t, const plane_ref cube[6], const plane_ref *planes, uint32_t count)
{
    s->corners.count = s->faces.count = 0;
    int open = 0;
    for (uint32_t face = 0; face < count; ++face) {
        const shape_fault fault = add_face(s, t, cube, planes, count, face);
        if (fault == SHAPE_NO_MEMORY) return fault;
        open |= fault == SHAPE_OPEN;
    }
    const shape_corner *c = s->corners.items;
    for (size_t i = 0; i < s->corners.count; ++i)
        for (int k = 0; k < 3; ++k) open |= !(fabs(c[i].position[k]) <= CULL_GRID_MOST);
    return s->faces.count == 0 ? SHAPE_EMPTY : open ? SHAPE_OPEN : SHAPE_SOUND;
}

// ---- Bounds ----

// The nearest whole step, and on which side of it the corner lies.
static int whole_step(const plane_table *t, const shape_corner *c, int axis, int32_t *out)
{
    const double nearest = floor(c->position[axis] + 0.5);
    *out = (int32_t)nearest;
    const double off = c->position[axis] - nearest;
    if (fabs(off) > 1.0 / 1048576) return off < 0 ? -1 : 1; // far above the position's error, 2^-26 at most
    cull_wide_plane step = {{0, 0, 0}, cull_wide_from(-(int64_t)*out)};
    step.normal[axis] = 1;
    return cull_side_of_meet(plane_table_canonical(t, c->planes[0]), plane_table_canonical(t, c->planes[1]), plane_table_canonical(t, c->planes[2]), &step);
}

void brush_shape_bounds(const brush_shape *s, const plane_table *t, int32_t min[3], int32_t max[3])
{
    const shape_corner *c = s->corners.items;
    for (int axis = 0; axis < 3; ++axis) {
        min[axis] = INT32_MAX;
        max[axis] = INT32_MIN;
        for (size_t i = 0; i < s->corners.count; ++i) {
            if (c[i].position[axis] > min[axis] + 0.5 && c[i].position[axis] < max[axis] - 0.5) continue; // inside both for sure
            int32_t step;
            const int side = whole_step(t, &c[i], axis, &step);
            const int32_t low = step - (side < 0), high = step + (side > 0);
            min[axis] = low < min[axis] ? low : min[axis];
            max[axis] = high > max[axis] ? high : max[axis];
        }
    }
}
