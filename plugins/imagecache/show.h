// A frame of the image cache: far cells as pictures, near ones as geometry. What stands between the plugin's table and cut.h, shots.h and seams.h.
// SPDX-License-Identifier: MIT
//
// Invariant: each item with a point in a volume is drawn, stands behind a picture shown, or both, where a seam parts it.
#ifndef PORTCULLIS_IMAGECACHE_SHOW_H
#define PORTCULLIS_IMAGECACHE_SHOW_H

#include "cut.h"
#include "seams.h"
#include "shots.h"

typedef struct show_options {
    enum { SHOW_QUADS, SHOW_GEOMETRY } show;
    enum { SHOW_TREE, SHOW_CELLS } nodes;
    double tolerance_px;
} show_options;

typedef struct show_culler { // what a culler keeps
    show_options options;
    const cull_costs *costs; // NULL: the host has none, and all is geometry
    lists lists;
    seams_index seams;
    double radius;
    uint32_t keep_depth; // something with depth may stand behind a picture: movers, and what is seen through portals
} show_culler;

cull_result show_build(const cull_host *host, const cull_zone *zone, const cells *c, const show_options *options, show_culler *out);
void show_free(const cull_host *host, show_culler *s);
void show_tell(const show_culler *s, const cells *c, cull_built *out);

typedef struct show_counts { // of a query's life
    uint64_t frames, geometry_frames; // frames; those in which pictures didn't pay, or could not be taken
    uint64_t pictures, captures;
    double error_px; // the largest
} show_counts;

typedef struct show { // a query's memory
    const show_culler *culler;
    cut cut;
    cut_request view; // of this frame
    shots shots;
    seams seams;
    double eye[3], step[3], speed;
    uint32_t frame;
    enum { SHOW_STARTS, SHOW_GOES_ON } history;
    uint32_t geometry_frames; // in a row
    show_counts counts;
} show;

int show_open(const cull_host *host, const cells *c, const show_culler *s, show *out); // 0: no memory
void show_close(const cull_host *host, show *s);

typedef struct show_frame {
    const cull_visit *visit;
    const inview *inview;
    geometry *geometry; // begun before show_geometry
    ground_cell eye;
} show_frame;
int show_takes(const show *s, const cull_visit *visit); // 0: there are no pictures in such a view
// Far cells. 0: pictures don't pay here, none is shown, and all is to be geometry.
int show_pictures(show *s, const show_frame *f, cull_batch *batch);
// And the near ones, after it.
void show_geometry(show *s, const show_frame *f, cull_batch *batch);

#endif
