// Dividing a zone into cells: see cells.h.
// SPDX-License-Identifier: MIT
// Invariant: nodes are divided in the order that they stand in, and a node reorders its own run only. Cells that hold all of their
// parent's items are passed over, so a node's children hold fewer; where a frame's finest cell holds too many, a new frame is laid in it.
#include "codes.h"

#include <string.h>

typedef enum node_rule { BY_CELL, BY_COUNT } node_rule; // by count: what no cell tells apart

typedef struct open_node { // beside each cull_node
    uint32_t level; // of its cell in the frame that its items' codes are of
    node_rule rule;
} open_node;

typedef struct divider {
    const cull_host *host;
    code_frame frame;
    coded_item *items, *spare;
    open_node *open;
    size_t open_room;
    octree_cells *cells;
} divider;

static int reserve(divider *d, size_t needed)
{
    if (!cells_reserve(d->host, d->cells, needed)) return 0;
    if (needed <= d->open_room) return 1;
    const size_t room = d->cells->node_room;
    open_node *more = d->host->alloc(d->host, room * sizeof *more, _Alignof(open_node));
    if (!more) return 0;
    if (d->open) {
        memcpy(more, d->open, d->open_room * sizeof *more);
        d->host->free(d->host, d->open, d->open_room * sizeof *more);
    }
    d->open = more;
    d->open_room = room;
    return 1;
}

static void node_add(divider *d, cull_run run, open_node how)
{
    const uint32_t n = d->cells->hierarchy.node_count++;
    d->cells->nodes[n] = (cull_node){.first_item = run.first, .item_count = run.count, .subtree = run};
    d->open[n] = how;
}

// The level at which the run comes apart: an item is too large to go on, or centres lie in two cells. CODE_LEVELS: nowhere.
static uint32_t parting(const divider *d, cull_run run, uint32_t level)
{
    const coded_item *items = d->items + run.first;
    const uint32_t bits = code_bits(d->frame.kind);
    uint32_t part = CODE_LEVELS;
    const uint64_t differ = items[0].code ^ items[run.count - 1].code; // sorted: all others agree where these do
    while (part > level && differ >> (CODE_LEVELS - part) * bits) part--;
    for (uint32_t i = 0; i < run.count; i++)
        if (items[i].level < part) part = items[i].level;
    return part > level ? part : level;
}

// Items too large for the cells below come first, otherwise the order stays. Returns how many they are.
static uint32_t large_first(divider *d, cull_run run, uint32_t level)
{
    coded_item *items = d->items + run.first;
    uint32_t large = 0, small = 0;
    for (uint32_t i = 0; i < run.count; i++) {
        if (items[i].level <= level) items[large++] = items[i];
        else d->spare[small++] = items[i];
    }
    memcpy(items + large, d->spare, small * sizeof *items);
    return large;
}

static uint64_t cell_of(const divider *d, uint32_t place, uint32_t level)
{
    return d->items[place].code >> (CODE_LEVELS - level) * code_bits(d->frame.kind);
}

// One child for each cell of the level that holds some of the run, which is sorted.
static void add_cells(divider *d, cull_run run, uint32_t level)
{
    const uint32_t end = run.first + run.count;
    for (uint32_t first = run.first, i = run.first; i < end; i++) {
        if (i + 1 < end && cell_of(d, i + 1, level) == cell_of(d, i, level)) continue;
        node_add(d, (cull_run){first, i + 1 - first}, (open_node){level, BY_CELL});
        first = i + 1;
    }
}

static void add_even(divider *d, cull_run run)
{
    for (uint32_t i = 0; i < 8; i++) {
        const uint32_t from = (uint32_t)((uint64_t)run.count * i / 8), to = (uint32_t)((uint64_t)run.count * (i + 1) / 8);
        if (to > from) node_add(d, (cull_run){run.first + from, to - from}, (open_node){CODE_LEVELS, BY_COUNT});
    }
}

// The large ones: the node's own, or, if many, under a child of their own.
static void keep_large(divider *d, uint32_t n, uint32_t large)
{
    const cull_run all = d->cells->nodes[n].subtree;
    if (large == all.count) {
        d->cells->nodes[n].item_count = 0;
        add_even(d, all);
        return;
    }
    d->cells->nodes[n].item_count = large <= OCTREE_LEAF_ITEMS ? large : 0;
    if (large > OCTREE_LEAF_ITEMS) node_add(d, (cull_run){all.first, large}, (open_node){CODE_LEVELS, BY_COUNT});
}

// Two children, cut at the median of the axis along which centres spread most, at a whole number of blocks where there are several.
static void add_halves(divider *d, uint32_t n)
{
    const cull_run run = d->cells->nodes[n].subtree;
    const uint32_t unit = run.count > 2 * OCTREE_LEAF_ITEMS ? 2 * OCTREE_LEAF_ITEMS : OCTREE_LEAF_ITEMS, units = (run.count + unit - 1) / unit;
    const uint32_t left = units / 2 * unit;
    codes_sort_widest(&d->frame, d->items + run.first, d->spare, run.count);
    d->cells->nodes[n].item_count = 0;
    node_add(d, (cull_run){run.first, left}, (open_node){CODE_LEVELS, BY_COUNT});
    node_add(d, (cull_run){run.first + left, run.count - left}, (open_node){CODE_LEVELS, BY_COUNT});
    d->cells->nodes[n].child_count = 2;
}

static void divide(divider *d, uint32_t n)
{
    const cull_run run = d->cells->nodes[n].subtree;
    open_node how = d->open[n];
    if (run.count <= OCTREE_LEAF_ITEMS) return;
    d->cells->nodes[n].first_child = d->cells->hierarchy.node_count;
    if (run.count <= OCTREE_CELL_ITEMS) {
        add_halves(d, n);
        return;
    }
    if (how.rule == BY_CELL) how.level = parting(d, run, how.level);
    if (how.rule == BY_CELL && how.level == CODE_LEVELS) {
        if (codes_make(&d->frame, d->items + run.first, d->spare, run.count)) how.level = 0; // a new frame comes apart at once
        else how.rule = BY_COUNT;
    }
    const uint32_t large = how.rule == BY_COUNT ? run.count : large_first(d, run, how.level);
    keep_large(d, n, large);
    if (large < run.count) add_cells(d, (cull_run){run.first + large, run.count - large}, how.level + 1);
    d->cells->nodes[n].child_count = d->cells->hierarchy.node_count - d->cells->nodes[n].first_child;
}

static int divide_all(divider *d, uint32_t count)
{
    if (!reserve(d, 1)) return 0;
    for (uint32_t i = 0; i < count; i++) d->items[i] = (coded_item){0, i, 0};
    // The whole zone has no frame yet: a run of the finest cell gets one.
    node_add(d, (cull_run){0, count}, (open_node){CODE_LEVELS, BY_CELL});
    for (uint32_t n = 0; n < d->cells->hierarchy.node_count; n++) {
        if (!reserve(d, (size_t)d->cells->hierarchy.node_count + 9)) return 0;
        divide(d, n);
    }
    for (uint32_t i = 0; i < count; i++) d->cells->order[i] = d->items[i].item;
    return 1;
}

cull_result cells_divide(const cull_host *host, const cull_zone *zone, double loose, octree_cells *cells)
{
    divider d = {.host = host, .frame = {&zone->boxes, cells->kind, loose}, .cells = cells};
    const size_t bytes = (zone->item_count ? zone->item_count : 1) * sizeof *d.items;
    d.items = host->alloc(host, bytes, _Alignof(coded_item));
    d.spare = host->alloc(host, bytes, _Alignof(coded_item));
    const int done = d.items && d.spare && divide_all(&d, zone->item_count);
    if (d.items) host->free(host, d.items, bytes);
    if (d.spare) host->free(host, d.spare, bytes);
    if (d.open) host->free(host, d.open, d.open_room * sizeof *d.open);
    return done ? CULL_OK : CULL_ERR_MEMORY;
}
