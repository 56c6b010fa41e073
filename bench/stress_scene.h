// A scene made anew from another: moved, turned, scaled, its points jittered, its items copied, or with tiny ones beside them.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_BENCH_STRESS_SCENE_H
#define PORTCULLIS_BENCH_STRESS_SCENE_H

#include "../host/core/scene.h"

typedef struct scene_change {
    builder_transform place;
    double jitter_m;     // each coordinate of each point goes by -1, 0 or 1 times this, equal points alike; before the place
    uint64_t seed;       // of the jitter
    uint32_t copies;     // of each item that never moves; the first stand first, then all the second ones
    uint32_t tiny_count; // triangles at the first corner of each such item, as items of their own behind the copies
    double tiny_m;       // their sides
} scene_change;

// What is derived is derived anew by the scene builder, which refuses what it cannot hold, with a line. Exact planes, solids,
// places, lights, paths and normal maps stay behind. Items are listed in the zones that list them in `from`.
result scene_rebuild(const scene *from, const scene_change *c, const allocator *memory, report *r, scene **out);
// Which item of `from` an item of that scene came from: global ids.
uint32_t scene_rebuilt_from(const scene *from, const scene *rebuilt, uint32_t item);

#endif
