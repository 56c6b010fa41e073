// The index in numbers, for cull.figures/1.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_BSP_FIGURES_H
#define PORTCULLIS_BSP_FIGURES_H

#include "cells.h"
#include "walk.h"

enum { FIGURES_MOST = 16 };
typedef struct bsp_figures {
    cull_figures lent;
    cull_figure list[FIGURES_MOST];
} bsp_figures;

// [build] cells NULL: there are none.
void figures_fill(const bsp_tree *tree, const bsp_shapes *shapes, const bsp_walk *walk, const bsp_cells_data *cells, bsp_figures *out);

#endif
