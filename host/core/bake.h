// Baked indices: what a culler kept of a zone (extension cull.bake/1) is lent to it again where all of its key agrees.
// SPDX-License-Identifier: MIT
// Invariant: a blob of another culler, version, option or geometry is never lent; then the culler just builds.
#ifndef PORTCULLIS_HOST_BAKE_H
#define PORTCULLIS_HOST_BAKE_H

#include "scene.h"

typedef struct bake_key {
    const cull_descriptor *descriptor; // id and version
    uint64_t options_hash, zone_hash;
    uint32_t zone;
} bake_key;

uint64_t bake_options_hash(const cull_descriptor *d, const char *const *values); // one of each option, in order
// Of what a culler is lent at build. Room for movers is left out: it is the viewer's choice, and no index holds movers.
uint64_t bake_zone_hash(const cull_zone *zone, const cull_hierarchy *lent);
// The scene's blob for it, or NULL. Bakes stand in order of their zones.
const scene_bake *bake_find(const scene *s, const bake_key *key);
// Without one: why a blob of this zone, culler and options is not lent, in words; NULL: there is none.
const char *bake_fault(const scene *s, const bake_key *key);

#endif
