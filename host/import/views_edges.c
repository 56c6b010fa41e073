// Automatic views auto:edges:N: eyes where rounding decides. Every other one on a zone's portal: inside it, on its edge, at its corner (the
// latter two as near as an eye may stand to what is solid there); the rest in the planes of walls, gone on through the air.
// SPDX-License-Identifier: MIT
// Invariant: an eye keeps AUTO_CLEARANCE_M from all solids and lies in its plane to the last bit where that is at a right angle to
// an axis, else to double's rounding; every other eye is then moved by up to ULPS_MOST steps of double or float a coordinate. One in
// a wall's plane stands in a zone and is reached from where an eye of auto:N stands without going through one; round one on a portal
// most walls show their fronts: portals may be larger than their holes, and reach into the void.
#include "views_auto.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum { EDGE_TRIES = 400, ULPS_MOST = 4, AIM_ALONG_EVERY = 4 };
static const double PI = 3.14159265358979323846;
static const double PITCH_MOST_DEG = 25;
static const double STEP_MOST_M = 1;        // of a way that is looked along for solids
static const double ZONE_ROUNDING_M = 1e-9; // a place in a slanting portal is off its plane by double's rounding
static const double INWARD_STEP = 1.0 / 64; // of the way from a portal's corner or edge to its middle

typedef struct edge_place {
    double at[3], normal[3];
} edge_place; // relative to auto_views.origin; normal: a unit vector, of the plane

// ---- Places on portals ----

static void portal_point(const auto_views *a, const scene_portal *p, uint32_t i, double out[3])
{
    const double *point = a->scene->portal_points[p->first_point + i % p->point_count];
    for (int k = 0; k < 3; ++k) out[k] = point[k] - a->origin[k];
}

static void portal_middle(const auto_views *a, const scene_portal *p, double out[3])
{
    memset(out, 0, 3 * sizeof *out);
    for (uint32_t i = 0; i < p->point_count; ++i) {
        double at[3];
        portal_point(a, p, i, at);
        for (int k = 0; k < 3; ++k) out[k] += at[k] / p->point_count;
    }
}

// from + share * (to - from): a coordinate that both have stays, bit for bit.
static void between(const double from[3], const double to[3], double share, double out[3])
{
    for (int k = 0; k < 3; ++k) out[k] = from[k] + share * (to[k] - from[k]);
}

static void axis_keep(const auto_views *a, const scene_portal *p, double at[3]) // what all corners share, the middle shares
{
    for (int k = 0; k < 3; ++k) {
        double first[3], other[3];
        portal_point(a, p, 0, first);
        int same = 1;
        for (uint32_t i = 1; i < p->point_count; ++i) {
            portal_point(a, p, i, other);
            same &= other[k] == first[k];
        }
        if (same) at[k] = first[k];
    }
}

static void corner_of(const auto_views *a, uint32_t index, double out[3])
{
    const cull_vec3 p = a->scene->positions[a->scene->indices[index]];
    const double at[3] = {(double)p.x, (double)p.y, (double)p.z};
    for (int k = 0; k < 3; ++k) out[k] = at[k] + (a->scene->whole.origin[k] - a->origin[k]);
}

static int is_in_zone(const auto_views *a, const double at[3])
{
    const scene *s = a->scene;
    const double world[3] = {at[0] + a->origin[0], at[1] + a->origin[1], at[2] + a->origin[2]};
    for (uint32_t z = 0; z < s->zone_count; ++z)
        if (s->zones[z].flags & ZONE_EVERYWHERE && !(s->zones[z].flags & ZONE_STRAY)) return 1;
    for (uint32_t h = 0; h < s->hull_count; ++h)
        if (scene_hull_height(s, h, world) <= ZONE_ROUNDING_M) return 1;
    return 0;
}

// Where the ray from `at` meets the plane of the triangle inside of it, as a share of `way`; negative: from behind. 0: nowhere before it.
static double hit_of(double corners[3][3], const double at[3], const double way[3])
{
    double u[3], v[3], from[3], normal[3], turned[3], down = 0, height = 0, along_u = 0, along_v = 0;
    for (int k = 0; k < 3; ++k) {
        u[k] = corners[1][k] - corners[0][k];
        v[k] = corners[2][k] - corners[0][k];
        from[k] = at[k] - corners[0][k];
    }
    for (int k = 0; k < 3; ++k) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        normal[k] = u[i] * v[j] - u[j] * v[i];
        turned[k] = way[i] * from[j] - way[j] * from[i];
        down -= normal[k] * way[k];
        height += normal[k] * from[k];
    }
    for (int k = 0; k < 3; ++k) {
        along_u -= turned[k] * v[k];
        along_v += turned[k] * u[k];
    }
    if (down == 0 || height / down <= 0 || along_u / down < 0 || along_v / down < 0 || (along_u + along_v) / down > 1) return 0;
    return down > 0 ? height / down : -height / down;
}

// The first wall along the ray shows its back, though it has none: the ray starts in the void.
static int sees_a_back(const auto_views *a, const double at[3], const double way[3])
{
    const scene *s = a->scene;
    double nearest = INFINITY;
    int is_back = 0;
    for (uint32_t i = 0; i < s->item_count; ++i)
        for (uint32_t k = s->items[i].first_index; k < s->items[i].first_index + s->items[i].index_count; k += 3) {
            double corners[3][3];
            for (uint32_t c = 0; c < 3; ++c) corner_of(a, k + c, corners[c]);
            const double hit = hit_of(corners, at, way);
            if (hit == 0 || fabs(hit) >= nearest) continue;
            nearest = fabs(hit);
            is_back = hit < 0 && (s->items[i].flags & (CULL_ITEM_WALL | CULL_ITEM_TWO_SIDED)) == CULL_ITEM_WALL;
        }
    return is_back;
}

// A portal may be larger than its hole, and a zone's hulls may hold void.
static int is_inside(const auto_views *a, const double at[3])
{
    static const double ways[][3] = {{1, 0.123, 0.271}, {-1, -0.219, 0.187}, {0.173, 1, -0.257}, {-0.281, -1, 0.149}, {0.237, -0.163, 1}, {-0.131, 0.291, -1}};
    int inside = is_in_zone(a, at);
    for (size_t i = 0; inside && i < sizeof ways / sizeof *ways; ++i) inside = !sees_a_back(a, at, ways[i]);
    return inside;
}

typedef enum portal_part { PART_INSIDE, PART_EDGE, PART_CORNER, PART_COUNT } portal_part;

static int on_portal(auto_views *a, const scene_portal *p, portal_part part, double out[3])
{
    double middle[3], corner[3], next[3], from[3];
    const uint32_t i = random_below(&a->random, p->point_count);
    portal_middle(a, p, middle);
    axis_keep(a, p, middle);
    portal_point(a, p, i, corner);
    portal_point(a, p, i + 1, next);
    between(corner, next, part == PART_CORNER ? 0 : random_unit(&a->random), from);
    const double start = part == PART_INSIDE ? random_unit(&a->random) : 0;
    for (double share = start; share <= 1; share += INWARD_STEP) {
        between(from, middle, share, out);
        if (auto_is_in_air(a, out) && is_inside(a, out)) return 1;
    }
    return 0;
}

static int portal_place(auto_views *a, portal_part part, edge_place *out)
{
    const scene *s = a->scene;
    for (int tries = 0; s->portal_count && tries < EDGE_TRIES; ++tries) {
        const scene_portal *p = &s->portals[random_below(&a->random, s->portal_count)];
        memcpy(out->normal, p->plane, sizeof out->normal);
        if (on_portal(a, p, part, out->at)) return 1;
    }
    return 0;
}

// ---- Places in planes of walls ----

typedef struct triangle_plane {
    double point[3], normal[3];
} triangle_plane;

static int random_plane(auto_views *a, triangle_plane *out)
{
    const scene *s = a->scene;
    const scene_item *item = &s->items[random_below(&a->random, s->item_count)];
    if (item->index_count < 3) return 0;
    const uint32_t first = item->first_index + 3 * random_below(&a->random, item->index_count / 3);
    double b[3], c[3], length = 0;
    corner_of(a, first, out->point);
    corner_of(a, first + 1, b);
    corner_of(a, first + 2, c);
    for (int k = 0; k < 3; ++k) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        out->normal[k] = (b[i] - out->point[i]) * (c[j] - out->point[j]) - (b[j] - out->point[j]) * (c[i] - out->point[i]);
        length += out->normal[k] * out->normal[k];
    }
    length = sqrt(length);
    for (int k = 0; k < 3; ++k) out->normal[k] /= length;
    return length > DBL_MIN;
}

// The nearest point of the plane. At a right angle to an axis its coordinate is the plane's own, bit for bit; else the largest
// component of the normal makes up for the rounding of the others.
static void drop_onto(const triangle_plane *p, const double from[3], double out[3])
{
    double height = 0;
    int largest = 0;
    for (int k = 0; k < 3; ++k) {
        height += p->normal[k] * (from[k] - p->point[k]);
        if (fabs(p->normal[k]) > fabs(p->normal[largest])) largest = k;
    }
    double rest = 0;
    for (int k = 0; k < 3; ++k) out[k] = from[k] - height * p->normal[k];
    for (int k = 0; k < 3; ++k)
        if (k != largest) rest += p->normal[k] * (out[k] - p->point[k]);
    out[largest] = p->point[largest] - rest / p->normal[largest];
}

// By balls of free space from one to the next: where they touch, no wall stands between, however thin.
static int is_open_way(const auto_views *a, const double from[3], const double to[3])
{
    double way[3], length = 0;
    for (int k = 0; k < 3; ++k) {
        way[k] = to[k] - from[k];
        length += way[k] * way[k];
    }
    length = sqrt(length);
    for (double gone = 0; gone < length;) {
        double at[3];
        between(from, to, gone / length, at);
        const double room = free_space_clearance(a->space, at, STEP_MOST_M, SPACE_ALL & ~(uint32_t)SPACE_LIQUIDS);
        if (room < AUTO_CLEARANCE_M / 4) return 0;
        gone += room;
    }
    return 1;
}

static int plane_place(auto_views *a, uint32_t i, edge_place *out)
{
    for (int tries = 0; a->scene->item_count && tries < EDGE_TRIES; ++tries) {
        triangle_plane p;
        const eye from = auto_place(a, i + (uint32_t)tries);
        if (!random_plane(a, &p)) continue;
        drop_onto(&p, from.at, out->at);
        memcpy(out->normal, p.normal, sizeof out->normal);
        if (auto_is_in_air(a, out->at) && is_in_zone(a, out->at) && is_open_way(a, from.at, out->at)) return 1;
    }
    return 0;
}

// ---- Cameras ----

static double by_ulps(double value, int count, int is_float)
{
    const double towards = count < 0 ? -INFINITY : INFINITY;
    for (int i = 0; i < (count < 0 ? -count : count); ++i)
        value = is_float ? (double)nextafterf((float)value, (float)towards) : nextafter(value, towards);
    return value;
}

static void move_by_ulps(auto_views *a, camera *c)
{
    const int is_float = (int)random_below(&a->random, 2);
    for (int k = 0; k < 3; ++k) c->eye[k] = by_ulps(c->eye[k], (int)random_below(&a->random, 2 * ULPS_MOST + 1) - ULPS_MOST, is_float);
}

// Along the plane, so that it is a line through the picture's middle.
static void aim_along(const double normal[3], camera *c)
{
    double along = 0;
    for (int k = 0; k < 3; ++k) along += c->forward[k] * normal[k];
    double turned[3], length = 0;
    for (int k = 0; k < 3; ++k) {
        turned[k] = c->forward[k] - along * normal[k];
        length += turned[k] * turned[k];
    }
    length = sqrt(length);
    if (length < 0.5 || fabs(turned[1]) > 0.9 * length) return; // along the normal, or steeply up: as it was
    for (int k = 0; k < 3; ++k) c->forward[k] = turned[k] / length;
}

result auto_edges_make(auto_views *a, uint32_t count, camera *cameras)
{
    for (uint32_t i = 0; i < count; ++i) {
        edge_place place;
        const int found = (i % 2 == 0 && portal_place(a, (portal_part)(i / 4 % PART_COUNT), &place)) || plane_place(a, i, &place);
        if (!found)
            return report_error(a->report, a->scene->path, 0, "no place on a portal or in a plane of its walls has room for an eye; use auto:%u",
                                count);
        const double yaw = random_between(&a->random, -PI, PI), pitch = random_between(&a->random, -PITCH_MOST_DEG, PITCH_MOST_DEG) * (PI / 180);
        cameras[i] = auto_camera(a, place.at, yaw, pitch);
        if (i / 2 % AIM_ALONG_EVERY == 0) aim_along(place.normal, &cameras[i]);
        if (i / 2 % 2 == 1) move_by_ulps(a, &cameras[i]);
    }
    return RESULT_OK;
}
