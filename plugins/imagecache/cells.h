// The cells of a zone: which items each lists, as runs of an order in which neighbours stand together (Morton, 1966).
// SPDX-License-Identifier: MIT
//
// Invariant: an item is listed in every closed cell whose column one of its triangles touches (triangles are not split; what its box alone says
// lists an item of boxes); a cell's box holds those triangles' parts in the column. Nothing is lost to rounding: it lists more.
#ifndef PORTCULLIS_IMAGECACHE_CELLS_H
#define PORTCULLIS_IMAGECACHE_CELLS_H

#include "ground.h"

enum {
    CELLS_LEVEL_AUTO = 255,
    CELLS_ITEMS = 8,           // items a cell lists about, where the level is found
    CELLS_COPIES_MOST = 4,     // listings an item, on the whole, at a level that was found
    CELLS_COPIES_ASKED = 64,   // and at one that was asked for: a coarser one is taken instead
    CELLS_LISTINGS_FREE = 4096, // listings that are never too many
};

// Places that a cell lists, all of one home: the cell among those that list an item in which it stands in the order.
typedef struct cells_run { uint32_t first, count, home; } cells_run;

typedef struct cells {
    ground ground;
    uint32_t *order;     // order[place] = item; by homes, those in Morton order
    uint32_t *firsts;    // cell count + 1, in runs
    cells_run *runs;     // of a cell ascending, apart or of two homes; all of a cell's own items are one of them
    cull_box *boxes;     // of the cells; min above max where nothing is listed
    cull_box *items;     // of the items, by place
    uint32_t item_count, cell_count, run_count;
    uint32_t used_count;   // cells that list something
    uint64_t listing_count;
    uint32_t level_asked;  // finer than ground.level where that listed too much
    size_t order_bytes, first_bytes, run_bytes, box_bytes, item_bytes; // allocated
} cells;

// [build] level: at most GROUND_LEVELS_MOST, or CELLS_LEVEL_AUTO. On failure nothing is left behind; cells_free of zeros is fine. O(triangles + listings)
// for each level that is tried.
cull_result cells_build(const cull_host *host, const cull_zone *zone, uint32_t level, cells *out);
void cells_free(const cull_host *host, cells *c);
size_t cells_bytes(const cells *c);

static inline int cells_is_empty(const cells *c, uint32_t cell)
{
    return c->firsts[cell] == c->firsts[cell + 1];
}

// ---- A step of it, a file of its own ----

// Cells first .. last of a row that something touches, and that something's own box.
typedef struct cells_touch {
    int32_t row;
    ground_range columns;
    cull_box box;
} cells_touch;

typedef struct cells_listener {
    void (*touch)(void *context, const cells_touch *touch);
    void *context;
} cells_listener;

// Says each row of cells that a triangle of the item (or its box) touches; a cell may be said often.
void cells_list_item(const ground *g, const cull_zone *zone, uint32_t item, const cells_listener *to);

#endif
