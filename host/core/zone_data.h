// Zone data: one zone's geometry as plugins are lent it, float relative to the zone's own origin; made once, shared by all
// chains that the zone ever gets.
// SPDX-License-Identifier: MIT
// Invariant: coordinates differ from the scene's by a whole number of metres, exactly; items stand in ascending global id.
#ifndef PORTCULLIS_HOST_ZONE_DATA_H
#define PORTCULLIS_HOST_ZONE_DATA_H

#include "scene.h"

typedef struct zone_data {
    const scene *scene;
    cull_zone zone;         // items in ascending global id; portals in the order of scene.zone_portals
    const uint32_t *items;  // zone.item_count global ids; NULL: place i is item i (the zone lists all)
    const uint32_t *shared; // shared_count places of items that other zones list too, ascending
    uint32_t index, shared_count;
    const allocator *memory;
    void *block; // of all arrays that are not the scene's own; block_bytes
    size_t block_bytes;
} zone_data;

typedef struct zone_data_request {
    const scene *scene;
    uint32_t zone, mover_capacity;
} zone_data_request;

// [any thread] The scene is borrowed. RESULT_NO_MEMORY leaves nothing.
result zone_data_open(const zone_data_request *q, const allocator *memory, zone_data *out);
void zone_data_close(zone_data *z); // zeroed is fine

#endif
