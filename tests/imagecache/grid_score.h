// What ways to find and order the cells in view come to, by the oracles of grid_camera.h: for tests and for measure_grid.
// SPDX-License-Identifier: MIT
#ifndef TESTS_IMAGECACHE_GRID_SCORE_H
#define TESTS_IMAGECACHE_GRID_SCORE_H

#include "grid_camera.h"
#include "plugins/imagecache/forms.h"
#include "plugins/imagecache/nodes.h"
#include "plugins/imagecache/rings.h"

typedef enum grid_way { GRID_RINGS, GRID_REPORT } grid_way; // the report's: thin border, single slope

enum { GRID_CELLS = 1 << 2 * GROUND_LEVELS_MOST };

typedef struct grid_score {
    uint64_t views, touched, kept, lost, extra; // cells over all views; touched, lost and extra by the oracle
    uint64_t views_lost, views_inverted;        // with at least one
    uint64_t rays, inversions;
    uint64_t disorder; // rings' cells that are not footprint_keeps' cells, or come twice
} grid_score;

typedef struct grid_bench { // memory for it
    ground ground;
    footprint print;
    forms_border border;
    grid_oracle oracle;
    rings rings;
    uint32_t *cells, *ranks; // near first; by cell: 1 + its place among them, 0 where it is not kept
    nodes_mark *marks;
    uint32_t *nodes;
    ground_cell *ray;
    uint32_t count;
} grid_bench;

void grid_bench_open(grid_bench *b, uint32_t level); // ends the program without memory
void grid_bench_close(grid_bench *b);

void grid_find(grid_bench *b, const grid_view *v, grid_way way);                       // cells and ranks
void grid_score_cells(const grid_bench *b, const grid_view *v, grid_score *s);         // against the oracle of touching
void grid_score_rings(grid_bench *b, const grid_view *v, grid_score *s);               // near first, far first and footprint_keeps against each other
void grid_score_rays(grid_bench *b, const grid_view *v, uint32_t rays, uint64_t *r, grid_score *s); // against the oracle of order
void grid_score_nodes(grid_bench *b, const grid_view *v, uint64_t *r, grid_score *s);  // some cells' nodes merged at random, against a ray

#endif
