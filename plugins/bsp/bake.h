// A tree in bytes and back.
// SPDX-License-Identifier: MIT
// Invariant: planes, boxes and figures are made from the zone again; of what is read, every number is checked before it is used.
#ifndef PORTCULLIS_BSP_BAKE_H
#define PORTCULLIS_BSP_BAKE_H

#include "tree.h"

// CULL_ERR_BLOB: not a tree of this zone with this wish. On failure nothing is left; nothing is logged.
cull_result bsp_tree_load(const cull_host *host, const bsp_source *from, bsp_tree *out);

#endif
