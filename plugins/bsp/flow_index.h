// The cells laid out for the flow: what a visit reads lies together and in order, in float.
// SPDX-License-Identifier: MIT
//
// Invariant: a face is told from the side that the flow sees it from: its plane has the eye in front, its points run counterclockwise
// from there. Rounding to float moves points and planes by less than half of what bsp_flow_index.slack has more than the cells' own; the
// other half is for corners that stand outside another edge's line then, but for faces that are FACE_BENT.
#ifndef PORTCULLIS_BSP_FLOW_INDEX_H
#define PORTCULLIS_BSP_FLOW_INDEX_H

#include "cells.h"

enum { FLOW_POINTS = 62 }; // of an opening or piece; one of more is taken as seen whole

typedef union flow_word { float f; uint32_t u; } flow_word;

enum { // words of a face; its points' x, then y, then z follow. Of an item that is no wall: FACE_HEAD words, no points.
       // Points are read in pairs: there is one word more behind the last face
    FACE_PLANE = 0,  // normal, offset; of an item that is no wall: the least corner of its box
    FACE_BALL = 4,   // middle, radius: around its points; of an item that is no wall: the greatest corner of its box
    FACE_WHO = 8,    // the cell behind an opening, or an item
    FACE_BITS = 9,   // count of points, and below
    FACE_HEAD = 10,
};
#define FACE_COUNT 0xffffffu           // of FACE_BITS
#define FACE_ONE_SIDED 0x1000000u // of a wall that is not TWO_SIDED and shows no front to eyes behind its plane
#define FACE_BACK 0x2000000u      // told from the wall's back
#define FACE_BENT 0x4000000u      // rounding turned an edge away from its corners

typedef struct flow_node { float normal[3], offset; uint32_t child[2], parent, reserved; } flow_node;

typedef struct flow_cell {
    size_t first_word; // its openings, then what it shows
    uint32_t parent, opening_count, entry_count, front_count; // front_count: of entries, pieces whose front it shows
    uint32_t edge_count, reserved; // behind the entries: pieces that touch it, for who draws backs
} flow_cell;

#endif
