// The test culler `testportal`: a crosser that narrows volumes to portals, in full, for tests of the flow.
// SPDX-License-Identifier: MIT
// After Luebke and Georges, Portals and Mirrors (1995), with polygons instead of rectangles. Invariant: planes are left
// out where they would be badly conditioned or too many: that is wider, never narrower.
#include <portcullis/clip.h>
#include <portcullis/culler.h>
#include <portcullis/plane.h>

#include <math.h>
#include <string.h>

enum { POINTS = 64, ROOM = 2 * (POINTS + CULL_MAX_PLANES) };

// Sine between two rays to an edge's ends below which its plane is left out: its normal would be off by double's 2^-52
// over this, 2^-28, half a hundredth of the guard band's 2^-20.
static const double LEAST_SINE = 1.0 / 16777216;

struct cull_culler {
    const cull_host *host;
    const cull_zone *zone;
};
struct cull_query { const cull_culler *culler; };

typedef struct narrowing {
    cull_guard guard;
    const cull_portal *portal;
    cull_point corners[POINTS];    // of the portal, relative to the eye
    cull_point points[2][ROOM];    // clipped
    const cull_point *polygon;     // the latest of them
    uint32_t count;
    uint8_t cuts[CULL_MAX_PLANES]; // the volume's planes that cut it
    cull_plane *planes;
    uint32_t plane_count;
} narrowing;

static cull_cut cut_at_eye(const narrowing *n, cull_plane plane)
{
    cull_cut cut = {(double)plane.normal.x, (double)plane.normal.y, (double)plane.normal.z, (double)plane.offset};
    cut.offset += (cut.x * n->guard.eye[0] + cut.y * n->guard.eye[1]) + cut.z * n->guard.eye[2];
    return cut;
}

static void heights_find(const narrowing *n, cull_cut cut, double *least, double *most)
{
    *least = INFINITY;
    *most = -INFINITY;
    for (uint32_t i = 0; i < n->count; i++) {
        const double height = cull_cut_height(cut, n->polygon[i]);
        *least = height < *least ? height : *least;
        *most = height > *most ? height : *most;
    }
}

static void start(narrowing *n, const cull_view *view, const cull_zone *zone)
{
    memcpy(n->guard.eye, view->eye_exact, sizeof n->guard.eye);
    memcpy(n->guard.forward, view->forward, sizeof n->guard.forward);
    n->guard.pixel_tangent = view->pixel_tangent;
    n->guard.reach = view->reach;
    n->guard.radius = (double)zone->radius;
    n->count = n->portal->point_count;
    for (uint32_t i = 0; i < n->count; i++) {
        const cull_vec3 p = n->portal->points[i];
        n->corners[i] = (cull_point){(double)p.x - n->guard.eye[0], (double)p.y - n->guard.eye[1], (double)p.z - n->guard.eye[2]};
    }
    n->polygon = n->corners;
}

static void clip(narrowing *n, const cull_volume *in)
{
    cull_point *out = n->points[0], *next = n->points[1];
    for (uint32_t i = 0; i < in->plane_count && n->count > 0; i++) {
        const cull_cut cut = cut_at_eye(n, in->planes[i]);
        double least, most;
        heights_find(n, cut, &least, &most);
        n->cuts[i] = least < 0;
        if (least >= 0) continue;
        n->count = cull_polygon_clip(n->polygon, n->count, cut, out, ROOM);
        n->polygon = out;
        out = next;
        next = (cull_point *)(uintptr_t)n->polygon;
    }
}

static int is_near(const narrowing *n, const cull_view *view)
{
    const cull_vec3 normal = n->portal->plane.normal;
    const cull_point at = n->corners[0];
    const double height = -((double)normal.x * at.x + (double)normal.y * at.y + (double)normal.z * at.z);
    return height < (double)view->near_distance * view->reach + n->guard.radius / 65536;
}

static int plane_add(narrowing *n, cull_plane plane)
{
    if (n->plane_count == CULL_MAX_PLANES) return 0;
    n->planes[n->plane_count++] = plane;
    return 1;
}

// What cut the portal still bounds what is seen through it; and what ends the view, like a far plane, goes on doing so.
static int kept_add(narrowing *n, const cull_volume *in)
{
    for (uint32_t i = 0; i < in->plane_count; i++) {
        const cull_cut cut = cut_at_eye(n, in->planes[i]);
        double least, most;
        heights_find(n, cut, &least, &most);
        const int falls = least < cut.offset && cut.offset > n->guard.radius / 65536;
        if ((n->cuts[i] || falls) && !plane_add(n, in->planes[i])) return 0;
    }
    return 1;
}

// Edges of the portal that border what is left of it; from its corners, so that every path makes the same planes.
static int edges_add(narrowing *n)
{
    const uint32_t corners = n->portal->point_count;
    for (uint32_t i = 0; i < corners; i++) {
        const cull_point a = n->corners[i], b = n->corners[i + 1 < corners ? i + 1 : 0];
        const double c[3] = {b.y * a.z - b.z * a.y, b.z * a.x - b.x * a.z, b.x * a.y - b.y * a.x};
        const double length = sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]);
        const double sizes = sqrt((a.x * a.x + a.y * a.y + a.z * a.z) * (b.x * b.x + b.y * b.y + b.z * b.z));
        if (!(length > LEAST_SINE * sizes)) continue;
        const double normal[3] = {c[0] / length, c[1] / length, c[2] / length};
        double least, most;
        heights_find(n, (cull_cut){normal[0], normal[1], normal[2], 0}, &least, &most);
        if (least > most / 1048576) continue; // what is left lies off this edge
        if (!plane_add(n, cull_guard_plane(&n->guard, normal, 0))) return 0;
    }
    return 1;
}

// The portal's own plane: behind it. No slack but rounding; points off it are inside too.
static int own_add(narrowing *n)
{
    const cull_vec3 own = n->portal->plane.normal;
    const double behind[3] = {-(double)own.x, -(double)own.y, -(double)own.z};
    double offset = -INFINITY;
    for (uint32_t i = 0; i < n->portal->point_count; i++) {
        const cull_vec3 p = n->portal->points[i];
        const double at = -(behind[0] * (double)p.x + behind[1] * (double)p.y + behind[2] * (double)p.z);
        if (at > offset) offset = at;
    }
    return plane_add(n, cull_plane_outward(behind, offset, n->guard.radius));
}

static cull_crossing cross(cull_query *q, const cull_view *view, const cull_volume *in, uint32_t portal, cull_plane *planes, uint32_t *plane_count)
{
    const cull_zone *zone = q->culler->zone;
    narrowing n;
    n.portal = &zone->portals[portal];
    n.planes = planes;
    n.plane_count = 0;
    if (view->eye[3] == 0 || n.portal->point_count > POINTS) return CULL_CROSS_SAME;
    start(&n, view, zone);
    if (is_near(&n, view)) return CULL_CROSS_SAME;
    clip(&n, in);
    if (n.count == 0) return CULL_CROSS_NONE;
    if (n.count == ROOM || !kept_add(&n, in) || !edges_add(&n) || !own_add(&n)) return CULL_CROSS_SAME;
    *plane_count = n.plane_count;
    return CULL_CROSS_NARROW;
}

// ---- The rest of a culler ----

static cull_result create(const cull_host *host, const char *const *values, cull_culler **out)
{
    (void)values;
    cull_culler *c = host->alloc(host, sizeof *c, sizeof(void *));
    if (!c) return CULL_ERR_MEMORY;
    *c = (cull_culler){.host = host};
    *out = c;
    return CULL_OK;
}

static void destroy(cull_culler *c)
{
    c->host->free(c->host, c, sizeof *c);
}

static cull_result build(cull_culler *c, const cull_zone *zone, const cull_hierarchy *lent, cull_built *out)
{
    (void)lent;
    c->zone = zone;
    out->max_steps = 1;
    return CULL_OK;
}

static cull_result open(const cull_culler *c, cull_query **out)
{
    cull_query *q = c->host->alloc(c->host, sizeof *q, sizeof(void *));
    if (!q) return CULL_ERR_MEMORY;
    q->culler = c;
    *out = q;
    return CULL_OK;
}

static void close(cull_query *q)
{
    q->culler->host->free(q->culler->host, q, sizeof *q);
}

static const void *get_extension(const cull_culler *c, const char *id)
{
    (void)c;
    (void)id;
    return NULL;
}

static const cull_descriptor descriptor = {"testportal", "1", "narrows volumes to portals", NULL, 0, CULL_CONSERVATIVE | CULL_STATELESS};
static const cull_plugin plugin = {.descriptor = &descriptor, .create = create, .destroy = destroy, .build = build, .open = open,
                                   .close = close, .cross = cross, .get_extension = get_extension};
static const cull_plugin *const plugins[] = {&plugin};
CULL_ENTRY = {CULL_ABI, 1, plugins};
