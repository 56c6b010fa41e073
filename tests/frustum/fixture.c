// A small host for tests of cullers: see fixture.h.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "fixture.h"

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

uint64_t random_next(random_state *r) // splitmix64
{
    uint64_t z = r->state += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
    return z ^ z >> 31;
}

double random_unit(random_state *r)
{
    return (double)(random_next(r) >> 11) * 0x1p-53;
}

double random_between(random_state *r, double low, double high)
{
    return low + (high - low) * random_unit(r);
}

void random_direction(random_state *r, double out[3])
{
    double square;
    do {
        for (int i = 0; i < 3; i++) out[i] = random_between(r, -1, 1);
        square = out[0] * out[0] + out[1] * out[1] + out[2] * out[2];
    } while (square > 1 || square < 1e-4);
    for (int i = 0; i < 3; i++) out[i] /= sqrt(square);
}

static void *host_alloc(const cull_host *host, size_t size, size_t align)
{
    test_host *h = host->user;
    void *memory = NULL;
    if (++h->allocations == h->fail_at) return NULL;
    if (posix_memalign(&memory, align < sizeof(void *) ? sizeof(void *) : align, size ? size : 1) != 0) return NULL;
    memset(memory, 0xee, size);
    h->live_blocks++;
    h->live_bytes += (int64_t)size;
    return memory;
}

static void host_free(const cull_host *host, void *memory, size_t size)
{
    test_host *h = host->user;
    if (!memory) return;
    h->live_blocks--;
    h->live_bytes -= (int64_t)size;
    free(memory);
}

static void host_log(const cull_host *host, cull_log_level level, const char *message)
{
    test_host *h = host->user;
    (void)level;
    snprintf(h->last_log, sizeof h->last_log, "%s", message);
}

static void host_parallel_for(const cull_host *host, void (*task)(void *, uint32_t), void *context, uint32_t count)
{
    (void)host;
    for (uint32_t i = 0; i < count; i++) task(context, i);
}

static const void *host_get_extension(const cull_host *host, const cull_zone *zone, const char *id)
{
    (void)host;
    (void)zone;
    (void)id;
    return NULL;
}

void test_host_init(test_host *h)
{
    memset(h, 0, sizeof *h);
    h->host = (cull_host){CULL_ABI, h, host_alloc, host_free, host_log, host_parallel_for, host_get_extension};
}

static void *must_alloc(size_t size)
{
    void *memory = NULL;
    if (posix_memalign(&memory, 64, (size + 63) / 64 * 64) != 0) abort();
    memset(memory, 0, (size + 63) / 64 * 64);
    return memory;
}

void test_zone_make(const cull_box *boxes, uint32_t count, test_zone *out)
{
    memset(out, 0, sizeof *out);
    for (int row = 0; row < 6; row++) out->rows[row] = must_alloc(((size_t)count + CULL_PADDING) * sizeof(float));
    out->items = must_alloc(((size_t)count + 1) * sizeof *out->items);
    cull_box all = count ? cull_box_none() : (cull_box){{0, 0, 0}, {0, 0, 0}};
    for (uint32_t i = 0; i < count; i++) {
        const float c[6] = {boxes[i].min.x, boxes[i].min.y, boxes[i].min.z, boxes[i].max.x, boxes[i].max.y, boxes[i].max.z};
        for (int row = 0; row < 6; row++) out->rows[row][i] = c[row];
        out->items[i].flags = CULL_ITEM_BOX;
        all = cull_box_union(all, boxes[i]);
    }
    out->zone.items = out->items;
    out->zone.boxes = (cull_boxes){out->rows[0], out->rows[1], out->rows[2], out->rows[3], out->rows[4], out->rows[5]};
    out->zone.box = all;
    out->zone.radius = cull_box_radius(all);
    out->zone.item_count = count;
}

void test_zone_free(test_zone *z)
{
    for (int row = 0; row < 6; row++) free(z->rows[row]);
    free(z->items);
    memset(z, 0, sizeof *z);
}

const cull_plugin *plugin_frustum(void)
{
    const char *folder = getenv("PORTCULLIS_PLUGINS");
    char path[4096];
    snprintf(path, sizeof path, "%s/frustum.culler.so", folder ? folder : "build/plugins");
    void *library = dlopen(path, RTLD_NOW | RTLD_LOCAL); // stays open: sanitizers want its symbols
    if (!library) {
        fprintf(stderr, "no frustum library: %s\n", dlerror());
        return NULL;
    }
    const cull_entry_v0 *entry = dlsym(library, CULL_ENTRY_SYMBOL);
    return entry && entry->abi == CULL_ABI && entry->plugin_count == 1 ? entry->plugins[0] : NULL;
}

cull_result session_open(session *s, test_host *h, const cull_plugin *plugin, const cull_zone *zone, const char *const *values)
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
