// The test culler `testsingles`: draws all items in runs of one, forwards, backwards or criss-cross: runs need not ascend.
// SPDX-License-Identifier: MIT
#define OPTION_COUNT 1
#define QUERY_FIELDS
#include "shell.h"

static cull_result build(cull_culler *c, const cull_zone *zone, const cull_hierarchy *lent, cull_built *out)
{
    (void)lent;
    c->zone = zone;
    out->index_bytes = sizeof *c;
    out->promises = CULL_CONSERVATIVE | CULL_SAMPLED | CULL_STATELESS;
    out->max_runs = zone->item_count;
    out->max_steps = 1;
    return CULL_OK;
}

static uint32_t place_of(const cull_culler *c, uint32_t i)
{
    const uint32_t count = c->zone->item_count, half = count / 2;
    switch (c->values[0][0]) {
    case 'f': return i;
    case 'b': return count - 1 - i;
    default: return i % 2 ? i / 2 : half + i / 2; // the rear half and the front half by turns
    }
}

static cull_progress select_items(cull_query *q, const cull_visit *visit, cull_batch *batch)
{
    const cull_culler *c = q->culler;
    (void)visit;
    for (uint32_t i = 0; i < c->zone->item_count; ++i) batch->runs[batch->run_count++] = (cull_run){place_of(c, i), 1};
    return CULL_DONE;
}

static const void *get_extension(const cull_culler *c, const char *id)
{
    (void)c;
    (void)id;
    return NULL;
}

static const cull_option options[OPTION_COUNT] = {{"way", "forwards", "forwards backwards crossed", "in which order"}};
static const cull_descriptor descriptor = {"testsingles", "1", "draws all items one by one", options, OPTION_COUNT,
                                           CULL_CONSERVATIVE | CULL_SAMPLED | CULL_STATELESS};
static const cull_plugin plugin = {.descriptor = &descriptor,
                                   .create = shell_create,
                                   .destroy = shell_destroy,
                                   .build = build,
                                   .open = shell_open,
                                   .close = shell_close,
                                   .select = select_items,
                                   .get_extension = get_extension};
static const cull_plugin *const plugins[] = {&plugin};
CULL_ENTRY = {CULL_ABI, 1, plugins};
