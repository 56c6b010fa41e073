// A small host for tests of cullers: counted memory, zones made of boxes, a session that runs steps.
// SPDX-License-Identifier: MIT
#ifndef TESTS_FRUSTUM_FIXTURE_H
#define TESTS_FRUSTUM_FIXTURE_H

#include "host/core/builtin.h"
#include "host/core/view.h"

#include <portcullis/plane.h>

// ---- Numbers: one seeded generator, the same everywhere ----

typedef struct random_state { uint64_t state; } random_state;
uint64_t random_next(random_state *r);
double random_unit(random_state *r);                          // [0, 1)
double random_between(random_state *r, double low, double high);
void random_direction(random_state *r, double out[3]);        // unit

// ---- The host ----

typedef struct test_host {
    cull_host host;
    int64_t live_blocks, live_bytes;
    uint64_t allocations;
    uint64_t fail_at; // the allocation of this number (from 1) fails; 0: none
    char last_log[256];
} test_host;
void test_host_init(test_host *h);

// ---- Zones ----

typedef struct test_zone {
    cull_zone zone;
    float *rows[6];
    cull_item *items;
} test_zone;
// Boxes are copied; every item's flags are CULL_ITEM_BOX. Aborts without memory.
void test_zone_make(const cull_box *boxes, uint32_t count, test_zone *out);
void test_zone_free(test_zone *z);

// ---- Sessions ----

const cull_plugin *plugin_frustum(void); // from the folder named in PORTCULLIS_PLUGINS; NULL when it isn't there

typedef struct session {
    const cull_plugin *plugin;
    cull_culler *culler;
    cull_query *query;
    cull_built built;
    cull_run *runs;
    void *scratch;
    uint32_t item_count, run_count, nodes_visited;
} session;

// values: one for each option of the plugin, in its order. Returns what create or build said.
cull_result session_open(session *s, test_host *h, const cull_plugin *plugin, const cull_zone *zone, const char *const *values);
void session_close(session *s);
void session_select(session *s, const cull_view *view, const cull_volume *volumes, uint32_t volume_count);
// seen[original item] = 1 or 0. Returns NULL, or what is wrong with the runs: order, overlap, range.
const char *session_set(const session *s, uint8_t *seen);

#endif
