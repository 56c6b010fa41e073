// Portals between automatic rooms: pieces of one plane between the same two rooms that touch become one convex portal where it is
// not much larger than they are. A portal may be larger than its hole: what lies around it hides the rest.
// SPDX-License-Identifier: MIT
#include "items.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double LARGER_MOST = 1.5; // the joined portal's area over that of its pieces
// Share of a portal's size by which a corner may stand out of its hull and be left out: far below a float's step.
static const double FLAT_SHARE = 1e-12;

typedef struct flat_point { double at[2], position[3]; uint32_t vertex; } flat_point; // at: on the plane's main axes; position: grid steps

typedef struct joined {
    uint32_t first, count; // in points: its hull, counterclockwise on the main axes
    double area;           // of its pieces, on the main axes
    uint32_t is_gone;
} joined;

typedef struct joining {
    const item_job *job;
    buffer points;  // flat_point
    buffer groups;  // joined: of one plane and pair of rooms
    buffer scratch; // flat_point
    const compiled_portal *like;
    uint32_t axes[2], numbered;
    int is_turned; // counterclockwise on the axes is clockwise from the plane's front
} joining;

// ---- Hulls ----

static double cross(const flat_point *a, const flat_point *b, const flat_point *c)
{
    return (b->at[0] - a->at[0]) * (c->at[1] - a->at[1]) - (b->at[1] - a->at[1]) * (c->at[0] - a->at[0]);
}

static int by_place(const void *a, const void *b)
{
    const flat_point *x = a, *y = b;
    for (int k = 0; k < 2; ++k)
        if (x->at[k] != y->at[k]) return x->at[k] < y->at[k] ? -1 : 1;
    return 0;
}

static double area_of(const flat_point *p, uint32_t count)
{
    double twice = 0;
    for (uint32_t i = 2; i < count; ++i) twice += cross(&p[0], &p[i - 1], &p[i]);
    return twice / 2;
}

// One chain of Andrew's hull (Another Efficient Algorithm for Convex Hulls in Two Dimensions, 1979) onto `out`.
static uint32_t chain_push(flat_point *out, uint32_t base, uint32_t count, const flat_point *p, double flat)
{
    while (count - base >= 2 && cross(&out[count - 2], &out[count - 1], p) <= flat) --count;
    out[count] = *p;
    return count + 1;
}

// Of the points in scratch, appended to points.
static result hull_make(joining *j, joined *out)
{
    const uint32_t count = (uint32_t)j->scratch.count;
    flat_point *from = j->scratch.items;
    qsort(from, count, sizeof *from, by_place);
    flat_point *to = buffer_push(&j->points, 2 * (size_t)count);
    if (!to) return RESULT_NO_MEMORY;
    const double wide = from[count - 1].at[0] - from[0].at[0], flat = FLAT_SHARE * wide * wide;
    uint32_t n = 0;
    for (uint32_t i = 0; i < count; ++i) n = chain_push(to, 0, n, &from[i], flat);
    const uint32_t lower = n - 1;
    for (uint32_t i = count - 1; i-- > 0;) n = chain_push(to, lower, n, &from[i], flat);
    out->count = n - 1; // the first point again
    out->first = (uint32_t)(to - (flat_point *)j->points.items);
    j->points.count = out->first + out->count;
    return RESULT_OK;
}

static flat_point *points_of(const joining *j, const joined *g)
{
    return (flat_point *)j->points.items + g->first;
}

// ---- One group ----

static void axes_find(joining *j)
{
    const cull_wide_plane p = plane_table_get(j->job->in->planes, j->like->plane);
    uint32_t axis = 0;
    for (uint32_t k = 1; k < 3; ++k)
        if (cull_magnitude(p.normal[k]) > cull_magnitude(p.normal[axis])) axis = k;
    j->axes[0] = (axis + 1) % 3;
    j->axes[1] = (axis + 2) % 3;
    j->is_turned = p.normal[axis] < 0;
}

static result group_add(joining *j, const compiled_portal *portal)
{
    const compile_mesh *m = j->job->zones->mesh;
    j->scratch.count = 0;
    for (uint32_t i = 0; i < portal->vertex_count; ++i) {
        flat_point *p = buffer_push(&j->scratch, 1);
        if (!p) return RESULT_NO_MEMORY;
        p->vertex = m->loop[portal->first_vertex + i];
        memcpy(p->position, m->vertices[p->vertex].position, sizeof p->position);
        for (int k = 0; k < 2; ++k) p->at[k] = p->position[j->axes[k]];
    }
    joined made = {0};
    const result r = hull_make(j, &made);
    if (r != RESULT_OK) return r;
    made.area = area_of(points_of(j, &made), made.count);
    return buffer_append(&j->groups, &made, 1) ? RESULT_OK : RESULT_NO_MEMORY;
}

static int boxes_touch(const joining *j, const joined *a, const joined *b)
{
    const flat_point *p = points_of(j, a), *q = points_of(j, b);
    for (int k = 0; k < 2; ++k) {
        double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
        for (uint32_t i = 0; i < a->count; ++i) low[0] = fmin(low[0], p[i].at[k]), high[0] = fmax(high[0], p[i].at[k]);
        for (uint32_t i = 0; i < b->count; ++i) low[1] = fmin(low[1], q[i].at[k]), high[1] = fmax(high[1], q[i].at[k]);
        if (low[0] > high[1] || low[1] > high[0]) return 0;
    }
    return 1;
}

// 1 in `done`: b has become part of a.
static result pair_try(joining *j, size_t a, size_t b, int *done)
{
    joined *g = j->groups.items;
    *done = 0;
    if (!boxes_touch(j, &g[a], &g[b])) return RESULT_OK;
    j->scratch.count = 0;
    if (!buffer_append(&j->scratch, points_of(j, &g[a]), g[a].count) || !buffer_append(&j->scratch, points_of(j, &g[b]), g[b].count)) return RESULT_NO_MEMORY;
    joined both = {.area = g[a].area + g[b].area};
    const size_t before = j->points.count;
    const result r = hull_make(j, &both);
    if (r != RESULT_OK) return r;
    if (area_of(points_of(j, &both), both.count) > LARGER_MOST * both.area) {
        j->points.count = before;
        return RESULT_OK;
    }
    g[b].is_gone = 1;
    g[a] = both;
    *done = 1;
    return RESULT_OK;
}

static result group_join(joining *j)
{
    result r = RESULT_OK;
    for (int again = 1; again && r == RESULT_OK;) {
        again = 0;
        for (size_t a = 0; a < j->groups.count && r == RESULT_OK; ++a)
            for (size_t b = 0; b < j->groups.count && r == RESULT_OK; ++b) {
                const joined *g = j->groups.items;
                int done;
                if (a == b || g[a].is_gone || g[b].is_gone) continue;
                r = pair_try(j, a, b, &done);
                again |= r == RESULT_OK && done;
            }
    }
    return r;
}

static result portal_emit(joining *j, const joined *g)
{
    const flat_point *p = points_of(j, g);
    double(*points)[3] = memory_alloc(j->job->memory, g->count, sizeof *points);
    if (!points) return RESULT_NO_MEMORY;
    for (uint32_t i = 0; i < g->count; ++i)
        for (int k = 0; k < 3; ++k) points[i][k] = p[j->is_turned ? g->count - 1 - i : i].position[k] / j->job->in->steps_per_metre;
    char name[32];
    double plane[4];
    item_plane(j->job, j->like->plane, plane);
    snprintf(name, sizeof name, "opening %u", j->numbered++);
    const builder_portal made = {.name = name, .points = (const double(*)[3])points, .point_count = g->count,
                                 .zones = {j->like->zones[0], j->like->zones[1]}, .door = SCENE_NONE, .normal = plane};
    const char *fault = NULL;
    uint32_t added;
    result r = scene_builder_portal(j->job->builder, &made, &added, &fault);
    if (r == RESULT_BAD_INPUT) r = report_error(j->job->report, j->job->in->path, 0, "%s %s; please report the map", name, fault);
    memory_free(j->job->memory, points, g->count, sizeof *points);
    return r;
}

// ---- All groups ----

typedef struct portal_key { uint32_t zones[2]; plane_ref plane; uint32_t portal; } portal_key;

static int by_group(const void *a, const void *b)
{
    const portal_key *x = a, *y = b;
    for (int k = 0; k < 2; ++k)
        if (x->zones[k] != y->zones[k]) return x->zones[k] < y->zones[k] ? -1 : 1;
    if (x->plane != y->plane) return x->plane < y->plane ? -1 : 1;
    return (x->portal > y->portal) - (x->portal < y->portal);
}

static int is_one_group(const portal_key *a, const portal_key *b)
{
    return a->zones[0] == b->zones[0] && a->zones[1] == b->zones[1] && a->plane == b->plane;
}

static result group_do(joining *j, const portal_key *keys, uint32_t count)
{
    j->points.count = j->groups.count = 0;
    j->like = &j->job->zones->portals[keys[0].portal];
    axes_find(j);
    result r = RESULT_OK;
    for (uint32_t i = 0; i < count && r == RESULT_OK; ++i) r = group_add(j, &j->job->zones->portals[keys[i].portal]);
    if (r == RESULT_OK) r = group_join(j);
    for (size_t i = 0; i < j->groups.count && r == RESULT_OK; ++i) {
        const joined *g = (joined *)j->groups.items + i;
        if (!g->is_gone) r = portal_emit(j, g);
    }
    return r;
}

result items_joined_portals(const item_job *job)
{
    const compiled_zones *z = job->zones;
    portal_key *keys = memory_alloc(job->memory, z->portal_count, sizeof *keys);
    if (!keys) return RESULT_NO_MEMORY;
    uint32_t count = 0;
    for (uint32_t i = 0; i < z->portal_count; ++i)
        if (z->portals[i].entity == COMPILE_NOTHING)
            keys[count++] = (portal_key){{z->portals[i].zones[0], z->portals[i].zones[1]}, z->portals[i].plane, i};
    if (count) qsort(keys, count, sizeof *keys, by_group);
    joining j = {.job = job,
                 .points = buffer_make(job->memory, sizeof(flat_point)),
                 .groups = buffer_make(job->memory, sizeof(joined)),
                 .scratch = buffer_make(job->memory, sizeof(flat_point))};
    result r = RESULT_OK;
    for (uint32_t first = 0, end; first < count && r == RESULT_OK; first = end) {
        for (end = first + 1; end < count && is_one_group(&keys[first], &keys[end]);) ++end;
        r = group_do(&j, keys + first, end - first);
    }
    memory_free(job->memory, keys, z->portal_count, sizeof *keys);
    buffer_free(&j.points);
    buffer_free(&j.groups);
    buffer_free(&j.scratch);
    return r;
}
