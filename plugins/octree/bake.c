// The baked octree: the order of items and the nodes without their boxes, which are the zone's own.
// SPDX-License-Identifier: MIT
// Invariant: what is loaded keeps the invariant of cells.h whatever the bytes are; anything else is CULL_ERR_BLOB, never used.
#include "cells.h"

#include <string.h>

typedef struct baked_head {
    char magic[8];
    uint32_t byte_order, item_count, node_count, kind;
    double loose;
    uint64_t check; // of all behind the head
} baked_head;

typedef struct baked_node { uint32_t item_count, child_count, subtree_count; } baked_node;

static const char MAGIC[8] = {'o', 'c', 't', 'r', 'e', 'e', '0', '1'};
enum { BYTE_ORDER_MARK = 0x01020304 };

// Fowler, Noll and Vo's hash 1a, four bytes at a time: each step can be undone, so no single wrong word goes unseen.
static uint64_t check_add(uint64_t hash, const void *bytes, size_t size)
{
    for (size_t i = 0; i + sizeof(uint32_t) <= size; i += sizeof(uint32_t)) {
        uint32_t word;
        memcpy(&word, (const char *)bytes + i, sizeof word);
        hash = (hash ^ word) * 0x100000001b3u;
    }
    return hash;
}

static const uint64_t CHECK_START = 0xcbf29ce484222325u;

uint64_t cells_save(const octree_cells *cells, const octree_wish *wish, void *blob, uint64_t size)
{
    const uint32_t node_count = cells->hierarchy.node_count, item_count = cells->nodes[0].subtree.count;
    const size_t order_bytes = item_count * sizeof *cells->order, bytes = order_bytes + node_count * sizeof(baked_node);
    if (size < sizeof(baked_head) + bytes) return sizeof(baked_head) + bytes;
    char *const body = (char *)blob + sizeof(baked_head), *const nodes = body + order_bytes;
    if (order_bytes) memcpy(body, cells->order, order_bytes);
    for (uint32_t n = 0; n < node_count; n++) {
        const cull_node *from = &cells->nodes[n];
        const baked_node node = {from->item_count, from->child_count, from->subtree.count};
        memcpy(nodes + n * sizeof node, &node, sizeof node);
    }
    baked_head head = {{0}, BYTE_ORDER_MARK, item_count, node_count, (uint32_t)cells->kind, wish->loose, check_add(CHECK_START, body, bytes)};
    memcpy(head.magic, MAGIC, sizeof head.magic);
    memcpy(blob, &head, sizeof head);
    return sizeof head + bytes;
}

// ---- Loading ----

static int head_fits(const baked_head *head, const octree_source *from, octree_kind kind)
{
    return memcmp(head->magic, MAGIC, sizeof head->magic) == 0 && head->byte_order == BYTE_ORDER_MARK &&
           head->item_count == from->zone->item_count && head->kind == (uint32_t)kind && head->loose == from->wish.loose && head->node_count > 0;
}

static int is_permutation(const uint32_t *order, uint32_t count, uint8_t *seen)
{
    memset(seen, 0, count);
    for (uint32_t i = 0; i < count; i++) {
        if (order[i] >= count || seen[order[i]]) return 0;
        seen[order[i]] = 1;
    }
    return 1;
}

// A node's children, which come next in the list: they take what its own items leave, to the last one.
static int children_fit(octree_cells *cells, uint32_t n, const baked_node *baked, uint32_t next, uint8_t *depths)
{
    cull_node *const node = &cells->nodes[n];
    const uint32_t count = node->subtree.count;
    if (baked[n].item_count > count || baked[n].child_count > cells->hierarchy.node_count - next) return 0;
    uint32_t left = count - baked[n].item_count, first = node->subtree.first + baked[n].item_count;
    node->first_item = node->subtree.first;
    node->item_count = baked[n].item_count;
    node->child_count = baked[n].child_count;
    node->first_child = node->child_count ? next : 0;
    for (uint32_t c = next; c < next + node->child_count; c++) {
        const uint32_t items = baked[c].subtree_count;
        if (items == 0 || items > left || items == count) return 0;
        cells->nodes[c].subtree = (cull_run){first, items};
        depths[c] = (uint8_t)(depths[n] + 1);
        first += items;
        left -= items;
    }
    return left == 0 && (node->child_count == 0 || depths[n] < 255);
}

static int nodes_fit(octree_cells *cells, const baked_node *baked, uint32_t item_count, uint8_t *depths)
{
    uint32_t next = 1;
    if (baked[0].subtree_count != item_count) return 0;
    cells->nodes[0].subtree = (cull_run){0, item_count};
    depths[0] = 0;
    for (uint32_t n = 0; n < cells->hierarchy.node_count; n++) {
        if (!children_fit(cells, n, baked, next, depths)) return 0;
        next += cells->nodes[n].child_count;
        if (next <= n + 1 && n + 1 < cells->hierarchy.node_count) return 0; // a node that nobody is the parent of
    }
    return next == cells->hierarchy.node_count;
}

static cull_result load_with(const octree_source *from, const baked_head *head, void *room, octree_cells *cells)
{
    const char *const body = (const char *)from->baked->bytes + sizeof *head;
    const size_t order_bytes = head->item_count * sizeof *cells->order, node_bytes = head->node_count * sizeof(baked_node);
    if (check_add(CHECK_START, body, order_bytes + node_bytes) != head->check) return CULL_ERR_BLOB;
    if (order_bytes) memcpy(cells->order, body, order_bytes);
    if (!is_permutation(cells->order, head->item_count, room)) return CULL_ERR_BLOB;
    memcpy(room, body + order_bytes, node_bytes);
    memset(cells->nodes, 0, head->node_count * sizeof *cells->nodes);
    cells->hierarchy.node_count = head->node_count;
    return nodes_fit(cells, room, head->item_count, (uint8_t *)room + node_bytes) ? CULL_OK : CULL_ERR_BLOB;
}

cull_result cells_load(const cull_host *host, const octree_source *from, octree_cells *cells)
{
    baked_head head;
    const cull_blob *baked = from->baked;
    if (!baked->bytes || baked->size < sizeof head) return CULL_ERR_BLOB;
    memcpy(&head, baked->bytes, sizeof head);
    if (!head_fits(&head, from, cells->kind)) return CULL_ERR_BLOB;
    const size_t order_bytes = head.item_count * sizeof *cells->order, node_bytes = head.node_count * sizeof(baked_node);
    if (baked->size != sizeof head + order_bytes + node_bytes) return CULL_ERR_BLOB; // before anything is asked for in such sizes
    if (!cells_reserve(host, cells, head.node_count)) return CULL_ERR_MEMORY;
    const size_t room_bytes = node_bytes + head.node_count + head.item_count;
    void *room = host->alloc(host, room_bytes, _Alignof(baked_node));
    if (!room) return CULL_ERR_MEMORY;
    const cull_result result = load_with(from, &head, room, cells);
    host->free(host, room, room_bytes);
    return result;
}
