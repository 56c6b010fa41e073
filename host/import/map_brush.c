// Brushes: see map_brush.h. Cutting keeps one polyhedron with shared vertices instead of one winding a face, so that a
// rounding decision about a vertex is taken once, for all faces that meet there.
// SPDX-License-Identifier: MIT
#include "map_brush.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { BOX_PLANES = 6, TOLERANCES_TRIED = 4 };
static const double TOLERANCE_STEP = 1.0 / 16; // a body that doesn't close is tried again this much finer
static const double COLLINEAR = 1e-12; // sine of the angle between a face's two edges: rounding of double alone reaches 1e-15
static const double EXACT_INTEGER_MOST = 9007199254740992.0; // 2^53

typedef struct edge_cut { // a vertex between two others, found by them
    uint32_t low, high, vertex, cut;
} edge_cut;

typedef struct plane_place {
    double unit[3], distance;
    uint32_t plane;
} plane_place;

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static double distance_of(const brush_plane *plane, const double p[3])
{
    return (dot(plane->normal, p) - plane->distance) / plane->length;
}

// ---- Planes ----

static int is_integer(double x)
{
    return fabs(x) < EXACT_INTEGER_MOST && x == floor(x);
}

static double common_divisor(double a, double b)
{
    a = fabs(a);
    b = fabs(b);
    while (b > 0) {
        const double rest = fmod(a, b);
        a = b;
        b = rest;
    }
    return a;
}

int brush_plane_from_points(const double points[3][3], brush_plane *out)
{
    double a[3], b[3], normal[3];
    for (int k = 0; k < 3; ++k) {
        a[k] = points[0][k] - points[1][k];
        b[k] = points[2][k] - points[1][k];
    }
    cross(a, b, normal);
    const double length = sqrt(dot(normal, normal));
    if (!(length > COLLINEAR * sqrt(dot(a, a)) * sqrt(dot(b, b)))) return 0;
    if (is_integer(normal[0]) && is_integer(normal[1]) && is_integer(normal[2])) {
        const double divisor = common_divisor(common_divisor(normal[0], normal[1]), normal[2]);
        for (int k = 0; k < 3; ++k) normal[k] /= divisor;
    }
    memcpy(out->normal, normal, sizeof normal);
    out->distance = dot(normal, points[1]);
    out->length = sqrt(dot(normal, normal));
    return out->length > 0;
}

brush_plane brush_plane_from_unit(const double normal[3], double distance)
{
    return (brush_plane){{normal[0], normal[1], normal[2]}, distance, 1};
}

static int compare_planes(const void *left, const void *right)
{
    const plane_place *a = left, *b = right;
    for (int k = 0; k < 3; ++k)
        if (a->unit[k] != b->unit[k]) return a->unit[k] < b->unit[k] ? -1 : 1;
    if (a->distance != b->distance) return a->distance < b->distance ? -1 : 1;
    return a->plane < b->plane ? -1 : a->plane > b->plane;
}

static int sort_planes(brush_body *b, const brush_plane *planes, uint32_t count)
{
    b->order.count = 0;
    plane_place *order = buffer_push(&b->order, count);
    if (!order) return 0;
    for (uint32_t i = 0; i < count; ++i) {
        for (int k = 0; k < 3; ++k) order[i].unit[k] = planes[i].normal[k] / planes[i].length;
        order[i].distance = planes[i].distance / planes[i].length;
        order[i].plane = i;
    }
    qsort(order, count, sizeof *order, compare_planes);
    return 1;
}

// ---- The body and its first box ----

brush_body brush_body_make(const allocator *memory)
{
    return (brush_body){.vertices = buffer_make(memory, sizeof(brush_vertex)),
                        .loops = buffer_make(memory, sizeof(brush_loop)),
                        .corners = buffer_make(memory, sizeof(uint32_t)),
                        .other_loops = buffer_make(memory, sizeof(brush_loop)),
                        .other_corners = buffer_make(memory, sizeof(uint32_t)),
                        .order = buffer_make(memory, sizeof(plane_place)),
                        .edges = buffer_make(memory, sizeof(edge_cut))};
}

void brush_body_free(brush_body *b)
{
    buffer *const all[] = {&b->vertices, &b->loops, &b->corners, &b->other_loops, &b->other_corners, &b->order, &b->edges};
    for (size_t i = 0; i < sizeof all / sizeof *all; ++i) buffer_free(all[i]);
}

static uint32_t add_vertex(brush_body *b, const double position[3])
{
    brush_vertex *v = buffer_push(&b->vertices, 1);
    if (!v) return UINT32_MAX;
    *v = (brush_vertex){.position = {position[0], position[1], position[2]}};
    return (uint32_t)b->vertices.count - 1;
}

// Vertex i of the box is low or high in x, y, z by its bits 0, 1, 2.
static int start_with_box(brush_body *b, uint32_t plane_count, double reach)
{
    static const uint32_t faces[BOX_PLANES][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    b->vertices.count = b->loops.count = b->corners.count = 0;
    for (uint32_t i = 0; i < 8; ++i) {
        const double position[3] = {i & 1 ? reach : -reach, i & 2 ? reach : -reach, i & 4 ? reach : -reach};
        if (add_vertex(b, position) == UINT32_MAX) return 0;
    }
    for (uint32_t f = 0; f < BOX_PLANES; ++f) {
        const brush_loop loop = {plane_count + f, f * 4, 4};
        if (!buffer_append(&b->loops, &loop, 1) || !buffer_append(&b->corners, faces[f], 4)) return 0;
    }
    return 1;
}

// ---- One cut ----

typedef struct sides { uint32_t inside, outside; } sides;

static sides classify(brush_body *b, const brush_plane *plane, double tolerance)
{
    brush_vertex *vertices = b->vertices.items;
    const uint32_t *corners = b->corners.items;
    sides s = {0, 0};
    for (size_t i = 0; i < b->corners.count; ++i) {
        brush_vertex *v = &vertices[corners[i]];
        if (v->seen == b->cut) continue;
        v->seen = b->cut;
        v->distance = distance_of(plane, v->position);
        v->side = v->distance > tolerance ? 1 : v->distance < -tolerance ? -1 : 0;
        s.inside += v->side < 0;
        s.outside += v->side > 0;
    }
    return s;
}

static int edges_reserve(brush_body *b)
{
    size_t size = 64;
    while (size < b->corners.count * 2) size *= 2;
    if (b->edges.count >= size) return 1;
    b->edges.count = 0;
    edge_cut *edges = buffer_push(&b->edges, size);
    if (!edges) return 0;
    memset(edges, 0, size * sizeof *edges);
    return 1;
}

static uint32_t cut_edge(brush_body *b, uint32_t from, uint32_t to)
{
    const uint32_t low = from < to ? from : to, high = from < to ? to : from;
    edge_cut *edges = b->edges.items;
    const size_t mask = b->edges.count - 1;
    size_t at = (low * 0x9e3779b9u ^ high * 0x85ebca6bu) & mask;
    for (; edges[at].cut == b->cut; at = (at + 1) & mask)
        if (edges[at].low == low && edges[at].high == high) return edges[at].vertex;
    const brush_vertex *v = b->vertices.items;
    const double part = v[low].distance / (v[low].distance - v[high].distance);
    double position[3];
    for (int k = 0; k < 3; ++k) position[k] = v[low].position[k] + part * (v[high].position[k] - v[low].position[k]);
    const uint32_t made = add_vertex(b, position);
    if (made == UINT32_MAX) return made;
    ((brush_vertex *)b->vertices.items)[made].seen = b->cut;
    edges[at] = (edge_cut){low, high, made, b->cut};
    return made;
}

// The part of one face that stays. What runs along the cut is an edge of the new face too, the other way round.
static brush_fault cut_loop(brush_body *b, const brush_loop *loop, uint32_t *links)
{
    const uint32_t first = (uint32_t)b->other_corners.count;
    int inside = 0;
    for (uint32_t i = 0; i < loop->count; ++i) {
        const uint32_t *corners = (const uint32_t *)b->corners.items + loop->first;
        const uint32_t from = corners[i], to = corners[(i + 1) % loop->count];
        const brush_vertex *v = b->vertices.items;
        const int from_side = v[from].side, to_side = v[to].side;
        inside |= from_side < 0;
        if (from_side <= 0 && !buffer_append(&b->other_corners, &from, 1)) return BRUSH_NO_MEMORY;
        if (from_side * to_side >= 0) continue;
        const uint32_t made = cut_edge(b, from, to);
        if (made == UINT32_MAX || !buffer_append(&b->other_corners, &made, 1)) return BRUSH_NO_MEMORY;
    }
    if (!inside) {
        b->other_corners.count = first;
        return BRUSH_SOUND;
    }
    const uint32_t count = (uint32_t)b->other_corners.count - first;
    const uint32_t *corners = (const uint32_t *)b->other_corners.items + first;
    brush_vertex *vertices = b->vertices.items;
    for (uint32_t i = 0; i < count; ++i) {
        const uint32_t from = corners[i], to = corners[(i + 1) % count];
        if (vertices[from].side != 0 || vertices[to].side != 0) continue;
        if (vertices[to].linked == b->cut) return BRUSH_BROKEN;
        vertices[to].linked = b->cut;
        vertices[to].next = from;
        ++*links;
    }
    const brush_loop kept = {loop->plane, first, count};
    return buffer_append(&b->other_loops, &kept, 1) ? BRUSH_SOUND : BRUSH_NO_MEMORY;
}

static uint32_t any_linked(const brush_body *b)
{
    const brush_vertex *vertices = b->vertices.items;
    const uint32_t *corners = b->other_corners.items;
    for (size_t i = 0; i < b->other_corners.count; ++i)
        if (vertices[corners[i]].linked == b->cut) return corners[i];
    return UINT32_MAX;
}

// The face that the cut lays open: its edges must form one ring.
static brush_fault close_cut(brush_body *b, uint32_t plane, uint32_t links)
{
    const brush_vertex *vertices = b->vertices.items;
    const uint32_t start = any_linked(b);
    if (links < 2 || start == UINT32_MAX) return BRUSH_BROKEN;
    const brush_loop loop = {plane, (uint32_t)b->other_corners.count, links};
    uint32_t *corners = buffer_push(&b->other_corners, links);
    if (!corners) return BRUSH_NO_MEMORY;
    uint32_t at = start;
    for (uint32_t i = 0; i < links; ++i) {
        if (vertices[at].linked != b->cut || (i > 0 && at == start)) return BRUSH_BROKEN;
        corners[i] = at;
        at = vertices[at].next;
    }
    if (at != start) return BRUSH_BROKEN;
    if (links > 2) return buffer_append(&b->other_loops, &loop, 1) ? BRUSH_SOUND : BRUSH_NO_MEMORY;
    b->other_corners.count -= links; // two faces meet in one edge: nothing is open
    return BRUSH_SOUND;
}

static brush_fault cut(brush_body *b, const brush_plane *plane, uint32_t number, double tolerance)
{
    b->cut++;
    const sides s = classify(b, plane, tolerance);
    if (s.inside == 0) return BRUSH_EMPTY;
    if (s.outside == 0) return BRUSH_SOUND;
    if (!edges_reserve(b)) return BRUSH_NO_MEMORY;
    b->other_corners.count = b->other_loops.count = 0;
    uint32_t links = 0;
    for (size_t i = 0; i < b->loops.count; ++i) {
        const brush_fault fault = cut_loop(b, (const brush_loop *)b->loops.items + i, &links);
        if (fault != BRUSH_SOUND) return fault;
    }
    const brush_fault fault = close_cut(b, number, links);
    if (fault != BRUSH_SOUND) return fault;
    const buffer loops = b->loops, corners = b->corners;
    b->loops = b->other_loops;
    b->corners = b->other_corners;
    b->other_loops = loops;
    b->other_corners = corners;
    return BRUSH_SOUND;
}

// ---- The vertices again, each from the planes that meet there, whatever the order of the cuts ----

static void note_planes(brush_body *b)
{
    brush_vertex *vertices = b->vertices.items;
    const brush_loop *loops = b->loops.items;
    const uint32_t *corners = b->corners.items;
    for (size_t l = 0; l < b->loops.count; ++l)
        for (uint32_t i = 0; i < loops[l].count; ++i) {
            brush_vertex *v = &vertices[corners[loops[l].first + i]];
            if (v->plane_count < sizeof v->planes / sizeof *v->planes) v->planes[v->plane_count++] = loops[l].plane;
        }
}

// From the first plane the one that leans most from it, then the one that leans most from their line.
static int choose_three(const brush_vertex *v, const brush_plane *planes, const brush_plane *out[3])
{
    double line[3] = {0}, best = 0;
    out[0] = &planes[v->planes[0]];
    for (uint32_t i = 1; i < v->plane_count; ++i) {
        const brush_plane *p = &planes[v->planes[i]];
        double c[3];
        cross(out[0]->normal, p->normal, c);
        const double lean = dot(c, c) / (p->length * p->length);
        if (lean <= best) continue;
        best = lean;
        out[1] = p;
        memcpy(line, c, sizeof line);
    }
    if (!(best > 0)) return 0;
    best = 0;
    for (uint32_t i = 1; i < v->plane_count; ++i) {
        const brush_plane *p = &planes[v->planes[i]];
        const double lean = fabs(dot(line, p->normal)) / p->length;
        if (lean <= best) continue;
        best = lean;
        out[2] = p;
    }
    return best > 0;
}

static int compare_pointers(const void *left, const void *right)
{
    const brush_plane *const *a = left, *const *b = right;
    for (int k = 0; k < 3; ++k)
        if ((*a)->normal[k] != (*b)->normal[k]) return (*a)->normal[k] < (*b)->normal[k] ? -1 : 1;
    return (*a)->distance < (*b)->distance ? -1 : (*a)->distance > (*b)->distance;
}

static int meet(const brush_plane *three[3], double out[3])
{
    double bc[3], ca[3], ab[3];
    cross(three[1]->normal, three[2]->normal, bc);
    cross(three[2]->normal, three[0]->normal, ca);
    cross(three[0]->normal, three[1]->normal, ab);
    const double determinant = dot(three[0]->normal, bc);
    for (int k = 0; k < 3; ++k)
        out[k] = (three[0]->distance * bc[k] + three[1]->distance * ca[k] + three[2]->distance * ab[k]) / determinant + 0.0;
    return isfinite(out[0]) && isfinite(out[1]) && isfinite(out[2]);
}

static void place_vertex(brush_vertex *v, const brush_plane *planes, double tolerance)
{
    const brush_plane *three[3];
    double position[3];
    if (v->plane_count < 3 || !choose_three(v, planes, three)) return;
    qsort(three, 3, sizeof *three, compare_pointers);
    if (!meet(three, position)) return;
    for (int k = 0; k < 3; ++k) // nearly parallel planes meet anywhere: keep where the cuts put it
        if (!(fabs(position[k] - v->position[k]) <= 4 * tolerance)) return;
    memcpy(v->position, position, sizeof position);
}

static void place_vertices(brush_body *b, const brush_plane *planes, double tolerance)
{
    brush_vertex *vertices = b->vertices.items;
    note_planes(b);
    for (size_t i = 0; i < b->vertices.count; ++i)
        if (vertices[i].plane_count) place_vertex(&vertices[i], planes, tolerance);
}

static int same_place(const brush_vertex *a, const brush_vertex *b)
{
    return a->position[0] == b->position[0] && a->position[1] == b->position[1] && a->position[2] == b->position[2];
}

// Edges that have become points go, on both of their sides, and faces with them that were no more than two edges.
static void drop_points(brush_body *b)
{
    const brush_vertex *v = b->vertices.items;
    brush_loop *loops = b->loops.items;
    uint32_t *corners = b->corners.items;
    size_t loops_kept = 0;
    for (size_t l = 0; l < b->loops.count; ++l) {
        uint32_t *at = corners + loops[l].first, kept = 0;
        const uint32_t count = loops[l].count;
        for (uint32_t i = 0; i < count; ++i)
            if (!same_place(&v[at[i]], &v[at[(i + 1) % count]])) at[kept++] = at[i];
        if (kept < 3) continue;
        loops[loops_kept] = loops[l];
        loops[loops_kept++].count = kept;
    }
    b->loops.count = loops_kept;
}

static brush_fault try_cut(brush_body *b, const brush_plane *planes, uint32_t plane_count, double reach, double tolerance)
{
    if (!start_with_box(b, plane_count, reach)) return BRUSH_NO_MEMORY;
    const plane_place *order = b->order.items;
    for (uint32_t i = 0; i < plane_count; ++i) {
        const brush_fault fault = cut(b, &planes[order[i].plane], order[i].plane, tolerance);
        if (fault != BRUSH_SOUND) return fault;
    }
    const brush_loop *loops = b->loops.items;
    for (size_t l = 0; l < b->loops.count; ++l)
        if (loops[l].plane >= plane_count) return BRUSH_OPEN;
    return BRUSH_SOUND;
}

brush_fault brush_body_cut(brush_body *b, const brush_plane *planes, uint32_t plane_count, double reach, double tolerance)
{
    if (!sort_planes(b, planes, plane_count)) return BRUSH_NO_MEMORY;
    brush_fault fault = BRUSH_BROKEN;
    for (int tries = 0; tries < TOLERANCES_TRIED && fault == BRUSH_BROKEN; ++tries, tolerance *= TOLERANCE_STEP)
        fault = try_cut(b, planes, plane_count, reach, tolerance);
    if (fault != BRUSH_SOUND) return fault;
    place_vertices(b, planes, tolerance / TOLERANCE_STEP);
    drop_points(b);
    return b->loops.count >= 4 ? BRUSH_SOUND : BRUSH_EMPTY;
}
