// Cells shown as geometry beside pictures: items that reach beyond the square of geometry (cut.h) are drawn clipped to it, all others whole.
// Enlarged clip volumes: Schaufler and Stuerzlinger, 1996.
// SPDX-License-Identifier: MIT
//
// Invariant: of an item with a point in a volume, each point in a cell of geometry that is in view is drawn, and none farther than delta from the
// square. It is drawn once, clipped or whole.
#ifndef PORTCULLIS_IMAGECACHE_SEAMS_H
#define PORTCULLIS_IMAGECACHE_SEAMS_H

#include "geometry.h"
#include "inview.h"
#include "looks.h"

// The columns and rows of cells that list an item.
typedef struct seams_span { uint16_t first_i, last_i, first_j, last_j; } seams_span;

typedef struct seams_index { // of a culler
    seams_span *spans; // by place
    size_t bytes;
} seams_index;

int seams_build(const cull_host *host, const cells *c, seams_index *out); // 0: no memory
void seams_free(const cull_host *host, seams_index *s);

typedef struct seams { // a query's memory
    const cells *cells;
    const seams_index *index;
    cull_run *runs; // of clipped items
    uint32_t *waiting; // cells whose boxes are tested first
    uint32_t run_count, first_run, waiting_count; // first_run: of the step
    size_t bytes, waiting_bytes;
} seams;

int seams_open(const cull_host *host, const cells *c, const seams_index *index, seams *out); // 0: no memory
void seams_close(const cull_host *host, seams *s);

typedef struct seams_request {
    const inview *inview;
    geometry *geometry; // begun
    ground_cell eye;
    int32_t ring; // the last one of geometry
    double at[3]; // the eye
    double pixels_per_tangent, tolerance_px;
    looks *looks; // NULL: nothing is tested, all is drawn at once
} seams_request;

void seams_draw(seams *s, const seams_request *q, cull_batch *batch);
// In the next step: those of the cells tested that are not hidden.
void seams_draw_rest(seams *s, const seams_request *q, cull_batch *batch);

#endif
