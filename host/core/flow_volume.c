// Volumes of a flow: planes carried from zone to zone, portals' polygons cut by them, and when one volume lies in another.
// SPDX-License-Identifier: MIT
// Invariant: a plane is only ever moved outward, and by one zone's rounding however many zones it was carried through:
// each zone's plane is made from the first record, never from the zone before.
#include "flow_internal.h"

#include <math.h>
#include <string.h>

cull_guard flow_guard(const flow *f, uint32_t zone)
{
    const view_place *z = &f->places[zone];
    cull_guard guard = {.pixel_tangent = f->base.pixel_tangent, .reach = f->base.reach, .radius = (double)z->radius};
    view_eye_in_zone(&f->base, z, guard.eye);
    for (int i = 0; i < 3; i++) guard.forward[i] = -f->base.back[i];
    return guard;
}

// The sides of the picture are known again by the bits of their normals, which are the same in every zone.
flow_record flow_record_of(const flow *f, cull_plane plane, uint32_t zone)
{
    flow_record r = {plane, zone};
    for (uint32_t i = 0; i < f->base.side_count; i++)
        if (memcmp(&f->base.sides[i].facing.normal, &plane.normal, sizeof plane.normal) == 0) r.origin = FLOW_ROOT_RECORD + i;
    return r;
}

// A plane written for zone `a` (float, guarded for points within a's radius of a's origin), for zone `b`.
// The half-space is n . p + offset >= 0 for p relative to a. Relative to b, p = q + d with d the difference of the origins,
// whole metres: n . q + (offset + n . d), computed in double, to 2^-50 of its terms. What has to be added then:
// - evaluating in float at |q| <= b's radius costs 3 u S of cull_plane_outward's 4 u S; all 4 are added,
// - the true normal was rounded for a: an error of u |n_i| a coordinate of p. a's slack pays for it up to a's radius only,
//   so here it is paid for b: u |n|_1 radius is the fourth u S, and u |n_i d_i| comes on top.
// With one origin and no larger radius a's slack serves, bits unchanged.
static float offset_moved(const view_place *a, const view_place *b, const cull_plane *plane)
{
    if (a->origin[0] == b->origin[0] && a->origin[1] == b->origin[1] && a->origin[2] == b->origin[2] && b->radius <= a->radius) return plane->offset;
    const double n[3] = {(double)plane->normal.x, (double)plane->normal.y, (double)plane->normal.z};
    double offset = (double)plane->offset, carried = 0;
    for (int i = 0; i < 3; i++) {
        const double along = n[i] * (b->origin[i] - a->origin[i]);
        offset += along;
        carried += fabs(along);
    }
    const double sum = fabs(n[0]) + fabs(n[1]) + fabs(n[2]), unit = 1.0 / 16777216;
    offset += CULL_GUARD_ROUNDING * sum * (double)b->radius + unit * (1 + 1.0 / 1024) * carried + CULL_GUARD_UNDERFLOW;
    const double most = (double)FLT_MAX, wanted = offset > most ? most : offset < -most ? -most : offset;
    const float moved = (float)wanted;
    return (double)moved < wanted ? cull_float_above(moved) : moved;
}

void flow_planes_in(const flow *f, uint32_t zone, const flow_record *records, uint32_t count, cull_plane *out)
{
    const view_place *place = &f->places[zone];
    for (uint32_t i = 0; i < count; i++) {
        const flow_record *r = &records[i];
        if (r->origin & FLOW_ROOT_RECORD) {
            double eye[3];
            view_eye_in_zone(&f->base, place, eye);
            out[i] = cull_guarded_at(&f->base.sides[r->origin - FLOW_ROOT_RECORD], eye, (double)place->radius);
            continue;
        }
        out[i].normal = r->plane.normal;
        out[i].offset = offset_moved(&f->places[r->origin], place, &r->plane);
    }
}

// ---- Polygons ----

cull_cut flow_cut_at_eye(const flow *f, cull_plane plane, uint32_t zone)
{
    cull_cut cut = {(double)plane.normal.x, (double)plane.normal.y, (double)plane.normal.z, (double)plane.offset};
    const double *eye = f->base.camera->eye, *origin = f->places[zone].origin;
    cut.offset += (cut.x * (eye[0] - origin[0]) + cut.y * (eye[1] - origin[1])) + cut.z * (eye[2] - origin[2]);
    return cut;
}

static uint32_t count_inside(const flow_polygon *p, cull_cut cut)
{
    uint32_t inside = 0;
    for (uint32_t i = 0; i < p->count; i++) inside += cull_cut_height(cut, p->points[i]) >= 0;
    return inside;
}

void flow_cuts_make(const flow *f, const flow_node *n, cull_cut cuts[CULL_MAX_PLANES])
{
    for (uint32_t i = 0; i < n->plane_count; i++) cuts[i] = flow_cut_at_eye(f, n->planes[i], n->zone);
}

flow_polygon flow_clip(const flow *f, uint32_t portal, const cull_cut *cuts, uint32_t cut_count)
{
    const scene_portal *p = &f->scene->portals[portal];
    const double *eye = f->base.camera->eye;
    cull_point *in = f->polygon[0], *out = f->polygon[1];
    flow_polygon polygon = {in, p->point_count};
    for (uint32_t i = 0; i < p->point_count; i++) {
        const double *at = f->scene->portal_points[p->first_point + i];
        in[i] = (cull_point){at[0] - eye[0], at[1] - eye[1], at[2] - eye[2]};
    }
    for (uint32_t i = 0; i < cut_count && polygon.count > 0; i++) {
        const uint32_t inside = count_inside(&polygon, cuts[i]);
        if (inside == polygon.count) continue;
        if (inside == 0) return (flow_polygon){in, 0};
        const uint32_t count = cull_polygon_clip(in, polygon.count, cuts[i], out, f->polygon_capacity);
        if (count == f->polygon_capacity) continue; // no room, so uncut: larger
        polygon = (flow_polygon){out, count};
        out = in;
        in = (cull_point *)(uintptr_t)polygon.points;
    }
    return polygon;
}

flow_rectangle flow_rectangle_of(const flow *f, const flow_polygon *p)
{
    const view_base *b = &f->base;
    flow_rectangle r = {{1, 1}, {-1, -1}};
    for (uint32_t i = 0; i < p->count; i++) {
        const cull_point q = p->points[i];
        const double depth = -(q.x * b->back[0] + q.y * b->back[1] + q.z * b->back[2]);
        if (!(depth > 0)) return (flow_rectangle){{-1, -1}, {1, 1}};
        const double at[2] = {(q.x * b->right[0] + q.y * b->right[1] + q.z * b->right[2]) / (depth * b->wide),
                              (q.x * b->up[0] + q.y * b->up[1] + q.z * b->up[2]) / (depth * b->tall)};
        for (int k = 0; k < 2; k++) {
            const double guard = f->guard_tangent / (k == 0 ? b->wide : b->tall);
            if (at[k] - guard < r.low[k]) r.low[k] = at[k] - guard;
            if (at[k] + guard > r.high[k]) r.high[k] = at[k] + guard;
        }
    }
    for (int k = 0; k < 2; k++) {
        if (!(r.low[k] > -1)) r.low[k] = -1;
        if (!(r.high[k] < 1)) r.high[k] = 1;
        if (r.low[k] > r.high[k]) r.low[k] = r.high[k] = r.low[k] > 1 ? 1 : -1; // outside by rounding
    }
    return r;
}

// ---- One volume in another ----

static int has_record(const flow_candidate *c, const flow_record *r)
{
    for (uint32_t i = 0; i < c->plane_count; i++) {
        if (c->records[i].origin != r->origin) continue;
        if (r->origin & FLOW_ROOT_RECORD || memcmp(&c->records[i].plane, &r->plane, sizeof r->plane) == 0) return 1;
    }
    return 0;
}

// Points of the volume behind a polygon are t q with q in it, t >= 1. At a height of offset + t n . q they stay inside where
// n . q >= 0 and, for an eye outside of the plane, q itself is inside. With the plane's guard band to spare, as the
// picture's snapping and the boxes' widening let something through at the polygon's border; 7/8: the plane's own guard
// stands in its float normal, rounded. No band against the plane of the portal itself, which q lies on.
static int polygon_is_inside(const flow *f, const flow_polygon *p, cull_cut cut, int is_on_plane)
{
    const double *back = f->base.back;
    const double along = cut.x * back[0] + cut.y * back[1] + cut.z * back[2], rest = 1 - along * along;
    const double across = rest > 0 ? sqrt(rest) : 0;
    const double guard = 0.875 * (CULL_GUARD_PX * f->base.pixel_tangent * across + f->widening);
    const double offset = cut.offset < 0 ? cut.offset : 0;
    cut.offset = 0;
    for (uint32_t i = 0; i < p->count; i++) {
        const cull_point q = p->points[i];
        const double depth = -(q.x * back[0] + q.y * back[1] + q.z * back[2]), rise = cull_cut_height(cut, q);
        if (!(rise >= 0) || !(rise + offset >= (is_on_plane ? 0 : guard * depth))) return 0;
    }
    return 1;
}

int flow_is_inside(const flow *f, const flow_candidate *c, const flow_node *other)
{
    for (uint32_t i = 0; i < other->plane_count; i++) {
        if (has_record(c, &other->records[i])) continue;
        const cull_cut cut = flow_cut_at_eye(f, other->planes[i], other->zone);
        if (!polygon_is_inside(f, c->polygon, cut, cut.offset < 0 && c->way == other->way)) return 0;
    }
    return 1;
}
