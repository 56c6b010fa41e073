// What cullers tell of their indices (cull.figures/1), of all zones together.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_BENCH_FIGURES_H
#define PORTCULLIS_BENCH_FIGURES_H

#include "../host/core/chain.h"

enum { FIGURES_MOST = 32, FIGURE_NAME_BYTES = 48 };

typedef struct bench_figure {
    char name[FIGURE_NAME_BYTES]; // "bsp.nodes"
    double value;
} bench_figure;

typedef struct bench_figures {
    bench_figure list[FIGURES_MOST];
    uint32_t count;
} bench_figures;

// Of all stages of a zone's chain. What is no word or no number, and what there is no room for, is left out.
void figures_add_chain(bench_figures *figures, const chain *c);

#endif
