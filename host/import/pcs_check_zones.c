// Checks of a scene that no builder made: zones with their items, hulls and origins, and the portals between them.
// SPDX-License-Identifier: MIT
#include "pcs_check.h"

#include "../core/hull.h"
#include "../core/scene_finish.h"

#include <float.h>
#include <math.h>
#include <string.h>

static const double FLAT_MOST = 1e-3;               // of a portal's size: as a builder takes them
static const double CONVEX_MOST = 2e-3;             // of it: the same
static const double FLAT_ROUNDED = 1.0 / 16777216;  // of its zones' size: the same, where those are that much larger
static const double ROUNDED_STEPS = 4;              // of the scene's step: what rounding moves a point from a plane or an edge

// ---- Portals ----

static double dot(const double a[3], const double b[3])
{
    return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
}

static void subtract(const double a[3], const double b[3], double out[3])
{
    for (int k = 0; k < 3; ++k) out[k] = a[k] - b[k];
}

typedef struct slack { double off, dent; } slack; // metres: from the plane, from an edge

// All points left of the edge from `from` to `to`. A short edge that rounding turned is that much worse far away.
static int edge_is_outer(const scene *s, const scene_portal *p, uint32_t from, double dent)
{
    const uint32_t to = from + 1 < p->first_point + p->point_count ? from + 1 : p->first_point;
    double edge[3];
    subtract(s->portal_points[to], s->portal_points[from], edge);
    const double length = sqrt(dot(edge, edge)), *n = p->plane;
    if (!(length > 0)) return 0;
    const double inward[3] = {n[1] * edge[2] - n[2] * edge[1], n[2] * edge[0] - n[0] * edge[2], n[0] * edge[1] - n[1] * edge[0]};
    for (uint32_t i = p->first_point; i < p->first_point + p->point_count; ++i) {
        double a[3];
        subtract(s->portal_points[i], s->portal_points[from], a);
        const double most = dent + ROUNDED_STEPS * s->step * (1 + sqrt(dot(a, a)) / length);
        if (dot(a, inward) < -most * length) return 0;
    }
    return 1;
}

static const char *check_portal_within(const scene *s, const scene_portal *p, slack most)
{
    const double *o = s->whole.origin; // far from the world's origin the sum below and the plane itself are rounded
    const double plane_error = 16 * DBL_EPSILON * (((fabs(o[0]) + fabs(o[1])) + fabs(o[2])) + (double)s->whole.radius);
    for (uint32_t i = p->first_point; i < p->first_point + p->point_count; ++i) {
        const double height = dot(p->plane, s->portal_points[i]) + p->plane[3];
        if (fabs(height) > most.off + ROUNDED_STEPS * s->step + plane_error) return "a portal that is not flat";
        if (!edge_is_outer(s, p, i, most.dent)) return "a portal that is not convex, or has a point twice";
    }
    return NULL;
}

static double size_of_portal(const scene *s, const scene_portal *p)
{
    double square = 0;
    for (uint32_t i = p->first_point; i < p->first_point + p->point_count; ++i) {
        double a[3];
        subtract(s->portal_points[i], s->portal_points[p->first_point], a);
        square = fmax(square, dot(a, a));
    }
    return sqrt(square);
}

static double size_of_zones(const scene *s, const scene_portal *p)
{
    double most = 0;
    for (int side = 0; side < 2; ++side) {
        const scene_zone *z = &s->zones[p->zones[side]];
        for (uint32_t h = z->first_hull; h < z->first_hull + z->hull_count; ++h)
            for (int k = 0; k < 3; ++k) most = fmax(most, s->hulls[h].max[k] - s->hulls[h].min[k]);
    }
    return most;
}

static const char *check_portal_shape(const scene *s, const scene_portal *p)
{
    double plane[4];
    if (!finish_portal_plane((const double(*)[3])s->portal_points + p->first_point, p->point_count, plane) || memcmp(plane, p->plane, sizeof plane) != 0)
        return "a portal whose plane is not that of its points";
    const double size = size_of_portal(s, p);
    if (!check_portal_within(s, p, (slack){FLAT_MOST * size, CONVEX_MOST * size})) return NULL;
    const double rounded = FLAT_ROUNDED * size_of_zones(s, p); // only now: a zone may have many hulls and many portals
    return check_portal_within(s, p, (slack){fmax(FLAT_MOST * size, rounded), fmax(CONVEX_MOST * size, 2 * rounded)});
}

static const char *check_portals(const scene *s)
{
    uint32_t points = 0;
    for (uint32_t i = 0; i < s->portal_point_count; ++i)
        for (int k = 0; k < 3; ++k)
            if (!check_on_step(s, s->portal_points[i][k] - s->whole.origin[k])) return "a portal's point that is not on the scene's step, or too far out";
    for (uint32_t i = 0; i < s->portal_count; ++i) {
        const scene_portal *p = &s->portals[i];
        if (p->first_point != points || p->point_count > s->portal_point_count - points) return "portals whose points do not follow each other";
        if (p->point_count < 3 || p->point_count > PORTAL_POINTS_MOST) return "a portal of under 3 or over 64 points";
        if (p->zones[0] >= s->zone_count || p->zones[1] >= s->zone_count || p->zones[0] == p->zones[1]) return "a portal that does not join two zones";
        if (p->door != SCENE_NONE && p->door >= s->door_count) return "a portal with a door that is not there";
        const char *fault = check_portal_shape(s, p);
        if (fault) return fault;
        points += p->point_count;
    }
    return points == s->portal_point_count ? NULL : "points of no portal";
}

// ---- Zones ----

// A parent comes before its child, or is the one zone that is everywhere: so no way up goes round.
static const char *check_kind(const scene *s, uint32_t zone)
{
    const scene_zone *z = &s->zones[zone];
    if (!*z->name) return "a zone without a name";
    if (z->flags & ~(uint32_t)(ZONE_EVERYWHERE | ZONE_STRAY) || z->flags == (ZONE_EVERYWHERE | ZONE_STRAY)) return "a zone with flags that nobody knows";
    if (z->flags && (z->hull_count || z->parent != SCENE_NONE)) return "a zone that is everywhere, with a hull or a zone around it";
    if (z->flags & ZONE_STRAY && (zone + 1 != s->zone_count || z->portal_count || z->item_count != s->stray_items)) return "a zone of stray items that is not";
    if (z->parent == SCENE_NONE) return NULL;
    if (z->parent >= s->zone_count || (z->parent >= zone && !(s->zones[z->parent].flags & ZONE_EVERYWHERE))) return "a zone in a zone that is not there, or in itself";
    return s->zones[z->parent].flags & ZONE_STRAY ? "a zone in that of the stray items" : NULL;
}

static const char *check_lists(const scene *s, uint32_t zone, uint32_t items, uint32_t portals)
{
    const scene_zone *z = &s->zones[zone];
    if (z->first_item != items || z->item_count > s->zone_item_count - items) return "zones whose items do not follow each other";
    for (uint32_t i = items; i < items + z->item_count; ++i)
        if (s->zone_items[i] >= s->item_count || (i > items && s->zone_items[i] <= s->zone_items[i - 1])) return "a zone whose items do not rise, or are not there";
    if (z->first_portal != portals || z->portal_count > 2 * s->portal_count - portals) return "zones whose portals do not follow each other";
    for (uint32_t i = portals; i < portals + z->portal_count; ++i) {
        const uint32_t way = s->zone_portals[i];
        if (way >= 2 * s->portal_count || s->portals[way / 2].zones[way % 2] != zone) return "a zone with a portal that is not its own";
        if (i > portals && way <= s->zone_portals[i - 1]) return "a zone whose portals do not rise";
    }
    return NULL;
}

static const char *check_origin(const scene *s, uint32_t zone)
{
    double origin[3];
    finish_zone_origin(s, zone, origin);
    for (int k = 0; k < 3; ++k)
        if (origin[k] != s->zones[zone].origin[k]) return "a zone whose origin is not the middle of what is in it";
    return NULL;
}

static const char *check_hull(const scene *s, uint32_t zone, uint32_t hull, uint32_t planes)
{
    const scene_hull *h = &s->hulls[hull];
    if (h->zone != zone || h->first_plane != planes || h->plane_count > s->hull_plane_count - planes) return "hulls whose planes do not follow each other";
    if (h->plane_count > HULL_PLANES_MOST) return "a hull of over 256 planes";
    for (uint32_t i = planes; i < planes + h->plane_count; ++i)
        if (!check_unit(s->hull_planes[i].normal) || !isfinite(s->hull_planes[i].distance)) return "a hull's plane without a unit normal";
    double min[3], max[3];
    if (hull_fault(s->hull_planes + planes, h->plane_count, min, max)) return "a hull that holds nothing, or everything";
    return memcmp(min, h->min, sizeof min) == 0 && memcmp(max, h->max, sizeof max) == 0 ? NULL : "a hull whose box is not its planes'";
}

static const char *check_hulls(const scene *s)
{
    uint32_t hulls = 0, planes = 0;
    for (uint32_t z = 0; z < s->zone_count; ++z) {
        if (s->zones[z].first_hull != hulls || s->zones[z].hull_count > s->hull_count - hulls) return "zones whose hulls do not follow each other";
        for (; hulls < s->zones[z].first_hull + s->zones[z].hull_count; ++hulls) {
            const char *fault = check_hull(s, z, hulls, planes);
            if (fault) return fault;
            planes += s->hulls[hulls].plane_count;
        }
    }
    return hulls == s->hull_count && planes == s->hull_plane_count ? NULL : "hulls or planes of no zone";
}

const char *check_zones(const scene *s)
{
    uint32_t items = 0, portals = 0, everywhere = 0, stray = 0;
    const char *fault = check_hulls(s); // first: portals are as exact as their zones are small
    if (!fault) fault = check_portals(s);
    for (uint32_t z = 0; z < s->zone_count && !fault; ++z) {
        fault = check_kind(s, z);
        if (!fault) fault = check_lists(s, z, items, portals);
        if (!fault) fault = check_origin(s, z);
        items += s->zones[z].item_count;
        portals += s->zones[z].portal_count;
        everywhere += (s->zones[z].flags & ZONE_EVERYWHERE) != 0;
        stray += (s->zones[z].flags & ZONE_STRAY) != 0;
    }
    if (fault) return fault;
    if (items != s->zone_item_count || portals != 2 * s->portal_count) return "items or portals of no zone";
    if (everywhere > 1) return "two zones that are everywhere";
    return stray || !s->stray_items ? NULL : "stray items without a zone";
}
