// What bsp lends as cull.hierarchy/1: the tree's leaves with the boxes of the pieces in them.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_BSP_HIERARCHY_H
#define PORTCULLIS_BSP_HIERARCHY_H

#include "tree.h"

enum { LENT_LEAF_LISTINGS = 8 }; // subtrees of at most as many entries are one leaf

typedef struct bsp_lent {
    cull_hierarchy hierarchy;
    cull_node *nodes;
    uint32_t *items;       // room for the tree's entries
    uint32_t listing_room;
} bsp_lent;

// [build] On failure nothing is left behind; lent_free of zeros is fine.
cull_result lent_build(const cull_host *host, const cull_zone *zone, const bsp_tree *tree, bsp_lent *out);
void lent_free(const cull_host *host, bsp_lent *lent);
size_t lent_bytes(const bsp_lent *lent);

#endif
