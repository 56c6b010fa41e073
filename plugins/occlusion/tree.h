// The tree that occlusion walks: a copy of the lent one where each item is listed once, else one of its own.
// Items are numbered by place: their order in the tree's lists. Boxes fit the items below, whatever the lent ones were.
// SPDX-License-Identifier: MIT
#ifndef OCCLUSION_TREE_H
#define OCCLUSION_TREE_H

#include <portcullis/box.h>

enum { TREE_WIDTH = 8, TREE_LEAF_ITEMS = 8 }; // of a tree of its own
enum { TREE_LIST_MOST = 64 };                      // items that a node of a lent tree may list
enum { TREE_UNIT_ITEMS = 256 };               // subtrees that are judged whether testing them pays: see ledger.h
#define TREE_NONE UINT32_MAX

typedef struct tree_node {
    cull_box box; // of all items at and under the node
    uint32_t parent, unit; // unit: the node, itself or above, whose ledger it stands in; TREE_NONE above all units
    uint32_t first_child, child_count;
    uint32_t first_item, item_count;    // places: the node's own
    uint32_t first_below, below_count;  // places of all items at and under it
    uint32_t polygons;                  // of them
    uint32_t is_contiguous;             // those places lie together
} tree_node;

typedef struct occlusion_tree {
    tree_node *nodes;
    cull_box *boxes;      // by place, as all of these
    uint32_t *item_nodes; // the node that lists it
    uint32_t *polygons;
    uint8_t *solid;       // 1: leaves depth at all of its texels
    uint32_t *ids;        // the zone's item of each place
    uint32_t *places;     // back, by item
    uint32_t node_count, item_count, depth, unit_count;
} occlusion_tree;

// 1 when every item is listed once, so that the lent tree can be walked as it is.
int tree_can_walk(const cull_zone *zone, const cull_hierarchy *lent);
// 1 when no node of it lists so many items that a tree of occlusion's own serves better.
int tree_is_fine(const cull_hierarchy *lent);
// [build] lent: NULL: a tree of its own is made. On failure nothing is left behind.
cull_result tree_make(const cull_host *host, const cull_zone *zone, const cull_hierarchy *lent, occlusion_tree *out);
void tree_free(const cull_host *host, occlusion_tree *tree);
size_t tree_bytes(const occlusion_tree *tree);

// The nodes with children and own items only, and ids: item_count of them, there already.
cull_result tree_split(const cull_host *host, const cull_zone *zone, occlusion_tree *out);

// Entries of a walk: nodes, then items, then movers, in one row of numbers below 2^31.
typedef uint32_t tree_entry;
static inline tree_entry tree_entry_of_item(const occlusion_tree *t, uint32_t place)
{
    return t->node_count + place;
}

static inline int tree_is_node(const occlusion_tree *t, tree_entry e)
{
    return e < t->node_count;
}

static inline cull_box tree_entry_box(const occlusion_tree *t, tree_entry e)
{
    return e < t->node_count ? t->nodes[e].box : t->boxes[e - t->node_count];
}

static inline uint32_t tree_entry_polygons(const occlusion_tree *t, tree_entry e)
{
    return e < t->node_count ? t->nodes[e].polygons : t->polygons[e - t->node_count];
}

static inline uint32_t tree_entry_unit(const occlusion_tree *t, tree_entry e)
{
    return t->nodes[e < t->node_count ? e : t->item_nodes[e - t->node_count]].unit;
}

// The node after n in a walk of start's subtree without a stack, below n first when it is entered. TREE_NONE: it was the last.
typedef enum tree_way { TREE_ENTER, TREE_PASS } tree_way;
static inline uint32_t tree_next(const occlusion_tree *t, uint32_t start, uint32_t n, tree_way way)
{
    if (way == TREE_ENTER && t->nodes[n].child_count) return t->nodes[n].first_child;
    while (n != start) {
        const tree_node *above = &t->nodes[t->nodes[n].parent];
        if (n + 1 < above->first_child + above->child_count) return n + 1;
        n = t->nodes[n].parent;
    }
    return TREE_NONE;
}

#endif
