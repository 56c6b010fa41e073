// The boxes of leaves and nodes, of whole items.
// SPDX-License-Identifier: MIT
// Invariant: a node's box holds those of its children and its own entries' items; what lists nothing has a box that holds nothing.
#include "build.h"

static cull_box entries_box(const cull_zone *zone, const bsp_tree *tree, uint32_t first, uint32_t count)
{
    cull_box box = cull_box_none();
    for (uint32_t i = first; i < first + count; i++) box = cull_box_union(box, cull_box_at(&zone->boxes, tree->order[tree->entries[i].item]));
    return box;
}

void tree_measure_boxes(const cull_zone *zone, bsp_tree *tree)
{
    for (uint32_t i = 0; i < tree->leaf_count; i++)
        tree->leaf_boxes[i] = entries_box(zone, tree, tree->leaves[i].first_entry, tree->leaves[i].entry_count);
    for (uint32_t i = tree->node_count; i-- > 0;) {
        const bsp_node *node = &tree->nodes[i];
        cull_box box = entries_box(zone, tree, node->first_entry, node->entry_count);
        for (int side = 0; side < 2; side++) {
            const uint32_t child = node->child[side];
            box = cull_box_union(box, child & BSP_LEAF ? tree->leaf_boxes[child & ~BSP_LEAF] : tree->node_boxes[child]);
        }
        tree->node_boxes[i] = box;
    }
}
