// Where brushes touch each other, or nearly do: corners of one at the planes of another.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_COMPILE_INPUT_MEET_H
#define PORTCULLIS_HOST_COMPILE_INPUT_MEET_H

#include "input.h"

typedef struct brush_corner {
    plane_ref planes[3];
    double position[3]; // grid steps
    uint32_t brush;
} brush_corner;

typedef struct brush_meeting { // a corner of one brush within the weld of a face of another
    uint32_t corner;           // in meeting_set.corners
    uint32_t plane;            // number of the other's plane, none of the corner's own
    uint32_t is_apart;         // 1: the corner isn't on that plane
} brush_meeting;

typedef struct meeting_set {
    input_draft *draft;
    buffer corners, first;  // brush_corner by brush; uint32_t: brushes + 1
    buffer edges, first_edge; // pairs of corners by brush; uint32_t: brushes + 1
    buffer meetings;        // brush_meeting, each once, by plane, then place
    buffer is_movable;      // uint8_t by plane: all faces on it were rounded, so it may be an error of rounding
    buffer boxes;           // tree_box by brush
} meeting_set;

meeting_set meeting_set_make(input_draft *d);
void meeting_set_free(meeting_set *m);
// Anew, of the brushes as they are. Only pairs of brushes of which one has a movable plane are looked at.
result meeting_set_find(meeting_set *m, uint32_t *apart);
int meeting_set_may_move(const meeting_set *m, uint32_t plane);
// Signed height over a plane in grid steps, in its normal's direction.
double plane_height(const plane_table *t, plane_ref plane, const double p[3]);

#endif
