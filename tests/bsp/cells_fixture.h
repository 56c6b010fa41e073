// For tests of the cells: zones from maps by the whole compiler, cells built, segments walked through them.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_CELLS_FIXTURE_H
#define PORTCULLIS_TESTS_CELLS_FIXTURE_H

#include "host/core/zone_data.h"
#include "plugins/bsp/cells.h"
#include "tests/common/culler_host.h"
#include "tests/common/hand_zone.h"
#include "tests/compile/whole_fixture.h"

// ---- A compiled map ----

typedef struct cells_map {
    whole whole;
    zone_data *zones; // scene.zone_count of them
} cells_map;
// 0: the file isn't there, with a line on stderr. Aborts when it doesn't compile.
int cells_map_open(const char *name, portal_choice portals, cells_map *out);
void cells_map_close(cells_map *m);
const zone_data *cells_map_largest(const cells_map *m); // by items

// ---- Built ----

typedef struct cells_built {
    culler_host host;
    bsp_tree tree;
    bsp_cells_data cells;
} cells_built;
void cells_built_make(cells_built *b, const cull_zone *zone); // aborts when a build fails
int cells_built_free(cells_built *b);                         // 1: all memory came back
uint64_t cells_hash(const bsp_cells_data *c, const uint32_t *order); // of all bytes, items by their numbers in the zone

// ---- Segments ----

typedef struct segment { double from[3], to[3]; } segment;
typedef struct crossing { double at; uint32_t from, to, node, side; } crossing; // side: the eye's
enum { CROSSINGS_MOST = 4096 };
typedef struct segment_walk { crossing crossings[CROSSINGS_MOST]; uint32_t count; } segment_walk;
// The cells along the segment, by the nodes alone. 0: too many.
int segment_walk_make(const bsp_cells_data *c, const segment *s, segment_walk *out);
uint32_t cell_of(const bsp_cells_data *c, const double p[3]);

// How far the point lies from the polygon's nearest edge, positive inside; the polygon lies in the plane.
double polygon_depth(const cull_point *points, uint32_t count, const double normal[3], const double p[3]);
// The opening that the crossing goes through; NULL: none within `slack`.
const bsp_opening *opening_of(const bsp_cells_data *c, const crossing *x, const double p[3], double slack);

#endif
