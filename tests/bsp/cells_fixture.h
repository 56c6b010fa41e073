// Zones for tests of the cells: from maps by the whole compiler, from walls made by hand; and segments walked through the cells.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_CELLS_FIXTURE_H
#define PORTCULLIS_TESTS_CELLS_FIXTURE_H

#include "host/core/zone_data.h"
#include "plugins/bsp/cells.h"
#include "tests/common/failing_allocator.h"
#include "tests/compile/whole_fixture.h"

// ---- The host ----

typedef struct cells_host {
    cull_host host;
    failing_allocator counted;
    char last_log[256];
    uint32_t logs;
} cells_host;
void cells_host_init(cells_host *h, uint64_t fail_at);

// ---- A compiled map ----

typedef struct cells_map {
    whole whole;
    zone_data *zones; // scene.zone_count of them
} cells_map;
// 0: the file isn't there, with a line on stderr. Aborts when it doesn't compile.
int cells_map_open(const char *name, portal_choice portals, cells_map *out);
void cells_map_close(cells_map *m);
const zone_data *cells_map_largest(const cells_map *m); // by items

// ---- Zones made by hand ----

enum { HAND_MOST = 40000 };
typedef struct hand_zone { // positions in float, planes in double rounded to float, no exact ones
    cull_zone zone;
    cull_item *items;
    cull_wall *walls;
    cull_vec3 *positions;
    uint32_t *wall_vertices, *indices;
    cull_plane *planes;
    float *rows[6];
    cull_portal portals[16];
    cull_vec3 portal_points[16][16];
} hand_zone;
void hand_zone_init(hand_zone *z);
// A wall, counterclockwise from its front; a plane of its own.
void hand_zone_wall(hand_zone *z, const cull_vec3 *points, uint32_t count, uint32_t flags);
void hand_zone_cluster(hand_zone *z, cull_box box);
void hand_zone_portal(hand_zone *z, const cull_vec3 *points, uint32_t count);
typedef enum hand_face { FACE_IN, FACE_OUT } hand_face; // where the walls of a box show their front
void hand_zone_box(hand_zone *z, cull_box box, hand_face face, uint32_t flags);
void hand_zone_end(hand_zone *z); // boxes, radius
void hand_zone_free(hand_zone *z);

// ---- Built ----

typedef struct cells_built {
    cells_host host;
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
