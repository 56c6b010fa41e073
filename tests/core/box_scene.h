// Scenes for tests: boxes strewn by a seed, one item each, some of them movers.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_BOX_SCENE_H
#define PORTCULLIS_TESTS_BOX_SCENE_H

#include "host/core/scene.h"
#include "host/core/view.h"

typedef struct box_scene {
    uint32_t items, movers;
    uint64_t seed;
    double at[3]; // the scene's middle, metres; whole metres move it without any other change
} box_scene;

// Box centres lie within BOX_SCENE_RADIUS_M of the middle on each axis; corners are multiples of 2^-10 m.
#define BOX_SCENE_RADIUS_M 50.0

result box_scene_make(const box_scene *b, const allocator *memory, report *r, scene **out);
// One more box of 12 triangles in 6 polygons to a builder that has a material 0 and an object 0; name NULL: an item,
// else a mover of that name.
result box_scene_add(scene_builder *b, const double min[3], const double max[3], const char *name);
// The same, open_offset metres from shut to open.
typedef struct box_scene_door { const char *name; const double *open_offset; } box_scene_door;
result box_scene_add_door(scene_builder *b, const double min[3], const double max[3], const box_scene_door *door);
// At the scene's middle, looking along (cos yaw, 0, sin yaw).
camera box_scene_camera(const box_scene *b, double yaw_deg);

#endif
