// Scenes with zones for tests: short ways to add zones and portals, and random scenes of nested, turned zones.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_ZONE_SCENE_H
#define PORTCULLIS_TESTS_ZONE_SCENE_H

#include "tests/core/builder_fixture.h"

typedef struct zone_box { double min[3], max[3]; } zone_box;

void box_planes(const zone_box *box, scene_solid_plane planes[6]);
// A zone of one box. parent may be SCENE_NONE.
result add_box_zone(scene_builder *b, const char *name, const zone_box *box, uint32_t parent, uint32_t *out);
result add_everywhere(scene_builder *b, const char *name, uint32_t *out);
// A rectangle across x = at, over [low, high] in y and z.
typedef struct door_hole { double x, low[2], high[2]; uint32_t zones[2]; } door_hole;
result add_hole(scene_builder *b, const door_hole *hole, uint32_t *out, const char **fault);
// A flat quadrilateral wall item with its loop and plane; corners counterclockwise from the front.
result add_wall(scene_builder *b, const double corners[4][3]);

typedef enum zone_outside { OUTSIDE_NONE, OUTSIDE_FIRST, OUTSIDE_LAST } zone_outside;
typedef struct zone_scene {
    uint32_t zones, items; // zones of one or two hulls, a third of them in another
    uint64_t seed;
    double at[3]; // whole metres move it without any other change
    zone_outside outside;
} zone_scene;
result zone_scene_fill(scene_builder *b, const zone_scene *z);
result zone_scene_make(const zone_scene *z, const allocator *memory, report *r, scene **out);

#endif
