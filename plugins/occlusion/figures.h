// What occlusion tells of itself as cull.figures/1.
// SPDX-License-Identifier: MIT
#ifndef OCCLUSION_FIGURES_H
#define OCCLUSION_FIGURES_H

#include "history.h"

// Those of the tree stay as they are; those of tests are added to when a viewer closes.
enum {
    FIGURE_NODES,
    FIGURE_DEPTH,
    FIGURE_UNITS,
    FIGURE_FRAMES,
    FIGURE_TESTS,
    FIGURE_WAITED,
    FIGURE_WASTED,
    FIGURE_UNANSWERED,
    FIGURE_AGE,
    FIGURE_OFF,
    FIGURE_RESTS,
    FIGURE_JOINT,
    FIGURE_JOINT_HITS,
    FIGURE_EARLY,
    FIGURE_TURNS,
    FIGURE_RECTANGLES,
    FIGURE_HIZ_ITEMS,
    FIGURE_HIZ_POLYGONS,
    FIGURE_PICTURES_TESTED,
    FIGURE_PICTURES_HIDDEN,
    FIGURE_CAPTURES_SAVED,
    FIGURE_COUNT
};
typedef struct occlusion_figures {
    cull_figures lent;
    cull_figure list[FIGURE_COUNT];
    double late_answers, age_sum, off_sum, turns;
} occlusion_figures;

void figures_begin(const occlusion_tree *tree, occlusion_figures *out); // *out must not move
void figures_add(occlusion_figures *f, const occlusion_counters *c);

#endif
