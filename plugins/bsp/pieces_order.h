// "cull.pieces/1" of a tree that keeps its pieces (split=1, split=node): the pieces, and their exact order for any eye.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_BSP_PIECES_ORDER_H
#define PORTCULLIS_BSP_PIECES_ORDER_H

#include "tree.h"

typedef struct bsp_span { uint32_t first, count; } bsp_span; // in pieces

typedef struct bsp_pieces {
    cull_pieces lent;      // stands first: the order is asked for with it
    const bsp_tree *tree;  // borrowed
    cull_piece *pieces;    // of nodes, then of leaves, each one's together
    uint32_t *planes;      // by piece, in tree.planes: its front is the piece's
    uint32_t *owners;      // by piece: a node, or a leaf with BSP_LEAF
    bsp_span *nodes, *leaves;
    uint32_t piece_count;
} bsp_pieces;

// Of a tree built with split=1 or split=node, which outlives it. With leaves that are not convex (bent_leaves) there is no
// order, and there are no pieces. CULL_ERR_MEMORY: nothing is left.
cull_result bsp_pieces_make(const cull_host *host, const bsp_tree *tree, bsp_pieces *out);
void bsp_pieces_free(const cull_host *host, bsp_pieces *pieces); // of zeros is fine
size_t bsp_pieces_bytes(const bsp_pieces *pieces);

#endif
