// Shapes by points: see json_polygon.h. Faces of a hull are found by trying each triple of points.
// SPDX-License-Identifier: MIT
// Invariant: everything is computed relative to the first point, so that a whole move of the points changes no decision.
#include "json_polygon.h"

#include <math.h>

// Shares of the points' extent. Files give decimals: of a 10 m wall the micrometre is the last digit that people write.
static const double FLAT_SHARE = 1.0 / (1 << 18);   // 4e-6: how far a point may lie off the plane of its polygon
static const double HULL_SHARE = 1.0 / (1 << 22);   // 2e-7: nearer faces are one; rounded quads get two planes, which is no harm
static const double SLIVER_SHARE = 1.0 / (1 << 30); // of extent squared: a triple this thin tells no plane
static const double SAME_NORMAL = 1.0 / (1 << 20);  // radians: planes that differ by less are one

typedef struct vec { double x, y, z; } vec;

static vec minus(const double a[3], const double b[3])
{
    return (vec){a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

static vec cross(vec a, vec b)
{
    return (vec){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static double dot(vec a, vec b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static double length_of(vec v)
{
    return sqrt(dot(v, v));
}

static double extent_of(const double (*points)[3], size_t count)
{
    double extent = 0;
    for (size_t i = 1; i < count; ++i) extent = fmax(extent, length_of(minus(points[i], points[0])));
    return extent;
}

// ---- Polygons ----

static vec newell(const double (*points)[3], size_t count) // twice the area, along the normal
{
    vec sum = {0, 0, 0};
    for (size_t i = 1; i + 1 < count; ++i) {
        const vec c = cross(minus(points[i], points[0]), minus(points[i + 1], points[0]));
        sum = (vec){sum.x + c.x, sum.y + c.y, sum.z + c.z};
    }
    return sum;
}

static const char *corners_fault(const double (*points)[3], size_t count, vec normal, double slack)
{
    for (size_t i = 0; i < count; ++i) {
        const vec edge = minus(points[(i + 1) % count], points[i]);
        const double length = length_of(edge);
        if (!(length > slack)) return "has a point twice; drop one";
        const vec inward = cross(normal, edge);
        for (size_t k = 0; k < count; ++k)
            if (dot(inward, minus(points[k], points[i])) < -slack * length) return "is not convex; split it";
    }
    return NULL;
}

const char *polygon_plane(const double (*points)[3], size_t count, double plane[4])
{
    const double extent = extent_of(points, count), slack = extent * FLAT_SHARE;
    const vec area = newell(points, count);
    const double twice = length_of(area);
    if (!(twice > extent * slack)) return "has no area: its points lie on a line, or its edges cross; give them in order around it";
    const vec n = {area.x / twice, area.y / twice, area.z / twice};
    for (size_t i = 1; i < count; ++i)
        if (fabs(dot(n, minus(points[i], points[0]))) > slack) return "is not flat; move its points into one plane, or split it into triangles";
    plane[0] = n.x;
    plane[1] = n.y;
    plane[2] = n.z;
    plane[3] = -(n.x * points[0][0] + n.y * points[0][1] + n.z * points[0][2]) + 0.0;
    return corners_fault(points, count, n, slack);
}

size_t polygon_fan_start(const double (*points)[3], size_t count)
{
    size_t best = 0;
    double best_area = -1;
    for (size_t start = 0; start < count; ++start) {
        double least = INFINITY;
        for (size_t i = 1; i + 1 < count; ++i) {
            const double *a = points[(start + i) % count], *b = points[(start + i + 1) % count];
            least = fmin(least, length_of(cross(minus(a, points[start]), minus(b, points[start]))));
        }
        if (least <= best_area) continue;
        best = start;
        best_area = least;
    }
    return best;
}

// ---- Hulls ----

typedef struct hull_search {
    const double (*points)[3];
    size_t count;
    double slack; // metres
    scene_solid_plane *planes;
    uint32_t plane_count;
    double least_depth; // of the body behind any of the planes
    size_t above, below; // points that ruled out the plane before: they rule out most of those beside it too
} hull_search;

static int is_known(const hull_search *h, vec n)
{
    for (uint32_t p = 0; p < h->plane_count; ++p) {
        const double *m = h->planes[p].normal;
        const vec apart = {n.x - m[0], n.y - m[1], n.z - m[2]};
        if (length_of(apart) < SAME_NORMAL) return 1;
    }
    return 0;
}

static double height_of(const hull_search *h, const double *a, vec n, size_t point)
{
    return dot(n, minus(h->points[point], a));
}

// The plane, if no point lies above it. 0: too many planes.
static int take_plane(hull_search *h, const double *a, vec n, double lowest, double highest)
{
    if (highest > h->slack || is_known(h, n)) return 1;
    if (h->plane_count == HULL_POINT_PLANES_MOST) return 0;
    h->planes[h->plane_count++] = (scene_solid_plane){{n.x, n.y, n.z}, n.x * a[0] + n.y * a[1] + n.z * a[2] + highest};
    h->least_depth = fmin(h->least_depth, highest - lowest);
    return 1;
}

// The plane through the three points, either way round, if all points lie on its one side. 0: too many planes.
static int try_triple(hull_search *h, size_t i, size_t j, size_t k, double sliver)
{
    const double *a = h->points[i];
    const vec c = cross(minus(h->points[j], a), minus(h->points[k], a));
    const double length = length_of(c);
    if (!(length > sliver)) return 1;
    const vec n = {c.x / length, c.y / length, c.z / length}, back = {-n.x, -n.y, -n.z};
    if (height_of(h, a, n, h->above) > h->slack && height_of(h, a, n, h->below) < -h->slack) return 1;
    double highest = -INFINITY, lowest = INFINITY;
    for (size_t p = 0; p < h->count; ++p) {
        const double height = height_of(h, a, n, p);
        if (height > highest) {
            highest = height;
            h->above = p;
        }
        if (height < lowest) {
            lowest = height;
            h->below = p;
        }
        if (highest > h->slack && lowest < -h->slack) return 1;
    }
    return take_plane(h, a, n, lowest, highest) && take_plane(h, a, back, -highest, -lowest);
}

const char *hull_planes_of_points(const double (*points)[3], size_t count, scene_solid_plane *planes, uint32_t *out_count)
{
    const double extent = extent_of(points, count);
    hull_search h = {.points = points, .count = count, .slack = extent * HULL_SHARE, .planes = planes, .least_depth = INFINITY};
    for (size_t i = 0; i < count; ++i)
        for (size_t j = i + 1; j < count; ++j)
            for (size_t k = j + 1; k < count; ++k)
                if (!try_triple(&h, i, j, k, extent * extent * SLIVER_SHARE)) return "has over 128 sides; use fewer points";
    if (h.plane_count < HULL_POINTS_LEAST || h.least_depth <= 4 * h.slack) return "is flat; give points that are not all in one plane";
    *out_count = h.plane_count;
    return NULL;
}

void hull_planes_of_box(const double min[3], const double max[3], scene_solid_plane planes[6])
{
    for (int k = 0; k < 3; ++k) {
        planes[2 * k] = (scene_solid_plane){.distance = -min[k]};
        planes[2 * k].normal[k] = -1;
        planes[2 * k + 1] = (scene_solid_plane){.distance = max[k]};
        planes[2 * k + 1].normal[k] = 1;
    }
}
