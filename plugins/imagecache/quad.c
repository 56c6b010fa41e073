// quad.c: pictures' parallelograms: outline of the box from the eye, the smallest rectangle around it, texels that are never magnified.
// Sections 1.6 to 1.8 of the reference page.
// Invariant: a ray from the capture eye through any point of the box meets the parallelogram, a texel inside its border.
// SPDX-License-Identifier: MIT
#include "quad.h"

#include <string.h>

// A tilted rectangle is taken where it is this much smaller: texels upright in the world blur walls' edges less and change less
// from one capture to the next.
#define TILT_GAIN 0.9
#define FLOATS_PER_TEXEL 64.0         // roundings of a coordinate to a texel: padding, off by up to 3 * sqrt(3) of them, keeps nine tenths
#define GUARD_FLOAT (1.0 / 16777216) // 2^-24: one rounding to float

typedef struct frame {
    double right[3], up[3];
} frame;

typedef struct extent {
    double low[2], high[2];
} extent;

static void scaled(const double a[3], double by, double out[3])
{
    for (int k = 0; k < 3; k++) out[k] = a[k] * by;
}

static void unit(double a[3])
{
    scaled(a, 1 / sqrt(bound_dot(a, a)), a);
}

// Upright in the world; looking straight up or down, along x.
static frame upright_of(const double normal[3])
{
    const double up[3] = {0, 1, 0}, ahead[3] = {0, 0, -1};
    frame out;
    // Within 0.06 degrees of straight up or down, up gives no direction that rounding doesn't change.
    bound_cross(normal, fabs(normal[1]) < 0.9999995 ? up : ahead, out.right);
    unit(out.right);
    bound_cross(out.right, normal, out.up);
    return out;
}

static frame tilted(const frame *from, double cosine, double sine)
{
    frame out;
    for (int k = 0; k < 3; k++) {
        out.right[k] = cosine * from->right[k] + sine * from->up[k];
        out.up[k] = cosine * from->up[k] - sine * from->right[k];
    }
    return out;
}

// Left of a-b, twice the triangle's area.
static double turn(const double a[2], const double b[2], const double c[2])
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

// Andrew's monotone chain (1979). Counterclockwise; returns how many stay.
static uint32_t hull_of(double points[BOUND_CORNERS][2], double out[BOUND_CORNERS][2])
{
    double sorted[BOUND_CORNERS][2], chain[2 * BOUND_CORNERS][2];
    for (int i = 0; i < BOUND_CORNERS; i++) {
        int at = i;
        for (; at > 0 && (sorted[at - 1][0] > points[i][0] || (sorted[at - 1][0] == points[i][0] && sorted[at - 1][1] > points[i][1])); at--)
            memcpy(sorted[at], sorted[at - 1], sizeof sorted[at]);
        memcpy(sorted[at], points[i], sizeof sorted[at]);
    }
    uint32_t count = 0;
    for (int i = 0; i < BOUND_CORNERS; i++) {
        while (count >= 2 && !(turn(chain[count - 2], chain[count - 1], sorted[i]) > 0)) count--;
        memcpy(chain[count++], sorted[i], sizeof sorted[i]);
    }
    const uint32_t lower = count + 1;
    for (int i = BOUND_CORNERS - 2; i >= 0; i--) {
        while (count >= lower && !(turn(chain[count - 2], chain[count - 1], sorted[i]) > 0)) count--;
        memcpy(chain[count++], sorted[i], sizeof sorted[i]);
    }
    count = count > 1 ? count - 1 : count; // the first stands at the end once more
    if (count > BOUND_CORNERS) count = BOUND_CORNERS;
    memcpy(out, chain, count * sizeof chain[0]);
    return count;
}

static extent extent_of(double (*points)[2], uint32_t count, double cosine, double sine)
{
    extent out = {{INFINITY, INFINITY}, {-INFINITY, -INFINITY}};
    for (uint32_t i = 0; i < count; i++) {
        const double at[2] = {cosine * points[i][0] + sine * points[i][1], cosine * points[i][1] - sine * points[i][0]};
        for (int k = 0; k < 2; k++) {
            if (at[k] < out.low[k]) out.low[k] = at[k];
            if (at[k] > out.high[k]) out.high[k] = at[k];
        }
    }
    return out;
}

static double area_of(const extent *e)
{
    return (e->high[0] - e->low[0]) * (e->high[1] - e->low[1]);
}

// The smallest rectangle around a convex outline has a side along one of its edges (Freeman and Shapira 1975). Tried in order, so
// that the same outline gives the same rectangle.
static void fit(quad *outline, double turned[2])
{
    const extent plain = extent_of(outline->outline, outline->outline_count, 1, 0);
    double least = area_of(&plain) * TILT_GAIN;
    turned[0] = 1;
    turned[1] = 0;
    for (uint32_t i = 0; i < outline->outline_count; i++) {
        const double *a = outline->outline[i], *b = outline->outline[(i + 1) % outline->outline_count];
        double along[2] = {b[0] - a[0], b[1] - a[1]};
        const double length = sqrt(along[0] * along[0] + along[1] * along[1]);
        if (!(length > 0)) continue;
        // Quarter turns are the same rectangle: the one nearest to upright is meant.
        double cosine = along[0] / length, sine = along[1] / length;
        if (fabs(sine) > fabs(cosine)) {
            const double swap = cosine;
            cosine = sine;
            sine = -swap;
        }
        if (cosine < 0) {
            cosine = -cosine;
            sine = -sine;
        }
        const extent tried = extent_of(outline->outline, outline->outline_count, cosine, sine);
        if (!(area_of(&tried) < least)) continue;
        least = area_of(&tried);
        turned[0] = cosine;
        turned[1] = sine;
    }
}

static double away_from(const quad_request *request)
{
    const double low[3] = {request->box.min.x, request->box.min.y, request->box.min.z};
    const double high[3] = {request->box.max.x, request->box.max.y, request->box.max.z};
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        const double under = low[k] - request->eye[k], over = request->eye[k] - high[k], away = under > over ? under : over;
        if (away > 0) sum += away * away;
    }
    return sqrt(sum);
}

static double coordinates_of(const quad_request *request)
{
    const double all[9] = {request->box.min.x, request->box.min.y, request->box.min.z, request->box.max.x, request->box.max.y,
                           request->box.max.z, request->eye[0],    request->eye[1],    request->eye[2]};
    double most = 0;
    for (int i = 0; i < 9; i++) most = fabs(all[i]) > most ? fabs(all[i]) : most;
    return most;
}

// The box's corners along rays from the eye onto the plane, in metres from the centre. The hull of them is the box's outline exactly: a
// projection keeps hulls.
static quad_result outline_of(const quad_request *request, const frame *axes, quad *to)
{
    const bound_capture seen = bound_capture_of(request->eye, &request->box);
    double points[BOUND_CORNERS][2];
    for (int i = 0; i < BOUND_CORNERS; i++) {
        const double depth = bound_dot(to->normal, seen.offset[i]);
        double from_centre[3];
        if (!(depth > 0)) return QUAD_TOO_WIDE;
        for (int k = 0; k < 3; k++) from_centre[k] = seen.offset[i][k] * (to->distance / depth) + (request->eye[k] - seen.centre[k]);
        points[i][0] = bound_dot(axes->right, from_centre);
        points[i][1] = bound_dot(axes->up, from_centre);
        const double far = points[i][0] * points[i][0] + points[i][1] * points[i][1];
        if (!(far <= QUAD_WIDEST * QUAD_WIDEST * to->distance * to->distance)) return QUAD_TOO_WIDE;
    }
    to->outline_count = hull_of(points, to->outline);
    return QUAD_OK;
}

// A segment of the plane is seen from at least distance - room off its line: its tangent is at most bound_segment, 2 x / (1 - x^2) of
// x = length / (2 distance), solved for the length that gives `magnification` pixels at the worst place.
static double texel_of(const quad_request *request, double distance)
{
    const bound_optics optics = {request->optics.pixels_per_tangent, request->place == QUAD_PLACE_ANY ? request->optics.reach : 1};
    const double t = bound_tangent(request->magnification, &optics);
    return 2 * (distance - request->room) * t / (1 + sqrt(1 + t * t));
}

static cull_vec3 floats_of(const double a[3])
{
    const cull_vec3 out = {(float)a[0], (float)a[1], (float)a[2]};
    return out;
}

static quad_result lay(const quad_request *request, const frame *axes, extent around, quad *to)
{
    const double texel = texel_of(request, to->distance), *sides[2] = {axes->right, axes->up};
    double corner[3], along[2][3];
    uint32_t count[2];
    if (!(texel >= FLOATS_PER_TEXEL * GUARD_FLOAT * coordinates_of(request))) return QUAD_TOO_FINE;
    memcpy(corner, to->centre, sizeof corner);
    for (int k = 0; k < 2; k++) {
        // A flat box seen from its edge still has a texel.
        const double wide = around.high[k] - around.low[k], length = wide > texel ? wide : texel;
        const double inside = ceil(length / texel);
        if (!(inside + 2 <= (double)request->most_texels)) return QUAD_TOO_LARGE;
        count[k] = (uint32_t)inside + 2;
        to->texel[k] = length / inside;
        scaled(sides[k], to->texel[k] * count[k], along[k]);
        const double start = around.low[k] - (length - wide) / 2 - to->texel[k];
        for (int c = 0; c < 3; c++) corner[c] += sides[k][c] * start;
    }
    to->corner = floats_of(corner);
    to->right = floats_of(along[0]);
    to->up = floats_of(along[1]);
    to->width_px = count[0];
    to->height_px = count[1];
    return QUAD_OK;
}

static quad_result starts(const quad_request *request)
{
    const double away = away_from(request);
    if (!(away > 0)) return QUAD_EYE_INSIDE;
    return away > request->near_distance && away > request->room ? QUAD_OK : QUAD_TOO_NEAR;
}

quad_result quad_of(const quad_request *request, quad *out)
{
    quad made = {.reserved = 0};
    double turned[2];
    quad_result result = starts(request);
    if (result != QUAD_OK) return result;
    const bound_capture capture = bound_capture_of(request->eye, &request->box);
    memcpy(made.centre, capture.centre, sizeof made.centre);
    memcpy(made.normal, capture.normal, sizeof made.normal);
    made.distance = capture.distance;
    frame axes = upright_of(made.normal);
    result = outline_of(request, &axes, &made);
    if (result != QUAD_OK) return result;
    fit(&made, turned);
    axes = tilted(&axes, turned[0], turned[1]);
    const extent around = extent_of(made.outline, made.outline_count, turned[0], turned[1]);
    result = lay(request, &axes, around, &made);
    for (uint32_t i = 0; i < made.outline_count; i++) {
        const double x = made.outline[i][0], y = made.outline[i][1];
        made.outline[i][0] = turned[0] * x + turned[1] * y;
        made.outline[i][1] = turned[0] * y - turned[1] * x;
    }
    if (result == QUAD_OK) *out = made;
    return result;
}

quad_result quad_aligned_of(const quad_request *request, const bound_view *taken, quad *out)
{
    quad made = {.reserved = 0};
    frame axes;
    double from_eye[3];
    quad_result result = starts(request);
    if (result != QUAD_OK) return result;
    const bound_capture capture = bound_capture_of(request->eye, &request->box);
    bound_subtract(capture.centre, request->eye, from_eye);
    memcpy(made.centre, capture.centre, sizeof made.centre);
    memcpy(made.normal, taken->forward, sizeof made.normal);
    memcpy(axes.right, taken->right, sizeof axes.right);
    memcpy(axes.up, taken->up, sizeof axes.up);
    made.distance = bound_dot(made.normal, from_eye);
    if (!(made.distance > request->room)) return QUAD_TOO_NEAR;
    result = outline_of(request, &axes, &made);
    if (result != QUAD_OK) return result;
    result = lay(request, &axes, extent_of(made.outline, made.outline_count, 1, 0), &made);
    if (result == QUAD_OK) *out = made;
    return result;
}

// The picture keeps its size in the world: on the screen it is scaled by the ratio of the centre's depths.
quad quad_aligned_shown(const quad *taken, const bound_view *view)
{
    quad out = *taken;
    const double width = taken->texel[0] * taken->width_px, height = taken->texel[1] * taken->height_px;
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY}, corner[3], along[3], from_eye[3];
    for (uint32_t i = 0; i < taken->outline_count; i++) {
        for (int k = 0; k < 2; k++) {
            low[k] = taken->outline[i][k] < low[k] ? taken->outline[i][k] : low[k];
            high[k] = taken->outline[i][k] > high[k] ? taken->outline[i][k] : high[k];
        }
    }
    // As lay() placed it: padded evenly on both sides.
    const double left = (low[0] + high[0] - width) / 2, below = (low[1] + high[1] - height) / 2;
    for (int k = 0; k < 3; k++) corner[k] = taken->centre[k] + left * view->right[k] + below * view->up[k];
    out.corner = floats_of(corner);
    scaled(view->right, width, along);
    out.right = floats_of(along);
    scaled(view->up, height, along);
    out.up = floats_of(along);
    memcpy(out.normal, view->forward, sizeof out.normal);
    bound_subtract(taken->centre, view->eye, from_eye);
    out.distance = bound_dot(view->forward, from_eye);
    return out;
}

double quad_magnification(const quad *shown, const double eye[3], const bound_optics *optics)
{
    double from_eye[3];
    bound_subtract(shown->centre, eye, from_eye);
    const double distance = bound_dot(shown->normal, from_eye), side = shown->texel[0] > shown->texel[1] ? shown->texel[0] : shown->texel[1];
    return distance > 0 ? bound_pixels(bound_segment(side, distance), optics) : INFINITY;
}

// WHY. On a surface with normal s that crosses the seam, both sides' clip planes, moved out by d, leave a strip between the two
// borders 2 d / sin(w) wide, w the angle between surface and seam. Let l be the border's direction, r a unit line of sight to it, at
// most `distance` long: the far border's distance from the plane of sight through the near one is
// 2 d |(l x s) . (l x r)| / (sin(w) |l x r|) = 2 d |s.r| / (sin(w) |l x r|) >= 2 d |s.r|,
// and in the picture at least pixels_per_tangent / distance as many pixels, more off the axis. A picture's border is shown at most error_px
// off, and its last texel may be missing: no gap opens while 2 d sine >= error_px distance / f + texel. Where surfaces are seen
// at 30 degrees and steeper that is less than the page's rule, error_px distance / f + texel, which is then kept.
double quad_seam_delta(const quad_seam *seam)
{
    const double wanted = seam->error_px * seam->distance / seam->pixels_per_tangent + seam->texel;
    return seam->sine < 0.5 ? wanted / (2 * seam->sine) : wanted;
}
