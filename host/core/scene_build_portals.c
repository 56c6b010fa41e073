// Scene builder, portals: flat, convex, between two zones that it touches, turned counterclockwise for the first of them.
// SPDX-License-Identifier: MIT
#include "hull.h"
#include "scene_builder.h"
#include "zone_seam.h"

#include <math.h>
#include <string.h>

// All lengths are shares of a portal's size, or of its zones' where those are so large that float leaves them coarser steps:
// the same scene is taken at any scale.
static const double FLAT_MOST = 1e-3;  // of the distance from the middle to the farthest point: what rounded numbers may be off
static const double CONVEX_MOST = 2e-3; // of it: the same, of a corner that is almost straight, seen from the next but one
static const double FLAT_ROUNDED = 1.0 / 16777216; // of the zones' size: a step of float
static const double AREA_LEAST = 1e-9;        // of the square of the portal's size: thinner is a line
static const double PROBE = 1.0 / 64;         // of the portal's size: how far in front of it its sides are looked at
static const double SIDE_LEAST = 1.0 / 4;     // of the probe: heights that differ less name no side
static const double ALONG_MOST = 1e-3;        // cosine: a given normal this near to the portal's plane names no side

typedef struct gate {
    const scene_builder *b;
    const builder_portal *from;
    double (*points)[3];
    uint32_t count;
    double middle[3], normal[3], size; // size: the farthest point from the middle
    double zones_size;                 // the longest side of the bounds of both zones' hulls
} gate;

static double dot(const double a[3], const double b[3])
{
    return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
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

// ---- Shape ----

void polygon_measure(const double (*points)[3], uint32_t count, double middle[3], double twice_area[3])
{
    double sum[3] = {0, 0, 0};
    memset(twice_area, 0, 3 * sizeof *twice_area);
    for (uint32_t i = 1; i < count; ++i) {
        double a[3], c[3] = {0, 0, 0}, product[3];
        subtract(points[i], points[0], a);
        if (i + 1 < count) subtract(points[i + 1], points[0], c);
        cross(a, c, product);
        for (int k = 0; k < 3; ++k) {
            sum[k] += a[k];
            twice_area[k] += product[k];
        }
    }
    for (int k = 0; k < 3; ++k) middle[k] = points[0][k] + sum[k] / count;
}

static const char *find_plane(gate *g)
{
    double twice_area[3], square = 0;
    polygon_measure((const double(*)[3])g->points, g->count, g->middle, twice_area);
    for (uint32_t i = 0; i < g->count; ++i) {
        double a[3];
        subtract(g->points[i], g->middle, a);
        square = fmax(square, dot(a, a));
    }
    g->size = sqrt(square);
    const double length = sqrt(dot(twice_area, twice_area));
    if (!(length > AREA_LEAST * square)) return "has no area: its points lie on a line, or its edges cross";
    for (int k = 0; k < 3; ++k) g->normal[k] = twice_area[k] / length;
    return NULL;
}

static const char *shape_fault(const gate *g)
{
    const double rounded = FLAT_ROUNDED * g->zones_size;
    const double off = fmax(FLAT_MOST * g->size, rounded), dent = fmax(CONVEX_MOST * g->size, 2 * rounded);
    for (uint32_t i = 0; i < g->count; ++i) {
        double a[3];
        subtract(g->points[i], g->middle, a);
        if (fabs(dot(a, g->normal)) > off) return "is not flat: a point lies over 1/2000 of its width off the plane of the others";
    }
    for (uint32_t i = 0; i < g->count; ++i) {
        double edge[3], inward[3];
        subtract(g->points[i + 1 < g->count ? i + 1 : 0], g->points[i], edge);
        const double length = sqrt(dot(edge, edge));
        if (!(length > 0)) return "has a point twice";
        cross(g->normal, edge, inward);
        for (uint32_t j = 0; j < g->count; ++j) {
            double a[3];
            subtract(g->points[j], g->points[i], a);
            if (j > i && dot(a, a) == 0) return "has a point twice";
            if (dot(a, inward) < -dent * length) return "is not convex";
        }
    }
    return NULL;
}

static const char *take_points(gate *g)
{
    const builder_portal *from = g->from;
    if (from->point_count < 3) return "has under 3 points";
    if (from->point_count > PORTAL_POINTS_MOST) return "has over 64 points";
    for (uint32_t i = 0; i < from->point_count; ++i) {
        builder_point(g->b, from->points[i], g->points[i]);
        for (int k = 0; k < 3; ++k) {
            if (!isfinite(g->points[i][k])) return "has a number that is not finite";
            if (fabs(g->points[i][k]) > 1e9) return "has a coordinate beyond 1e9 m"; // as for all coordinates of a scene
        }
    }
    g->count = from->point_count;
    const char *fault = find_plane(g);
    return fault ? fault : shape_fault(g);
}

// ---- Sides ----

static const scene_zone *zone_at(const gate *g, int side)
{
    return (const scene_zone *)g->b->zones.items + g->from->zones[side];
}

static double zones_size(const scene_builder *b, const builder_portal *p)
{
    const scene_zone *zones = b->zones.items;
    const scene_hull *hulls = b->hulls.items;
    double most = 0;
    for (int side = 0; side < 2; ++side) {
        const scene_zone *z = &zones[p->zones[side]];
        for (uint32_t h = z->first_hull; h < z->first_hull + z->hull_count; ++h)
            for (int k = 0; k < 3; ++k) most = fmax(most, hulls[h].max[k] - hulls[h].min[k]);
    }
    return most;
}

// Over the zone's surface, least over its hulls: below 0 inside.
static double height(const gate *g, int side, const double p[3])
{
    const scene_zone *z = zone_at(g, side);
    const scene_hull *hulls = g->b->hulls.items;
    const scene_solid_plane *planes = g->b->hull_planes.items;
    double least = z->hull_count ? INFINITY : -INFINITY;
    for (uint32_t h = z->first_hull; h < z->first_hull + z->hull_count; ++h)
        least = fmin(least, hull_height(planes + hulls[h].first_plane, hulls[h].plane_count, p));
    return least;
}

static int touches_zone(const gate *g, int side)
{
    const double most = seam_tolerance_m(g->size, g->zones_size);
    for (uint32_t i = 0; i < g->count; ++i)
        if (height(g, side, g->points[i]) > most) return 0;
    return 1;
}

static int lies_in(const gate *g, int side, uint32_t outer)
{
    const scene_zone *zones = g->b->zones.items;
    uint32_t z = g->from->zones[side];
    while (z != SCENE_NONE && z != outer) z = zones[z].parent;
    return z == outer;
}

// Behind such a portal the zone would go on and hold what is there, as if it were before it: the zone about it, which the
// portal leads to, would not be found from there. Zones side by side both hold what lies in both.
static int is_sunk(const gate *g, int side)
{
    const scene_zone *z = zone_at(g, side), *other = zone_at(g, 1 - side);
    if (!z->hull_count || (other->hull_count && !lies_in(g, side, g->from->zones[1 - side]))) return 0;
    const scene_hull *hulls = g->b->hulls.items;
    const scene_solid_plane *planes = g->b->hull_planes.items;
    const double most = seam_tolerance_m(g->size, g->zones_size), sign = side ? 1 : -1;
    for (uint32_t h = z->first_hull; h < z->first_hull + z->hull_count; ++h)
        for (int moved = 0; moved < 2; ++moved) { // behind it another hull of the zone may begin
            hull_polygon q = {.points = (const double(*)[3])g->points, .point_count = g->count, .depth = moved ? most / 2 : most};
            for (int k = 0; k < 3; ++k) q.shift[k] = moved * most * sign * g->normal[k];
            if (hull_has_some(planes + hulls[h].first_plane, hulls[h].plane_count, &q)) return 1;
        }
    return 0;
}

// How much deeper in the zone the portal's front is than its back.
static double depth_gained(const gate *g, int side)
{
    double front[3], back[3];
    for (int k = 0; k < 3; ++k) {
        front[k] = g->middle[k] + g->normal[k] * g->size * PROBE;
        back[k] = g->middle[k] - g->normal[k] * g->size * PROBE;
    }
    return height(g, side, back) - height(g, side, front);
}

// Positive: the normal points into zones[0]. Of a zone and one in it the inner one decides: the outer one is on both sides.
static double front_score(const gate *g)
{
    double turned[3];
    if (g->from->normal) {
        builder_direction(g->b, g->from->normal, turned);
        const double along = dot(turned, g->normal), length = sqrt(dot(turned, turned));
        return fabs(along) > ALONG_MOST * length && isfinite(along) ? along : 0;
    }
    const int first_counts = zone_at(g, 0)->hull_count && !lies_in(g, 1, g->from->zones[0]);
    const int second_counts = zone_at(g, 1)->hull_count && !lies_in(g, 0, g->from->zones[1]);
    double score = 0;
    if (first_counts) score += depth_gained(g, 0);
    if (second_counts) score -= depth_gained(g, 1);
    return fabs(score) > SIDE_LEAST * PROBE * g->size ? score : 0;
}

static void turn_round(gate *g)
{
    for (uint32_t i = 0, j = g->count - 1; i < j; ++i, --j)
        for (int k = 0; k < 3; ++k) {
            const double swap = g->points[i][k];
            g->points[i][k] = g->points[j][k];
            g->points[j][k] = swap;
        }
    for (int k = 0; k < 3; ++k) g->normal[k] = -g->normal[k];
}

static const char *ends_fault(const gate *g)
{
    const builder_portal *p = g->from;
    if (p->zones[0] >= g->b->zones.count || p->zones[1] >= g->b->zones.count) return "joins a zone that is not there";
    if (p->zones[0] == p->zones[1]) return "joins a zone to itself";
    if (p->door != SCENE_NONE && p->door >= g->b->doors.count) return "has a door that is not there";
    return NULL;
}

static const char *place(gate *g)
{
    const char *fault = ends_fault(g);
    if (fault) return fault;
    g->zones_size = zones_size(g->b, g->from);
    fault = take_points(g);
    if (fault) return fault;
    if (!touches_zone(g, 0)) return "has a point outside of its first zone, by over 1/64 of its width";
    if (!touches_zone(g, 1)) return "has a point outside of its second zone, by over 1/64 of its width";
    const double score = front_score(g);
    if (score == 0 && g->from->normal) return "has a normal that lies in its plane";
    if (score == 0) return "lies so that its sides cannot be told apart; give it a normal towards its first zone";
    if (score < 0) turn_round(g);
    if (is_sunk(g, 0)) return "lies inside its first zone, by over 1/64 of its width";
    if (is_sunk(g, 1)) return "lies inside its second zone, by over 1/64 of its width";
    return NULL;
}

result scene_builder_portal(scene_builder *b, const builder_portal *p, uint32_t *out, const char **fault)
{
    double points[PORTAL_POINTS_MOST][3];
    gate g = {.b = b, .from = p, .points = points};
    *fault = place(&g);
    if (*fault) return RESULT_BAD_INPUT;
    builder_gate to = {.zones = {p->zones[0], p->zones[1]}, .first_point = (uint32_t)b->gate_points.count, .point_count = g.count, .door = p->door};
    const char *name = p->name ? p->name : "";
    to.name = arena_text(&b->names, name, strlen(name));
    if (!to.name || !buffer_append(&b->gate_points, points, g.count)) return RESULT_NO_MEMORY;
    if (!buffer_append(&b->gates, &to, 1)) return RESULT_NO_MEMORY;
    *out = (uint32_t)b->gates.count - 1;
    return RESULT_OK;
}
