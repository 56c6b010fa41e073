// See oracle.h.
// SPDX-License-Identifier: MIT
// A target is rounded to the zone's floats first and the line is followed to it anew, so a target is a point that geometry
// can have, and planes are evaluated on it plainly in float, like a culler does.
#include "tests/flow/oracle.h"

#include "host/core/zone_seam.h"
#include "tests/common/random.h"

#include <portcullis/plane.h>

#include <math.h>
#include <string.h>

// Metres that portals may lie off their zones' faces: the scene's rounding, with room.
static const double SEAM_M = 1e-2;

typedef struct ray { double from[3], along[3]; } ray; // points from + t along; the target at t 1
typedef struct span { double in, out; } span;

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static span hull_span(const scene *s, uint32_t hull, const ray *r)
{
    const scene_hull *h = &s->hulls[hull];
    span out = {-INFINITY, INFINITY};
    for (uint32_t i = 0; i < h->plane_count; i++) {
        const scene_solid_plane *p = &s->hull_planes[h->first_plane + i];
        const double above = dot(p->normal, r->from) - p->distance, rise = dot(p->normal, r->along);
        if (rise > 0) out.out = fmin(out.out, -above / rise);
        else if (rise < 0) out.in = fmax(out.in, -above / rise);
        else if (above > 0) return (span){INFINITY, -INFINITY};
    }
    return out;
}

// Where the ray leaves the union of the zone's hulls that it is in at `start`; one begins where another ends, or a seam off.
static double hulls_end(const scene *s, const scene_zone *z, const ray *r, double start, double seam)
{
    double end = -INFINITY, before;
    for (uint32_t h = z->first_hull; h < z->first_hull + z->hull_count; h++) {
        const span in = hull_span(s, h, r);
        if (in.in <= start + seam && in.out >= start - seam) end = fmax(end, in.out);
    }
    if (end == -INFINITY) return start;
    do {
        before = end;
        for (uint32_t h = z->first_hull; h < z->first_hull + z->hull_count; h++) {
            const span in = hull_span(s, h, r);
            if (in.in < in.out && in.in <= end + seam) end = fmax(end, in.out);
        }
    } while (end > before);
    return end;
}

// Where the ray leaves the zone, portals apart: through its hulls, or into a zone that lies in it.
static double zone_end(const scene *s, uint32_t zone, const ray *r, double start, double seam)
{
    const scene_zone *z = &s->zones[zone];
    double end = z->hull_count > 0 ? hulls_end(s, z, r, start, seam) : INFINITY;
    for (uint32_t h = 0; h < s->hull_count; h++) {
        if (s->zones[s->hulls[h].zone].parent != zone) continue;
        const span in = hull_span(s, h, r);
        if (in.in < in.out && in.out > start + seam && in.in < end) end = fmax(in.in, start);
    }
    return end;
}

// The line passes through the loop: on the inner side of each edge, seen from where it starts.
static int is_in_loop(const scene *s, uint32_t way, const ray *r)
{
    const scene_portal *p = &s->portals[way / 2];
    const double sign = way % 2 ? -1 : 1; // counterclockwise seen from side 0
    for (uint32_t i = 0; i < p->point_count; i++) {
        const double *on = s->portal_points[p->first_point + i], *next = s->portal_points[p->first_point + (i + 1) % p->point_count];
        const double a[3] = {on[0] - r->from[0], on[1] - r->from[1], on[2] - r->from[2]};
        const double b[3] = {next[0] - r->from[0], next[1] - r->from[1], next[2] - r->from[2]};
        const double inner[3] = {b[1] * a[2] - b[2] * a[1], b[2] * a[0] - b[0] * a[2], b[0] * a[1] - b[1] * a[0]};
        if (sign * dot(inner, r->along) < 0) return 0;
    }
    return 1;
}

typedef struct step { double t; uint32_t way; } step;

static step next_portal(const oracle_request *q, uint32_t zone, const ray *r, double start, double end)
{
    const scene *s = q->scene;
    step best = {INFINITY, SCENE_NONE};
    for (uint32_t i = 0; i < s->zones[zone].portal_count; i++) {
        const uint32_t way = s->zone_portals[s->zones[zone].first_portal + i];
        const scene_portal *p = &s->portals[way / 2];
        const double sign = way % 2 ? -1 : 1, *on = s->portal_points[p->first_point];
        const double off[3] = {r->from[0] - on[0], r->from[1] - on[1], r->from[2] - on[2]};
        const double above = sign * dot(p->plane, off), rise = sign * dot(p->plane, r->along);
        if (!q->open[way / 2] || !(rise < 0)) continue;
        const double t = -above / rise;
        if (t < start || t > end || t >= best.t) continue;
        if (is_in_loop(s, way, r)) best = (step){t, way};
    }
    return best;
}

typedef struct trace { uint32_t zones[64], ways[64]; double starts[65]; uint32_t count; } trace; // ways: into the zone; SCENE_NONE: it starts there

// Through which zones the ray goes. starts[i] .. starts[i + 1] lies in zones[i].
static void follow(const oracle_request *q, uint32_t zone, const ray *r, trace *out)
{
    const double seam = SEAM_M / sqrt(dot(r->along, r->along));
    out->count = 0;
    double start = 0;
    uint32_t way = SCENE_NONE;
    while (out->count < 64) {
        const double end = zone_end(q->scene, zone, r, start, seam);
        const step next = next_portal(q, zone, r, fmax(start - seam, 0), end + seam);
        out->zones[out->count] = zone;
        out->ways[out->count] = way;
        out->starts[out->count++] = start;
        out->starts[out->count] = fmax(next.way == SCENE_NONE ? end : next.t, start); // never back, where faces are off by a seam
        if (next.way == SCENE_NONE) return;
        way = next.way;
        zone = q->scene->portals[way / 2].zones[1 - way % 2];
        start = out->starts[out->count];
    }
}

// In the part of the picture that the volume is said to cover.
static int is_in_rectangle(const flow_volume *v, const float p[2])
{
    return v->rectangle[0] <= p[0] && p[0] <= v->rectangle[2] && v->rectangle[1] <= p[1] && p[1] <= v->rectangle[3];
}

// It does not say that all of it came in another way.
static int may_enter(const scene *s, const flow_volume *v, uint32_t way)
{
    return v->volume.entry == 0 || (s->zone_portals[s->zones[v->zone].first_portal + v->volume.entry - 1] ^ 1) == way;
}

typedef struct target { uint32_t zone, way; float at[3], picture[2]; } target;

static int is_seen(const oracle_request *q, const target *p)
{
    const flow_result *f = q->result;
    const cull_vec3 at = {p->at[0], p->at[1], p->at[2]};
    for (uint32_t i = 0; i < f->zone_count; i++) {
        if (f->zones[i].zone != p->zone) continue;
        for (uint32_t k = 0; k < f->zones[i].count; k++) {
            const flow_volume *v = &f->volumes[f->by_zone[f->zones[i].first + k]];
            if (may_enter(q->scene, v, p->way) && is_in_rectangle(v, p->picture) && cull_volume_touches(&v->volume, (cull_box){at, at})) return 1;
        }
    }
    return 0;
}

static void look_at(const oracle_request *q, const view_base *base, uint32_t start_zone, const ray *r, const trace *t, uint32_t place,
                    double share, oracle_answer *out)
{
    const double from = t->starts[place], to = fmin(t->starts[place + 1], from + 1);
    const uint32_t zone = t->zones[place];
    const double *origin = q->scene->zones[zone].origin, at = from + share * (to - from);
    target p = {.zone = zone, .way = t->ways[place]};
    ray exact = *r;
    for (int i = 0; i < 3; i++) {
        p.at[i] = (float)(r->from[i] + at * r->along[i] - origin[i]);
        exact.along[i] = ((double)p.at[i] + origin[i]) - r->from[i];
    }
    const double size = sqrt(dot(exact.along, exact.along));
    if (!(size > q->camera->near_m)) return;
    trace again;
    follow(q, start_zone, &exact, &again);
    if (again.count <= place || again.zones[place] != zone || again.ways[place] != p.way || !(again.starts[place] <= 1 && again.starts[place + 1] >= 1)) return;
    const double depth = -dot(exact.along, base->back);
    p.picture[0] = (float)(dot(exact.along, base->right) / (depth * base->wide));
    p.picture[1] = (float)(dot(exact.along, base->up) / (depth * base->tall));
    if (!(depth > 0) || depth > q->camera->far_m || fabsf(p.picture[0]) > 1 || fabsf(p.picture[1]) > 1) return; // not in the picture
    out->points++;
    out->behind += place >= 2;
    if (is_seen(q, &p)) return;
    if (out->missed++ > 0) return;
    out->zone = zone;
    out->portals = place;
    for (int i = 0; i < 3; i++) out->at[i] = (double)p.at[i] + origin[i];
}

static int holds(const scene *s, uint32_t zone, const double p[3])
{
    const scene_zone *z = &s->zones[zone];
    if (z->flags & ZONE_STRAY) return 0;
    const double rounding = 1e-6; // metres: an eye on a border is on both its sides
    if (z->hull_count > 0 && zone_height(s, zone, p) > rounding) return 0;
    for (uint32_t h = 0; h < s->hull_count; h++)
        if (s->zones[s->hulls[h].zone].parent == zone && scene_hull_height(s, h, p) < -rounding) return 0;
    return 1;
}

static int aim_anywhere(const oracle_request *q, const view_base *base, uint64_t *seed, ray *out)
{
    const double x = random_between(seed, -1, 1) * base->wide, y = random_between(seed, -1, 1) * base->tall;
    memcpy(out->from, q->camera->eye, sizeof out->from);
    for (int k = 0; k < 3; k++) out->along[k] = 100 * (x * base->right[k] + y * base->up[k] - base->back[k]);
    return 1;
}

// Just inside of a portal's edge or corner, where volumes are tightest. Seldom in the picture, and then left out.
static int aim_at_border(const oracle_request *q, uint64_t *seed, ray *out)
{
    const scene *s = q->scene;
    if (s->portal_count == 0) return 0;
    const scene_portal *p = &s->portals[random_below(seed, s->portal_count)];
    const double(*points)[3] = (const double(*)[3]) & s->portal_points[p->first_point];
    const uint32_t edge = random_below(seed, p->point_count), after = (edge + 1) % p->point_count;
    const double share = random_below(seed, 4) == 0 ? 0 : random_between(seed, 0, 1), inset = pow(10, random_between(seed, -8, -1));
    double length = 0;
    memcpy(out->from, q->camera->eye, sizeof out->from);
    for (int k = 0; k < 3; k++) {
        double middle = 0;
        for (uint32_t i = 0; i < p->point_count; i++) middle += points[i][k] / p->point_count;
        const double on = points[edge][k] + share * (points[after][k] - points[edge][k]);
        out->along[k] = on + inset * (middle - on) - out->from[k];
        length += out->along[k] * out->along[k];
    }
    for (int k = 0; k < 3; k++) out->along[k] *= 100 / sqrt(length);
    return length > 0;
}

oracle_answer oracle_ask(const oracle_request *q)
{
    oracle_answer out = {0};
    uint64_t seed = q->seed;
    view_base base;
    view_base_make(q->camera, &(view_frame){320, 240, 0, 0, CULL_VIEW_MAIN}, &base);
    for (uint32_t zone = 0; zone < q->scene->zone_count; zone++) {
        if (!holds(q->scene, zone, q->camera->eye)) continue;
        for (uint32_t i = 0; i < q->rays; i++) {
            ray r;
            if (!(i % 2 ? aim_at_border(q, &seed, &r) : aim_anywhere(q, &base, &seed, &r))) continue;
            trace t;
            follow(q, zone, &r, &t);
            for (uint32_t place = 0; place < t.count; place++) look_at(q, &base, zone, &r, &t, place, random_between(&seed, 0, 1), &out);
        }
    }
    return out;
}
