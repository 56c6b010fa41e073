// What one viewer sees through the cells, volume by volume: items to draw, and what leaves the zone through its portals. A volume's flow
// is run once a frame, when the host asks about its portals or when it is selected by, whichever comes first.
// SPDX-License-Identifier: MIT
//
// Invariant: what is kept belongs to the view and the volumes that it was made for, number for number; so an answer depends on these alone.
#ifndef PORTCULLIS_BSP_SIGHT_H
#define PORTCULLIS_BSP_SIGHT_H

#include "cells.h"

enum { SIGHT_VOLUMES = 72 }; // kept; what comes on top is run again at select

typedef struct sight_volume { cull_plane planes[CULL_MAX_PLANES]; uint32_t plane_count, entry; } sight_volume;
typedef struct sight_view {
    double eye[4], forward[3], pixel_tangent, reach, near_distance;
    float right[3], eye_w; // right: the picture's, which the windows' axes follow
    uint32_t frame, purpose;
} sight_view;

typedef struct bsp_sight {
    bsp_flow_request flow; // visit stands for the volume at hand; scratch and drawn are this viewer's
    size_t drawn_bytes, scratch_bytes;
    sight_view view;
    sight_volume volumes[SIGHT_VOLUMES]; // of this view: those that `drawn` holds
    uint32_t volume_count, current;      // current: whose exits stand in the scratch; SIGHT_VOLUMES: none's
    uint32_t is_spoilt;                  // `drawn` is not what the list says: a volume could not be run, or kept, or `drawn` was handed out
    bsp_flow_figures untold;             // of what was run since the last select, in this view
} bsp_sight;

// how: all but visit, scratch, drawn.
cull_result sight_open(const cull_host *host, const bsp_flow_request *how, size_t drawn_bytes, bsp_sight *out);
void sight_close(const cull_host *host, bsp_sight *s); // of zeros is fine
// [step] Marks what the visit's volumes see in s->flow.drawn, the caller's to write over; figures: with those of what was asked before.
// 0: this view is none for it.
int sight_select(bsp_sight *s, const cull_visit *visit, bsp_flow_figures *figures);
typedef struct sight_question { const cull_view *view; const cull_volume *in; uint32_t portal, part; } sight_question;
cull_crossing sight_part(bsp_sight *s, const sight_question *q, cull_plane *planes, uint32_t *plane_count); // as cull_sight.part

#endif
