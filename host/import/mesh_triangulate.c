// Triangles of one polygon: see mesh_triangulate.h. Ear clipping after Meisters (1975), O(n) ear tests, each against the
// obstacles whose x lies in the ear's range only.
// SPDX-License-Identifier: MIT
#include "mesh_triangulate.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct ring_vertex {
    uint32_t previous, next;
    uint32_t is_gone, is_ear;
} ring_vertex;

typedef struct obstacle { // a vertex that isn't convex: it may stand inside an ear
    double x;
    uint32_t vertex;
} obstacle;

typedef struct clipping {
    const double (*points)[3];
    const double (*flat)[2]; // the points in the plane, counterclockwise
    ring_vertex *ring;
    const obstacle *obstacles;
    size_t obstacle_count;
    double flat_m;
    buffer *triangles;
} clipping;

triangulator triangulator_make(const allocator *memory)
{
    return (triangulator){buffer_make(memory, 2 * sizeof(double)), buffer_make(memory, sizeof(ring_vertex)),
                          buffer_make(memory, sizeof(uint32_t)), buffer_make(memory, sizeof(obstacle))};
}

void triangulator_free(triangulator *t)
{
    buffer_free(&t->points);
    buffer_free(&t->vertices);
    buffer_free(&t->queue);
    buffer_free(&t->obstacles);
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void subtract(const double a[3], const double b[3], double out[3])
{
    for (int k = 0; k < 3; ++k) out[k] = a[k] - b[k];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

// Twice the area's vector of a triangle; 0 where its height over its longest edge is at most flat_m.
static int corner_normal(const double a[3], const double b[3], const double c[3], double flat_m, double out[3])
{
    double ab[3], bc[3], ca[3];
    subtract(b, a, ab);
    subtract(c, b, bc);
    subtract(a, c, ca);
    cross(ab, bc, out);
    const double longest = fmax(dot(ab, ab), fmax(dot(bc, bc), dot(ca, ca)));
    return dot(out, out) > flat_m * flat_m * longest;
}

static int has_area(const clipping *c, uint32_t i, uint32_t j, uint32_t k)
{
    double normal[3];
    return corner_normal(c->points[i], c->points[j], c->points[k], c->flat_m, normal);
}

// Twice the signed area in the plane.
static double turn(const clipping *c, uint32_t i, uint32_t j, uint32_t k)
{
    const double *a = c->flat[i], *b = c->flat[j], *d = c->flat[k];
    return (b[0] - a[0]) * (d[1] - a[1]) - (b[1] - a[1]) * (d[0] - a[0]);
}

static result emit(const clipping *c, uint32_t i, uint32_t j, uint32_t k)
{
    if (!has_area(c, i, j, k)) return RESULT_OK;
    const uint32_t triangle[3] = {i, j, k};
    return buffer_append(c->triangles, triangle, 3) ? RESULT_OK : RESULT_NO_MEMORY;
}

// Newell's normal. A polygon that crosses itself may have none though it has area: then its largest corner's. 0: no area.
static int polygon_normal(const double (*points)[3], uint32_t count, double flat_m, double normal[3])
{
    double edge_sum = 0, best = 0, at[3], to[3], corner[3];
    memset(normal, 0, 3 * sizeof *normal);
    for (uint32_t i = 0; i < count; ++i) {
        subtract(points[i], points[0], at);
        subtract(points[(i + 1) % count], points[0], to);
        cross(at, to, corner);
        for (int k = 0; k < 3; ++k) normal[k] += corner[k];
        subtract(to, at, corner);
        edge_sum += sqrt(dot(corner, corner));
    }
    if (sqrt(dot(normal, normal)) > flat_m * edge_sum) return 1;
    for (uint32_t i = 0; i < count; ++i) {
        if (!corner_normal(points[i], points[(i + 1) % count], points[(i + 2) % count], flat_m, corner)) continue;
        if (dot(corner, corner) <= best) continue;
        best = dot(corner, corner);
        memcpy(normal, corner, sizeof corner);
    }
    return best > 0;
}

// Along the normal's largest axis: coordinates are dropped, never mixed, so equal points stay equal.
static void flatten(const double (*points)[3], uint32_t count, const double normal[3], double (*flat)[2])
{
    int axis = 0;
    for (int k = 1; k < 3; ++k)
        if (fabs(normal[k]) > fabs(normal[axis])) axis = k;
    const int u = normal[axis] > 0 ? (axis + 1) % 3 : (axis + 2) % 3, v = 3 - axis - u;
    for (uint32_t i = 0; i < count; ++i) {
        flat[i][0] = points[i][u] - points[0][u];
        flat[i][1] = points[i][v] - points[0][v];
    }
}

static result split_quad(const clipping *c)
{
    const double first = fmin(turn(c, 0, 1, 2), turn(c, 0, 2, 3)), second = fmin(turn(c, 1, 2, 3), turn(c, 1, 3, 0));
    double a[3], b[3];
    subtract(c->points[2], c->points[0], a);
    subtract(c->points[3], c->points[1], b);
    // Both halves of a good diagonal turn left by more than a sliver. Between two good ones the clearly shorter wins: one
    // part in a million is far above the rounding of a moved mesh, so a square splits the same wherever it stands.
    const double sliver = 1e-6 * (fabs(turn(c, 0, 1, 2)) + fabs(turn(c, 0, 2, 3)));
    const int use_second = first > sliver && second > sliver ? dot(b, b) < dot(a, a) * (1 - 1e-6) : second > first + sliver;
    const uint32_t s = use_second ? 1 : 0;
    const result done = emit(c, s, s + 1, s + 2);
    return done == RESULT_OK ? emit(c, s, s + 2, (s + 3) % 4) : done;
}

static int is_convex(const clipping *c, uint32_t i)
{
    const ring_vertex *v = &c->ring[i];
    return turn(c, v->previous, i, v->next) > 0 && has_area(c, v->previous, i, v->next);
}

static size_t first_obstacle(const clipping *c, double x)
{
    size_t low = 0, high = c->obstacle_count;
    while (low < high) {
        const size_t middle = (low + high) / 2;
        if (c->obstacles[middle].x < x) low = middle + 1;
        else high = middle;
    }
    return low;
}

static int same_place(const double a[2], const double b[2])
{
    return a[0] == b[0] && a[1] == b[1];
}

// How far a point may seem to lie outside an edge that it lies on: flat_m, in the unit of turn().
static double edge_slack(const clipping *c, uint32_t i, uint32_t j)
{
    const double x = c->flat[j][0] - c->flat[i][0], y = c->flat[j][1] - c->flat[i][1];
    return -c->flat_m * sqrt(x * x + y * y);
}

static int is_ear(const clipping *c, uint32_t i)
{
    if (!is_convex(c, i)) return 0;
    const uint32_t p = c->ring[i].previous, n = c->ring[i].next;
    const double *a = c->flat[p], *b = c->flat[i], *d = c->flat[n];
    const double before = edge_slack(c, p, i), behind = edge_slack(c, i, n), across = edge_slack(c, n, p);
    const double low = fmin(a[0], fmin(b[0], d[0])) - c->flat_m, high = fmax(a[0], fmax(b[0], d[0])) + c->flat_m;
    for (size_t o = first_obstacle(c, low); o < c->obstacle_count && c->obstacles[o].x <= high; ++o) {
        const uint32_t q = c->obstacles[o].vertex;
        if (c->ring[q].is_gone || q == p || q == i || q == n) continue;
        const double *at = c->flat[q];
        if (same_place(at, a) || same_place(at, b) || same_place(at, d)) continue; // a slit to a hole touches itself
        if (turn(c, p, i, q) >= before && turn(c, i, n, q) >= behind && turn(c, n, p, q) >= across) return 0;
    }
    return 1;
}

static int by_x(const void *a, const void *b)
{
    const obstacle *l = a, *r = b;
    if (l->x != r->x) return l->x < r->x ? -1 : 1;
    return l->vertex < r->vertex ? -1 : 1;
}

static result ring_open(triangulator *t, clipping *c, uint32_t count)
{
    t->vertices.count = t->obstacles.count = t->queue.count = 0;
    c->ring = buffer_push(&t->vertices, count);
    if (!c->ring) return RESULT_NO_MEMORY;
    for (uint32_t i = 0; i < count; ++i) c->ring[i] = (ring_vertex){.previous = (i + count - 1) % count, .next = (i + 1) % count};
    for (uint32_t i = 0; i < count; ++i) {
        if (is_convex(c, i)) continue;
        const obstacle o = {c->flat[i][0], i};
        if (!buffer_append(&t->obstacles, &o, 1)) return RESULT_NO_MEMORY;
    }
    if (t->obstacles.count > 1) qsort(t->obstacles.items, t->obstacles.count, sizeof(obstacle), by_x);
    c->obstacles = t->obstacles.items;
    c->obstacle_count = t->obstacles.count;
    return RESULT_OK;
}

static result test_ear(triangulator *t, clipping *c, uint32_t i)
{
    c->ring[i].is_ear = (uint32_t)is_ear(c, i);
    return !c->ring[i].is_ear || buffer_append(&t->queue, &i, 1) ? RESULT_OK : RESULT_NO_MEMORY;
}

static result clip_ear(triangulator *t, clipping *c, uint32_t i)
{
    const uint32_t p = c->ring[i].previous, n = c->ring[i].next;
    result done = emit(c, p, i, n);
    c->ring[i].is_gone = 1;
    c->ring[p].next = n;
    c->ring[n].previous = p;
    if (done == RESULT_OK) done = test_ear(t, c, p);
    return done == RESULT_OK ? test_ear(t, c, n) : done;
}

// What is left without an ear crosses itself or has no area: a fan loses nothing of it.
static result fan_rest(const clipping *c, uint32_t start)
{
    result done = RESULT_OK;
    for (uint32_t i = c->ring[start].next; c->ring[i].next != start && done == RESULT_OK; i = c->ring[i].next)
        done = emit(c, start, i, c->ring[i].next);
    return done;
}

static result clip_ears(triangulator *t, clipping *c, uint32_t count)
{
    result done = ring_open(t, c, count);
    for (uint32_t i = 0; i < count && done == RESULT_OK; ++i) done = test_ear(t, c, i);
    uint32_t left = count, start = 0;
    for (size_t at = 0; done == RESULT_OK && at < t->queue.count && left > 3; ++at) {
        const uint32_t i = ((const uint32_t *)t->queue.items)[at];
        if (c->ring[i].is_gone || !c->ring[i].is_ear) continue;
        start = c->ring[i].next;
        done = clip_ear(t, c, i);
        left--;
    }
    return done == RESULT_OK ? fan_rest(c, start) : done;
}

result polygon_triangulate(triangulator *t, const double (*points)[3], uint32_t count, double flat_m, buffer *triangles)
{
    clipping c = {.points = points, .flat_m = flat_m, .triangles = triangles};
    if (count < 3) return RESULT_OK;
    if (count == 3) return emit(&c, 0, 1, 2);
    double normal[3];
    if (!polygon_normal(points, count, flat_m, normal)) return RESULT_OK;
    t->points.count = 0;
    double(*flat)[2] = buffer_push(&t->points, count);
    if (!flat) return RESULT_NO_MEMORY;
    flatten(points, count, normal, flat);
    c.flat = (const double(*)[2])flat;
    return count == 4 ? split_quad(&c) : clip_ears(t, &c, count);
}
