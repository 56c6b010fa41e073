// Why an item is kept or dropped, for a person.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_OCTREE_EXPLAIN_H
#define PORTCULLIS_OCTREE_EXPLAIN_H

#include "cells.h"

typedef enum explain_backs { EXPLAIN_BACKS_KEPT, EXPLAIN_BACKS_DROPPED } explain_backs;

typedef struct explain_source {
    const cull_zone *zone;
    const octree_cells *cells;
    explain_backs backs;
} explain_source;

// [step] As cull_explain.item.
size_t explain_item(const explain_source *from, const cull_visit *visit, uint32_t place, char *text, size_t size);

#endif
