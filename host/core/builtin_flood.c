// The built-in culler `flood`: passes every volume through every portal unclipped. What a chain without a crosser does,
// as a name, so that it can be written and swept: `frustum+flood`.
// SPDX-License-Identifier: MIT
#include "builtin.h"

struct cull_culler { const cull_host *host; };
struct cull_query { const cull_culler *culler; };

static cull_result flood_create(const cull_host *host, const char *const *values, cull_culler **out)
{
    (void)values;
    cull_culler *c = host->alloc(host, sizeof *c, _Alignof(cull_culler));
    if (!c) return CULL_ERR_MEMORY;
    *c = (cull_culler){host};
    *out = c;
    return CULL_OK;
}

static void flood_destroy(cull_culler *c)
{
    c->host->free(c->host, c, sizeof *c);
}

static cull_result flood_build(cull_culler *c, const cull_zone *zone, const cull_hierarchy *lent, cull_built *out)
{
    (void)zone;
    (void)lent;
    out->promises = CULL_CONSERVATIVE | CULL_SAMPLED | CULL_STATELESS | CULL_ORDERED;
    out->index_bytes = sizeof *c;
    out->max_steps = 1;
    return CULL_OK;
}

static cull_result flood_open(const cull_culler *c, cull_query **out)
{
    cull_query *q = c->host->alloc(c->host, sizeof *q, _Alignof(cull_query));
    if (!q) return CULL_ERR_MEMORY;
    q->culler = c;
    *out = q;
    return CULL_OK;
}

static void flood_close(cull_query *q)
{
    q->culler->host->free(q->culler->host, q, sizeof *q);
}

static cull_crossing flood_cross(cull_query *q, const cull_view *view, const cull_volume *in, uint32_t portal, cull_plane *planes,
                                 uint32_t *plane_count)
{
    (void)q;
    (void)view;
    (void)in;
    (void)portal;
    (void)planes;
    (void)plane_count;
    return CULL_CROSS_SAME;
}

static const void *flood_get_extension(const cull_culler *c, const char *id)
{
    (void)c;
    (void)id;
    return NULL;
}

static const cull_descriptor flood_descriptor = {
    .id = "flood",
    .version = "1",
    .summary = "a crosser: volumes pass portals unclipped",
    .may_promise = CULL_CONSERVATIVE | CULL_SAMPLED | CULL_STATELESS | CULL_ORDERED,
};

const cull_plugin builtin_flood = {
    .descriptor = &flood_descriptor,
    .create = flood_create,
    .destroy = flood_destroy,
    .build = flood_build,
    .open = flood_open,
    .close = flood_close,
    .cross = flood_cross,
    .get_extension = flood_get_extension,
};
