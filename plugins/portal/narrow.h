// What is left of a portal inside a volume, and the volume behind it: shared by the ways of narrowing.
// SPDX-License-Identifier: MIT
// Invariant: everything is relative to the eye, in double; the planes written are guarded (plane.h) and lose no point that the
// portal's polygon and the volume let through.
#ifndef PORTCULLIS_PORTAL_NARROW_H
#define PORTCULLIS_PORTAL_NARROW_H

#include <portcullis/clip.h>
#include <portcullis/culler.h>
#include <portcullis/plane.h>

// A clip against each plane of a volume adds at most one corner; twice, as rounding may bend a loop.
enum { NARROW_CORNERS = 64, NARROW_ROOM = 2 * (NARROW_CORNERS + CULL_MAX_PLANES) };

typedef struct narrowing {
    cull_guard guard;
    const cull_view *view;
    const cull_volume *in;
    const cull_portal *portal;
    cull_point corners[NARROW_CORNERS]; // of the portal
    cull_point points[2][NARROW_ROOM];  // clipped
    const cull_point *polygon;          // what is left: corners, or one of points
    uint32_t count;                     // of polygon; NARROW_ROOM: it grew too large to be trusted
    cull_cut cuts[CULL_MAX_PLANES];     // the volume's planes, relative to the eye
    uint8_t has_cut[CULL_MAX_PLANES];   // 1: that plane cut the polygon
    cull_plane *planes;                 // the volume behind
    uint32_t plane_count;
} narrowing;

typedef enum narrow_verdict { NARROW_GONE, NARROW_WHOLE, NARROW_CLIPPED } narrow_verdict;
typedef enum narrow_choice { NARROW_CUT, NARROW_UNCUT } narrow_choice; // UNCUT: only looks whether all lies outside one plane
// Takes view, in, portal, planes and guard.radius. GONE: nothing is left. WHOLE: the eye is at the portal, or the view has no eye: pass what came, unclipped.
narrow_verdict narrow_start(narrowing *n, narrow_choice choice);

// The portal's edges that border what is left, the volume's planes that cut it, and the portal's own plane. 0: more planes
// than a volume holds; some are written then.
int narrow_exact(narrowing *n);
// The smallest polygon of `sides` sides in fixed directions of the picture (4: its rectangle, 8: octagon) around what is left.
// 0: what is left reaches beside the eye, where it has no place on the picture.
int narrow_window(narrowing *n, uint32_t sides);
// The volume's planes and the portal's edges, all of them, without clipping. 0: as in narrow_exact.
int narrow_planes(narrowing *n);

#endif
