// bound.h: how far a cached picture may show a point from its place, in pixels of the current view, as a proved upper bound
// (section 1.10 of the reference page; Shade et al. 1996 and Schaufler 1996 test angles at 8 corners, which is no bound).
// Invariant: no point of the node's box is displaced by more than is said here; what cannot be bounded is INFINITY.
// SPDX-License-Identifier: MIT
//
// A picture is taken from the capture eye and stands in the plane through the node's centre, perpendicular to the line of
// sight to it (quad.h). "Displaced" is the distance in pixels between where a point of the box belongs and where its picture
// is shown, for every point of which one of the two places lies inside the picture of the view.
#ifndef PORTCULLIS_IMAGECACHE_BOUND_H
#define PORTCULLIS_IMAGECACHE_BOUND_H

#include <portcullis/culler.h>

#include <math.h>

enum { BOUND_CORNERS = 8, BOUND_PATCHES = 24 };

// What of a view its rotation doesn't change.
typedef struct bound_optics {
    double pixels_per_tangent; // f
    double reach;              // secant of the widest angle from the view's axis that the picture holds
} bound_optics;

typedef struct bound_view {
    double eye[3], right[3], up[3], forward[3]; // relative to the zone's origin; unit vectors at right angles
    bound_optics optics;
} bound_view;

// A quarter of a face of the box, in metres.
typedef struct bound_patch {
    double near, height; // least distance from the capture eye; largest distance from the picture's plane
} bound_patch;

// A node's box as seen from the capture eye, prepared once a capture.
typedef struct bound_capture {
    double eye[3], centre[3], half[3], normal[3]; // normal: unit, from the eye to the centre
    double distance;                              // of the centre
    double radius;                                // largest absolute coordinate of the box, the eye and the picture: floats round by it
    double offset[BOUND_CORNERS][3];              // of corner i (bit k: the far end on axis k) from the eye
    double depth[BOUND_CORNERS], height[BOUND_CORNERS]; // along the normal: from the eye; above the picture's plane
    double nearest_depth;                         // the least of depth; not positive: no picture of it can be shown
    bound_patch patches[BOUND_PATCHES]; // those that decide how far the eye may go
    uint32_t patch_count, reserved;
} bound_capture;

// How the picture's texels are read where it is shown.
typedef enum bound_filter {
    BOUND_TEXEL_CENTRES, // where the texels' centres come to stand: nothing is added. Bilinear reading blurs, it moves no centre
    BOUND_NEAREST,       // a pixel shows the nearest texel: up to half its diagonal away
} bound_filter;

static inline double bound_dot(const double a[3], const double b[3])
{
    return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
}

static inline void bound_subtract(const double a[3], const double b[3], double out[3])
{
    for (int k = 0; k < 3; k++) out[k] = a[k] - b[k];
}

static inline void bound_cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

// The view in doubles. A view from infinitely far has optics of reach INFINITY: every bound for it is INFINITY.
bound_view bound_view_of(const cull_view *view);

// box: of all that the picture shows, as enlarged for its seams. eye outside of it, else all bounds are INFINITY.
bound_capture bound_capture_of(const double eye[3], const cull_box *box);

// ---- What is shown as a parallelogram in the world, exact under rotation (quad_of) ----

double bound_quad_px(const bound_capture *capture, const bound_view *view);
// The same whichever way the view looks.
double bound_turned_px(const bound_capture *capture, const double eye[3], const bound_optics *optics);
// For every eye within `distance` metres of the capture eye and every way to look. Never falls when the distance grows.
double bound_within_px(const bound_capture *capture, double distance, const bound_optics *optics);
// Its inverse: how far the eye may go from the capture eye while no point is displaced by more than tolerance_px, rounding
// included. 0: not at all. A frame's check of a valid picture is one compare with it.
double bound_reach_of_eye(const bound_capture *capture, double tolerance_px, const bound_optics *optics);
// How many frames a picture taken now stays valid at `step` metres a frame in one direction; at least 1: the frame it is taken in.
double bound_frames(double reach_of_eye, double step);

// ---- The other ways to show ----

// Centre alignment (section 1.7): taken by `taken`, whose eye is the capture's, shown by `view`; all rotation is in it.
double bound_centre_px(const bound_capture *capture, const bound_view *taken, const bound_view *view);
// Depth kept and re-projected: what a step of depth (metres along the capture's normal, rounded to nearest) leaves.
double bound_depth_px(const bound_capture *capture, const bound_view *view, double depth_step);

// ---- Terms that are added, each for its reason ----

// Floats: of the parallelogram, of the matrices that draw it and the geometry, and the rasterizer's own grid. In all bounds above.
// moved: metres from the capture eye.
double bound_rounding_px(const bound_capture *capture, double moved, const bound_optics *optics);
// Texels: magnification is the largest side of a texel in pixels. In no bound above: it depends on the renderer's filter.
double bound_sampling_px(bound_filter filter, double magnification);

// ---- Parts that other files build on ----

// The largest displacement in pixels where the angle between the two directions has this tangent, and its inverse.
double bound_pixels(double tangent, const bound_optics *optics);
double bound_tangent(double pixels, const bound_optics *optics);
// The tangent of the angle under which a segment is seen at most, from this far off its line; INFINITY from a right angle on.
double bound_segment(double length, double distance);
// As bound_quad_px in tangents of a view with this axis, whose picture has no end; no rounding.
double bound_on_plane(const bound_capture *capture, const double eye[3], const double axis[3]);

#endif
