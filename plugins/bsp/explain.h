// Why an item is kept or dropped, for a person.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_BSP_EXPLAIN_H
#define PORTCULLIS_BSP_EXPLAIN_H

#include "leaf_clip.h"

typedef enum explain_flow { EXPLAIN_WALKED, EXPLAIN_REACHED, EXPLAIN_UNREACHED } explain_flow; // how the cells' flow judged it

typedef struct explain_request {
    const bsp_shapes *shapes;
    const cull_visit *visit;
    uint32_t backface;
    explain_flow flow; // WALKED: it did not
} explain_request;

// [step] As cull_explain.item; uses the visit's scratch.
size_t explain_item(const explain_request *q, uint32_t item, char *text, size_t size);
size_t explain_scratch(const bsp_shapes *shapes);

#endif
