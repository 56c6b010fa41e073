// Pieces of an item cut by its triangles: small triangles that cover what the item's own cover, without gaps between them.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_RENDER_PIECES_MESH_H
#define PORTCULLIS_RENDER_PIECES_MESH_H

#include "../core/scene.h"

// Weights are of the triangle's three corners, in the scene's order; a triangle's attributes are affine over it.
typedef struct piece_vertex {
    cull_vec3 position; // relative to the scene's origin
    uint32_t triangle;  // global
    double weights[3];  // exactly 1, 0, 0 where it is a corner
    uint32_t is_centre; // the last vertex of its triangles, and of no others
} piece_vertex;

typedef struct piece_span { uint32_t first_index, index_count; } piece_span;

typedef struct pieces_mesh {
    buffer vertices; // piece_vertex
    buffer indices;  // uint32_t, in vertices
    buffer points, polygons, places, loop, clip[2]; // scratch of one item
    const allocator *memory;
} pieces_mesh;

pieces_mesh pieces_mesh_make(const allocator *memory);
void pieces_mesh_free(pieces_mesh *m);

typedef struct pieces_mesh_request {
    const scene *scene;
    const cull_pieces *lent;
    const uint32_t *numbers; // the item's pieces
    uint32_t count, item;    // item: global id
    double offset[3];        // of the zone's origin from the scene's
} pieces_mesh_request;

// Appends the item's. spans[i] is of numbers[i]. RESULT_BAD_INPUT: the pieces do not cover the item once; nothing appended.
result pieces_mesh_item(pieces_mesh *m, const pieces_mesh_request *q, piece_span *spans);

#endif
