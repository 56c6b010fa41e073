// Zones of boxes and sessions: see fixture.h.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "fixture.h"

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void *must_alloc(size_t size)
{
    void *memory = NULL;
    if (posix_memalign(&memory, 64, (size + 63) / 64 * 64) != 0) abort();
    memset(memory, 0, (size + 63) / 64 * 64);
    return memory;
}

void zone_of_boxes(const cull_box *boxes, uint32_t count, hand_zone *out)
{
    hand_zone_open(out, count, 0);
    for (uint32_t i = 0; i < count; i++) hand_zone_cluster(out, boxes[i]);
    hand_zone_end(out);
}

void zone_in_order(const cull_zone *zone, const uint32_t *order, hand_zone *out)
{
    hand_zone_open(out, zone->item_count, 0);
    for (uint32_t place = 0; place < zone->item_count; place++) hand_zone_cluster(out, cull_box_at(&zone->boxes, order[place]));
    hand_zone_end(out);
}

const cull_plugin *plugin_named(const char *id)
{
    const char *folder = getenv("PORTCULLIS_PLUGINS");
    char path[4096];
    snprintf(path, sizeof path, "%s/%s.culler.so", folder ? folder : "build/plugins", id);
    void *library = dlopen(path, RTLD_NOW | RTLD_LOCAL); // stays open: sanitizers want its symbols
    if (!library) {
        fprintf(stderr, "no library: %s\n", dlerror());
        return NULL;
    }
    const cull_exports *entry = dlsym(library, CULL_ENTRY_SYMBOL);
    return entry && entry->abi == CULL_ABI && entry->plugin_count == 1 ? entry->plugins[0] : NULL;
}

cull_result session_open(session *s, culler_host *h, const cull_plugin *plugin, const cull_zone *zone, const char *const *values)
{
    memset(s, 0, sizeof *s);
    s->plugin = plugin;
    s->item_count = zone->item_count;
    cull_result result = plugin->create(&h->host, values, &s->culler);
    if (result != CULL_OK) return result;
    result = plugin->build(s->culler, zone, NULL, &s->built);
    if (result == CULL_OK) result = plugin->open(s->culler, &s->query);
    if (result != CULL_OK) {
        plugin->destroy(s->culler);
        memset(s, 0, sizeof *s);
        return result;
    }
    s->runs = must_alloc((size_t)s->built.max_runs * sizeof *s->runs);
    s->scratch = must_alloc(s->built.scratch_size + 1);
    return CULL_OK;
}

void session_close(session *s)
{
    if (!s->culler) return;
    s->plugin->close(s->query);
    s->plugin->destroy(s->culler);
    free(s->runs);
    free(s->scratch);
    memset(s, 0, sizeof *s);
}

void session_select(session *s, const cull_view *view, const cull_volume *volumes, uint32_t volume_count)
{
    const cull_visit visit = {.view = view, .volumes = volumes, .volume_count = volume_count, .scratch = s->scratch};
    cull_batch batch = {.runs = s->runs};
    const cull_progress progress = s->plugin->select(s->query, &visit, &batch);
    s->run_count = progress == CULL_DONE ? batch.run_count : UINT32_MAX;
    s->nodes_visited = batch.nodes_visited;
}

const char *session_set(const session *s, uint8_t *seen)
{
    if (s->item_count) memset(seen, 0, s->item_count);
    if (s->run_count > s->built.max_runs) return "more runs than max_runs";
    uint64_t least = 0;
    for (uint32_t i = 0; i < s->run_count; i++) {
        const cull_run r = s->runs[i];
        if (r.count == 0) return "an empty run";
        if (i > 0 && r.first <= least) return "runs out of order, overlapping or touching";
        least = (uint64_t)r.first + r.count;
        if (least > s->item_count) return "a run beyond the last item";
        for (uint32_t place = r.first; place < least; place++) seen[s->built.order ? s->built.order[place] : place]++;
    }
    for (uint32_t i = 0; i < s->item_count; i++)
        if (seen[i] > 1) return "an item twice";
    return NULL;
}

const char *session_set_any_order(const session *s, uint8_t *seen)
{
    if (s->item_count) memset(seen, 0, s->item_count);
    if (s->run_count > s->built.max_runs) return "more runs than max_runs";
    for (uint32_t i = 0; i < s->run_count; i++) {
        const cull_run r = s->runs[i];
        if (r.count == 0) return "an empty run";
        if (r.first >= s->item_count || r.count > s->item_count - r.first) return "a run beyond the last item";
        for (uint32_t place = r.first; place < r.first + r.count; place++)
            if (seen[s->built.order[place]]++) return "an item twice";
    }
    return NULL;
}
