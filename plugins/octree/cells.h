// The octree (or quadtree) of a zone: loose cells over the items' centres (Ulrich, Loose Octrees, 2000), items in Morton order (1966).
// Inside the smallest cells nodes halve at medians (Bentley's k-d tree, 1975).
// SPDX-License-Identifier: MIT
//
// Invariant: a node is a run of the order: first its own items, then its children's one after the other. Every item stands in one
// node. Children come after their parent, side by side, and each holds fewer items than it. The boxes are tight: of the items.
#ifndef PORTCULLIS_OCTREE_CELLS_H
#define PORTCULLIS_OCTREE_CELLS_H

#include <portcullis/culler.h>

typedef enum octree_kind { OCTREE_OCT, OCTREE_QUAD, OCTREE_AUTO } octree_kind; // quad: cells divide x and z only

enum {
    OCTREE_LEAF_ITEMS = 8,    // a node of at most as many is not divided
    OCTREE_CELL_ITEMS = 256,  // a cell of at most as many is divided by medians: so blocks of 16 are full, as cells would not be
};

typedef struct octree_wish {
    octree_kind kind;
    double loose; // sizes of its cell that an item may reach over: more than 1
} octree_wish;

typedef struct octree_cells {
    cull_hierarchy hierarchy; // items NULL: nodes list runs of the order
    cull_node *nodes;
    uint32_t *order; // order[place] = item
    size_t node_room, order_bytes;
    octree_kind kind; // never OCTREE_AUTO
} octree_cells;

typedef struct octree_source {
    const cull_zone *zone;
    const cull_blob *baked; // by cells_save; NULL: there is none. The cells are the same bit for bit
    octree_wish wish;
} octree_source;

// [build] On failure nothing is left behind; cells_free of zeros is fine. O(n log n) for any input.
cull_result cells_build(const cull_host *host, const octree_source *from, octree_cells *out);
void cells_free(const cull_host *host, octree_cells *cells);
size_t cells_bytes(const octree_cells *cells);

// ---- Steps of it, each a file ----

// Which kind `auto` is: quad where the heights of centres spread a quarter as far as the wider of the other two, or less.
octree_kind cells_kind_of(const cull_zone *zone, octree_kind wish);

// What cells_divide and cells_load leave out: the boxes, the depth and the root of nothing.
void cells_measure(const cull_zone *zone, octree_cells *cells);

// Finds order and nodes. cells->order is there, of item_count; nodes are made.
cull_result cells_divide(const cull_host *host, const cull_zone *zone, double loose, octree_cells *cells);

uint64_t cells_save(const octree_cells *cells, const octree_wish *wish, void *blob, uint64_t size); // as cull_bake.save
// CULL_ERR_BLOB where it isn't what cells_save wrote for such a wish and as many items, or breaks the invariant.
cull_result cells_load(const cull_host *host, const octree_source *from, octree_cells *cells);

// Room for `needed` nodes, what is there kept. 0: no memory, nothing changed.
int cells_reserve(const cull_host *host, octree_cells *cells, size_t needed);

#endif
