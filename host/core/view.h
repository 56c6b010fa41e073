// Cameras, and what a culler is told of them: view and volume, derived in double, moved out by the guard band.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_VIEW_H
#define PORTCULLIS_HOST_VIEW_H

#include <portcullis/culler.h>
#include <portcullis/plane.h>

// World coordinates, metres. forward and up need not be normal or perpendicular.
typedef struct camera {
    double eye[3], forward[3], up[3];
    double fovy_deg, aspect; // width / height of the image plane
    double near_m, far_m;    // far_m may be INFINITY
} camera;

// NULL when the camera is usable, else what is wrong with it, a constant text.
const char *camera_fault(const camera *c);
// Orthonormal: right, up, back (the eye looks along -back). The camera must be usable.
void camera_axes(const camera *c, double right[3], double up[3], double back[3]);
// Column major; p relative to the eye, in world axes; reversed z: 1 at near_m, 0 at far_m. The same bits everywhere.
void camera_clip_from_eye(const camera *c, double out[16]);

typedef struct view_frame {
    uint32_t width_px, height_px;
    uint32_t frame; // rises with each frame of a view
    uint32_t flags;
    cull_purpose purpose;
} view_frame;

enum { VIEW_SIDES_MOST = 5 }; // left, bottom, right, top of the picture, and the far plane while far_m is finite

typedef struct view_volume {
    cull_plane planes[VIEW_SIDES_MOST];
    uint32_t sides[VIEW_SIDES_MOST]; // of the base: which one each plane is
    uint32_t plane_count;
} view_volume;

// What is the same for all zones that a camera sees, computed once a frame.
typedef struct view_base {
    const camera *camera; // as long as the base
    view_frame frame;
    double right[3], up[3], back[3];
    double tall, wide;            // half the picture at distance 1
    double pixel_tangent, reach;  // as in cull_view
    double clip_from_eye[16];
    cull_guarded sides[VIEW_SIDES_MOST]; // guarded: in each zone they have the same normal, bit for bit
    uint32_t side_count;
} view_base;
void view_base_make(const camera *c, const view_frame *f, view_base *out);
typedef struct view_place { double origin[3]; cull_box box; float radius; } view_place; // a zone, as a view sees it
void view_eye_in_zone(const view_base *b, const view_place *z, double out[3]); // relative to the zone's origin
void view_in_zone(const view_base *b, const view_place *z, cull_view *out);
void view_volume_in_zone(const view_base *b, const view_place *z, view_volume *out); // the whole frustum, as in view_derive

double view_plane_height(const cull_plane *plane, const cull_box *box); // of the box's least corner: 0 or more, and all of it is inside

// The camera seen from a zone: view, and the whole frustum as a guarded volume. Planes that the zone's box lies inside
// of are left out. The far plane is one of them while far_m is finite.
void view_derive(const camera *c, const view_frame *f, const double zone_origin[3], const cull_box *zone_box, cull_view *view,
                 view_volume *volume);

#endif
