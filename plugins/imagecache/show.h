// A frame of the image cache: far cells as pictures, near ones as geometry. What stands between the plugin's table and cut.h, shots.h and seams.h.
// SPDX-License-Identifier: MIT
//
// Invariant: each item with a point in a volume is drawn, stands behind a picture shown, or both, where a seam parts it.
#ifndef PORTCULLIS_IMAGECACHE_SHOW_H
#define PORTCULLIS_IMAGECACHE_SHOW_H

#include "account.h"
#include "cut.h"
#include "seams.h"
#include "shots.h"

enum { SHOW_LEVELS_MOST = 7 }; // a slot for each of 21,845 nodes; a renderer has some 65,536

typedef struct show_options {
    enum { SHOW_QUADS, SHOW_CENTRED, SHOW_GEOMETRY } show;
    enum { SHOW_TREE, SHOW_CELLS } nodes;
    enum { SHOW_HIDDEN_TESTED, SHOW_HIDDEN_TOO } hidden; // nodes that geometry hides: tested where this culler may step, or shown
    enum { SHOW_BOUNDED, SHOW_STEADY } budget;           // where a frame's time is spent: geometry's error all the same, or older pictures
    enum { SHOW_COARSER, SHOW_FULL } detail;             // of what pictures are taken of, where the host has it
    double tolerance_px;
    uint64_t bytes_most; // of pictures; the host may allow less
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
    uint64_t handed_back;             // of these, those of geometry's turn after pictures lost
    uint64_t pictures, captures, early, stale, tests, hidden, evicted;
    double polygons, spared; // of captures: drawn as foretold; left out by coarser levels
    double error_px; // the largest
} show_counts;

typedef struct show { // a query's memory
    const show_culler *culler;
    account account;
    cut cut;
    cut_request view; // of this frame
    shots shots;
    looks looks;
    seams seams;
    double eye[3], step[3], speed;
    uint32_t frame;
    enum { SHOW_STARTS, SHOW_GOES_ON } history;
    enum { SHOW_ALL_GEOMETRY, SHOW_HAS_PICTURES } last; // the last frame
    uint32_t geometry_frames; // in a row
    show_counts counts;
} show;

int show_open(const cull_host *host, const cells *c, const show_culler *s, show *out); // 0: no memory; close it all the same
void show_close(const cull_host *host, show *s);

typedef struct show_frame {
    const cull_visit *visit;
    const inview *inview;
    geometry *geometry; // begun before show_geometry; its runs are added to by both
    ground_cell eye;
} show_frame;

// Steps of a frame: show_takes, show_plan, show_geometry, and, in the same step or the next one, show_pictures.
int show_takes(const show *s, const cull_visit *visit); // 0: there are no pictures in such a view
int show_plan(show *s, const show_frame *f);            // 0: they don't pay, all is to be geometry
// Near cells. CULL_WAIT: call show_pictures in the next step, with the answers to the tests given.
cull_progress show_geometry(show *s, const show_frame *f, cull_batch *batch);
void show_pictures(show *s, const show_frame *f, cull_batch *batch);

// What pictures of the last frame have to do with an item that some cell in view lists, for a person. 0: nothing; else the text's length.
size_t show_explain(const show *s, uint32_t place, char *text, size_t size);

#endif
