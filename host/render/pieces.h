// See-through items of a layout drawn piece by piece: what is made once (pieces.c), and the order of a frame (pieces_draw.c).
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_RENDER_PIECES_H
#define PORTCULLIS_RENDER_PIECES_H

#include "gl.h"
#include "pieces_mesh.h"
#include "whole_order.h"
#include "zone_order.h"

typedef struct pieces_zone {
    const cull_pieces *lent; // NULL: the zone's items go by distance
    uint32_t *item_first;    // by place in the zone, and one more: in numbers; an item without pieces has none
    uint32_t *numbers;       // pieces of see-through items, item by item, each ascending
    uint32_t *entries;       // by place in the zone: its translucent_item in this picture; scratch
    uint8_t *wanted;         // by piece: 1 while its place in the order is asked for, else 0
    piece_span *spans;       // by piece, in layout_pieces.indices
    whole_order whole;       // of items with pieces; no rows: there are too many
    uint32_t *rows;          // by place: in `whole`
    uint32_t *row_places;    // by row
    uint32_t place_count, number_count, number_room, item_count; // item_count: with pieces
} pieces_zone;

typedef struct pieces_draw { pixel_box cut; uint32_t first, count; } pieces_draw; // in the staged indices

struct layout_pieces {
    pieces_zone *zones;    // by zone
    vertex_buffers buffers; // the scene's vertices, then the pieces'
    GLuint vertices, elements;
    buffer indices;        // uint32_t, in buffers: of all pieces
    zone_order order;
    uint32_t *numbers;     // largest number_count
    uint32_t *places;      // 3 * item_room: those of a zone's picture, in order, and where groups of them end
    uint32_t *knots;       // item_room: pieces of each group in `numbers`; 0: it is one item, and whole
    void *scratch;         // of cullers
    uint32_t *staged;      // indices of a picture's see-through things, in their order
    pieces_draw *draws;
    size_t number_room, item_room, scratch_room, staged_room, draw_room, staged_count, draw_count;
    uint32_t has_faults;   // an order that was none has been told
};

void pieces_close(render_layout *l);
void pieces_forget_zone(render_layout *l, uint32_t zone);
// All that f->translucent holds, which is of layout l or of movers: in the exact order where zones lend pieces.
void pieces_draw_all(renderer *g, render_layout *l);

#endif
