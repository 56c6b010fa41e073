// How coarse a picture's items may be: level of detail by what it adds to the picture's error (Funkhouser, Sequin, "Adaptive display algorithm for
// interactive frame rates", 1993: benefit against cost), here as captures a frame.
// SPDX-License-Identifier: MIT
//
// A picture that is off by e px from the start lives (tolerance - e) / tolerance of its life. So a level pays where it saves a larger share of the capture.
// Invariant: a level's points stand at most away_m from their places, so seen from the eye at most detail_px; who shows the picture adds it.
#ifndef PORTCULLIS_IMAGECACHE_DETAIL_H
#define PORTCULLIS_IMAGECACHE_DETAIL_H

#include "bound.h"

typedef struct detail_request {
    const cull_costs *costs;
    const bound_optics *optics;
    const double *eye; // 3, that the picture is first shown to
    const cull_box *box;
    double tolerance_px;
    uint32_t polygon_count, reserved;
} detail_request;

typedef struct detail_choice {
    float away_m; // cull_capture.detail_m; 0: every polygon
    uint32_t reserved;
    double polygons; // that are left, as foretold
} detail_choice;

detail_choice detail_choose(const detail_request *q);
// Of points of the box that stand so far from their places, whichever way the eye looks. INFINITY: it is too near.
double detail_px(double away_m, const double eye[3], const cull_box *box, const bound_optics *optics);
cull_box detail_box(const cull_box *box, double away_m); // of what is drawn

#endif
