// Morton codes of items in a frame: a cube (for a quadtree a square) around their centres, halved CODE_LEVELS times.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_OCTREE_CODES_H
#define PORTCULLIS_OCTREE_CODES_H

#include "cells.h"

enum { CODE_LEVELS = 20 }; // halvings of a frame: 60 bits

typedef struct coded_item {
    uint64_t code; // Morton's, of the centre, 3 bits a level (2 in a quadtree), the first halving's highest
    uint32_t item;
    uint32_t level; // the deepest whose cells the item fits, loosely: 0 .. CODE_LEVELS
} coded_item;

typedef struct code_frame {
    const cull_boxes *boxes;
    octree_kind kind;
    double loose;
} code_frame;

// The frame of these items' centres: gives them codes and levels, and sorts them by code, equal codes by item. `spare` is as long.
// Returns 0 where all centres are equal, and then there is nothing to divide: the items stay as they are.
int codes_make(const code_frame *f, coded_item *items, coded_item *spare, uint32_t count);

// Sorts them along the axis of which their centres take the most; codes are lost.
void codes_sort_widest(const code_frame *f, coded_item *items, coded_item *spare, uint32_t count);

static inline uint32_t code_bits(octree_kind kind) // of a level
{
    return kind == OCTREE_QUAD ? 2 : 3;
}

#endif
