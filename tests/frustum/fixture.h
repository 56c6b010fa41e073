// For tests of cullers: zones made of boxes, a session that runs steps.
// SPDX-License-Identifier: MIT
#ifndef TESTS_FRUSTUM_FIXTURE_H
#define TESTS_FRUSTUM_FIXTURE_H

#include "host/core/builtin.h"
#include "host/core/view.h"
#include "tests/common/culler_host.h"
#include "tests/common/hand_zone.h"
#include "tests/common/random.h"

#include <portcullis/plane.h>

// ---- Zones ----

void zone_of_boxes(const cull_box *boxes, uint32_t count, hand_zone *out); // clusters all; hand_zone_free it
void zone_in_order(const cull_zone *zone, const uint32_t *order, hand_zone *out); // its boxes as a host lays them out; hand_zone_free it

// ---- Sessions ----

const cull_plugin *plugin_named(const char *id); // from the folder named in PORTCULLIS_PLUGINS; NULL when it isn't there

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
cull_result session_open(session *s, culler_host *h, const cull_plugin *plugin, const cull_zone *zone, const char *const *values);
void session_close(session *s);
void session_select(session *s, const cull_view *view, const cull_volume *volumes, uint32_t volume_count);
// seen[original item] = 1 or 0. Returns NULL, or what is wrong with the runs: order, overlap, range.
const char *session_set(const session *s, uint8_t *seen);
const char *session_set_any_order(const session *s, uint8_t *seen); // the same, but runs may come in any order, and touch

#endif
