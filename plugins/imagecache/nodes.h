// The quadtree over the cells of a zone, and its exact order for nodes of mixed levels: at each node by the eye's side of the two lines that part
// it: the near quadrant, the two beside it, the one opposite.
// SPDX-License-Identifier: MIT
//
// Invariant: along any ray from the eye no node comes before one that hides it, for an eye inside or outside. Within a node: a ray crosses each
// of its two lines at most once and away from the eye, so it goes from the near quadrant through at most one of the two beside it to the one opposite.
#ifndef PORTCULLIS_IMAGECACHE_NODES_H
#define PORTCULLIS_IMAGECACHE_NODES_H

#include "ground.h"

// Level 0 is the root, level l the cells. Nodes of a level stand in Morton order, level after level; of all 4^level, whether the ground has them.
enum { NODES_STACK = 3 * GROUND_LEVELS_MOST + 1 };

static inline uint32_t nodes_first(uint32_t level) // of a level; also how many nodes stand above it
{
    return (((uint32_t)1 << 2 * level) - 1) / 3;
}

static inline uint32_t nodes_count(const ground *g)
{
    return nodes_first(g->level + 1);
}

static inline uint32_t nodes_parent(uint32_t node) // of any but the root
{
    return (node - 1) / 4;
}

static inline uint32_t nodes_child(uint32_t node, uint32_t quadrant) // bit 0: the greater side along x, bit 1: along z
{
    return 4 * node + 1 + quadrant;
}

uint32_t nodes_level(uint32_t node);
uint32_t nodes_of_cell(const ground *g, ground_cell c); // its node of level l

// The cells of a node: from `first`, `side` each way; some may lie beyond the ground.
typedef struct nodes_square {
    ground_cell first;
    int32_t side;
} nodes_square;
nodes_square nodes_square_of(const ground *g, uint32_t node);

// What is shown of the tree this frame, by node. Of a node's ancestors all are OPEN.
typedef uint8_t nodes_mark;
enum { NODES_SKIP = 0, NODES_OPEN = 1, NODES_TAKE = 2 };

// Marks TAKE on a cell's node and OPEN on all above it: O(1) a cell on the whole, as the way up ends where it is marked.
void nodes_take_cell(const ground *g, nodes_mark *marks, ground_cell c);

// SKIP again on the cell's node and all above it, whatever they were marked meanwhile. Told of every cell taken, it leaves no mark but SKIP.
void nodes_clear_cell(const ground *g, nodes_mark *marks, ground_cell c);

// The nodes marked TAKE, near first; read backwards: far first. Returns how many; out has room for all of them.
uint32_t nodes_in_order(const ground *g, const nodes_mark *marks, ground_cell eye, uint32_t *out);

#endif
