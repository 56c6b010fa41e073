// Convex bodies of planes: each plane's face is a large square cut by all other planes; the faces' corners give the box.
// SPDX-License-Identifier: MIT
// Invariant: done twice, first coarsely from the world's origin, then from the body's own middle, so that a small body far
// away is measured as well as one near by.
#include "hull.h"

#include <portcullis/clip.h>

#include <math.h>
#include <string.h>

static const double REACH_MOST = 4e9;    // metres: the first square's half side; twice what a bounded body can need
static const double CORNER_MOST = 2e9;   // metres: a corner beyond it is the square's own
static const double HULL_MOST = 1e9;     // metres: as for all coordinates of a scene
static const double SAME_PLANE = 1e-12;  // two planes whose unit normals differ by less are parallel
static const double VOLUME_LEAST = 1e-12; // of the cube of the body's diagonal: thinner is rounding, not a body
static const double SAME_VOLUME = 1e-9;   // of the body's: what rounding may make of the same body with fewer planes

typedef struct hull_measure {
    const scene_solid_plane *planes;
    uint32_t plane_count;
    double middle[3], reach; // squares reach that far from the middle
    double min[3], max[3], volume;
    uint8_t has_face[HULL_CUTS_MOST];
} hull_measure;

static double dot(const double a[3], const double b[3])
{
    return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
}

static double distance_of(const hull_measure *m, uint32_t plane)
{
    return m->planes[plane].distance - dot(m->planes[plane].normal, m->middle);
}

// A square in the plane, counterclockwise seen from outside, relative to the middle.
static void square(const hull_measure *m, uint32_t plane, cull_point out[4])
{
    const double *n = m->planes[plane].normal, h = distance_of(m, plane);
    const int axis = fabs(n[0]) <= fabs(n[1]) && fabs(n[0]) <= fabs(n[2]) ? 0 : fabs(n[1]) <= fabs(n[2]) ? 1 : 2; // the flattest
    double u[3], v[3], e[3] = {0, 0, 0};
    e[axis] = 1;
    const double along = n[axis];
    for (int k = 0; k < 3; ++k) u[k] = e[k] - along * n[k];
    const double length = sqrt(dot(u, u));
    for (int k = 0; k < 3; ++k) u[k] *= m->reach / length;
    v[0] = n[1] * u[2] - n[2] * u[1];
    v[1] = n[2] * u[0] - n[0] * u[2];
    v[2] = n[0] * u[1] - n[1] * u[0];
    static const double signs[4][2] = {{1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
    for (int c = 0; c < 4; ++c) {
        double p[3];
        for (int k = 0; k < 3; ++k) p[k] = n[k] * h + signs[c][0] * u[k] + signs[c][1] * v[k];
        out[c] = (cull_point){p[0], p[1], p[2]};
    }
}

static int is_same_plane(const scene_solid_plane *a, const scene_solid_plane *b)
{
    return dot(a->normal, b->normal) > 1 - SAME_PLANE && fabs(a->distance - b->distance) <= SAME_PLANE * (1 + fabs(a->distance));
}

// The plane's face, at most plane_count + 4 points; 0: it has none, or an earlier plane is the same.
static uint32_t face(const hull_measure *m, uint32_t plane, cull_point **out, cull_point *a, cull_point *b)
{
    if (fabs(distance_of(m, plane)) > m->reach) return 0;
    square(m, plane, a);
    uint32_t count = 4;
    for (uint32_t p = 0; p < m->plane_count && count; ++p) {
        if (p == plane) continue;
        if (is_same_plane(&m->planes[p], &m->planes[plane])) {
            if (p < plane) return 0;
            continue;
        }
        const double *n = m->planes[p].normal;
        const cull_cut cut = {-n[0], -n[1], -n[2], distance_of(m, p)};
        count = cull_polygon_clip(a, count, cut, b, HULL_CUTS_MOST + 8);
        cull_point *swap = a;
        a = b;
        b = swap;
    }
    *out = a;
    return count;
}

static double twice_area(const cull_point *p, uint32_t count, const double n[3])
{
    double sum = 0;
    for (uint32_t i = 1; i + 1 < count; ++i) {
        const double u[3] = {p[i].x - p[0].x, p[i].y - p[0].y, p[i].z - p[0].z};
        const double v[3] = {p[i + 1].x - p[0].x, p[i + 1].y - p[0].y, p[i + 1].z - p[0].z};
        const double cross[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
        sum += dot(cross, n);
    }
    return sum;
}

static void measure(hull_measure *m)
{
    cull_point first[HULL_CUTS_MOST + 8], second[HULL_CUTS_MOST + 8];
    m->volume = 0;
    for (int k = 0; k < 3; ++k) {
        m->min[k] = INFINITY;
        m->max[k] = -INFINITY;
    }
    for (uint32_t i = 0; i < m->plane_count; ++i) {
        cull_point *points = first;
        const uint32_t count = face(m, i, &points, first, second);
        m->has_face[i] = count >= 3;
        if (count < 3) continue;
        m->volume += twice_area(points, count, m->planes[i].normal) * distance_of(m, i) / 6;
        for (uint32_t c = 0; c < count; ++c) {
            const double p[3] = {points[c].x, points[c].y, points[c].z};
            for (int k = 0; k < 3; ++k) {
                m->min[k] = fmin(m->min[k], m->middle[k] + p[k]);
                m->max[k] = fmax(m->max[k], m->middle[k] + p[k]);
            }
        }
    }
}

static const char OPEN[] = "has a hull that is not closed on all sides";
static const char EMPTY[] = "has an empty hull; its planes leave nothing between them";

static const char *coarse_fault(const hull_measure *m)
{
    if (m->min[0] > m->max[0]) return EMPTY;
    for (int k = 0; k < 3; ++k) {
        if (m->min[k] < -CORNER_MOST || m->max[k] > CORNER_MOST) return OPEN;
        if (m->min[k] < -HULL_MOST || m->max[k] > HULL_MOST) return "reaches beyond 1e9 m; move it nearer to the origin";
    }
    return NULL;
}

// About the middle of a box that holds the body. 0: there is no body.
static int measure_near(hull_measure *m, const double min[3], const double max[3])
{
    double size = 0, diagonal = 0;
    for (int k = 0; k < 3; ++k) {
        m->middle[k] = min[k] + (max[k] - min[k]) / 2;
        size = fmax(size, max[k] - min[k]);
    }
    m->reach = 4 * size + 1e-3; // 1 mm: a body below the first measure's error is still found
    measure(m);
    for (int k = 0; k < 3; ++k) {
        if (!(m->min[k] <= m->max[k])) return 0;
        diagonal = hypot(diagonal, m->max[k] - m->min[k]);
    }
    return m->volume > VOLUME_LEAST * diagonal * diagonal * diagonal;
}

const char *hull_fault(const scene_solid_plane *planes, uint32_t plane_count, double min[3], double max[3])
{
    if (plane_count < 4) return OPEN;
    hull_measure m = {.planes = planes, .plane_count = plane_count, .reach = REACH_MOST};
    measure(&m);
    const char *fault = coarse_fault(&m);
    if (fault) return fault;
    const double least[3] = {m.min[0], m.min[1], m.min[2]}, most[3] = {m.max[0], m.max[1], m.max[2]};
    if (!measure_near(&m, least, most)) return EMPTY;
    memcpy(min, m.min, sizeof m.min);
    memcpy(max, m.max, sizeof m.max);
    return NULL;
}

// Two planes a rounding apart may each leave no face of the other: then the body would grow without both, and all stay.
const char *hull_needed(const scene_solid_plane *planes, uint32_t plane_count, uint8_t *is_needed, double min[3], double max[3])
{
    scene_solid_plane kept[HULL_CUTS_MOST];
    hull_measure all = {.planes = planes, .plane_count = plane_count}, few = {.planes = kept};
    if (plane_count < 4) return OPEN;
    if (!measure_near(&all, min, max)) return EMPTY;
    for (uint32_t i = 0; i < plane_count; ++i)
        if (all.has_face[i]) kept[few.plane_count++] = planes[i];
    const int is_same = few.plane_count == plane_count || (measure_near(&few, min, max) && fabs(few.volume - all.volume) <= SAME_VOLUME * all.volume);
    for (uint32_t i = 0; i < plane_count; ++i) is_needed[i] = !is_same || all.has_face[i];
    memcpy(min, all.min, sizeof all.min);
    memcpy(max, all.max, sizeof all.max);
    return NULL;
}

double hull_height(const scene_solid_plane *planes, uint32_t plane_count, const double p[3])
{
    double most = -INFINITY;
    for (uint32_t i = 0; i < plane_count; ++i) {
        const double height = dot(planes[i].normal, p) - planes[i].distance;
        most = height > most ? height : most;
    }
    return most;
}

int hull_has_some(const scene_solid_plane *planes, uint32_t plane_count, const hull_polygon *q)
{
    enum { ROOM = 2 * HULL_CUTS_MOST };
    cull_point first[ROOM], second[ROOM], *in = first, *out = second;
    uint32_t count = q->point_count < ROOM ? q->point_count : ROOM;
    double base[3];
    for (int k = 0; k < 3; ++k) base[k] = q->points[0][k] + q->shift[k];
    for (uint32_t i = 0; i < count; ++i) in[i] = (cull_point){q->points[i][0] - q->points[0][0], q->points[i][1] - q->points[0][1], q->points[i][2] - q->points[0][2]};
    for (uint32_t p = 0; p < plane_count && count; ++p) {
        const double *n = planes[p].normal;
        const cull_cut cut = {-n[0], -n[1], -n[2], planes[p].distance - dot(n, base) - q->depth};
        count = cull_polygon_clip(in, count, cut, out, ROOM);
        cull_point *swap = in;
        in = out;
        out = swap;
    }
    return count > 0;
}
