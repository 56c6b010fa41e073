// compose.c: the error of a picture composed from others: frozen slip in its plane, plus its own. Proof in compose.h.
// Section 1.9 of the reference page.
// Invariant: every term is the largest that it can be, apart from the others.
// SPDX-License-Identifier: MIT
#include "compose.h"

#define GUARD_MATRIX (1.0 / 1048576) // 2^-20 of the distance: float matrices, of the taking and of the composing

// Pictures reach at most a tangent of 1 from their middle (QUAD_WIDEST), so there the secant is at most the root of 2.
static const bound_optics plane = {1, 1.4142135623730951};

static double plane_distance(const bound_capture *capture, const double eye[3])
{
    double from_eye[3];
    bound_subtract(capture->centre, eye, from_eye);
    return bound_dot(capture->normal, from_eye);
}

// Tangents in the parent's plane of a segment in the child's.
static double segment_tangent(const compose_child *child, const double eye[3], double length)
{
    const double distance = plane_distance(child->capture, eye);
    return distance > 0 ? bound_pixels(bound_segment(length, distance), &plane) : INFINITY;
}

double compose_slip(const bound_capture *parent, const compose_child *child)
{
    const double shown = bound_on_plane(child->capture, parent->eye, parent->normal);
    const double before = segment_tangent(child, parent->eye, child->slip);
    const double read = segment_tangent(child, parent->eye, bound_sampling_px(child->filter, child->texel));
    const double rounded = bound_pixels(2 * GUARD_MATRIX, &plane);
    return parent->distance * (shown + before + read + rounded);
}

static double slip_px(double slip, double distance, const bound_optics *optics)
{
    return distance > 0 ? bound_pixels(bound_segment(slip, distance), optics) : INFINITY;
}

static bound_optics widened(const bound_optics *optics, double pixels)
{
    const double corner = sqrt(optics->reach * optics->reach - 1) + pixels / optics->pixels_per_tangent;
    const bound_optics out = {optics->pixels_per_tangent, sqrt(1 + corner * corner)};
    return out;
}

// One of the two ends of the true displacement is inside the picture, the place of p or of S; P may be outside of it. Where S is
// inside, P is by the frozen part farther out, so the own part is asked about a picture that reaches so much farther. Where p
// is inside, P is by the own part farther out, and so the frozen part is asked.
static double sum_px(const bound_capture *parent, double slip, const bound_view *view, double own(const bound_capture *, const bound_view *))
{
    const double distance = plane_distance(parent, view->eye), frozen = slip_px(slip, distance, &view->optics);
    if (!(frozen < INFINITY)) return INFINITY;
    bound_view wide = *view;
    wide.optics = widened(&view->optics, frozen);
    const double moved = own(parent, &wide);
    wide.optics = widened(&view->optics, moved);
    return moved < INFINITY ? moved + slip_px(slip, distance, &wide.optics) : INFINITY;
}

static double turned_px(const bound_capture *parent, const bound_view *view)
{
    return bound_turned_px(parent, view->eye, &view->optics);
}

double compose_turned_px(const bound_capture *parent, double slip, const double eye[3], const bound_optics *optics)
{
    const bound_view view = {.eye = {eye[0], eye[1], eye[2]}, .optics = *optics};
    return sum_px(parent, slip, &view, turned_px);
}

double compose_quad_px(const bound_capture *parent, double slip, const bound_view *view)
{
    return sum_px(parent, slip, view, bound_quad_px);
}

// The frozen part rises with the way moved: it is taken at the most that the way may become, where there is no slip.
double compose_reach_of_eye(const bound_capture *parent, double slip, double tolerance_px, const bound_optics *optics)
{
    const double most = bound_reach_of_eye(parent, tolerance_px, optics), distance = parent->distance - most;
    const bound_optics own = widened(optics, slip_px(slip, distance, optics)), frozen = widened(optics, tolerance_px);
    const double rest = tolerance_px - slip_px(slip, distance, &frozen);
    if (!(rest > 0) || !(own.reach < INFINITY)) return 0;
    const double reach = bound_reach_of_eye(parent, rest, &own);
    return reach < most ? reach : most;
}
