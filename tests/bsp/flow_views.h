// Views into a grid for tests of the flow.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_FLOW_VIEWS_H
#define PORTCULLIS_TESTS_FLOW_VIEWS_H

#include "grid_cells.h"

#include <portcullis/plane.h>

typedef struct flow_view {
    cull_view view;
    cull_plane planes[CULL_MAX_PLANES];
    cull_volume volume;
    cull_visit visit;
    double right[3], up[3], tangents[2]; // of the picture, half its width and height at distance 1
    double eye_unposed[3];
} flow_view;

typedef struct flow_aim { double eye[3], forward[3], tangents[2], near_distance; } flow_aim; // eye and forward in the unposed block; eye_ulps posed

void flow_view_make(const grid_cells *g, const flow_aim *aim, flow_view *out); // points into itself: it must not move
// Through the picture at (u, v) in [-1, 1]: the direction in the unposed block.
void flow_view_ray(const grid_cells *g, const flow_view *v, double u, double w, double way[3]);

typedef struct flow_run { uint8_t *drawn; void *scratch; bsp_flow_figures figures; int result; } flow_run;
void flow_run_make(const grid_cells *g, flow_run *out); // room for any way
void flow_run_free(flow_run *r);
void flow_run_step(const grid_cells *g, const flow_view *v, bsp_cells how, uint32_t backface, flow_run *r);

#endif
