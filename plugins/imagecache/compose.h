// compose.h: the error of a picture that was composed from other pictures, as a quadtree's parent is from its children
// (section 1.9 of the reference page: errors add). Invariant: what is said holds for every point of every child's box.
// SPDX-License-Identifier: MIT
//
// PROOF. Let the parent's picture be taken from e1, and a point p of a child's box have been shown there, by the child's picture,
// as if it stood in another direction. On the parent's plane let P be where p belongs, S where it came to stand: |P - S| is at
// most the child's displacement seen from e1 on that very plane, its `slip`. It is frozen: nothing of the child is read again.
// Seen later from e, the shown place of p is place(S), so
//     |place(p) - place(S)| <= |place(p) - place(P)| + |place(P) - place(S)|:
// the parent's own displacement, as if it had been taken from geometry, and a segment in its plane no longer than the slip, no
// nearer than the plane. err(parent) <= err(child at composition) + parent's own. A child that was itself composed has its
// own slip in its plane, a segment again: the sum goes on upwards, level by level.
#ifndef PORTCULLIS_IMAGECACHE_COMPOSE_H
#define PORTCULLIS_IMAGECACHE_COMPOSE_H

#include "bound.h"

// A picture that a parent is composed of.
typedef struct compose_child {
    const bound_capture *capture; // of its own taking
    double slip;                  // metres in its own plane; 0: taken from geometry
    double texel;                 // metres, the larger side
    bound_filter filter;          // how the composition reads it
} compose_child;

// Metres in the parent's plane; the parent's slip is the largest of its children's. INFINITY: compose it not, render it.
double compose_slip(const bound_capture *parent, const compose_child *child);

// As bound_turned_px, bound_quad_px and bound_reach_of_eye of a picture with that slip.
double compose_turned_px(const bound_capture *parent, double slip, const double eye[3], const bound_optics *optics);
double compose_quad_px(const bound_capture *parent, double slip, const bound_view *view);
double compose_reach_of_eye(const bound_capture *parent, double slip, double tolerance_px, const bound_optics *optics);

#endif
