// The tree that occlusion walks: see tree.h.
// SPDX-License-Identifier: MIT
#include "tree.h"

#include <string.h>

static size_t at_least_one(size_t count)
{
    return count ? count : 1;
}

static void *array_alloc(const cull_host *host, size_t count, size_t size)
{
    void *array = count > SIZE_MAX / size ? NULL : host->alloc(host, at_least_one(count) * size, 64);
    if (array) memset(array, 0, at_least_one(count) * size);
    return array;
}

static void array_free(const cull_host *host, void *array, size_t count, size_t size)
{
    if (array) host->free(host, array, at_least_one(count) * size);
}

// ---- A copy of the lent tree ----

int tree_can_walk(const cull_zone *zone, const cull_hierarchy *lent)
{
    return lent && lent->node_count && (!lent->items || lent->item_count == zone->item_count);
}

int tree_is_fine(const cull_hierarchy *lent)
{
    for (uint32_t n = 0; n < lent->node_count; n++)
        if (lent->nodes[n].item_count > TREE_LIST_MOST) return 0;
    return 1;
}

static cull_result tree_copy(const cull_host *host, const cull_zone *zone, const cull_hierarchy *lent, occlusion_tree *out)
{
    out->node_count = lent->node_count;
    out->nodes = array_alloc(host, lent->node_count, sizeof *out->nodes);
    if (!out->nodes) return CULL_ERR_MEMORY;
    for (uint32_t i = 0; i < zone->item_count; i++) out->ids[i] = lent->items ? lent->items[i] : i;
    for (uint32_t n = 0; n < lent->node_count; n++) {
        const cull_node *from = &lent->nodes[n];
        tree_node *to = &out->nodes[n];
        to->first_child = from->first_child;
        to->child_count = from->child_count;
        to->first_item = from->item_count ? from->first_item : 0;
        to->item_count = from->item_count;
    }
    return CULL_OK;
}

// ---- What follows from nodes and ids ----

static int items_alloc(const cull_host *host, occlusion_tree *t)
{
    t->boxes = array_alloc(host, t->item_count, sizeof *t->boxes);
    t->item_nodes = array_alloc(host, t->item_count, sizeof *t->item_nodes);
    t->polygons = array_alloc(host, t->item_count, sizeof *t->polygons);
    t->solid = array_alloc(host, t->item_count, sizeof *t->solid);
    t->ids = array_alloc(host, t->item_count, sizeof *t->ids);
    t->places = array_alloc(host, t->item_count, sizeof *t->places);
    return t->boxes && t->item_nodes && t->polygons && t->solid && t->ids && t->places;
}

static void items_fill(const cull_zone *zone, occlusion_tree *t)
{
    for (uint32_t place = 0; place < t->item_count; place++) {
        const uint32_t item = t->ids[place];
        const cull_item *is = &zone->items[item];
        t->boxes[place] = cull_box_at(&zone->boxes, item);
        t->polygons[place] = is->polygon_count;
        t->solid[place] = !(is->flags & (CULL_ITEM_SEE_THROUGH | CULL_ITEM_CUT_OUT));
        t->places[item] = place;
    }
}

static uint32_t sum_of(uint32_t a, uint32_t b)
{
    return a > UINT32_MAX - b ? UINT32_MAX : a + b;
}

// One backward loop: children come behind their node. last: the largest place below, in is_contiguous for the while.
static void node_fold(occlusion_tree *t, uint32_t n)
{
    tree_node *node = &t->nodes[n];
    cull_box box = cull_box_none();
    uint32_t low = UINT32_MAX, high = 0, below = node->item_count, polygons = 0;
    for (uint32_t i = node->first_item; i < node->first_item + node->item_count; i++) {
        box = cull_box_union(box, t->boxes[i]);
        polygons = sum_of(polygons, t->polygons[i]);
        t->item_nodes[i] = n;
    }
    if (node->item_count) {
        low = node->first_item;
        high = node->first_item + node->item_count - 1;
    }
    for (uint32_t c = node->first_child; c < node->first_child + node->child_count; c++) {
        tree_node *child = &t->nodes[c];
        child->parent = n;
        if (!child->below_count) continue;
        box = cull_box_union(box, child->box);
        polygons = sum_of(polygons, child->polygons);
        low = child->first_below < low ? child->first_below : low;
        high = child->is_contiguous > high ? child->is_contiguous : high;
        below += child->below_count;
    }
    node->box = box;
    node->polygons = polygons;
    node->first_below = low;
    node->below_count = below;
    node->is_contiguous = high;
}

static void nodes_finish(occlusion_tree *t)
{
    for (uint32_t n = t->node_count; n-- > 0;) node_fold(t, n);
    for (uint32_t n = 0; n < t->node_count; n++) {
        tree_node *node = &t->nodes[n];
        node->is_contiguous = node->below_count && node->is_contiguous - node->first_below + 1 == node->below_count;
        if (n == 0) node->parent = TREE_NONE;
        node->unit = n == 0 ? TREE_NONE : t->nodes[node->parent].unit;
        const int is_unit = node->unit == TREE_NONE && node->below_count && (node->below_count <= TREE_UNIT_ITEMS || !node->child_count);
        if (is_unit) node->unit = n;
        t->unit_count += is_unit != 0;
    }
}

static uint32_t depth_of(const occlusion_tree *t)
{
    uint32_t depth = 0;
    for (uint32_t n = 0; n < t->node_count; n++) {
        if (t->nodes[n].child_count) continue;
        uint32_t here = 0;
        for (uint32_t at = n; at != TREE_NONE; at = t->nodes[at].parent) here++;
        depth = here > depth ? here : depth;
    }
    return depth;
}

cull_result tree_make(const cull_host *host, const cull_zone *zone, const cull_hierarchy *lent, occlusion_tree *out)
{
    occlusion_tree t = {.item_count = zone->item_count};
    cull_result result = items_alloc(host, &t) ? CULL_OK : CULL_ERR_MEMORY;
    if (result == CULL_OK) result = lent ? tree_copy(host, zone, lent, &t) : tree_split(host, zone, &t);
    if (result != CULL_OK) {
        tree_free(host, &t);
        return result;
    }
    items_fill(zone, &t);
    nodes_finish(&t);
    t.depth = depth_of(&t);
    *out = t;
    return CULL_OK;
}

void tree_free(const cull_host *host, occlusion_tree *t)
{
    array_free(host, t->nodes, t->node_count, sizeof *t->nodes);
    array_free(host, t->boxes, t->item_count, sizeof *t->boxes);
    array_free(host, t->item_nodes, t->item_count, sizeof *t->item_nodes);
    array_free(host, t->polygons, t->item_count, sizeof *t->polygons);
    array_free(host, t->solid, t->item_count, sizeof *t->solid);
    array_free(host, t->ids, t->item_count, sizeof *t->ids);
    array_free(host, t->places, t->item_count, sizeof *t->places);
    *t = (occlusion_tree){.nodes = NULL};
}

size_t tree_bytes(const occlusion_tree *t)
{
    const size_t item = sizeof *t->boxes + sizeof *t->item_nodes + sizeof *t->polygons + sizeof *t->solid + sizeof *t->ids + sizeof *t->places;
    return t->node_count * sizeof *t->nodes + t->item_count * item;
}
