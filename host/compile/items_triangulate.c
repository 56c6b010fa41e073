// Triangles of convex loops with vertices along their sides: ears, widest first, none of three vertices of one side.
// SPDX-License-Identifier: MIT
// Invariant: which ears have an area is decided by which vertices share a side, exactly; rounded points only choose among them.
#include "items.h"

#include <math.h>
#include <string.h>

loop_triangulator loop_triangulator_make(const item_job *j, const rounded_mesh *rounded)
{
    return (loop_triangulator){.job = j,
                               .mesh = j->zones->mesh,
                               .rounded = rounded,
                               .corners = buffer_make(j->memory, sizeof(loop_corner)),
                               .counts = buffer_make(j->memory, sizeof(uint32_t))};
}

void loop_triangulator_free(loop_triangulator *t)
{
    buffer_free(&t->corners);
    buffer_free(&t->counts);
}

// ---- Corners ----

// Vertices in a row that are rounded to one point are one corner, on the sides before the first and after the last of them.
static int push_corner(loop_triangulator *t, const loop_corner *c)
{
    loop_corner *all = t->corners.items;
    if (t->corners.count && all[t->corners.count - 1].vertex == c->vertex) {
        all[t->corners.count - 1].sides[1] = c->sides[1];
        return 1;
    }
    return buffer_append(&t->corners, c, 1) != NULL;
}

static result take_corners(loop_triangulator *t, const compile_polygon *p, uint32_t *side_count)
{
    uint32_t start = 0, side = 0;
    while (start < p->vertex_count && item_goes_straight(t->job, p, start)) start++;
    t->corners.count = 0;
    if (start == p->vertex_count) return RESULT_OK;
    for (uint32_t i = 0; i < p->vertex_count; ++i) {
        const uint32_t at = (start + i) % p->vertex_count;
        loop_corner c = {.vertex = t->rounded->same_as[t->mesh->loop[p->first_vertex + at]], .place = at, .sides = {side, side}};
        if (i && !item_goes_straight(t->job, p, at)) c.sides[1] = ++side;
        if (!push_corner(t, &c)) return RESULT_NO_MEMORY;
    }
    loop_corner *all = t->corners.items;
    all[0].sides[0] = side;
    while (t->corners.count > 1 && all[t->corners.count - 1].vertex == all[0].vertex) all[0].sides[0] = all[--t->corners.count].sides[0];
    *side_count = side + 1;
    return RESULT_OK;
}

// ---- Ears ----

static int is_on(const loop_corner *c, uint32_t side)
{
    return c->sides[0] == side || c->sides[1] == side;
}

static int are_straight(const loop_corner *a, const loop_corner *b, const loop_corner *c)
{
    return (is_on(a, b->sides[0]) && is_on(c, b->sides[0])) || (is_on(a, b->sides[1]) && is_on(c, b->sides[1]));
}

// Twice the area over the longest edge, squared, with the sign of the turn at the middle one of three vertices of the mesh.
// Products and sums are exact: below 2^53.
static double width_of(const loop_triangulator *t, const compile_polygon *p, const uint32_t corners[3])
{
    const int32_t *q = t->rounded->points[corners[0]], *o = t->rounded->points[corners[1]], *r = t->rounded->points[corners[2]];
    const cull_wide_plane *plane = plane_table_canonical(t->job->in->planes, p->plane);
    double u[3], v[3], along = 0, cross[3], size = 0, longest = 0, lengths[3] = {0};
    for (int k = 0; k < 3; ++k) {
        u[k] = (double)r[k] - o[k];
        v[k] = (double)q[k] - o[k];
        lengths[0] += u[k] * u[k];
        lengths[1] += v[k] * v[k];
        lengths[2] += ((double)r[k] - q[k]) * ((double)r[k] - q[k]);
    }
    for (int k = 0; k < 3; ++k) {
        cross[k] = u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
        along += cross[k] * (double)plane->normal[k];
        size += cross[k] * cross[k];
        longest = lengths[k] > longest ? lengths[k] : longest;
    }
    if (size == 0 || longest == 0) return 0;
    return along * plane_ref_sign(p->plane) > 0 ? size / longest : -size / longest;
}

static void measure(loop_triangulator *t, const compile_polygon *p, uint32_t at)
{
    loop_corner *all = t->corners.items;
    const uint32_t ear[3] = {all[all[at].before].vertex, all[at].vertex, all[all[at].after].vertex};
    all[at].width = width_of(t, p, ear);
}

// An ear with an area that leaves some area, or nothing: not the one corner that the others' line faces.
static int is_ear(const loop_triangulator *t, uint32_t at, uint32_t left)
{
    const loop_corner *all = t->corners.items, *c = &all[at];
    const uint32_t *counts = t->counts.items;
    if (are_straight(&all[c->before], c, &all[c->after])) return 0;
    if (left == 3) return 1;
    const loop_corner *other = &all[c->after];
    for (int i = 0; i < 2; ++i)
        if (!is_on(c, other->sides[i]) && counts[other->sides[i]] == left - 1) return 0;
    return 1;
}

static uint32_t widest_ear(const loop_triangulator *t, uint32_t first, uint32_t left)
{
    const loop_corner *all = t->corners.items;
    uint32_t best = UINT32_MAX, at = first;
    for (uint32_t i = 0; i < left; ++i, at = all[at].after)
        if ((best == UINT32_MAX || all[at].width > all[best].width) && is_ear(t, at, left)) best = at;
    return best;
}

static void count_off(loop_triangulator *t, const loop_corner *c, uint32_t by)
{
    uint32_t *counts = t->counts.items;
    counts[c->sides[0]] += by;
    if (c->sides[1] != c->sides[0]) counts[c->sides[1]] += by;
}

static result clip(loop_triangulator *t, const compile_polygon *p, buffer *triangles)
{
    loop_corner *all = t->corners.items;
    uint32_t first = 0;
    for (uint32_t left = (uint32_t)t->corners.count; left >= 3; --left) {
        const uint32_t ear = widest_ear(t, first, left);
        if (ear == UINT32_MAX) return RESULT_OK; // flat when rounded: nothing is left to see
        loop_corner *c = &all[ear], *before = &all[c->before], *after = &all[c->after];
        const uint32_t triangle[3] = {before->place, c->place, after->place};
        const int is_whole = before->vertex != c->vertex && c->vertex != after->vertex && after->vertex != before->vertex;
        if (is_whole && !buffer_append(triangles, triangle, 3)) return RESULT_NO_MEMORY;
        count_off(t, c, UINT32_MAX);
        before->after = c->after;
        after->before = c->before;
        first = c->after;
        measure(t, p, c->before);
        measure(t, p, c->after);
    }
    return RESULT_OK;
}

// ---- Triangles that rounding has made flat ----

static double triangle_width(const loop_triangulator *t, const compile_polygon *p, const uint32_t places[3])
{
    uint32_t v[3];
    for (int k = 0; k < 3; ++k) v[k] = t->rounded->same_as[t->mesh->loop[p->first_vertex + places[k]]];
    return width_of(t, p, v);
}

static double smaller(double a, double b)
{
    return fabs(a) < fabs(b) ? a : b;
}

typedef struct diagonal_flip { uint32_t *one, *other, made[2][3]; double width; } diagonal_flip; // width: of the thinner; 0: no flip

// The edge from place k of `one`, as the diagonal of two triangles, turned to the other diagonal.
static void try_flip(const loop_triangulator *t, const compile_polygon *p, uint32_t *one, int k, buffer *triangles, diagonal_flip *best)
{
    const uint32_t a = one[k], b = one[(k + 1) % 3], c = one[(k + 2) % 3];
    uint32_t *all = triangles->items;
    for (size_t i = 0; i < triangles->count; i += 3)
        for (int j = 0; j < 3; ++j) {
            if (all[i + (size_t)j] != b || all[i + (size_t)((j + 1) % 3)] != a) continue;
            const uint32_t d = all[i + (size_t)((j + 2) % 3)];
            diagonal_flip flip = {one, all + i, {{a, d, c}, {d, b, c}}, 0};
            flip.width = fabs(smaller(triangle_width(t, p, flip.made[0]), triangle_width(t, p, flip.made[1])));
            if (flip.width > best->width) *best = flip;
        }
}

// A vertex inside a side leaves the line of the side when it is rounded, and then may lie in that of a diagonal. The count of
// those turned.
static uint32_t flip_flat(const loop_triangulator *t, const compile_polygon *p, buffer *triangles)
{
    uint32_t *all = triangles->items, count = 0;
    for (size_t i = 0; i < triangles->count; i += 3) {
        if (triangle_width(t, p, all + i) != 0) continue;
        diagonal_flip best = {.width = 0};
        for (int k = 0; k < 3; ++k) try_flip(t, p, all + i, k, triangles, &best);
        if (best.width == 0) continue; // what lies beside it is flat too, yet or at all
        memcpy(best.one, best.made[0], sizeof best.made[0]);
        memcpy(best.other, best.made[1], sizeof best.made[1]);
        ++count;
    }
    return count;
}

static result push_true_corners(const loop_triangulator *t, buffer *loop)
{
    const loop_corner *all = t->corners.items;
    for (size_t i = 0; i < t->corners.count; ++i)
        if (all[i].sides[0] != all[i].sides[1] && !buffer_append(loop, &all[i].place, 1)) return RESULT_NO_MEMORY;
    return RESULT_OK;
}

result loop_triangulate(loop_triangulator *t, const compile_polygon *p, buffer *loop, buffer *triangles)
{
    uint32_t sides = 0;
    loop->count = triangles->count = t->counts.count = 0;
    const result done = take_corners(t, p, &sides);
    const uint32_t count = (uint32_t)t->corners.count;
    if (done != RESULT_OK || count < 3) return done;
    uint32_t *counts = buffer_push(&t->counts, sides);
    if (!counts) return RESULT_NO_MEMORY;
    for (uint32_t i = 0; i < sides; ++i) counts[i] = 0;
    loop_corner *all = t->corners.items;
    for (uint32_t i = 0; i < count; ++i) {
        all[i].before = i ? i - 1 : count - 1;
        all[i].after = i + 1 < count ? i + 1 : 0;
        count_off(t, &all[i], 1);
    }
    for (uint32_t i = 0; i < count; ++i) measure(t, p, i);
    if (push_true_corners(t, loop) != RESULT_OK) return RESULT_NO_MEMORY;
    if (clip(t, p, triangles) != RESULT_OK) return RESULT_NO_MEMORY;
    while (flip_flat(t, p, triangles)) continue; // ends: each turn leaves a flat triangle less
    return RESULT_OK;
}
