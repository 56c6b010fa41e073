// Small scenes of boxes and point entities for the tests of zones.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_ZONES_FIXTURE_H
#define PORTCULLIS_TESTS_ZONES_FIXTURE_H

#include "csg_fixture.h"
#include "oracle_bsp.h"

enum { ENTITIES_MOST = 64, UNIT = 256 }; // UNIT: steps

typedef struct zone_scene {
    scene_draft draft;
    compile_entity entities[ENTITIES_MOST];
    uint32_t entity_count;
    compile_input in; // of zone_scene_end
} zone_scene;

void zone_scene_begin(zone_scene *s);
// Units. Air in a box: a brush that takes away.
void zone_scene_box(zone_scene *s, brush_kind kind, int x, int y, int z, int dx, int dy, int dz);
void zone_scene_hollow(zone_scene *s, int x, int y, int z, int dx, int dy, int dz); // a box less a box, walls of 8 units
// The brushes from here on belong to an entity of that class.
void zone_scene_brushes_of(zone_scene *s, const char *class_name, brush_role role);
void zone_scene_point(zone_scene *s, const char *class_name, double x, double y, double z); // units
void zone_scene_end(zone_scene *s); // bounds of brushes; s->in is ready
void zone_scene_free(zone_scene *s);

compiled_zones *zones_of(const compile_input *in, portal_choice choice, report *r); // asserts that it works
uint32_t zones_reached(const compiled_zones *z);
uint32_t t_junctions_left(const compile_input *in, const compile_mesh *m); // by looking at every vertex against every edge
uint32_t open_edges(const compile_input *in, const compiled_zones *z);     // directed edges of walls without their reverse
uint32_t polygons_in_zone(const compiled_zones *z, uint32_t zone);

#endif
