// An oracle of zones: a BSP of the brushes down to convex cells, exact, and a flood fill over the cells' common faces.
// SPDX-License-Identifier: MIT
// Slow and simple; shares with the compiler only the plane table and the cut of a convex polygon.
#ifndef PORTCULLIS_TESTS_ORACLE_BSP_H
#define PORTCULLIS_TESTS_ORACLE_BSP_H

#include "host/compile/compile.h"

typedef struct oracle_zones {
    uint32_t regions; // of air, without the void
    uint32_t reached; // of them those that a point entity stands in
    uint32_t leak;    // a point entity stands in the void
    uint32_t cells;
} oracle_zones;

// Asserts on failure; liquids are open.
void oracle_bsp(const compile_input *in, oracle_zones *out);

#endif
