// The test culler `testnothing`: a select that draws nothing, whatever it promises. It promises SAMPLED unless told not to.
// SPDX-License-Identifier: MIT
#define OPTION_COUNT 2
#define QUERY_FIELDS
#include "../../core/plugins/shell.h"

static cull_result build(cull_culler *c, const cull_zone *zone, const cull_hierarchy *lent, cull_built *out)
{
    (void)lent;
    c->zone = zone;
    out->index_bytes = sizeof *c;
    out->promises = c->values[0][0] == '1' ? CULL_SAMPLED : 0;
    out->max_runs = 1;
    out->max_steps = 1;
    return CULL_OK;
}

static cull_progress select_items(cull_query *q, const cull_visit *visit, cull_batch *batch)
{
    (void)q;
    (void)visit;
    batch->run_count = 0;
    return CULL_DONE;
}

static const void *get_extension(const cull_culler *c, const char *id)
{
    (void)c;
    (void)id;
    return NULL;
}

static const cull_option options[OPTION_COUNT] = {{"promise", "1", NULL, "0 promises nothing"}, {"backface", "0", NULL, "1 is judged by front walls"}};
static const cull_descriptor descriptor = {"testnothing", "1", "draws nothing", options, OPTION_COUNT, CULL_SAMPLED};
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
