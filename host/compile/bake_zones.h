// Bakes the indices of a world's chains, to be kept in its scene's file.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_COMPILE_BAKE_ZONES_H
#define PORTCULLIS_COMPILE_BAKE_ZONES_H

#include "../core/world.h"

typedef struct baked_zones {
    arena memory;      // blobs and bakes; ids and versions are the plugins' own
    scene_bake *bakes; // in order of zones, then of stages; what pcs_write takes
    uint32_t count, cullers_without; // built cullers that keep nothing
    uint64_t bytes;
} baked_zones;

// [main] The world is open, its plugins stay loaded as long as the bakes are used. Free with baked_zones_free.
result baked_zones_make(const world *w, const allocator *memory, report *r, baked_zones *out);
void baked_zones_free(baked_zones *b); // zeroed is fine

#endif
