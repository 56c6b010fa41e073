// What every test plugin repeats: a culler that remembers zone and options, a query that knows its culler.
// Included by one plugin source each, which defines OPTION_COUNT and QUERY_FIELDS before.
// SPDX-License-Identifier: MIT
#include <portcullis/culler.h>

#include <stdlib.h>
#include <string.h>

enum { VALUE_BYTES = 32 };

struct cull_culler {
    const cull_host *host;
    const cull_zone *zone;
    const cull_hierarchy *lent;
    char values[OPTION_COUNT][VALUE_BYTES]; // the host's texts live for the call only
};
struct cull_query {
    const cull_culler *culler;
    QUERY_FIELDS
};

static cull_result shell_create(const cull_host *host, const char *const *values, cull_culler **out)
{
    for (size_t i = 0; i < OPTION_COUNT; ++i)
        if (strlen(values[i]) >= VALUE_BYTES) return CULL_ERR_OPTION;
    cull_culler *c = host->alloc(host, sizeof *c, _Alignof(cull_culler));
    if (!c) return CULL_ERR_MEMORY;
    memset(c, 0, sizeof *c);
    c->host = host;
    for (size_t i = 0; i < OPTION_COUNT; ++i) memcpy(c->values[i], values[i], strlen(values[i]));
    *out = c;
    return CULL_OK;
}

static void shell_destroy(cull_culler *c)
{
    c->host->free(c->host, c, sizeof *c);
}

static cull_result shell_open(const cull_culler *c, cull_query **out)
{
    cull_query *q = c->host->alloc(c->host, sizeof *q, _Alignof(cull_query));
    if (!q) return CULL_ERR_MEMORY;
    memset(q, 0, sizeof *q);
    q->culler = c;
    *out = q;
    return CULL_OK;
}

static void shell_close(cull_query *q)
{
    q->culler->host->free(q->culler->host, q, sizeof *q);
}
