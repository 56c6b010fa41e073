// Which part of a zone is shown as geometry and which as pictures of quadtree nodes: a square of cells about the eye's is geometry, all beyond are
// pictures; its size and the nodes are those that cost least (cost test of the 1998 report, with costs that the host measured).
// SPDX-License-Identifier: MIT
//
// Invariant: no geometry lies behind a picture. The square is convex and holds the eye: a ray from there that has left it does not come back. (From
// beyond the ground the square reaches on to the eye, over cells that are not there.) So a picture needs no depth of its own, but for what others
// draw: movers, and what is seen through portals. And what crosses its border is clipped by the four planes of one convex set.
#ifndef PORTCULLIS_IMAGECACHE_CUT_H
#define PORTCULLIS_IMAGECACHE_CUT_H

#include "inview.h"
#include "lists.h"
#include "looks.h"

typedef struct cut_optics {
    double pixels_per_tangent, near_distance;
    double pixels; // of the whole picture
} cut_optics;

typedef struct cut_request {
    const inview *inview;
    const cull_costs *costs;
    double eye[3], step[3], speed; // step: metres a frame that the eye goes; speed: how fast it is taken to be
    double radius;                 // the zone's largest coordinate
    cut_optics optics;
    double tolerance_px;
    double picture_pixel_ns; // with depth or without
    double wear;             // how many times sooner pictures have to be taken anew than the bound foretells; 0: as foretold
    ground_cell eye_cell;
    enum { CUT_TREE, CUT_CELLS } nodes; // CELLS: no node but the cells
    enum { CUT_ANEW, CUT_GOES_ON } history;
    enum { CUT_FACING, CUT_ALIGNED } planes; // pictures lie across the line of sight to their middles, or all across the view's
    double forward[3];                       // the view's; of CUT_ALIGNED
    const looks *looks; // NULL: nobody looks what is hidden. It says nothing about prices: choices would come and go with it
} cut_request;

// A query's memory of it.
typedef struct cut {
    const cells *cells;
    const lists *lists;
    float *prices;      // by node: of the cheapest pictures that show what is in view of it
    uint32_t *stamps;   // by node: the frame that it was in view last
    uint32_t *seen;     // nodes in view, level after level from the cells up
    uint8_t *choices;   // by node: NODES_TAKE, one picture is cheapest; NODES_OPEN, those of its children
    nodes_mark *marks;  // by node, for nodes_in_order; all SKIP between frames
    uint32_t *taken;    // nodes shown as pictures, near first
    double *by_ring;    // what geometry costs there more than pictures
    double *drawn_ring; // what geometry costs there
    uint32_t seen_count, taken_count, stamp, ring_count;
    int32_t ring;       // half the square's side: cut_ring of the last geometry; -1: none
    double geometry_ns, picture_ns; // of all in view, as foretold: as geometry, and as pictures but where there can be none
    double ring_ns, taken_ns;       // of what is geometry here, and of showing (not taking) what are pictures
    size_t bytes;
} cut;

int cut_open(const cull_host *host, const cells *c, const lists *l, cut *out); // 0: no memory
void cut_close(const cull_host *host, cut *c);
void cut_make(cut *c, const cut_request *q);

// Of a cell: how many cells it is off the eye's, along the axis where that is more.
static inline int32_t cut_ring(ground_cell eye, int32_t i, int32_t j)
{
    const int32_t along = i > eye.i ? i - eye.i : eye.i - i, across = j > eye.j ? j - eye.j : eye.j - j;
    return along > across ? along : across;
}

// Metres that clip planes move out by at a distance, so that no seam opens; see quad_seam_delta.
double cut_delta(double distance, double pixels_per_tangent, double tolerance_px);

// What one node as a picture comes to: showing it and taking it, and how many frames it is foretold to last if the eye goes straight on.
typedef struct cut_price { double showing_ns, taking_ns, frames; } cut_price;
cut_price cut_price_of(const cut_request *q, const lists_node *node);
double cut_geometry_ns(const cut_request *q, const lists_node *cell); // what a cell takes as geometry

// Distance and half diagonal under which a picture can be taken at all, see QUAD_WIDEST and the rest of quad_result.
int cut_can_be_taken(const cut_request *q, const cull_box *box);

#endif
