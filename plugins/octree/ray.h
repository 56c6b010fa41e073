// Items whose boxes a segment or a box touches, for cull.ray/1.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_OCTREE_RAY_H
#define PORTCULLIS_OCTREE_RAY_H

#include "cells.h"

typedef struct ray_source {
    const cull_zone *zone;
    const octree_cells *cells;
} ray_source;

// [any] As cull_ray.segment and cull_ray.box. No memory but the runs: a list too short for all keeps the nearest.
uint32_t ray_segment(const ray_source *from, cull_vec3 start, cull_vec3 end, cull_run *runs, uint32_t max_runs);
uint32_t ray_box(const ray_source *from, const cull_box *box, cull_run *runs, uint32_t max_runs);

#endif
