// The property that cells live by, tried on segments: where no wall hides, the way is open. Walls are looked up by brute force in a
// grid of lists, openings by the cells that the nodes alone tell.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_CELLS_SIGHT_H
#define PORTCULLIS_TESTS_CELLS_SIGHT_H

#include "cells_fixture.h"

typedef struct sight_figures {
    uint64_t segments, crossings, open, shut;
    uint64_t lost;        // shut, and no wall hides within 3 slack of the point: must be 0
    uint64_t grazed;      // shut, and a wall hides within 3 slack but not at the point
    uint64_t leaky;       // open, though a wall hides there, from a cell that is reached from the zone's portals
    uint64_t beyond;      // the same through a portal: air of the zone lies behind, or may
    uint64_t inside;      // cells that are
    uint64_t outside;     // leave the box of the openings: not judged
    segment lost_segment; // the last lost one
    double lost_at[3];
} sight_figures;

// A third of the segments between points anywhere, a third from in front of walls, a third along walls within 1e-6 m of their planes.
void sight_check(const cull_zone *zone, const bsp_tree *tree, const bsp_cells_data *cells, uint64_t segments, uint64_t seed, sight_figures *out);
void sight_print(const sight_figures *f);

#endif
