// The built tree of a zone: planes in nodes, walls in leaves, each wall whole in every leaf that a piece of it reaches (non-splitting
// leaf BSP; Fuchs, Kedem and Naylor, On Visible Surface Generation by A Priori Tree Structures, 1980).
// SPDX-License-Identifier: MIT
//
// Invariant: flat arrays, constant once built; a child comes after its parent; item numbers are places in the order that the
// build gave the host; child 0 lies in front of the plane, child 1 behind; pieces of one wall overlap nowhere and cover it.
#ifndef PORTCULLIS_BSP_TREE_H
#define PORTCULLIS_BSP_TREE_H

#include <portcullis/box.h>
#include <portcullis/clip.h>
#include <portcullis/culler.h>
#include <portcullis/exact.h>
#include <portcullis/plane.h>

#define BSP_LEAF 0x80000000u // a child with this bit is a leaf: the rest is its number
#define BSP_NONE 0xffffffffu

typedef enum bsp_split { BSP_WHOLE, BSP_SPLIT_LEAVES, BSP_SPLIT_NODES } bsp_split;       // option split=0|1|node
typedef enum bsp_choose { BSP_BALANCE, BSP_SAH, BSP_FIRST } bsp_choose;                 // option choose=
typedef enum bsp_cells { BSP_CELLS_OFF, BSP_CELLS_RECT, BSP_CELLS_HULL, BSP_CELLS_EXACT } bsp_cells; // option cells=

typedef struct bsp_wish { bsp_split split; bsp_choose choose; uint32_t max_leaf_depth, reserved; } bsp_wish; // 0: no limit

// Exact planes are in grid steps from the zone's origin, |point| <= 2^24 steps. Where the zone tells its walls' exact planes they are
// these; else (float scenes) a plane goes through three of the wall's vertices, rounded to the grid. All sides are decided by `exact`.
typedef struct bsp_plane {
    cull_wide_plane exact;
    double normal[3], offset; // the same, a unit normal, metres: height = normal . p + offset, positive in front
} bsp_plane;

typedef struct bsp_node {
    uint32_t plane, child[2], parent; // parent: BSP_NONE for the root
    uint32_t first_entry, entry_count; // split=node: the pieces that lie in the plane, by item; else none
} bsp_node;

typedef struct bsp_leaf {
    uint32_t parent;                   // BSP_NONE: the leaf is the whole tree
    uint32_t first_entry, entry_count; // walls' pieces, each in front of all others of the leaf, by item; then, by item, what is filed by its box
} bsp_leaf;

// A wall's piece in a leaf or node, or an item that is no wall, filed by its box (point_count 0). One entry an item a leaf.
typedef struct bsp_entry { uint32_t item, first_point, point_count, plane; } bsp_entry; // plane: of the wall, in planes; front: its face

typedef struct bsp_tree {
    bsp_plane *planes;
    bsp_node *nodes;       // none: the tree is leaf 0
    bsp_leaf *leaves;
    cull_box *node_boxes;  // of all items under the node, whole items, so that a wall is found by any leaf that lists it
    cull_box *leaf_boxes;  // of the PIECES' owners in the leaf; an empty leaf: min = +FLT_MAX, max = -FLT_MAX
    bsp_entry *entries;
    cull_point *points;    // of pieces, metres from the zone's origin, counterclockwise from the wall's front
    uint32_t *order;       // cull_built.order
    double steps_per_metre;
    double slack;          // metres: a vertex within this of a plane lies on it; the rounding of positions to float, see tree.c
    uint32_t plane_count, node_count, leaf_count, entry_count, point_count, item_count;
    bsp_wish wish; // that it was built for
    uint32_t depth, splits, spanning; // figures for the bench: longest way in nodes, cuts made, items listed more than once
    uint32_t bent_leaves;             // leaves that a limit stopped before they were convex; right for select, not for an order
    uint32_t boxed_walls;             // walls without a usable plane, filed by their boxes
    uint64_t classified;              // pieces held against planes while building; 0 of a tree from a blob
} bsp_tree;
// A leaf's pieces are convex together: each lies in front of (or on) all others, facing as they do where it lies on. So from any eye the
// pieces that show their front hide none of each other, and those that show their back none of each other, but hide the former.
// All three values of `split` keep the pieces; WHOLE and SPLIT_LEAVES give the same tree, and differ in what is drawn of it.

// Builds from the zone, or from the blob where one is given (CULL_ERR_BLOB when it does not fit). On failure a line is logged and nothing is left.
typedef struct bsp_source { const cull_zone *zone; const cull_blob *blob; bsp_wish wish; } bsp_source;
cull_result bsp_tree_build(const cull_host *host, const bsp_source *from, bsp_tree *out);
void bsp_tree_free(const cull_host *host, bsp_tree *tree); // of zeros is fine
uint64_t bsp_tree_save(const bsp_tree *tree, void *blob, uint64_t size); // bytes needed; writes when they fit
size_t bsp_tree_bytes(const bsp_tree *tree);

#endif
