// For tests of the octree: scenes of boxes, volumes, the set of a loop over all boxes, sessions of the plugin.
// SPDX-License-Identifier: MIT
#ifndef TESTS_OCTREE_FIXTURE_H
#define TESTS_OCTREE_FIXTURE_H

#include "tests/common/test.h"
#include "tests/frustum/fixture.h"

enum { VOLUMES_MOST = 40, ITEMS_MOST = 30000 };

typedef enum scene_kind {
    SCENE_SPREAD,  // in a cube
    SCENE_CITY,    // flat, in groups
    SCENE_GRID,    // cubes side by side
    SCENE_EQUAL,   // all at one place
    SCENE_NESTED,  // one centre, all sizes
    SCENE_GIANT,   // one among small ones
    SCENE_GIANTS,  // all as wide as the scene
    SCENE_LINE,
    SCENE_PLANE,   // upright
    SCENE_OUTLIER, // one 1e9 m off
    SCENE_SPIRAL,  // each half as far from a point as the one before
    SCENE_HUGE,    // coordinates to 1e30
    SCENE_KINDS
} scene_kind;

cull_box *scene_make(uint64_t *r, scene_kind kind, uint32_t count); // free it

typedef struct made_volumes {
    cull_plane planes[VOLUMES_MOST][CULL_MAX_PLANES];
    cull_volume volumes[VOLUMES_MOST];
    uint32_t count;
    cull_view view; // its eye
} made_volumes;

void volumes_make(uint64_t *r, const cull_box *boxes, uint32_t items, uint32_t count, made_volumes *out);
uint32_t loop_set(const cull_box *boxes, uint32_t count, const made_volumes *v, uint8_t *seen); // returns how many

typedef struct octree_values { const char *kind, *loose, *backface, *isa; } octree_values;
cull_result octree_open(session *s, culler_host *h, const cull_zone *zone, const octree_values *values);
int octree_has_isa(const char *isa); // on this CPU

// As session_set_any_order, but a run may not go on where the one before ends.
const char *octree_set(const session *s, uint8_t *seen);
void octree_must_be(const session *s, const cull_box *boxes, const made_volumes *v, const char *what); // after a select

// The extension, which must be there.
const void *octree_extension(const session *s, const char *id);

#endif
