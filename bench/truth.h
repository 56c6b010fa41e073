// Truth: what owns a pixel, view by view, from id pictures drawn with everything. Never asks a culler.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_BENCH_TRUTH_H
#define PORTCULLIS_BENCH_TRUTH_H

#include "../host/core/scene.h"
#include "../host/core/view.h"
#include "../host/import/views.h"
#include "../host/render/render.h"
#include "walls.h"

typedef struct truth_item {
    uint32_t item;     // global id
    uint32_t pixels;   // that it owns; 0 for a translucent one
    uint32_t polygons; // of it that own a pixel, or pass the opaque depth
} truth_item;

typedef struct truth_view { // sums hold no movers but for the last one
    uint32_t first, count; // in truth.items
    uint64_t polygons_visible, polygons_items, items_visible, floor_items, mover_polygons_visible;
} truth_view;

typedef struct truth {
    const scene *scene;
    const allocator *memory;
    uint32_t *triangle_polygon, *polygon_item; // lookups
    uint32_t *polygon_stamp, *item_pixels, *item_polygons;
    uint32_t *floor_bits;
    uint32_t *shown_bits; // items that count; NULL: all
    uint32_t *edge_bits;  // with shown_bits: others that the pictures hold and that hide what is behind them, but own nothing: see walls.h
    uint32_t *front_bits; // WALLS_MIXED: items judged by their fronts, for strategy_judge to say; all at first; otherwise NULL
    uint32_t front_turn;  // that front_bits are of, + 1; 0: none
    uint32_t stamp, triangle_count;
    id_picture picture;
    walls walls;
    buffer items; // truth_item
    buffer views; // truth_view, in the order added
} truth;

typedef struct truth_request {
    const scene *scene;
    uint32_t width_px, height_px;
    walls walls;
} truth_request;

// [main] The scene is borrowed and uploaded to the renderer already.
result truth_open(const truth_request *q, const allocator *memory, report *r, truth *out);
void truth_close(truth *t);
// The picture of the view, into t->picture: what truth_add_view counts.
result truth_draw(truth *t, renderer *g, const id_request *q, report *r);
result truth_add_view(truth *t, renderer *g, const camera *c, report *r);
// A view that nobody asks about: its number is taken, nothing is drawn.
result truth_skip_view(truth *t, report *r);
// A view of its own whose items are those of all sub-pixel shifts, or of a larger picture: what CONSERVATIVE is tested
// against. Its floor stays 0.
typedef struct truth_finer { uint32_t jitters; uint32_t scale; } truth_finer; // 16 and 1, or 1 and 4
result truth_add_finer(truth *t, renderer *g, const camera *c, const truth_finer *how, report *r);

#endif
