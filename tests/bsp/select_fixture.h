// Scenes, views and the oracle for tests of bsp's select: what a loop over all items finds.
// SPDX-License-Identifier: MIT
#ifndef TESTS_BSP_SELECT_FIXTURE_H
#define TESTS_BSP_SELECT_FIXTURE_H

#include "tests/frustum/fixture.h"

#include <portcullis/clip.h>

// ---- Sessions: see tests/frustum/fixture.h ----

const cull_plugin *bsp_or_skip(void);

typedef struct bsp_values { const char *backface, *split, *choose, *cells, *isa; } bsp_values; // in the order of the plugin's options
#define BSP_PLAIN_VALUES ((bsp_values){"0", "0", "balance", "off", "auto"})
cull_result bsp_open(session *s, culler_host *h, const cull_zone *zone, const bsp_values *values);

// ---- Scenes ----

enum { LOOP_MOST = 12 }; // corners of a wall
// Item i of `from` stands at places[i], and is scaled.
void zone_changed(const hand_zone *from, const uint32_t *places, float scale, hand_zone *out);

typedef enum scene_kind { SCENE_ROOMS, SCENE_LOOSE, SCENE_BOXES, SCENE_MIXED, SCENE_COINCIDENT, SCENE_KIND_COUNT } scene_kind;
void scene_fill(uint64_t *r, scene_kind kind, uint32_t items, hand_zone *out); // hand_zone_free it

// ---- Views: volumes guarded for the zone as a host makes them ----

enum { VIEW_VOLUMES_MOST = 24 };
typedef struct made_view {
    cull_view view;
    view_volume parts[VIEW_VOLUMES_MOST];
    cull_volume volumes[VIEW_VOLUMES_MOST];
    uint32_t volume_count;
} made_view;
// An eye in or around the zone's box, sometimes on a vertex; volumes: pictures of any angle from it.
void view_fill(uint64_t *r, const cull_zone *zone, uint32_t volumes, made_view *out);

// ---- Oracles ----

int item_touches(const cull_zone *zone, uint32_t item, const cull_volume *volume); // a wall by its loop or a triangle, others by their box
void loop_set(const cull_zone *zone, const made_view *v, uint8_t *seen);
// 1: some point of the item's triangles lies inside a volume by `margin` metres and more, in long double.
int item_is_inside(const cull_zone *zone, uint32_t item, const made_view *v, double margin);

#endif
