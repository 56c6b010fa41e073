// Portals between automatic rooms: pieces of one plane between the same two rooms that touch become one convex portal where it is
// not much larger than they are. A portal may be larger than its hole: what lies around it hides the rest.
// SPDX-License-Identifier: MIT
#include "flat_hulls.h"
#include "items.h"

#include <stdio.h>
#include <stdlib.h>

typedef struct joining {
    const item_job *job;
    flat_hulls hulls; // of one plane and pair of rooms
    const compiled_portal *like;
    uint32_t numbered;
} joining;

// ---- One group ----

static result piece_add(joining *j, const compiled_portal *portal)
{
    const compile_mesh *m = j->job->zones->mesh;
    result r = RESULT_OK;
    for (uint32_t i = 0; i < portal->vertex_count && r == RESULT_OK; ++i)
        r = flat_hulls_corner(&j->hulls, m->vertices[m->loop[portal->first_vertex + i]].position);
    return r == RESULT_OK ? flat_hulls_close(&j->hulls) : r;
}

static result portal_emit(joining *j, const flat_hull *g)
{
    const flat_point *p = flat_hull_points(&j->hulls, g);
    double(*points)[3] = memory_alloc(j->job->memory, g->count, sizeof *points);
    if (!points) return RESULT_NO_MEMORY;
    for (uint32_t i = 0; i < g->count; ++i)
        for (int k = 0; k < 3; ++k) points[i][k] = p[j->hulls.is_turned ? g->count - 1 - i : i].position[k] / j->job->in->steps_per_metre;
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

typedef struct portal_key { uint32_t zones[2], plane, portal; } portal_key; // zones: in front of the plane unflipped, behind

static portal_key key_of(const compiled_zones *z, uint32_t portal)
{
    const compiled_portal *p = &z->portals[portal];
    const uint32_t flipped = p->plane & 1;
    return (portal_key){{p->zones[flipped], p->zones[1 - flipped]}, p->plane >> 1, portal};
}

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
    uint32_t left;
    j->like = &j->job->zones->portals[keys[0].portal];
    flat_hulls_start(&j->hulls, j->job->in->planes, j->like->plane);
    result r = RESULT_OK;
    for (uint32_t i = 0; i < count && r == RESULT_OK; ++i) r = piece_add(j, &j->job->zones->portals[keys[i].portal]);
    if (r == RESULT_OK) r = flat_hulls_join(&j->hulls, &left);
    for (size_t i = 0; i < j->hulls.hulls.count && r == RESULT_OK; ++i) {
        const flat_hull *g = (flat_hull *)j->hulls.hulls.items + i;
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
        if (z->portals[i].entity == COMPILE_NOTHING) keys[count++] = key_of(z, i);
    if (count) qsort(keys, count, sizeof *keys, by_group);
    joining j = {.job = job, .hulls = flat_hulls_make(job->memory)};
    result r = RESULT_OK;
    for (uint32_t first = 0, end; first < count && r == RESULT_OK; first = end) {
        for (end = first + 1; end < count && is_one_group(&keys[first], &keys[end]);) ++end;
        r = group_do(&j, keys + first, end - first);
    }
    memory_free(job->memory, keys, z->portal_count, sizeof *keys);
    flat_hulls_free(&j.hulls);
    return r;
}
