// Hierarchy check: see hierarchy_check.h.
// SPDX-License-Identifier: MIT
// Invariant: each pass reads only what the passes before it found in range; nothing recurses.
#include "hierarchy_check.h"

#include <portcullis/box.h>

#include <math.h>

// What is known of a node's subtree.
typedef struct node_sum {
    uint64_t listed;     // items, those listed twice counted twice
    uint32_t low, high;  // the least and the largest item; low > high: none
    uint32_t depth;      // nodes on the way from the root, itself too; 0: not reached
} node_sum;

typedef struct item_sum {
    cull_box box; // of the nodes that list it, together
    uint64_t times;
} item_sum;

typedef struct hierarchy_walk {
    const cull_hierarchy *h;
    const cull_zone *zone;
    node_sum *nodes;
    item_sum *items;
} hierarchy_walk;

static int box_is_sound(cull_box b)
{
    const float c[6] = {b.min.x, b.min.y, b.min.z, b.max.x, b.max.y, b.max.z};
    for (int i = 0; i < 6; ++i)
        if (!isfinite(c[i])) return 0;
    return c[0] <= c[3] && c[1] <= c[4] && c[2] <= c[5];
}

// Every node is the child of one before it, so one way leads to it from the root.
static const char *tree_fault(hierarchy_walk *w)
{
    const cull_hierarchy *h = w->h;
    uint32_t reached = 1, deepest = 1;
    for (uint32_t n = 0; n < h->node_count; ++n)
        if (!box_is_sound(h->nodes[n].box)) return "a node's box is not finite or is inside out";
    w->nodes[0].depth = 1;
    for (uint32_t n = 0; n < h->node_count; ++n) {
        const cull_node *node = &h->nodes[n];
        if (!node->child_count) continue;
        if (node->first_child <= n) return "a node's children do not come after it";
        if (node->first_child >= h->node_count || node->child_count > h->node_count - node->first_child) return "a child is no node";
        const uint32_t depth = w->nodes[n].depth + 1;
        for (uint32_t c = node->first_child; c < node->first_child + node->child_count; ++c) {
            if (w->nodes[c].depth) return "a node is the child of two";
            if (!cull_box_contains(node->box, h->nodes[c].box)) return "a node's box does not cover a child's";
            w->nodes[c].depth = depth;
        }
        reached += node->child_count;
        if (depth > deepest) deepest = depth;
    }
    if (reached != h->node_count) return "a node cannot be reached from the root";
    return deepest == h->depth ? NULL : "its depth is not that of its deepest node";
}

static const char *list_fault(hierarchy_walk *w, uint32_t n, uint64_t *listed)
{
    const cull_node *node = &w->h->nodes[n];
    const uint32_t items = w->zone->item_count, listable = w->h->items ? w->h->item_count : items;
    if (!node->item_count) return NULL;
    if (node->first_item >= listable || node->item_count > listable - node->first_item) return "a node lists items that are not there";
    *listed += node->item_count;
    if (*listed > listable) return "nodes list more items than there are"; // which also bounds the time
    node_sum *sum = &w->nodes[n];
    for (uint32_t i = node->first_item; i < node->first_item + node->item_count; ++i) {
        const uint32_t item = w->h->items ? w->h->items[i] : i;
        if (item >= items) return "a node lists an item that is not in the zone";
        item_sum *s = &w->items[item];
        s->box = s->times++ ? cull_box_union(s->box, node->box) : node->box;
        if (item < sum->low) sum->low = item;
        if (item > sum->high) sum->high = item;
    }
    sum->listed = node->item_count;
    return NULL;
}

static const char *lists_fault(hierarchy_walk *w)
{
    uint64_t listed = 0;
    const char *fault = NULL;
    for (uint32_t n = 0; n < w->h->node_count; ++n) {
        w->nodes[n].low = UINT32_MAX;
        w->nodes[n].high = 0;
    }
    for (uint32_t n = 0; n < w->h->node_count && !fault; ++n) fault = list_fault(w, n, &listed);
    for (uint32_t i = 0; i < w->zone->item_count && !fault; ++i) {
        const item_sum *s = &w->items[i];
        if (s->times == 0) fault = "an item of the zone is in no node";
        else if (s->times > 1 && !w->h->items) fault = "an item is in two runs";
        else if (!cull_box_contains(s->box, cull_box_at(&w->zone->boxes, i))) fault = "the boxes of an item's nodes do not cover it";
    }
    return fault;
}

// A subtree's run holds what its nodes list and ends where that does.
static const char *subtrees_fault(hierarchy_walk *w)
{
    const cull_hierarchy *h = w->h;
    for (uint32_t n = h->node_count; n-- > 0;) {
        const cull_node *node = &h->nodes[n];
        node_sum *sum = &w->nodes[n];
        for (uint32_t c = node->first_child; node->child_count && c < node->first_child + node->child_count; ++c) {
            const node_sum *child = &w->nodes[c];
            sum->listed += child->listed;
            if (child->low < sum->low) sum->low = child->low;
            if (child->high > sum->high) sum->high = child->high;
        }
        const cull_run run = node->subtree;
        if (!run.count) continue;
        if (run.first >= w->zone->item_count || run.count > w->zone->item_count - run.first) return "a subtree's run is outside the zone";
        if (run.first != sum->low || run.first + run.count - 1 != sum->high || run.count > sum->listed || (!h->items && run.count != sum->listed))
            return "a subtree's run is not what its nodes list";
    }
    return NULL;
}

result hierarchy_check(const cull_hierarchy *h, const cull_zone *zone, const allocator *memory, const char **out_fault)
{
    *out_fault = NULL;
    if (!h->node_count) {
        if (zone->item_count) *out_fault = "it has no nodes";
        return RESULT_OK;
    }
    if (!h->nodes) {
        *out_fault = "its nodes are not there";
        return RESULT_OK;
    }
    hierarchy_walk w = {.h = h, .zone = zone, .nodes = memory_alloc_zeroed(memory, h->node_count, sizeof(node_sum))};
    w.items = w.nodes ? memory_alloc_zeroed(memory, zone->item_count, sizeof(item_sum)) : NULL;
    if (w.items) {
        *out_fault = tree_fault(&w);
        if (!*out_fault) *out_fault = lists_fault(&w);
        if (!*out_fault) *out_fault = subtrees_fault(&w);
    }
    const result done = w.items ? RESULT_OK : RESULT_NO_MEMORY;
    memory_free(memory, w.items, zone->item_count, sizeof(item_sum));
    memory_free(memory, w.nodes, h->node_count, sizeof(node_sum));
    return done;
}
