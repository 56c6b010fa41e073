// bound.c: upper bounds on what a cached picture displaces, as ratios of quadratic forms at 26 control points of the box.
// Section 1.10 of the reference page, in its exact form over the six faces.
// Invariant: every operation that isn't exact only makes a bound larger; see GROW.
// SPDX-License-Identifier: MIT
//
// THE DISPLACEMENT. From the capture eye, x = p - e0 is a point of the box, n the picture's normal, D its distance, and the
// picture of p stands at q = e0 + x * D / (n.x). Seen from e = e0 + m by a view with axis a, the picture plane at distance 1:
//     place(p) - place(q) = h * N / (v * w),   h = n.x - D,   N = a x (x x m) = x (a.m) - m (a.x),
//     v = a.x - a.m,   w = D a.x - (n.x) a.m
// (put p - q = h x / (n.x) into the difference of the two projections). h, N, v and w are affine in p. In this form the secants
// of both places and the direction of the displacement, radial or tangential, are exact: times f it is the length in pixels.
// Free of the axis:  tan(angle(p - e, q - e)) = |h (x x m)| / ((x - m) . (D x - (n.x) m)).
//
// ENTRY AND EXIT. On one ray from e0 the picture q stays and p runs along a line, so its place runs along a line through
// place(q): the distance grows both ways from q, and is largest where the ray enters or leaves the box. Only faces matter.
//
// THE BOUND ON A FACE. Numerator and denominator are quadratic polynomials in the two parameters of the face, so both are
// sums of 9 control values with the same weights B_k >= 0 (Bernstein). With all denominators d_k > 0
//     |sum B_k n_k| <= sum B_k |n_k| <= max(|n_k| / d_k) * sum B_k d_k,
// so no point of the face exceeds max |n_k| / d_k. Of the controls of all faces, 8 are the corners themselves (true
// displacements), 12 the mixed values of an edge's ends, 6 those of a face's diagonals: 26 in all. Where a corner is the
// largest of them, the bound is exact.
#include "bound.h"

#include <string.h>

#define GROW (1 + 1.0 / 1099511627776) // 2^-40 of the bound: rounding of doubles, some 100 operations of 2^-53
#define GUARD_MATRIX (1.0 / 1048576)   // 2^-20 of the distance: float matrices, as CULL_GUARD_DISTANCE of plane.h
#define GUARD_FLOAT (1.0 / 16777216)   // 2^-24 of a coordinate: one rounding to float
#define SNAP_PX (1.0 / 256)            // the rasterizer's grid: a vertex comes to stand half a step away, in x and in y
#define ROOT_2 1.4142135623730951
#define ROOT_3 1.7320508075688772

// Corners a, b of each edge, and a, b, c, d of each face with diagonals a-d and b-c.
static const uint8_t edges[12][2] = {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {0, 2}, {1, 3}, {4, 6}, {5, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
static const uint8_t faces[6][4] = {{0, 2, 4, 6}, {1, 3, 5, 7}, {0, 1, 4, 5}, {2, 3, 6, 7}, {0, 1, 2, 3}, {4, 5, 6, 7}};

// A control value, times 2 (an edge's, a corner's) or 4 (a face's): its numerator and denominator.
typedef struct control {
    double top[3], below;
} control;

// The mixed value of corners i and j of one way to show; i == j: the corner's own.
typedef control mixed(const void *forms, int i, int j);

bound_view bound_view_of(const cull_view *view)
{
    bound_view out = {.optics = {view->pixels_per_tangent, view->eye[3] == 0 ? INFINITY : view->reach}};
    const float *clip = view->clip_from_zone;
    double length = 0;
    memcpy(out.eye, view->eye_exact, sizeof out.eye);
    memcpy(out.forward, view->forward, sizeof out.forward);
    // The matrix's first row is right, plus some forward where the picture's middle is not on the axis. Only the centre
    // alignment asks for it; up then follows, so the three stand at right angles to double precision.
    for (int k = 0; k < 3; k++) out.right[k] = clip[4 * k];
    const double along = bound_dot(out.right, out.forward);
    for (int k = 0; k < 3; k++) out.right[k] -= along * out.forward[k];
    length = sqrt(bound_dot(out.right, out.right));
    for (int k = 0; k < 3; k++) out.right[k] /= length;
    bound_cross(out.right, out.forward, out.up);
    return out;
}

static double largest(double a, double b)
{
    return a > b ? a : b;
}

static double smallest(double a, double b)
{
    return a < b ? a : b;
}

// Metres from a point to the box low .. high.
static double distance_to(const double point[3], const double low[3], const double high[3])
{
    double away[3];
    for (int k = 0; k < 3; k++) away[k] = largest(0, largest(low[k] - point[k], point[k] - high[k]));
    return sqrt(bound_dot(away, away));
}

// Quarter `part` of face `face` (2 * axis + side): how near to the eye it comes, how far from the picture's plane.
static bound_patch patch_of(const bound_capture *capture, int face, int part)
{
    const int axis = face >> 1, u = (axis + 1) % 3, v = (axis + 2) % 3;
    double middle[3], half[3], away[3], height = 0, reach = 0;
    middle[axis] = (face & 1) ? capture->half[axis] : -capture->half[axis];
    half[axis] = 0;
    half[u] = capture->half[u] / 2;
    half[v] = capture->half[v] / 2;
    middle[u] = (part & 1) ? half[u] : -half[u];
    middle[v] = (part & 2) ? half[v] : -half[v];
    for (int k = 0; k < 3; k++) {
        height += capture->normal[k] * middle[k];
        reach += fabs(capture->normal[k]) * half[k];
        away[k] = largest(0, fabs(capture->eye[k] - capture->centre[k] - middle[k]) - half[k]);
    }
    const bound_patch patch = {sqrt(bound_dot(away, away)), fabs(height) + reach};
    return patch;
}

// One that is no nearer and no farther from the plane than another decides nothing: some four stay.
static void patches_of(bound_capture *capture)
{
    for (int i = 0; i < BOUND_PATCHES; i++) {
        const bound_patch patch = patch_of(capture, i >> 2, i & 3);
        uint32_t kept = 0, is_needed = 1;
        for (uint32_t k = 0; k < capture->patch_count && is_needed; k++)
            is_needed = capture->patches[k].near > patch.near || capture->patches[k].height < patch.height;
        if (!is_needed) continue;
        for (uint32_t k = 0; k < capture->patch_count; k++)
            if (capture->patches[k].near < patch.near || capture->patches[k].height > patch.height) capture->patches[kept++] = capture->patches[k];
        capture->patches[kept] = patch;
        capture->patch_count = kept + 1;
    }
}

bound_capture bound_capture_of(const double eye[3], const cull_box *box)
{
    const double low[3] = {box->min.x, box->min.y, box->min.z}, high[3] = {box->max.x, box->max.y, box->max.z};
    bound_capture out = {.radius = 0};
    for (int k = 0; k < 3; k++) {
        out.eye[k] = eye[k];
        out.centre[k] = low[k] + (high[k] - low[k]) / 2;
        out.half[k] = largest(high[k] - out.centre[k], out.centre[k] - low[k]);
        out.normal[k] = out.centre[k] - eye[k];
        out.radius = largest(out.radius, largest(fabs(eye[k]), fabs(out.centre[k])));
    }
    out.distance = sqrt(bound_dot(out.normal, out.normal));
    // A picture spans at most a tangent of 1 around its middle (QUAD_WIDEST of quad.h), so 1.5 to its corners with their padding.
    out.radius += 1.5 * out.distance;
    out.nearest_depth = INFINITY;
    for (int k = 0; k < 3; k++) out.normal[k] /= out.distance;
    for (int i = 0; i < BOUND_CORNERS; i++) {
        double from_centre[3];
        for (int k = 0; k < 3; k++) from_centre[k] = (i >> k & 1 ? high[k] : low[k]) - out.centre[k];
        for (int k = 0; k < 3; k++) out.offset[i][k] = (i >> k & 1 ? high[k] : low[k]) - eye[k];
        out.height[i] = bound_dot(out.normal, from_centre);
        out.depth[i] = out.distance + out.height[i];
        out.nearest_depth = smallest(out.nearest_depth, out.depth[i]);
    }
    patches_of(&out);
    return out;
}

// ---- Ratios at the controls ----

static control added(control a, control b)
{
    for (int k = 0; k < 3; k++) a.top[k] += b.top[k];
    a.below += b.below;
    return a;
}

// Squares of the largest ratio so far, without a division.
typedef struct greatest {
    double top, below, least_below;
} greatest;

static inline void take(greatest *so_far, control c)
{
    const double top = bound_dot(c.top, c.top), below = c.below * c.below;
    if (!(c.below > so_far->least_below)) so_far->least_below = c.below;
    if (!(top * so_far->below <= so_far->top * below)) {
        so_far->top = top;
        so_far->below = below;
    }
}

// The largest |numerator| / denominator of the 26 controls; INFINITY where a denominator isn't positive.
static inline double greatest_ratio(mixed *value, const void *forms)
{
    greatest so_far = {0, 1, INFINITY};
    for (int i = 0; i < BOUND_CORNERS; i++) take(&so_far, value(forms, i, i));
    for (int i = 0; i < 12; i++) take(&so_far, value(forms, edges[i][0], edges[i][1]));
    for (int i = 0; i < 6; i++)
        take(&so_far, added(value(forms, faces[i][0], faces[i][3]), value(forms, faces[i][1], faces[i][2])));
    return so_far.least_below > 0 ? sqrt(so_far.top / so_far.below) * GROW : INFINITY;
}

// ---- Angles to pixels ----

double bound_segment(double length, double distance)
{
    const double half = length / (2 * distance);
    return half < 1 ? 2 * half / (1 - half * half) : INFINITY;
}

// Two directions t = tan(angle) apart, one of them at most an angle A from the axis, 1 / cos(A) = reach. Their places U, W on
// the plane at distance 1: |U - W| * h = |U| |W| sin(angle), h >= 1 the distance from the eye to the line through them, |U| <=
// reach, |W| <= 1 / cos(A + angle). So |U - W| <= reach^2 t / (1 - t tan(A)): reached at the picture's corner, radially.
double bound_pixels(double t, const bound_optics *optics)
{
    const double corner = sqrt(optics->reach * optics->reach - 1), rest = 1 - t * corner;
    return rest > 0 && optics->reach < INFINITY ? optics->pixels_per_tangent * optics->reach * optics->reach * t / rest : INFINITY;
}

// Its inverse.
double bound_tangent(double pixels, const bound_optics *optics)
{
    const double corner = sqrt(optics->reach * optics->reach - 1);
    return pixels / (optics->pixels_per_tangent * optics->reach * optics->reach + pixels * corner);
}

// Matrices: the capture's, the showing one and that of the true geometry, each 2^-20 of the distance, and a quarter of it all for second order.
// The rasterizer's grid: the same three. The parallelogram: three numbers added, each rounded in three coordinates, lift its
// plane by e; along a ray of the picture that is up to e * sqrt(2), seen from the side by the sine of at most moved / distance.
double bound_rounding_px(const bound_capture *capture, double moved, const bound_optics *optics)
{
    const double away = capture->distance - moved;
    if (!(away > 0)) return INFINITY;
    const double lift = ROOT_2 * 3 * ROOT_3 * GUARD_FLOAT * capture->radius * (moved / capture->distance) / away;
    return bound_pixels(1.25 * 3 * GUARD_MATRIX + 1.25 * lift, optics) + 3 * SNAP_PX / ROOT_2;
}

double bound_sampling_px(bound_filter filter, double magnification)
{
    return filter == BOUND_NEAREST ? magnification / ROOT_2 : 0;
}

// ---- The parallelogram in the world ----

typedef struct seen {
    double height[BOUND_CORNERS], top[BOUND_CORNERS][3], point[BOUND_CORNERS], image[BOUND_CORNERS]; // h, N, v, w
} seen;

static inline control seen_mixed(const void *forms, int i, int j)
{
    const seen *f = forms;
    control out;
    for (int k = 0; k < 3; k++) out.top[k] = f->height[i] * f->top[j][k] + f->height[j] * f->top[i][k];
    // Both have to be in front of the eye: their product alone is positive behind it, too.
    out.below = f->point[i] > 0 && f->image[i] > 0 ? f->point[i] * f->image[j] + f->point[j] * f->image[i] : 0;
    return out;
}

static void seen_of(const bound_capture *capture, const bound_view *view, seen *out)
{
    double moved[3];
    bound_subtract(view->eye, capture->eye, moved);
    const double ahead = bound_dot(view->forward, moved);
    for (int i = 0; i < BOUND_CORNERS; i++) {
        const double *x = capture->offset[i], along = bound_dot(view->forward, x);
        for (int k = 0; k < 3; k++) out->top[i][k] = x[k] * ahead - moved[k] * along;
        out->height[i] = capture->height[i];
        out->point[i] = along - ahead;
        out->image[i] = capture->distance * along - capture->depth[i] * ahead;
    }
}

typedef struct turned {
    double height[BOUND_CORNERS], top[BOUND_CORNERS][3], point[BOUND_CORNERS][3], image[BOUND_CORNERS][3];
} turned;

static inline control turned_mixed(const void *forms, int i, int j)
{
    const turned *f = forms;
    control out;
    for (int k = 0; k < 3; k++) out.top[k] = f->height[i] * f->top[j][k] + f->height[j] * f->top[i][k];
    out.below = bound_dot(f->point[i], f->image[j]) + bound_dot(f->point[j], f->image[i]);
    return out;
}

static void turned_of(const bound_capture *capture, const double eye[3], turned *out)
{
    double moved[3];
    bound_subtract(eye, capture->eye, moved);
    for (int i = 0; i < BOUND_CORNERS; i++) {
        const double *x = capture->offset[i];
        bound_cross(x, moved, out->top[i]);
        out->height[i] = capture->height[i];
        bound_subtract(x, moved, out->point[i]);
        for (int k = 0; k < 3; k++) out->image[i][k] = capture->distance * x[k] - capture->depth[i] * moved[k];
    }
}

// Without rounding.
static double turned_px(const bound_capture *capture, const double eye[3], const bound_optics *optics)
{
    turned forms;
    turned_of(capture, eye, &forms);
    return bound_pixels(greatest_ratio(turned_mixed, &forms), optics);
}

static double distance_moved(const bound_capture *capture, const double eye[3])
{
    double moved[3];
    bound_subtract(eye, capture->eye, moved);
    return sqrt(bound_dot(moved, moved));
}

double bound_turned_px(const bound_capture *capture, const double eye[3], const bound_optics *optics)
{
    if (!(capture->nearest_depth > 0)) return INFINITY;
    return turned_px(capture, eye, optics) + bound_rounding_px(capture, distance_moved(capture, eye), optics);
}

double bound_on_plane(const bound_capture *capture, const double eye[3], const double axis[3])
{
    bound_view view = {.optics = {1, 1}};
    seen forms;
    if (!(capture->nearest_depth > 0)) return INFINITY;
    memcpy(view.eye, eye, sizeof view.eye);
    memcpy(view.forward, axis, sizeof view.forward);
    seen_of(capture, &view, &forms);
    return greatest_ratio(seen_mixed, &forms);
}

// Of a view, points outside of the picture count in the first form and not in the second: the smaller is a bound.
double bound_quad_px(const bound_capture *capture, const bound_view *view)
{
    if (!(capture->nearest_depth > 0) || !(view->optics.reach < INFINITY)) return INFINITY;
    seen forms;
    seen_of(capture, view, &forms);
    const double here = greatest_ratio(seen_mixed, &forms) * view->optics.pixels_per_tangent;
    return smallest(here, turned_px(capture, view->eye, &view->optics)) +
           bound_rounding_px(capture, distance_moved(capture, view->eye), &view->optics);
}

// ---- The eye anywhere near the capture eye ----

// For one point at distance X from the capture eye, its image at Q, the eye moved by m = (along, across) their ray:
//     tan(angle) = across |X - Q| / ((X - along) (Q - along) + across^2),
// over all |m| <= r largest at r |X - Q| / sqrt((X^2 - r^2) (Q^2 - r^2)). With |X - Q| = |h| s and Q = D s, s >= 1 the secant of
// the point's angle from the normal, that is at most r |h| / (sqrt(X^2 - r^2) sqrt(D^2 - r^2)), which falls with X and rises with
// |h|: over a patch, its least X and largest |h| bound it. All of it rises with r.
double bound_within_px(const bound_capture *capture, double distance, const bound_optics *optics)
{
    const double r2 = distance * distance, room = capture->distance * capture->distance - r2;
    double most = 0;
    if (!(capture->nearest_depth > 0) || !(room > 0)) return INFINITY;
    for (uint32_t i = 0; i < capture->patch_count; i++) {
        const bound_patch patch = capture->patches[i];
        const double left = patch.near * patch.near - r2;
        if (!(left > 0)) return INFINITY;
        most = largest(most, patch.height / sqrt(left * room));
    }
    return bound_pixels(most * distance * GROW, optics) + bound_rounding_px(capture, distance, optics);
}

// (X^2 - r^2) (D^2 - r^2) = (r h / t)^2 is quadratic in r^2; written with the sum below, so that nothing cancels. At most half of the
// distance: beyond it texels are magnified twice.
static double reach_at(const bound_capture *capture, double pixels, const bound_optics *optics)
{
    const double d2 = capture->distance * capture->distance;
    double least = d2 / 4;
    if (!(pixels > 0)) return 0;
    const double t = bound_tangent(pixels, optics) / GROW;
    for (uint32_t i = 0; i < capture->patch_count; i++) {
        const bound_patch patch = capture->patches[i];
        const double x2 = patch.near * patch.near, lever = patch.height / t, sum = x2 + d2 + lever * lever;
        const double square = sum * sum - 4 * x2 * d2;
        least = smallest(least, 2 * x2 * d2 / (sum + sqrt(largest(square, 0))));
    }
    return sqrt(least) / GROW;
}

// Rounding rises with r: the reach without what rises is farther than the one sought, so what is taken off for it is enough.
double bound_reach_of_eye(const bound_capture *capture, double tolerance_px, const bound_optics *optics)
{
    if (!(capture->nearest_depth > 0) || !(optics->reach < INFINITY)) return 0;
    const double far = reach_at(capture, tolerance_px - bound_rounding_px(capture, 0, optics), optics);
    return reach_at(capture, tolerance_px - bound_rounding_px(capture, far, optics), optics);
}

double bound_frames(double reach_of_eye, double step)
{
    return step > 0 ? 1 + floor(reach_of_eye / step) : INFINITY;
}

// ---- The other ways to show ----

// With y = p - c, z0 and z1 the centre's depths along the two views' axes a0, a1, and L(y) = z (right.y, up.y) - (right.c, up.c) (a.y)
// of each view, the shown place misses the true one by
//     (1 / z1) (L1(y) / (z1 + a1.y) - L0(y) / (z0 + a0.y)):
// the scale is z0 / z1, so that the picture keeps its size in the world. On a ray of the capture the second quotient stays and the
// first runs along a line: its distance from a fixed point is largest at an end, so here, too, only faces matter.
typedef struct aligned {
    double now[BOUND_CORNERS][2], before[BOUND_CORNERS][2], now_depth[BOUND_CORNERS], before_depth[BOUND_CORNERS];
} aligned;

static inline control aligned_mixed(const void *forms, int i, int j)
{
    const aligned *f = forms;
    control out = {{0, 0, 0}, 0};
    for (int k = 0; k < 2; k++) {
        out.top[k] = (f->now[i][k] * f->before_depth[j] - f->before[i][k] * f->now_depth[j]) +
                     (f->now[j][k] * f->before_depth[i] - f->before[j][k] * f->now_depth[i]);
    }
    if (f->now_depth[i] > 0 && f->before_depth[i] > 0)
        out.below = f->now_depth[i] * f->before_depth[j] + f->now_depth[j] * f->before_depth[i];
    return out;
}

// Returns the centre's depth.
static double aligned_of(const bound_capture *capture, const bound_view *view, double (*top)[2], double *below)
{
    double centre[3];
    bound_subtract(capture->centre, view->eye, centre);
    const double depth = bound_dot(view->forward, centre), x = bound_dot(view->right, centre), y = bound_dot(view->up, centre);
    for (int i = 0; i < BOUND_CORNERS; i++) {
        double from[3];
        for (int k = 0; k < 3; k++) from[k] = capture->offset[i][k] + capture->eye[k] - capture->centre[k];
        const double ahead = bound_dot(view->forward, from);
        top[i][0] = depth * bound_dot(view->right, from) - x * ahead;
        top[i][1] = depth * bound_dot(view->up, from) - y * ahead;
        below[i] = depth + ahead;
    }
    return depth;
}

double bound_centre_px(const bound_capture *capture, const bound_view *taken, const bound_view *view)
{
    aligned forms;
    if (!(taken->optics.reach < INFINITY) || !(view->optics.reach < INFINITY)) return INFINITY;
    const double before = aligned_of(capture, taken, forms.before, forms.before_depth);
    const double now = aligned_of(capture, view, forms.now, forms.now_depth);
    if (!(before > 0) || !(now > 0)) return INFINITY;
    // Here the parallelogram taken and the one shown are rounded apart: three numbers each, in three coordinates.
    const double rounded = 2 * 3 * ROOT_3 * GUARD_FLOAT * capture->radius / now;
    return greatest_ratio(aligned_mixed, &forms) / now * view->optics.pixels_per_tangent + bound_pixels(rounded, &view->optics) +
           bound_rounding_px(capture, 0, &view->optics);
}

// A depth wrong by d moves the point along its ray of the capture to depth n.x + d: the displacement above with h = d and that point
// for q, |N| d / (v (v (n.x) + d (a.x))) where v stays positive. One v is bounded apart; the rest is linear over quadratic.
typedef struct deep {
    double top[BOUND_CORNERS][3], point[BOUND_CORNERS], depth[BOUND_CORNERS], along[BOUND_CORNERS], step;
} deep;

static inline control deep_mixed(const void *forms, int i, int j)
{
    const deep *f = forms;
    control out;
    for (int k = 0; k < 3; k++) out.top[k] = f->top[i][k] + f->top[j][k];
    out.below = f->depth[i] * f->point[j] + f->depth[j] * f->point[i] - f->step * (f->along[i] + f->along[j]);
    return out;
}

static double deep_here(const bound_capture *capture, const bound_view *view, double error)
{
    seen all;
    deep forms = {.step = error};
    double least = INFINITY, least_along = INFINITY;
    seen_of(capture, view, &all);
    memcpy(forms.top, all.top, sizeof forms.top);
    memcpy(forms.point, all.point, sizeof forms.point);
    memcpy(forms.depth, capture->depth, sizeof forms.depth);
    for (int i = 0; i < BOUND_CORNERS; i++) {
        forms.along[i] = bound_dot(view->forward, capture->offset[i]);
        least = smallest(least, forms.point[i]);
        least_along = smallest(least_along, forms.along[i]);
    }
    if (!(least > 0) || !(least_along > 0)) return INFINITY;
    return greatest_ratio(deep_mixed, &forms) * error / least * view->optics.pixels_per_tangent;
}

// Whichever way the view looks: d s is how far the point moves along its ray, s the secant of the ray at the capture (largest at a
// corner: a convex function over a linear one). The sine of the angle at e is d s / |p - e| times the sine at the other end, which
// is at most |m| over the distance to there: e is no farther than |m| from the ray.
static double deep_turned(const bound_capture *capture, const bound_view *view, double error)
{
    double centre[3], low[3], high[3], secant = 1;
    bound_subtract(view->eye, capture->centre, centre);
    for (int k = 0; k < 3; k++) low[k] = -(high[k] = capture->half[k]);
    for (int i = 0; i < BOUND_CORNERS; i++)
        secant = largest(secant, sqrt(bound_dot(capture->offset[i], capture->offset[i])) / capture->depth[i]);
    const double away = distance_to(centre, low, high), slip = error * secant, rest = away - slip;
    if (!(rest > 0)) return INFINITY;
    const double sine = slip / away * smallest(1, distance_moved(capture, view->eye) / rest);
    return sine < 0.5 ? bound_pixels(sine / sqrt(1 - sine * sine), &view->optics) : INFINITY;
}

double bound_depth_px(const bound_capture *capture, const bound_view *view, double depth_step)
{
    if (!(capture->nearest_depth > 0) || !(view->optics.reach < INFINITY)) return INFINITY;
    const double error = depth_step / 2;
    return smallest(deep_here(capture, view, error), deep_turned(capture, view, error)) +
           bound_rounding_px(capture, distance_moved(capture, view->eye), &view->optics);
}
