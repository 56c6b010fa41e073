// Walls' triangles that rounding has laid onto one line: the middle one of their vertices goes into the triangle beyond their
// longest edge, in whatever polygon that is. This is an edge flip; what was closed stays so.
// SPDX-License-Identifier: MIT
// Invariant: the directed edges of all triangles together, less those that run both ways, stay the same.
#include "items.h"


enum { ROUNDS_MOST = 16, FLIPS_MOST = 2048 }; // each looks through all triangles

typedef struct flat_mender {
    item_job *job;
    const rounded_mesh *rounded;
    buffer *walls; // wall_triangle
    const uint32_t *first_vertex;
    uint8_t *is_closed;
} flat_mender;

typedef struct long_edge { int at; int64_t size; } long_edge; // from corner `at` to the next; squared steps

static const int32_t *point_of(const flat_mender *m, uint32_t vertex)
{
    return m->rounded->points[vertex];
}

static int is_flat(const flat_mender *m, const wall_triangle *t)
{
    const int32_t *a = point_of(m, t->vertices[0]), *b = point_of(m, t->vertices[1]), *c = point_of(m, t->vertices[2]);
    int64_t u[3], v[3];
    for (int k = 0; k < 3; ++k) {
        u[k] = (int64_t)b[k] - a[k];
        v[k] = (int64_t)c[k] - a[k];
    }
    return u[1] * v[2] == u[2] * v[1] && u[2] * v[0] == u[0] * v[2] && u[0] * v[1] == u[1] * v[0];
}

static int is_solid_wall(const flat_mender *m, const wall_triangle *t)
{
    if (t->polygon == SCENE_NONE) return 0;
    const compile_polygon *p = &m->job->zones->mesh->polygons[t->polygon];
    return m->job->in->brushes[p->brush].role != BRUSH_LIQUID;
}

static long_edge longest_of(const flat_mender *m, const wall_triangle *t)
{
    long_edge best = {0, -1};
    for (int i = 0; i < 3; ++i) {
        const int32_t *a = point_of(m, t->vertices[i]), *b = point_of(m, t->vertices[(i + 1) % 3]);
        int64_t size = 0;
        for (int k = 0; k < 3; ++k) size += ((int64_t)b[k] - a[k]) * ((int64_t)b[k] - a[k]);
        if (size > best.size) best = (long_edge){i, size};
    }
    return best;
}

static int edge_from_to(const flat_mender *m, const wall_triangle *t, uint32_t from, uint32_t to) // its first corner; -1: none
{
    const uint32_t *same = m->rounded->same_as;
    for (int i = 0; i < 3; ++i)
        if (same[t->vertices[i]] == same[from] && same[t->vertices[(i + 1) % 3]] == same[to]) return i;
    return -1;
}

typedef struct neighbour { wall_triangle *triangle; int edge, rank; } neighbour;

// Beyond the edge; best one with an area and of the same zone.
static neighbour neighbour_of(const flat_mender *m, const wall_triangle *t, const long_edge *e)
{
    const uint32_t from = t->vertices[(e->at + 1) % 3], to = t->vertices[e->at];
    const uint32_t *zones = m->job->zones->polygon_zone;
    wall_triangle *all = m->walls->items;
    neighbour best = {NULL, 0, -1};
    for (size_t i = 0; i < m->walls->count && best.rank < 3; ++i) {
        if (&all[i] == t || !is_solid_wall(m, &all[i])) continue;
        const int edge = edge_from_to(m, &all[i], from, to);
        if (edge < 0) continue;
        const int rank = 2 * !is_flat(m, &all[i]) + (zones[all[i].polygon] == zones[t->polygon]);
        if (rank > best.rank) best = (neighbour){&all[i], edge, rank};
    }
    return best;
}

// The mesh's vertex in the builder, as a corner of that polygon.
static result corner_in(const flat_mender *m, uint32_t vertex, uint32_t polygon, uint32_t *out)
{
    const item_job *j = m->job;
    const compile_mesh *mesh = j->zones->mesh;
    const compile_polygon *p = &mesh->polygons[polygon];
    for (uint32_t i = 0; i < p->vertex_count; ++i)
        if (mesh->loop[p->first_vertex + i] == vertex) {
            *out = m->first_vertex[polygon] + i;
            return RESULT_OK;
        }
    builder_vertex made = {.normal = {0, 0, 0}};
    for (int k = 0; k < 3; ++k) made.position[k] = mesh->vertices[vertex].position[k] / j->in->steps_per_metre;
    item_texcoord(&j->in->faces[p->face], made.position, made.texcoord);
    return scene_builder_vertices(j->builder, &made, 1, j->material_of[p->material], out);
}

static void set_triangle(const flat_mender *m, wall_triangle *t, const wall_triangle *to)
{
    const uint32_t *same = m->rounded->same_as, a = same[to->vertices[0]], b = same[to->vertices[1]], c = same[to->vertices[2]];
    *t = *to;
    if (a == b || b == c || c == a) t->polygon = SCENE_NONE; // its edges run both ways
}

// Flat (p, q, b) and (q, p, d) beyond it become (b, p, d) and (q, b, d), both of the other's polygon.
static result flip(const flat_mender *m, wall_triangle *t, const long_edge *e, const neighbour *n)
{
    const wall_triangle was = *n->triangle;
    const int q = n->edge, p = (n->edge + 1) % 3, d = (n->edge + 2) % 3;
    const uint32_t middle = t->vertices[(e->at + 2) % 3];
    uint32_t corner;
    const result done = corner_in(m, middle, was.polygon, &corner);
    if (done != RESULT_OK) return done;
    m->is_closed[t->polygon] = 1;
    const wall_triangle one = {{middle, was.vertices[p], was.vertices[d]}, {corner, was.corners[p], was.corners[d]}, was.polygon};
    const wall_triangle other = {{was.vertices[q], middle, was.vertices[d]}, {was.corners[q], corner, was.corners[d]}, was.polygon};
    set_triangle(m, t, &one);
    set_triangle(m, n->triangle, &other);
    return RESULT_OK;
}

static result mend_round(const flat_mender *m, uint32_t *flips)
{
    wall_triangle *all = m->walls->items;
    for (size_t i = 0; i < m->walls->count && *flips < FLIPS_MOST; ++i) {
        if (!is_solid_wall(m, &all[i]) || !is_flat(m, &all[i])) continue;
        const long_edge e = longest_of(m, &all[i]);
        const neighbour n = neighbour_of(m, &all[i], &e);
        if (!n.triangle) continue;
        if (n.rank < 2 && longest_of(m, n.triangle).size > e.size) continue; // that one first
        const result done = flip(m, &all[i], &e, &n);
        if (done != RESULT_OK) return done;
        ++*flips;
    }
    return RESULT_OK;
}

result items_mend_flat(item_job *j, const rounded_mesh *rounded, const uint32_t *first_vertex, buffer *walls, uint8_t *is_closed)
{
    const flat_mender m = {.job = j, .rounded = rounded, .walls = walls, .first_vertex = first_vertex, .is_closed = is_closed};
    uint32_t before = UINT32_MAX, flips = 0;
    result done = RESULT_OK;
    for (int round = 0; round < ROUNDS_MOST && flips != before && done == RESULT_OK; ++round) {
        before = flips;
        done = mend_round(&m, &flips);
    }
    return done;
}
