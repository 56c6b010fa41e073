// One tracing of the surface: cut by portals, its lines, shells and regions; and what is made of it.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_ZONE_TRACE_H
#define PORTCULLIS_HOST_ZONE_TRACE_H

#include "islands.h"
#include "portals.h"

typedef struct zone_trace {
    surface s;
    line_set lines;
    shell_set shells;
    ray_space rays;
    region_set regions;
    int stages; // how many of the above are made
} zone_trace;

typedef struct trace_input {
    const compile_input *in;
    const compile_mesh *mesh;
    const portal_set *portals;
    const uint8_t *seals; // by polygon of the mesh; NULL: none
} trace_input;
result zone_trace_make(const trace_input *from, const allocator *memory, zone_trace *out);
void zone_trace_free(zone_trace *t); // of zeros is fine
uint32_t zone_trace_region(const zone_trace *t, uint32_t face); // of a wall's front, a portal's side; REGION_VOID

#define ZONE_NONE UINT32_MAX

// zone_places.c: point entities in regions, regions numbered as zones: reached ones in the order of the entities first.
typedef struct zone_places {
    const allocator *memory;
    uint32_t *region_of;    // by entity: also REGION_SOLID, REGION_VOID; REGION_NOT_PLACED
    uint32_t *zone_of;      // by region
    uint32_t entity_count, region_count;
    uint32_t leaking;       // the first entity in the void, or ZONE_NONE
} zone_places;
#define REGION_NOT_PLACED (UINT32_MAX - 2)
result zone_places_make(const compile_input *in, zone_trace *t, const allocator *memory, zone_places *out);
void zone_places_free(zone_places *p); // of zeros is fine
void zone_place_point(const compile_input *in, const compile_entity *e, int32_t out[3]); // its origin on the grid
result zone_places_name(const compile_input *in, const zone_places *p, report *r, compiled_zones *z); // fills z->zones

// t_junctions.c: the surface back into z->mesh, every vertex of a line in all edges that run over it; polygon_zone, portals.
// ZONES_OPEN: all polygons into zone 0, no portals.
typedef enum zone_shape { ZONES_CLOSED, ZONES_OPEN } zone_shape;
result zone_emit(const zone_trace *t, ray_space *rays, const zone_places *p, zone_shape shape, compiled_zones *z);

// leak.c
result leak_line_make(const compile_input *in, zone_trace *t, uint32_t entity, const allocator *memory, compiled_zones *z);

#endif
