// Chains: a zone's cullers in the order written, such as `octree[leaf=64]+occlusion`, built on the zone's geometry.
// SPDX-License-Identifier: MIT
// Invariant: a built chain is constant; everything that changes in a frame lives in a viewer (viewer.h).
#ifndef PORTCULLIS_HOST_CHAIN_H
#define PORTCULLIS_HOST_CHAIN_H

#include "bake.h"
#include "host.h"
#include "loader.h"
#include "zone_data.h"

#include <pthread.h>

enum { CHAIN_STAGES_MOST = 8, CHAIN_OPTIONS_MOST = 32 };

typedef struct chain_option { const char *key, *value; } chain_option;
typedef struct chain_stage_spec {
    const char *id;
    chain_option options[CHAIN_OPTIONS_MOST];
    uint32_t option_count;
} chain_stage_spec;
typedef struct chain_spec {
    const char *text; // exactly as typed
    chain_stage_spec stages[CHAIN_STAGES_MOST];
    uint32_t stage_count;
} chain_spec;

// Texts live in the arena. Errors say where in the text.
result chain_parse(const char *text, arena *texts, report *r, chain_spec *out);

typedef enum stage_role { ROLE_SELECT, ROLE_FILTER, ROLE_CROSS } stage_role;
typedef struct chain_stage {
    cull_host host; // what its culler is made with: the services', and the baked index of the zone. Stands first: see chain.c
    const host_services *services;
    const cull_zone *zone; // that its culler is lent
    cull_blob blob;        // the baked index; bytes NULL: there is none
    uint64_t options_hash;
    const cull_plugin *plugin;
    cull_culler *culler;
    cull_built built;
    stage_role role;
} chain_stage;

typedef struct chain {
    uint32_t stage_count;
    const zone_data *data;
    const uint32_t *order;  // order[place] = place in the zone data; NULL: the same
    cull_zone zone;         // as lent to the select
    cull_zone ordered_zone; // as lent to the stages behind it; the same where order is NULL
    const cull_hierarchy *hierarchy; // that the select lends, checked; NULL: it has none, or nobody stands behind it
    cull_promises promises; // of all of it: those that every stage gives
    uint32_t uses_renderer; // a stage may ask for tests or pictures
    double build_ms;        // CPU time
    size_t index_bytes;
    arena memory;
    chain_stage stages[]; // stage_count
} chain;

typedef struct chain_request {
    const chain_spec *spec;
    const zone_data *zone;
    loader *plugins;
    const host_services *services;
    pthread_mutex_t *loading; // held while libraries are looked for and cullers created; NULL: nobody else does
} chain_request;

// [main; with `loading` any thread, and the services' allocator is asked from it] Everything but the spec is borrowed for
// the chain's life. On failure a line, and nothing is left.
result chain_build(const chain_request *q, report *r, chain **out);
// Of a built chain's stage: under what its index is kept and found.
bake_key chain_bake_key(const chain *c, uint32_t stage);
void chain_close(chain *c); // NULL is fine; no viewer of it may live

#endif
