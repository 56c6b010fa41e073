// The built-in culler `none`: draws everything, whatever the volumes. What all others are held against.
// SPDX-License-Identifier: MIT
#include "builtin.h"

struct cull_culler {
    const cull_host *host;
    uint32_t item_count;
};
struct cull_query { const cull_culler *culler; };

static cull_result none_create(const cull_host *host, const char *const *values, cull_culler **out)
{
    (void)values;
    cull_culler *c = host->alloc(host, sizeof *c, _Alignof(cull_culler));
    if (!c) return CULL_ERR_MEMORY;
    *c = (cull_culler){.host = host};
    *out = c;
    return CULL_OK;
}

static void none_destroy(cull_culler *c)
{
    c->host->free(c->host, c, sizeof *c);
}

static cull_result none_build(cull_culler *c, const cull_zone *zone, const cull_hierarchy *lent, cull_built *out)
{
    (void)lent;
    c->item_count = zone->item_count;
    out->promises = CULL_CONSERVATIVE | CULL_SAMPLED | CULL_STATELESS;
    out->index_bytes = sizeof *c;
    out->max_runs = 1;
    out->max_steps = 1;
    return CULL_OK;
}

static cull_result none_open(const cull_culler *c, cull_query **out)
{
    cull_query *q = c->host->alloc(c->host, sizeof *q, _Alignof(cull_query));
    if (!q) return CULL_ERR_MEMORY;
    q->culler = c;
    *out = q;
    return CULL_OK;
}

static void none_close(cull_query *q)
{
    q->culler->host->free(q->culler->host, q, sizeof *q);
}

static cull_progress none_select(cull_query *q, const cull_visit *visit, cull_batch *batch)
{
    (void)visit;
    if (q->culler->item_count > 0) batch->runs[batch->run_count++] = (cull_run){0, q->culler->item_count};
    return CULL_DONE;
}

static const void *none_get_extension(const cull_culler *c, const char *id)
{
    (void)c;
    (void)id;
    return NULL;
}

static const cull_descriptor none_descriptor = {
    .id = "none",
    .version = "1",
    .summary = "draws every item",
    .may_promise = CULL_CONSERVATIVE | CULL_SAMPLED | CULL_STATELESS,
};

const cull_plugin builtin_none = {
    .descriptor = &none_descriptor,
    .create = none_create,
    .destroy = none_destroy,
    .build = none_build,
    .open = none_open,
    .close = none_close,
    .select = none_select,
    .get_extension = none_get_extension,
};
