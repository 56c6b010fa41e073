// The test culler `testbake`: a select or filter that keeps everything, and an index that sums the zone's boxes up, saved
// and loaded. index_bytes tells which: BUILT or LOADED.
// SPDX-License-Identifier: MIT
#include <portcullis/culler.h>

#include <string.h>

enum { BUILT = 1000, LOADED = 2000, VALUE_BYTES = 16 };
static const char MAGIC[8] = "testbake";

typedef struct kept_index {
    char magic[8], value[VALUE_BYTES];
    double sum; // of all boxes, in order
    uint32_t item_count, has_order;
} kept_index;

struct cull_culler {
    const cull_host *host;
    const cull_zone *zone;
    kept_index index;
};
struct cull_query { const cull_culler *culler; };

static cull_result create(const cull_host *host, const char *const *values, cull_culler **out)
{
    if (strlen(values[0]) >= VALUE_BYTES) return CULL_ERR_OPTION;
    if (host->get_extension(host, NULL, CULL_EXT_BLOB)) return CULL_ERR_OPTION; // a blob is of a zone
    cull_culler *c = host->alloc(host, sizeof *c, _Alignof(cull_culler));
    if (!c) return CULL_ERR_MEMORY;
    memset(c, 0, sizeof *c);
    c->host = host;
    memcpy(c->index.magic, MAGIC, sizeof MAGIC);
    memcpy(c->index.value, values[0], strlen(values[0]));
    *out = c;
    return CULL_OK;
}

static void destroy(cull_culler *c)
{
    c->host->free(c->host, c, sizeof *c);
}

static cull_result build(cull_culler *c, const cull_zone *zone, const cull_hierarchy *lent, cull_built *out)
{
    const cull_blob *blob = c->host->get_extension(c->host, zone, CULL_EXT_BLOB);
    c->zone = zone;
    if (blob) {
        kept_index kept;
        if ((uintptr_t)blob->bytes % 64 || blob->size != sizeof kept) return CULL_ERR_BLOB;
        memcpy(&kept, blob->bytes, sizeof kept);
        if (memcmp(kept.magic, c->index.magic, sizeof kept.magic) != 0 || memcmp(kept.value, c->index.value, sizeof kept.value) != 0) return CULL_ERR_BLOB;
        if (kept.item_count != zone->item_count) return CULL_ERR_BLOB;
        c->index = kept;
    } else {
        for (uint32_t i = 0; i < zone->item_count; ++i) c->index.sum = c->index.sum * 1.5 + (double)zone->boxes.min_x[i];
        c->index.item_count = zone->item_count;
        c->index.has_order = lent != NULL;
    }
    out->index_bytes = blob ? LOADED : BUILT;
    out->max_runs = zone->item_count + 1;
    out->max_steps = 1;
    return CULL_OK;
}

static cull_result open(const cull_culler *c, cull_query **out)
{
    cull_query *q = c->host->alloc(c->host, sizeof *q, _Alignof(cull_query));
    if (!q) return CULL_ERR_MEMORY;
    q->culler = c;
    *out = q;
    return CULL_OK;
}

static void close(cull_query *q)
{
    q->culler->host->free(q->culler->host, q, sizeof *q);
}

static cull_progress select_items(cull_query *q, const cull_visit *visit, cull_batch *batch)
{
    (void)visit;
    batch->runs[batch->run_count++] = (cull_run){0, q->culler->zone->item_count};
    return CULL_DONE;
}

static cull_progress filter(cull_query *q, const cull_visit *visit, cull_batch *batch)
{
    (void)q;
    for (uint32_t i = 0; i < visit->candidate_count; ++i) batch->runs[batch->run_count++] = visit->candidates[i];
    return CULL_DONE;
}

static uint64_t save(const cull_culler *c, void *blob, uint64_t size)
{
    if (size >= sizeof c->index) memcpy(blob, &c->index, sizeof c->index);
    return sizeof c->index;
}

static const void *get_extension(const cull_culler *c, const char *id)
{
    static const cull_bake bake = {save};
    (void)c;
    return strcmp(id, CULL_EXT_BAKE) == 0 ? &bake : NULL;
}

static const cull_option options[] = {{"value", "0", NULL, "kept with the index"}};
static const cull_descriptor descriptor = {"testbake", "1", "keeps everything, and its index", options, 1, 0};
static const cull_plugin plugin = {.descriptor = &descriptor,
                                   .create = create,
                                   .destroy = destroy,
                                   .build = build,
                                   .open = open,
                                   .close = close,
                                   .select = select_items,
                                   .filter = filter,
                                   .get_extension = get_extension};
static const cull_plugin *const plugins[] = {&plugin};
CULL_ENTRY = {CULL_ABI, 1, plugins};
