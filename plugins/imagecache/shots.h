// Pictures of quadtree nodes: what each slot holds, whether it may be shown from where the eye is, and what to take anew.
// SPDX-License-Identifier: MIT
//
// Invariant: no picture is shown of which any point may sit more than the tolerance from its place (bound.h).
#ifndef PORTCULLIS_IMAGECACHE_SHOTS_H
#define PORTCULLIS_IMAGECACHE_SHOTS_H

#include "bound.h"
#include "cut.h"

// The picture of a node; its slot is the node's number.
typedef struct shot {
    double eye[3];     // that it was taken from
    cull_box box;      // of all that it shows
    float pixels_per_tangent; // that its texels were made for
    uint32_t keep_depth;
} shot;

typedef struct shots_request {
    const cull_visit *visit;
    const cut_request *view;
    const cut *cut;
    uint32_t keep_depth;
} shots_request;

// A query's memory of them.
typedef struct shots {
    const cells *cells;
    const lists *lists;
    shot *all; // by node
    uint32_t shown_count, taken_count; // this frame
    double error_px;                   // the largest shown
    size_t bytes;
} shots;

int shots_open(const cull_host *host, const cells *c, const lists *l, shots *out); // 0: no memory
void shots_close(const cull_host *host, shots *s);
// Pictures and captures of the nodes that are taken, near first, into the batch. 0: of one of them no picture can
// be taken (as near as it is, or so far from the zone's origin), and none is shown.
int shots_show(shots *s, const shots_request *q, cull_batch *batch);

#endif
