// The index in numbers: see figures.h.
// SPDX-License-Identifier: MIT
#include "figures.h"

#include <string.h>

static void add(bsp_figures *out, const char *name, double value, cull_figure_sort sort)
{
    out->list[out->lent.count++] = (cull_figure){name, value, sort, 0};
}

void figures_fill(const bsp_tree *tree, const bsp_shapes *shapes, const bsp_walk *walk, const bsp_cells_data *cells, bsp_figures *out)
{
    memset(out, 0, sizeof *out);
    out->lent.figures = out->list;
    add(out, "nodes", tree->node_count, CULL_FIGURE_SUM);
    add(out, "leaves", tree->leaf_count, CULL_FIGURE_SUM);
    add(out, "depth", tree->depth, CULL_FIGURE_MAX);
    add(out, "splits", tree->splits, CULL_FIGURE_SUM);
    add(out, "listings", tree->entry_count, CULL_FIGURE_SUM);
    add(out, "items_spanning", tree->spanning, CULL_FIGURE_SUM);
    add(out, "walk_nodes", walk->node_count, CULL_FIGURE_SUM);
    add(out, "walk_depth", walk->depth, CULL_FIGURE_MAX);
    add(out, "walls_bent", shapes->bent_count, CULL_FIGURE_SUM);
    if (!cells) return;
    add(out, "cells", cells->cell_count, CULL_FIGURE_SUM);
    add(out, "openings", cells->opening_count, CULL_FIGURE_SUM);
    add(out, "openings_doubtful", cells->doubtful, CULL_FIGURE_SUM);
}
