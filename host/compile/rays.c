// A ray's planes, what its box touches, exact hits counted by shell.
// SPDX-License-Identifier: MIT
#include "rays.h"

#include <assert.h>
#include <math.h>

enum {
    MAIN_STEP = 65537,     // of the direction along its axis; across it at most MOST_ACROSS
    MOST_ACROSS = 31,
    PARTS_A_STEP = 1024,   // a ray runs through a multiple of a part, nearer to a thin polygon's middle than a step
};
#define BOX_SLACK 4.0 // steps; what rounding moves the ray off its point is less than 1

// ---- The space ----

static result fill_space(ray_space *r)
{
    const uint32_t all = surface_polygon_count(r->s);
    r->boxes = memory_alloc(r->memory, all, sizeof(*r->boxes));
    r->polygons = memory_alloc(r->memory, all, sizeof(*r->polygons));
    r->counts = memory_alloc_zeroed(r->memory, r->shells->shell_count, sizeof(*r->counts));
    if (!r->boxes || !r->polygons || !r->counts) return RESULT_NO_MEMORY;
    for (uint32_t i = 0; i < all; ++i) {
        const surface_polygon *p = surface_polygon_at(r->s, i);
        if (p->kind == SURFACE_LIQUID) continue;
        for (int k = 0; k < 3; ++k) {
            r->boxes[r->polygon_count].min[k] = p->min[k];
            r->boxes[r->polygon_count].max[k] = p->max[k];
        }
        r->polygons[r->polygon_count++] = i;
    }
    return r->polygon_count ? box_tree_open(r->boxes, r->polygon_count, r->memory, &r->tree) : RESULT_OK;
}

result ray_space_make(const surface *s, const shell_set *shells, const allocator *memory, ray_space *out)
{
    ray_space r = {.s = s, .shells = shells, .memory = memory, .touched = buffer_make(memory, sizeof(uint32_t))};
    const result made = fill_space(&r);
    *out = r;
    if (made != RESULT_OK) {
        out->polygon_count = 0;
        ray_space_free(out);
    }
    return made;
}

void ray_space_free(ray_space *r)
{
    const uint32_t all = surface_polygon_count(r->s);
    if (r->polygon_count) box_tree_close(&r->tree, r->memory);
    memory_free(r->memory, r->boxes, all, sizeof(*r->boxes));
    memory_free(r->memory, r->polygons, all, sizeof(*r->polygons));
    memory_free(r->memory, r->counts, r->shells->shell_count, sizeof(*r->counts));
    buffer_free(&r->touched);
}

// ---- Setting out ----

static void direction_of(uint32_t attempt, int axis, int32_t out[3])
{
    const int32_t turn = (int32_t)(attempt * 7 % 27);
    out[axis] = MAIN_STEP;
    out[(axis + 1) % 3] = (attempt & 1 ? -1 : 1) * (5 + turn % MOST_ACROSS);
    out[(axis + 2) % 3] = (attempt & 2 ? -1 : 1) * (3 + (turn * 5 + 8) % (MOST_ACROSS - 2));
}

// Holds the direction and the point; its normal has nothing along the third axis.
static cull_wide_plane plane_along(const int32_t direction[3], int axis, int across, const int64_t parts[3])
{
    cull_wide_plane p = {{0, 0, 0}, {0, 0}};
    p.normal[across] = (int64_t)direction[axis] * PARTS_A_STEP;
    p.normal[axis] = -(int64_t)direction[across] * PARTS_A_STEP;
    p.offset = cull_wide_negate(cull_wide_add(cull_wide_product(direction[axis], parts[across]), cull_wide_product(-direction[across], parts[axis])));
    return p;
}

static void set_out(ray_space *r, const int64_t parts[3], uint32_t attempt, int axis, int forward)
{
    int32_t direction[3];
    direction_of(attempt, axis, direction);
    ray *y = &r->ray;
    y->a = plane_along(direction, axis, (axis + 1) % 3, parts);
    y->b = plane_along(direction, axis, (axis + 2) % 3, parts); // n_a x n_b is along the direction
    y->axis = axis;
    y->forward = forward;
    y->nearest = RAY_NO_FACE;
    const tree_box *all = &r->tree.nodes[0].box;
    for (int k = 0; k < 3; ++k) y->at[k] = (double)parts[k] / PARTS_A_STEP;
    const double way = fabs((forward > 0 ? all->max[axis] : all->min[axis]) - y->at[axis]) + BOX_SLACK;
    for (int k = 0; k < 3; ++k) y->to[k] = y->at[k] + forward * way * direction[k] / MAIN_STEP;
}

// ---- Hits ----

typedef enum hit { HIT_NONE, HIT_INSIDE, HIT_EDGE } hit;

static hit hit_of(const ray_space *r, const surface_polygon *p, const cull_wide_plane *plane)
{
    const surface_corner *c = surface_corners(r->s, p);
    hit found = HIT_INSIDE;
    for (uint32_t i = 0; i < p->count; ++i) {
        const cull_wide_plane edge = plane_table_get(r->s->planes, c[i].edge);
        const int side = cull_side_of_meet(&r->ray.a, &r->ray.b, plane, &edge);
        if (side > 0) return HIT_NONE;
        if (side == 0) found = HIT_EDGE;
    }
    return found;
}

static const cull_wide_plane *plane_of_face(const ray_space *r, uint32_t face)
{
    return plane_table_canonical(r->s->planes, surface_polygon_at(r->s, face >> 1)->plane);
}

static int looks_at_start(const ray_space *r, uint32_t face)
{
    const surface_polygon *p = surface_polygon_at(r->s, face >> 1);
    const cull_wide_plane plane = plane_table_get(r->s->planes, p->plane);
    const int along = cull_normals_sign(&r->ray.a, &r->ray.b, &plane) * r->ray.forward;
    return (face & 1 ? -along : along) < 0;
}

// Along the ray: 1 when `one` lies behind `two` as seen from the start. In one place a face that looks away from the start
// lies behind one that looks at it: there a shell's inside lies in the other's.
static int is_behind(const ray_space *r, uint32_t one, uint32_t two)
{
    const int order = cull_order_along(&r->ray.a, &r->ray.b, plane_of_face(r, one), plane_of_face(r, two)) * r->ray.forward;
    return order ? order > 0 : looks_at_start(r, two) && !looks_at_start(r, one);
}

static result count_face(ray_space *r, uint32_t face)
{
    const uint32_t shell = r->shells->shell_of[face];
    if (shell == SHELL_NONE) return RESULT_OK;
    ray_count *c = &r->counts[shell];
    if (c->crossings == 0 && !buffer_append(&r->touched, &shell, 1)) return RESULT_NO_MEMORY;
    if (c->crossings++ == 0 || is_behind(r, face, c->last_face)) c->last_face = face;
    if (looks_at_start(r, face) && (r->ray.nearest == RAY_NO_FACE || is_behind(r, r->ray.nearest, face))) r->ray.nearest = face;
    return RESULT_OK;
}

static result shoot_at(ray_space *r, uint32_t polygon, ray_end *end)
{
    const surface_polygon *p = surface_polygon_at(r->s, polygon);
    const cull_wide_plane *plane = plane_table_canonical(r->s->planes, p->plane);
    const ray *y = &r->ray;
    if (cull_normals_sign(&y->a, &y->b, plane) == 0) {
        if (cull_side_of_meet(&y->a, &y->b, &y->start, plane) == 0) *end = RAY_UNCLEAR;
        return RESULT_OK;
    }
    const int order = cull_order_along(&y->a, &y->b, plane, &y->start) * y->forward;
    if (order < 0) return RESULT_OK;
    const hit found = hit_of(r, p, plane);
    if (found == HIT_NONE) return RESULT_OK;
    if (order == 0) {
        *end = RAY_ON_SURFACE;
        return RESULT_OK;
    }
    if (found == HIT_EDGE) {
        if (*end == RAY_DONE) *end = RAY_UNCLEAR;
        return RESULT_OK;
    }
    const result counted = count_face(r, 2 * polygon);
    return counted == RESULT_OK ? count_face(r, 2 * polygon + 1) : counted;
}

static result shoot(ray_space *r, uint32_t own, ray_end *end)
{
    for (size_t i = 0; i < r->touched.count; ++i) r->counts[((uint32_t *)r->touched.items)[i]].crossings = 0;
    r->touched.count = 0;
    *end = RAY_DONE;
    tree_box box;
    for (int k = 0; k < 3; ++k) {
        const double *at = r->ray.at, *to = r->ray.to;
        box.min[k] = (at[k] < to[k] ? at[k] : to[k]) - BOX_SLACK;
        box.max[k] = (at[k] < to[k] ? to[k] : at[k]) + BOX_SLACK;
    }
    box_walk walk;
    box_walk_start(&walk, &r->tree, &box);
    result made = RESULT_OK;
    for (uint32_t i; made == RESULT_OK && *end != RAY_ON_SURFACE && box_walk_next(&walk, &i);)
        if (r->polygons[i] != own) made = shoot_at(r, r->polygons[i], end);
    return made;
}

result ray_from_point(ray_space *r, const int32_t point[3], uint32_t attempt, ray_end *end)
{
    r->touched.count = r->polygon_count ? r->touched.count : 0;
    *end = RAY_DONE;
    if (!r->polygon_count) return RESULT_OK;
    const int64_t parts[3] = {(int64_t)point[0] * PARTS_A_STEP, (int64_t)point[1] * PARTS_A_STEP, (int64_t)point[2] * PARTS_A_STEP};
    const int axis = (int)((attempt / 4 + 1) % 3);
    set_out(r, parts, attempt, axis, attempt & 4 ? -1 : 1);
    const cull_wide_plane start = {{axis == 0, axis == 1, axis == 2}, cull_wide_from(-(int64_t)point[axis])};
    r->ray.start = start;
    return shoot(r, UINT32_MAX, end);
}

static void middle_of(const surface *s, const surface_polygon *p, int64_t parts[3])
{
    const surface_corner *c = surface_corners(s, p);
    for (int k = 0; k < 3; ++k) {
        double sum = 0;
        for (uint32_t i = 0; i < p->count; ++i) sum += surface_vertex_at(s, c[i].vertex)->position[k];
        parts[k] = (int64_t)floor(sum / p->count * PARTS_A_STEP + 0.5);
    }
}

result ray_from_face(ray_space *r, uint32_t face, uint32_t attempt, ray_end *end)
{
    const surface_polygon *p = surface_polygon_at(r->s, face >> 1);
    const cull_wide_plane plane = plane_table_get(r->s->planes, p->plane ^ (face & 1));
    *end = RAY_UNCLEAR;
    if (!r->polygon_count) return RESULT_OK; // liquids alone: the caller asks for no shell
    int axis = 0;
    for (int k = 1; k < 3; ++k)
        if (cull_magnitude(plane.normal[k]) > cull_magnitude(plane.normal[axis])) axis = k;
    int64_t parts[3];
    middle_of(r->s, p, parts);
    set_out(r, parts, attempt, axis, plane.normal[axis] > 0 ? 1 : -1);
    r->ray.start = *plane_table_canonical(r->s->planes, p->plane);
    const int front = cull_normals_sign(&r->ray.a, &r->ray.b, &plane);
    if (front != r->ray.forward || hit_of(r, p, &r->ray.start) != HIT_INSIDE) return RESULT_OK;
    return shoot(r, face >> 1, end);
}

// ---- Asking ----

uint32_t ray_crossings(const ray_space *r, uint32_t shell)
{
    return r->counts[shell].crossings;
}

uint32_t ray_innermost(const ray_space *r, const uint8_t *is_wanted)
{
    uint32_t best = SHELL_NONE;
    for (size_t i = 0; i < r->touched.count; ++i) {
        const uint32_t shell = ((uint32_t *)r->touched.items)[i];
        const ray_count *c = &r->counts[shell];
        if (!(c->crossings & 1) || (is_wanted && !is_wanted[shell])) continue;
        if (best == SHELL_NONE || is_behind(r, r->counts[best].last_face, c->last_face)) best = shell;
    }
    return best;
}
