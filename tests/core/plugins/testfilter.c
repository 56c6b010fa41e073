// The test culler `testfilter`: a filter that keeps items by a plain rule, walks a hierarchy or takes candidates, takes
// movers or leaves them, keeps pictures or drops them.
// SPDX-License-Identifier: MIT
#define OPTION_COUNT 4
#define QUERY_FIELDS
#include "shell.h"

#include <portcullis/box.h>

enum { KEEP, MOVERS, PICTURES, WALK };

static cull_result build(cull_culler *c, const cull_zone *zone, const cull_hierarchy *lent, cull_built *out)
{
    c->zone = zone;
    c->lent = lent;
    out->index_bytes = sizeof *c;
    out->max_runs = zone->item_count;
    out->max_steps = 1;
    out->walks_hierarchy = c->values[WALK][0] == '1';
    out->takes_movers = c->values[MOVERS][0] == '1';
    return CULL_OK;
}

static int is_kept(const cull_culler *c, uint32_t item)
{
    if (strcmp(c->values[KEEP], "even") == 0) return item % 2 == 0;
    if (strcmp(c->values[KEEP], "right") == 0) return c->zone->boxes.min_x[item] >= 0;
    return 1;
}

// A walker has no candidates that a select took its pictures' items out of.
static int is_in_picture(const cull_visit *visit, const cull_batch *batch, uint32_t item)
{
    for (uint32_t p = 0; p < visit->picture_count; ++p)
        for (uint32_t r = 0; batch->keep_pictures[p] && r < visit->pictures[p].run_count; ++r)
            if (item - visit->pictures[p].runs[r].first < visit->pictures[p].runs[r].count) return 1;
    return 0;
}

static void keep_of_run(const cull_culler *c, cull_run run, cull_batch *batch)
{
    for (uint32_t i = run.first; i < run.first + run.count; ++i)
        if (is_kept(c, i)) batch->runs[batch->run_count++] = (cull_run){i, 1};
}

static void walk(const cull_culler *c, const cull_visit *visit, cull_batch *batch)
{
    for (uint32_t n = 0; n < c->lent->node_count; ++n) {
        const cull_node *node = &c->lent->nodes[n];
        for (uint32_t i = node->first_item; i < node->first_item + node->item_count; ++i)
            if (!is_in_picture(visit, batch, i)) keep_of_run(c, (cull_run){i, 1}, batch);
        batch->nodes_visited++;
    }
}

static void choose_pictures(const cull_culler *c, const cull_visit *visit, cull_batch *batch)
{
    const int drop_captures = strcmp(c->values[PICTURES], "keep") != 0, drop_pictures = strcmp(c->values[PICTURES], "drop") == 0;
    for (uint32_t i = 0; drop_captures && i < visit->capture_count; ++i) batch->keep_captures[i] = 0;
    for (uint32_t i = 0; drop_pictures && i < visit->picture_count; ++i) batch->keep_pictures[i] = 0;
    for (uint32_t i = 0; drop_pictures && i < visit->clipped_count; ++i) batch->keep_clipped[i] = 0;
}

static cull_progress filter(cull_query *q, const cull_visit *visit, cull_batch *batch)
{
    const cull_culler *c = q->culler;
    choose_pictures(c, visit, batch);
    if (c->values[WALK][0] == '1' && !visit->candidates && !visit->candidate_count) walk(c, visit, batch);
    for (uint32_t i = 0; i < visit->candidate_count; ++i) keep_of_run(c, visit->candidates[i], batch);
    for (uint32_t i = 0; i < visit->mover_count; ++i)
        if (i % 2 == 0) batch->runs[batch->run_count++] = (cull_run){visit->movers[i].id, 1};
    return CULL_DONE;
}

static const void *get_extension(const cull_culler *c, const char *id)
{
    (void)c;
    (void)id;
    return NULL;
}

static const cull_option options[OPTION_COUNT] = {
    {"keep", "even", NULL, "even: every second place; right: boxes at x >= 0; all"},
    {"movers", "0", NULL, "1 takes movers and keeps every second one that it is lent"},
    {"pictures", "keep", NULL, "keep, drop, or torn: captures dropped, pictures kept"},
    {"walk", "0", NULL, "1 walks the hierarchy that the select lends"},
};
static const cull_descriptor descriptor = {"testfilter", "1", "keeps items by a plain rule", options, OPTION_COUNT, 0};
static const cull_plugin plugin = {.descriptor = &descriptor,
                                   .create = shell_create,
                                   .destroy = shell_destroy,
                                   .build = build,
                                   .open = shell_open,
                                   .close = shell_close,
                                   .filter = filter,
                                   .get_extension = get_extension};
static const cull_plugin *const plugins[] = {&plugin};
CULL_ENTRY = {CULL_ABI, 1, plugins};
