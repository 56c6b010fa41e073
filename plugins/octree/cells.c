// The cells as a whole: what kind, their boxes, their memory; see cells.h.
// SPDX-License-Identifier: MIT
#include "cells.h"

#include <portcullis/box.h>

#include <string.h>

enum { ALIGN = 64, FIRST_ROOM = 64 };

static double variance(const float *low, const float *high, uint32_t count)
{
    double mean = 0, sum = 0;
    for (uint32_t i = 0; i < count; i++) mean += ((double)low[i] + (double)high[i]) / 2 / count;
    for (uint32_t i = 0; i < count; i++) {
        const double off = ((double)low[i] + (double)high[i]) / 2 - mean;
        sum += off * off / count;
    }
    return sum;
}

octree_kind cells_kind_of(const cull_zone *zone, octree_kind wish)
{
    const cull_boxes *b = &zone->boxes;
    const double flat = 1.0 / 16; // a quarter, squared
    if (wish != OCTREE_AUTO) return wish;
    const double x = variance(b->min_x, b->max_x, zone->item_count), z = variance(b->min_z, b->max_z, zone->item_count);
    const double y = variance(b->min_y, b->max_y, zone->item_count);
    return y <= flat * (x > z ? x : z) ? OCTREE_QUAD : OCTREE_OCT;
}

int cells_reserve(const cull_host *host, octree_cells *cells, size_t needed)
{
    if (needed <= cells->node_room) return 1;
    size_t room = cells->node_room ? 2 * cells->node_room : FIRST_ROOM;
    if (room < needed) room = needed;
    cull_node *more = host->alloc(host, room * sizeof *more, ALIGN);
    if (!more) return 0;
    if (cells->nodes) {
        memcpy(more, cells->nodes, cells->hierarchy.node_count * sizeof *more);
        host->free(host, cells->nodes, cells->node_room * sizeof *more);
    }
    cells->nodes = more;
    cells->node_room = room;
    return 1;
}

// Into memory that fits.
static int nodes_trim(const cull_host *host, octree_cells *cells)
{
    const size_t count = cells->hierarchy.node_count;
    cull_node *fit = host->alloc(host, count * sizeof *fit, ALIGN);
    if (!fit) return 0;
    memcpy(fit, cells->nodes, count * sizeof *fit);
    host->free(host, cells->nodes, cells->node_room * sizeof *fit);
    cells->nodes = fit;
    cells->node_room = count;
    return 1;
}

// Longest way from the root, without recursion: the first child of a node stands after the last node of the level above.
static uint32_t depth_of(const octree_cells *cells)
{
    uint32_t depth = 1, last = 0; // the last node of this level
    for (uint32_t n = 0, next = 0; n < cells->hierarchy.node_count; n++) {
        const cull_node *node = &cells->nodes[n];
        if (node->child_count) next = node->first_child + node->child_count - 1;
        if (n < last || next <= n) continue;
        depth++;
        last = next;
    }
    return depth;
}

void cells_measure(const cull_zone *zone, octree_cells *cells)
{
    for (uint32_t n = cells->hierarchy.node_count; n-- > 0;) {
        cull_node *node = &cells->nodes[n];
        node->box = cull_box_none();
        for (uint32_t i = 0; i < node->item_count; i++)
            node->box = cull_box_union(node->box, cull_box_at(&zone->boxes, cells->order[node->first_item + i]));
        for (uint32_t c = 0; c < node->child_count; c++) node->box = cull_box_union(node->box, cells->nodes[node->first_child + c].box);
    }
    if (zone->item_count == 0) cells->nodes[0].box = (cull_box){{0, 0, 0}, {0, 0, 0}}; // boxes are finite
    cells->hierarchy.nodes = cells->nodes;
    cells->hierarchy.depth = depth_of(cells);
}

cull_result cells_build(const cull_host *host, const octree_source *from, octree_cells *out)
{
    octree_cells cells = {.kind = cells_kind_of(from->zone, from->wish.kind)};
    cells.order_bytes = (size_t)(from->zone->item_count ? from->zone->item_count : 1) * sizeof *cells.order;
    cells.order = host->alloc(host, cells.order_bytes, ALIGN);
    cull_result result = cells.order ? CULL_OK : CULL_ERR_MEMORY;
    if (result == CULL_OK) result = from->baked ? cells_load(host, from, &cells) : cells_divide(host, from->zone, from->wish.loose, &cells);
    if (result == CULL_OK && !nodes_trim(host, &cells)) result = CULL_ERR_MEMORY;
    if (result != CULL_OK) {
        cells_free(host, &cells);
        return result;
    }
    cells_measure(from->zone, &cells);
    *out = cells;
    return CULL_OK;
}

void cells_free(const cull_host *host, octree_cells *cells)
{
    if (cells->nodes) host->free(host, cells->nodes, cells->node_room * sizeof *cells->nodes);
    if (cells->order) host->free(host, cells->order, cells->order_bytes);
    memset(cells, 0, sizeof *cells);
}

size_t cells_bytes(const octree_cells *cells)
{
    return cells->node_room * sizeof *cells->nodes + cells->order_bytes;
}
