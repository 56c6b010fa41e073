// Seams of zones: see zone_seam.h.
// SPDX-License-Identifier: MIT
#include "hull.h"
#include "zone_seam.h"

#include <math.h>

static const double TOUCH_STEPS = 1; // of the scene's step: rounding moves a corner by less than 0.9 of one
static const double HOLD_STEPS = 2;  // of it: strictly inside, with both roundings
static const double OFF_MOST = 1.0 / 32; // of the distance from a portal's middle to its farthest point: 1/64 of its width
static const double ROUNDED_MOST = 1.0 / 4194304; // of the zones' size: a few of the steps that float leaves them
enum { HALVINGS = 8 }; // of a depth that is looked for: to a share of 2^-8

double seam_touch_least_m(const scene *s)
{
    return TOUCH_STEPS * s->step;
}

double seam_hold_least_m(const scene *s)
{
    return HOLD_STEPS * s->step;
}

double seam_tolerance_m(double portal_size, double zones_size)
{
    return fmax(OFF_MOST * portal_size, ROUNDED_MOST * zones_size);
}

double zone_height(const scene *s, uint32_t zone, const double p[3])
{
    const scene_zone *z = &s->zones[zone];
    double least = z->hull_count ? INFINITY : -INFINITY;
    for (uint32_t h = z->first_hull; h < z->first_hull + z->hull_count; ++h) least = fmin(least, scene_hull_height(s, h, p));
    return least;
}

static int lies_in(const scene *s, uint32_t zone, uint32_t outer)
{
    if (!s->zones[outer].hull_count) return 1;
    while (zone != SCENE_NONE && zone != outer) zone = s->zones[zone].parent;
    return zone == outer;
}

static double bend_of(const scene *s, const scene_portal *p)
{
    const double(*points)[3] = (const double(*)[3]) & s->portal_points[p->first_point];
    double most = 0;
    for (uint32_t i = 0; i < p->point_count; ++i) {
        double above = 0;
        for (int k = 0; k < 3; ++k) above += p->plane[k] * (points[i][k] - points[0][k]);
        most = fmax(most, fabs(above));
    }
    return most;
}

static double portal_size(const scene *s, const scene_portal *p)
{
    const double(*points)[3] = (const double(*)[3]) & s->portal_points[p->first_point];
    double middle[3] = {0, 0, 0}, most = 0;
    for (uint32_t i = 0; i < p->point_count; ++i)
        for (int k = 0; k < 3; ++k) middle[k] += (points[i][k] - points[0][k]) / p->point_count;
    for (uint32_t i = 0; i < p->point_count; ++i) {
        double square = 0;
        for (int k = 0; k < 3; ++k) square += pow(points[i][k] - points[0][k] - middle[k], 2);
        most = fmax(most, sqrt(square));
    }
    return most;
}

static int has_some(const scene *s, uint32_t hull, const hull_polygon *q)
{
    const scene_hull *h = &s->hulls[hull];
    return hull_has_some(s->hull_planes + h->first_plane, h->plane_count, q);
}

// The greatest depth of a point of the polygon in the hull, from above. Nothing below `least` is told apart.
static double depth_in(const scene *s, uint32_t hull, hull_polygon q, double least)
{
    q.depth = least;
    if (!has_some(s, hull, &q)) return least;
    double low = least, high = 2 * least;
    for (q.depth = high; has_some(s, hull, &q); q.depth = high) {
        low = high;
        high *= 2;
    }
    for (int i = 0; i < HALVINGS; ++i) {
        q.depth = low + (high - low) / 2;
        if (has_some(s, hull, &q)) low = q.depth;
        else high = q.depth;
    }
    return high;
}

// On the portal itself, and a little behind it, where another hull of the zone may begin.
static double portal_depth(const scene *s, const scene_portal *p, uint32_t side)
{
    const scene_zone *z = &s->zones[p->zones[side]];
    const double behind = seam_tolerance_m(portal_size(s, p), 0) / 2, sign = side ? 1 : -1;
    hull_polygon q = {.points = (const double(*)[3]) & s->portal_points[p->first_point], .point_count = p->point_count};
    double most = 0;
    for (uint32_t h = z->first_hull; h < z->first_hull + z->hull_count; ++h)
        for (int moved = 0; moved < 2; ++moved) {
            for (int k = 0; k < 3; ++k) q.shift[k] = moved * behind * sign * p->plane[k];
            most = fmax(most, depth_in(s, h, q, s->step));
        }
    return most;
}

void zone_seams_find(const scene *s, zone_seam *out)
{
    for (uint32_t z = 0; z < s->zone_count; ++z) out[z] = (zone_seam){0};
    for (uint32_t i = 0; i < 2 * s->portal_count; ++i) {
        const scene_portal *p = &s->portals[i / 2];
        const uint32_t zone = p->zones[i % 2];
        const double bend = bend_of(s, p);
        for (uint32_t c = p->first_point; c < p->first_point + p->point_count; ++c)
            out[zone].out = fmax(out[zone].out, fmax(zone_height(s, zone, s->portal_points[c]), 0) + bend);
        if (s->zones[zone].hull_count && lies_in(s, zone, p->zones[1 - i % 2]))
            out[zone].in = fmax(out[zone].in, portal_depth(s, p, i % 2) + bend);
    }
    for (uint32_t z = 0; z < s->zone_count; ++z) {
        out[z].touch = fmax(seam_touch_least_m(s), out[z].out);
        out[z].hold = fmax(seam_hold_least_m(s), out[z].in + s->step); // a step: the item's own rounding
    }
}
