// Narrowing a volume to a portal (Luebke and Georges, Portals and Mirrors, 1995), with the portal's polygon clipped exactly
// instead of its rectangle on the picture. Invariant: a plane that would be badly conditioned is left out: wider, never narrower.
// SPDX-License-Identifier: MIT
#include "narrow.h"

#include <math.h>
#include <string.h>

// Sine between the rays to an edge's two ends below which its plane is left out: the normal would be off by double's 2^-52
// over this, 2^-28: half a hundredth of the guard band's 2^-20.
static const double LEAST_SINE = 1.0 / 16777216;
// Share of the zone's radius: rounding of floats, as in the host's rule for eyes near portals.
static const double NEAR_SHARE = 1.0 / 65536;

static cull_cut cut_at_eye(const narrowing *n, cull_plane plane)
{
    cull_cut cut = {(double)plane.normal.x, (double)plane.normal.y, (double)plane.normal.z, (double)plane.offset};
    cut.offset += (cut.x * n->guard.eye[0] + cut.y * n->guard.eye[1]) + cut.z * n->guard.eye[2];
    return cut;
}

typedef struct extent { double least, most; } extent;

static extent extent_along(const narrowing *n, cull_cut cut)
{
    extent e = {INFINITY, -INFINITY};
    for (uint32_t i = 0; i < n->count; i++) {
        const double height = cull_cut_height(cut, n->polygon[i]);
        e.least = height < e.least ? height : e.least;
        e.most = height > e.most ? height : e.most;
    }
    return e;
}

// ---- What is left of the portal ----

static void place_at_eye(narrowing *n)
{
    memcpy(n->guard.eye, n->view->eye_exact, sizeof n->guard.eye);
    n->count = n->portal->point_count;
    for (uint32_t i = 0; i < n->count; i++) {
        const cull_vec3 p = n->portal->points[i];
        n->corners[i] = (cull_point){(double)p.x - n->guard.eye[0], (double)p.y - n->guard.eye[1], (double)p.z - n->guard.eye[2]};
    }
    n->polygon = n->corners;
}

// DESIGN.md's rule 3: nearer than the corner of the near plane the picture may look past the portal's edge.
static int is_at_eye(const narrowing *n)
{
    const cull_vec3 normal = n->portal->plane.normal;
    const cull_point at = n->corners[0];
    const double height = -((double)normal.x * at.x + (double)normal.y * at.y + (double)normal.z * at.z);
    return height < (double)n->view->near_distance * n->view->reach + n->guard.radius * NEAR_SHARE;
}

// The heights of the polygon's corners above the cut, and between which they lie.
static extent heights_find(const narrowing *n, cull_cut cut, double *heights)
{
    extent e = {INFINITY, -INFINITY};
    for (uint32_t i = 0; i < n->count; i++) {
        heights[i] = cull_cut_height(cut, n->polygon[i]);
        e.least = heights[i] < e.least ? heights[i] : e.least;
        e.most = heights[i] > e.most ? heights[i] : e.most;
    }
    return e;
}

static void polygon_clip(narrowing *n, narrow_choice choice)
{
    double heights[NARROW_ROOM];
    for (uint32_t i = 0; i < n->in->plane_count && n->count > 0; i++) {
        const extent e = heights_find(n, n->cuts[i], heights);
        n->has_cut[i] = e.least < 0;
        if (e.least >= 0) continue;
        if (e.most < 0) n->count = 0;
        if (e.most < 0 || choice == NARROW_UNCUT) continue;
        cull_point *out = n->points[n->polygon == n->points[0] ? 1 : 0];
        n->count = cull_polygon_clip_at(n->polygon, heights, n->count, out, NARROW_ROOM);
        n->polygon = out;
    }
}

narrow_verdict narrow_start(narrowing *n, narrow_choice choice)
{
    n->plane_count = 0;
    if (n->view->eye[3] == 0 || n->portal->point_count > NARROW_CORNERS) return NARROW_WHOLE;
    place_at_eye(n);
    if (is_at_eye(n)) return NARROW_WHOLE;
    memcpy(n->guard.forward, n->view->forward, sizeof n->guard.forward);
    n->guard.pixel_tangent = n->view->pixel_tangent;
    n->guard.reach = n->view->reach;
    for (uint32_t i = 0; i < n->in->plane_count; i++) n->cuts[i] = cut_at_eye(n, n->in->planes[i]);
    polygon_clip(n, choice);
    if (n->count == 0) return NARROW_GONE;
    return n->count == NARROW_ROOM ? NARROW_WHOLE : NARROW_CLIPPED;
}

// ---- The volume behind ----

static int plane_add(narrowing *n, cull_plane plane)
{
    if (n->plane_count == CULL_MAX_PLANES) return 0;
    n->planes[n->plane_count++] = plane;
    return 1;
}

// A plane that ends the view, as a far plane does, goes on ending it, though it may not cut this portal.
static int is_end(const narrowing *n, uint32_t plane)
{
    const double offset = n->cuts[plane].offset;
    return offset > n->guard.radius * NEAR_SHARE && extent_along(n, n->cuts[plane]).least < offset;
}

static int ends_add(narrowing *n)
{
    for (uint32_t i = 0; i < n->in->plane_count; i++)
        if (is_end(n, i) && !plane_add(n, n->in->planes[i])) return 0;
    return 1;
}

static int cutters_add(narrowing *n)
{
    for (uint32_t i = 0; i < n->in->plane_count; i++)
        if ((n->has_cut[i] || is_end(n, i)) && !plane_add(n, n->in->planes[i])) return 0;
    return 1;
}

typedef enum edge_choice { EDGES_THAT_BORDER, EDGES_ALL } edge_choice;

static const double BORDER_SHARE = 1.0 / 1048576; // of how far what is left reaches from an edge: nearer, and the edge borders it
// Of |normal|_1 * |point|_1: 16 times what rounding may make of a height, of the normal's own as well, 5 * 2^-53.
static const double HEIGHT_DOUBT = 16 * 5.0 / 9007199254740992;

typedef enum verge { VERGE_OFF, VERGE_BORDERS, VERGE_UNSURE } verge;

// Edge i of a polygon that nothing cut has its own two ends at height 0, by rounding: one corner well off it says the rest.
static int is_whole_and_wide(const narrowing *n, uint32_t i, cull_cut cut, double doubt)
{
    if (n->polygon != n->corners) return 0;
    const uint32_t across = i + (n->count + 1) / 2;
    return cull_cut_height(cut, n->corners[across < n->count ? across : across - n->count]) * BORDER_SHARE > 2 * doubt;
}

// What the normal of unit length would say of edge i, without finding it: unsure where its rounding may decide.
static verge verge_of(const narrowing *n, uint32_t i, const double c[3], double farthest)
{
    const cull_cut cut = {c[0], c[1], c[2], 0};
    const double doubt = HEIGHT_DOUBT * (fabs(c[0]) + fabs(c[1]) + fabs(c[2])) * farthest;
    if (is_whole_and_wide(n, i, cut, doubt)) return VERGE_BORDERS;
    const extent e = extent_along(n, cut);
    if (e.least > e.most * BORDER_SHARE + doubt) return VERGE_OFF;
    return e.least < e.most * BORDER_SHARE - doubt ? VERGE_BORDERS : VERGE_UNSURE;
}

static int borders(const narrowing *n, const double normal[3])
{
    const extent e = extent_along(n, (cull_cut){normal[0], normal[1], normal[2], 0});
    return !(e.least > e.most * BORDER_SHARE); // else what is left lies off this edge
}

static double farthest_of(const narrowing *n)
{
    double most = 0;
    for (uint32_t i = 0; i < n->count; i++) {
        const cull_point p = n->polygon[i];
        const double far = fabs(p.x) + fabs(p.y) + fabs(p.z);
        most = far > most ? far : most;
    }
    return most;
}

static double square_of(cull_point p)
{
    return p.x * p.x + p.y * p.y + p.z * p.z;
}

// Planes through the eye and the portal's edges; from its own corners, so that every path makes the same planes.
static int edges_add(narrowing *n, edge_choice choice)
{
    const uint32_t corners = n->portal->point_count;
    const double farthest = choice == EDGES_THAT_BORDER ? farthest_of(n) : 0;
    for (uint32_t i = 0; i < corners; i++) {
        const cull_point a = n->corners[i], b = n->corners[i + 1 < corners ? i + 1 : 0];
        const double c[3] = {b.y * a.z - b.z * a.y, b.z * a.x - b.x * a.z, b.x * a.y - b.y * a.x};
        const verge at = choice == EDGES_THAT_BORDER ? verge_of(n, i, c, farthest) : VERGE_BORDERS;
        if (at == VERGE_OFF) continue;
        const double length = sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]);
        const double sizes = sqrt(square_of(a) * square_of(b));
        if (!(length > LEAST_SINE * sizes)) continue;
        const double normal[3] = {c[0] / length, c[1] / length, c[2] / length};
        if (at == VERGE_UNSURE && !borders(n, normal)) continue;
        if (!plane_add(n, cull_guard_plane(&n->guard, normal, 0))) return 0;
    }
    return 1;
}

// The portal's own plane: what is seen lies behind it. No slack but rounding and the portal's own bend: slack here makes two
// portals that meet at an edge feed each other.
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

int narrow_exact(narrowing *n)
{
    n->plane_count = 0;
    return cutters_add(n) && edges_add(n, EDGES_THAT_BORDER) && own_add(n);
}

int narrow_planes(narrowing *n)
{
    n->plane_count = 0;
    for (uint32_t i = 0; i < n->in->plane_count; i++)
        if (!plane_add(n, n->in->planes[i])) return 0;
    return edges_add(n, EDGES_ALL) && own_add(n);
}

// ---- On the picture ----

static void axes_make(const double forward[3], double right[3], double up[3])
{
    const int k = fabs(forward[1]) < 0.75 ? 1 : 0; // an axis well off forward
    double v[3] = {0, 0, 0};
    v[k] = 1;
    right[0] = forward[1] * v[2] - forward[2] * v[1];
    right[1] = forward[2] * v[0] - forward[0] * v[2];
    right[2] = forward[0] * v[1] - forward[1] * v[0];
    const double length = sqrt(right[0] * right[0] + right[1] * right[1] + right[2] * right[2]);
    for (int i = 0; i < 3; i++) right[i] /= length;
    up[0] = right[1] * forward[2] - right[2] * forward[1];
    up[1] = right[2] * forward[0] - right[0] * forward[2];
    up[2] = right[0] * forward[1] - right[1] * forward[0];
}

static double along(const double axis[3], cull_point p)
{
    return (axis[0] * p.x + axis[1] * p.y) + axis[2] * p.z;
}

enum { MOST_SIDES = 8 };

// How far what is left reaches in each direction of the picture, in tangents. 0: it reaches beside the eye.
static int reaches_find(const narrowing *n, const double (*ways)[3], uint32_t sides, double *reaches)
{
    for (uint32_t s = 0; s < sides; s++) reaches[s] = -INFINITY;
    for (uint32_t i = 0; i < n->count; i++) {
        const cull_point p = n->polygon[i];
        const double depth = along(n->guard.forward, p);
        const double size = fabs(p.x) + fabs(p.y) + fabs(p.z);
        if (!(depth > size * LEAST_SINE)) return 0;
        for (uint32_t s = 0; s < sides; s++) {
            const double at = along(ways[s], p) / depth;
            reaches[s] = at > reaches[s] ? at : reaches[s];
        }
    }
    return 1;
}

int narrow_window(narrowing *n, uint32_t sides)
{
    double right[3], up[3], ways[MOST_SIDES][3], reaches[MOST_SIDES];
    static const double turns[MOST_SIDES][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
    axes_make(n->guard.forward, right, up);
    for (uint32_t s = 0; s < sides; s++)
        for (int k = 0; k < 3; k++) ways[s][k] = turns[s][0] * right[k] + turns[s][1] * up[k];
    if (!reaches_find(n, (const double (*)[3])ways, sides, reaches)) return 0;
    n->plane_count = 0;
    if (!ends_add(n)) return 0;
    for (uint32_t s = 0; s < sides; s++) { // at / depth <= reach: reach * forward - way points inside
        double normal[3], square = 0;
        for (int k = 0; k < 3; k++) {
            normal[k] = reaches[s] * n->guard.forward[k] - ways[s][k];
            square += normal[k] * normal[k];
        }
        const double length = sqrt(square);
        for (int k = 0; k < 3; k++) normal[k] /= length;
        if (!plane_add(n, cull_guard_plane(&n->guard, normal, 0))) return 0;
    }
    return own_add(n);
}
