// quad.h: the parallelogram that a node's picture is taken on and shown as, the report's centre alignment beside it, and how
// far clip planes move out at seams (sections 1.6 to 1.8 of the reference page; Schaufler and Stuerzlinger 1996).
// Invariant: it covers the exact outline of the node's box as seen from the capture eye, and a texel more on each side.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_IMAGECACHE_QUAD_H
#define PORTCULLIS_IMAGECACHE_QUAD_H

#include "bound.h"

// Tangent of the widest angle from the centre's line that an outline may reach: 45 degrees. There a texel is already seen at
// half of its size, and a box that wide has its eye within about its own size, where pictures are never worth it.
#define QUAD_WIDEST 1.0

typedef enum quad_result {
    QUAD_OK,
    QUAD_EYE_INSIDE, // of the box
    QUAD_TOO_NEAR,   // the near plane would cut it, or it is left with no room to move in
    QUAD_TOO_WIDE,   // see QUAD_WIDEST
    QUAD_TOO_LARGE,  // more texels a side than asked for
    QUAD_TOO_FINE,   // texels that floats so far from the zone's origin don't resolve
} quad_result;

// Where in the view's picture a texel is to be no larger than promised.
typedef enum quad_place {
    QUAD_PLACE_ANY,    // everywhere, whichever way the view turns: reach^2 finer, pixels stretch towards the corners
    QUAD_PLACE_MIDDLE, // where the view looks straight at it
} quad_place;

typedef struct quad_request {
    double eye[3]; // capture eye
    cull_box box;  // of all that the picture shows, enlarged for seams
    bound_optics optics;
    double room;          // metres that the eye may go from the capture eye
    double near_distance; // metres: nothing nearer is drawn in a capture
    double magnification; // the largest side of a texel in pixels: 1, or less to oversample
    quad_place place;
    uint32_t most_texels; // a side
} quad_request;

typedef struct quad {
    cull_vec3 corner, right, up;     // as cull_capture has them: along and up over the whole picture
    uint32_t width_px, height_px;    // in texels, padding included
    double centre[3], normal[3];     // of the plane; unit, away from the eye
    double distance;                 // of the plane from the capture eye
    double texel[2];                 // metres, along right and up
    double outline[BOUND_CORNERS][2]; // the exact hull of the box's outline, in metres from the centre along right and up
    uint32_t outline_count, reserved;
} quad;

// Perpendicular to the line from the eye to the box's centre, through the centre. *out is untouched where it is refused.
quad_result quad_of(const quad_request *request, quad *out);

// Centre alignment: parallel to the taking view's picture, through the centre. request->eye is the view's.
quad_result quad_aligned_of(const quad_request *request, const bound_view *taken, quad *out);
// What to show of it in another view: re-placed by its centre, scaled by distance, sides along the view's. What the view turned by is
// lost: bound_centre_px says by how much.
quad quad_aligned_shown(const quad *taken, const bound_view *view);

// The largest side of a texel in pixels, from this eye whichever way it looks. INFINITY from behind.
double quad_magnification(const quad *shown, const double eye[3], const bound_optics *optics);

// ---- Seams ----

typedef struct quad_seam {
    double error_px;           // of the pictures on both sides together; geometry has none
    double distance;           // metres: the farthest point of the seam from the eye, wherever the pictures are valid
    double pixels_per_tangent; // at the middle of the picture, where pixels are largest
    double texel;              // metres, the larger picture's
    double sine;               // the least between the line of sight and a surface that crosses the seam, over 0 up to 1
} quad_seam;

// Metres that both sides' clip planes have to move out.
double quad_seam_delta(const quad_seam *seam);

#endif
