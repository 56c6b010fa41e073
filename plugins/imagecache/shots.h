// Pictures of quadtree nodes: what each slot holds, whether it may be shown from where the eye is, and what to take anew: what has to be, and where a
// frame's time is counted of what soon will have to be as much as keeps frames even (budgeted refresh of the 1998 report, most urgent first).
// SPDX-License-Identifier: MIT
//
// Invariant: no picture is shown of which any point may sit more than the tolerance from its place (bound.h); with SHOTS_STEADY, none that was never
// taken, and what it may be off is said.
#ifndef PORTCULLIS_IMAGECACHE_SHOTS_H
#define PORTCULLIS_IMAGECACHE_SHOTS_H

#include "cut.h"
#include "detail.h"
#include "quad.h"
#include "store.h"

// Of a node: what its slot, numbered as the node, was last filled with.
typedef struct shot {
    double eye[3];            // that it was taken from
    cull_box box;             // of all that it shows
    float pixels_per_tangent; // that its texels were made for
    float ns;                 // that taking it takes, as foretold
    float away_m;             // that its items' points may stand from their places (detail.h)
    uint32_t keep_depth, frame;
} shot;

// Beside it, where pictures are shown by centre alignment.
typedef struct shot_aligned {
    quad taken;
    bound_view view; // that took it
} shot_aligned;

// Of a node in this frame.
typedef struct shot_state {
    float error_px;    // INFINITY: it can't be shown
    float frames_left; // that it stays within the tolerance, as the eye goes on; below 0: not looked at
    uint32_t next;     // 1 + another that is as urgent; 0: none
} shot_state;

typedef struct shots_request {
    const cull_visit *visit;
    const cut_request *view;
    const cut *cut;
    uint32_t keep_depth, frame;
    uint64_t bytes_most; // of all pictures
    double spare_ns; // for captures; INFINITY: whatever it takes
    enum { SHOTS_BOUNDED, SHOTS_STEADY } budget; // where that is not enough: more all the same; or older pictures
    enum { SHOTS_COARSER, SHOTS_FULL } detail; // items with fewer polygons where that pays; with all
} shots_request;

// A query's memory of them.
typedef struct shots {
    const cells *cells;
    const lists *lists;
    shot *all;          // by node
    shot_aligned *aligned; // by node; NULL: pictures are parallelograms in the world
    store store;
    uint32_t captures_most; // room for them in a batch
    shot_state *states; // by place in cut.taken
    double even_ns;     // a frame, that captures take as long as all goes on
    uint32_t shown_count, taken_count, early_count, stale_count; // this frame
    double error_px;                                             // the largest shown
    double polygons, spared;                                     // of those taken: as foretold; fewer than there are
    size_t bytes, aligned_bytes;
} shots;

typedef enum shots_way { SHOTS_QUADS, SHOTS_CENTRED } shots_way; // sections 1.7: exact under rotation; the report's centre alignment
int shots_open(const cull_host *host, const cells *c, const lists *l, shots_way way, shots *out); // 0: no memory; close it all the same
uint32_t shots_captures_most(const cells *c);
void shots_close(const cull_host *host, shots *s);
// How the pictures of the nodes taken stand: before shots_show, in the same frame.
void shots_check(shots *s, const shots_request *q);
// Pictures and captures of the nodes taken that are not hidden, near first, into the batch. Where one of them can't be taken (as near as it is, or so
// far from the zone's origin) all are clipped geometry instead: returns 0, and no picture is shown.
int shots_show(shots *s, const shots_request *q, cull_batch *batch);

#endif
