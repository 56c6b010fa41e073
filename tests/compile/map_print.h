// What must stay of a compiled map when it is turned, mirrored, moved or written in another order: counts, and prints of all
// polygons, zones and portals that depend on no number and no order.
// SPDX-License-Identifier: MIT
// Invariant: points are compared in the field of 2^61 - 1, turned back there: equal rational points are equal, others but by chance.
#ifndef PORTCULLIS_TESTS_MAP_PRINT_H
#define PORTCULLIS_TESTS_MAP_PRINT_H

#include "map_rewrite.h"

#include "host/compile/compile.h"

typedef struct map_counts {
    uint32_t polygons_in, polygons_csg, polygons_merged, polygons_traced, zones, zones_sealed, shells, portals, leak, t_junctions_inserted, triangles, weld_moves;
    uint32_t open_edges, t_junctions_left, degenerate_triangles; // have to be 0 in the second
} map_counts;

typedef struct print_list { // sorted
    uint64_t *prints;
    size_t count;
} print_list;

typedef struct map_print {
    map_counts counts;
    print_list merged;  // polygons of compile_csg: corners, sides, material
    print_list traced;  // those of compile_zones, with the print of their zone
    print_list portals; // with those of their two zones
    print_list labels;  // of zones, by entities in them and the zones next to them: holds without any point
    double max_move;
    double cpu_ms;      // of all stages
} map_print;

// Compiles the text, which must work; on the grid of whole units for POINTS_SCALED, of 1/256 for POINTS_ROUNDED.
map_print map_print_of(const char *text, size_t size, const map_rewrite *by, portal_choice choice);
void map_print_free(map_print *p);
// Names what differs, one word each, into the text; the count of them.
enum { DIFFERENCES_BYTES = 512 };
typedef enum print_depth { PRINT_ALL, PRINT_ZONES, PRINT_CHECKS } print_depth; // zones: how many, how they are joined, and the checks
int map_print_differences(const map_print *a, const map_print *b, print_depth depth, char out[DIFFERENCES_BYTES]);

#endif
