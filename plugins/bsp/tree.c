// A tree's life: from a zone or a blob, its bytes, its end. See tree.h.
// SPDX-License-Identifier: MIT
//
// The slack: a vertex was rounded to float's steps, half a step a coordinate, so it lies within 0.87 steps of planes that it
// lay on; 2 steps where those are exact, 8 where they go through rounded vertices themselves (planes.c), and twice what any
// wall's vertex is found to lie off its own plane, where that is more (a zone cut from a larger scene has coarser steps).
#include "bake.h"
#include "build.h"

#include <stdio.h>
#include <string.h>

enum { PIECES_A_WALL = 16, PIECES_LEAST = 1 << 16 }; // made by cuts and counted with those cut; then sets become leaves as they are

static cull_result fail(const cull_host *host, cull_result result)
{
    static const char foreign[] = "bsp: the baked tree is not one of this zone with these options";
    static const char memory[] = "bsp: out of memory while the tree was built";
    host->log(host, CULL_LOG_ERROR, result == CULL_ERR_BLOB ? foreign : memory);
    return result;
}

// ---- From the zone ----

static cull_result maker_fill(tree_maker *m, uint32_t depth_most)
{
    m->nodes = vector_make(m->host, sizeof(bsp_node));
    m->leaves = vector_make(m->host, sizeof(bsp_leaf));
    m->filings = vector_make(m->host, sizeof(tree_filing));
    m->tasks = vector_make(m->host, sizeof(tree_task));
    m->lists = m->aside[0] = m->aside[1] = vector_make(m->host, sizeof(uint32_t));
    m->depth_most = depth_most;
    cull_result result = bsp_planes_make(m->host, m->zone, &m->table);
    if (result == CULL_OK) result = piece_set_make(m->host, m->zone, &m->table, &m->set);
    if (result == CULL_OK) result = chooser_make(m->host, &m->set, m->wish, &m->chooser);
    const uint64_t pieces_most = (uint64_t)PIECES_A_WALL * m->set.pieces.count + PIECES_LEAST;
    m->pieces_most = pieces_most < BSP_LEAF / 4 ? (uint32_t)pieces_most : BSP_LEAF / 4;
    if (result == CULL_OK) result = tree_divide(m);
    return result == CULL_OK ? tree_file_boxes(m) : result;
}

static cull_result tree_take(tree_maker *m, bsp_tree *out)
{
    int failed = 0;
    out->nodes = vector_copy(&m->nodes, &failed);
    out->leaves = vector_copy(&m->leaves, &failed);
    out->planes = vector_copy(&m->table.planes, &failed);
    out->node_count = m->nodes.count;
    out->leaf_count = m->leaves.count;
    out->plane_count = m->table.planes.count;
    out->node_boxes = array_alloc(m->host, out->node_count, sizeof *out->node_boxes, &failed);
    out->leaf_boxes = array_alloc(m->host, out->leaf_count, sizeof *out->leaf_boxes, &failed);
    out->order = array_alloc(m->host, out->item_count, sizeof *out->order, &failed);
    return failed ? CULL_ERR_MEMORY : tree_lay_out(m, out);
}

static void take_figures(const tree_maker *m, bsp_tree *out)
{
    out->steps_per_metre = m->table.steps_per_metre;
    out->slack = m->table.slack;
    out->depth = m->depth;
    out->splits = m->splits;
    out->bent_leaves = m->bent_leaves;
    out->boxed_walls = m->table.boxed_walls;
    out->classified = m->chooser.classified;
}

static void warn(const cull_host *host, const bsp_tree *tree)
{
    char line[160];
    if (!tree->boxed_walls) return;
    snprintf(line, sizeof line, "bsp: %u walls have no plane that fits their vertices and are kept by their boxes", (unsigned)tree->boxed_walls);
    host->log(host, CULL_LOG_WARN, line);
}

static cull_result from_zone(const cull_host *host, const bsp_source *from, uint32_t depth_most, bsp_tree *out)
{
    tree_maker m = {.host = host, .zone = from->zone, .wish = from->wish};
    bsp_tree tree = {.item_count = from->zone->item_count, .wish = from->wish};
    cull_result result = maker_fill(&m, depth_most);
    if (result == CULL_OK) result = tree_take(&m, &tree);
    if (result == CULL_OK) {
        take_figures(&m, &tree);
        tree_measure_boxes(from->zone, &tree);
        *out = tree;
    } else bsp_tree_free(host, &tree);
    tree_maker_free(&m);
    return result;
}

cull_result bsp_tree_build(const cull_host *host, const bsp_source *from, bsp_tree *out)
{
    const uint32_t wished = from->wish.max_leaf_depth, depth_most = wished && wished < BSP_DEPTH_MOST ? wished : BSP_DEPTH_MOST;
    bsp_tree tree;
    cull_result result = from->blob ? bsp_tree_load(host, from, &tree) : from_zone(host, from, depth_most, &tree);
    if (result == CULL_ERR_ZONE) {
        host->log(host, CULL_LOG_WARN, "bsp: too many items span too many leaves; the zone is kept as one leaf");
        result = from_zone(host, from, 0, &tree);
    }
    if (result != CULL_OK) return fail(host, result);
    warn(host, &tree);
    *out = tree;
    return CULL_OK;
}

// ---- Life ----

void bsp_tree_free(const cull_host *host, bsp_tree *tree)
{
    array_free(host, tree->planes, tree->plane_count, sizeof *tree->planes);
    array_free(host, tree->nodes, tree->node_count, sizeof *tree->nodes);
    array_free(host, tree->leaves, tree->leaf_count, sizeof *tree->leaves);
    array_free(host, tree->node_boxes, tree->node_count, sizeof *tree->node_boxes);
    array_free(host, tree->leaf_boxes, tree->leaf_count, sizeof *tree->leaf_boxes);
    array_free(host, tree->entries, tree->entry_count, sizeof *tree->entries);
    array_free(host, tree->points, tree->point_count, sizeof *tree->points);
    array_free(host, tree->order, tree->item_count, sizeof *tree->order);
    memset(tree, 0, sizeof *tree);
}

size_t bsp_tree_bytes(const bsp_tree *tree)
{
    return tree->plane_count * sizeof *tree->planes + tree->node_count * (sizeof *tree->nodes + sizeof *tree->node_boxes) +
           tree->leaf_count * (sizeof *tree->leaves + sizeof *tree->leaf_boxes) + tree->entry_count * sizeof *tree->entries +
           tree->point_count * sizeof *tree->points + tree->item_count * sizeof *tree->order;
}
