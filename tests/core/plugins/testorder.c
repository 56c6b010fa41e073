// The test culler `testorder`: a select that has the zone laid out backwards and lends a hierarchy of a root and two
// leaves over it. It draws everything.
// SPDX-License-Identifier: MIT
#define OPTION_COUNT 1
#define QUERY_FIELDS
#include "shell.h"

#include <portcullis/box.h>

enum { NODES = 3 };

typedef struct index {
    cull_hierarchy hierarchy;
    cull_node nodes[NODES];
    uint32_t order[];
} index;

static size_t index_bytes(uint32_t item_count)
{
    return sizeof(index) + item_count * sizeof(uint32_t);
}

static index *index_of(const cull_culler *c)
{
    return (index *)c->lent; // a select is lent none: its own stands there
}

static cull_box box_of(const cull_zone *zone, const uint32_t *order, uint32_t first, uint32_t count)
{
    cull_box box = cull_box_none();
    for (uint32_t i = first; i < first + count; ++i) box = cull_box_union(box, cull_box_at(&zone->boxes, order[i]));
    return box;
}

static cull_result build(cull_culler *c, const cull_zone *zone, const cull_hierarchy *lent, cull_built *out)
{
    (void)lent;
    const uint32_t count = zone->item_count, half = count / 2;
    index *x = c->host->alloc(c->host, index_bytes(count), 64);
    if (!x) return CULL_ERR_MEMORY;
    memset(x, 0, sizeof *x);
    for (uint32_t i = 0; i < count; ++i) x->order[i] = count - 1 - i;
    x->nodes[0] = (cull_node){.box = box_of(zone, x->order, 0, count), .first_child = 1, .child_count = 2, .subtree = {0, count}};
    x->nodes[1] = (cull_node){.box = box_of(zone, x->order, 0, half), .first_item = 0, .item_count = half, .subtree = {0, half}};
    x->nodes[2] = (cull_node){.box = box_of(zone, x->order, half, count - half), .first_item = half, .item_count = count - half, .subtree = {half, count - half}};
    x->hierarchy = (cull_hierarchy){.nodes = x->nodes, .node_count = NODES, .item_count = count, .depth = 2};
    c->zone = zone;
    c->lent = &x->hierarchy;
    out->order = x->order;
    out->index_bytes = index_bytes(count);
    out->promises = CULL_CONSERVATIVE;
    out->max_runs = 1;
    out->max_steps = 1;
    return CULL_OK;
}

static void destroy(cull_culler *c)
{
    if (c->lent) c->host->free(c->host, index_of(c), index_bytes(c->zone->item_count));
    shell_destroy(c);
}

static cull_progress select_items(cull_query *q, const cull_visit *visit, cull_batch *batch)
{
    (void)visit;
    batch->runs[batch->run_count++] = (cull_run){0, q->culler->zone->item_count};
    return CULL_DONE;
}

static const void *get_extension(const cull_culler *c, const char *id)
{
    return c->values[0][0] == '1' && strcmp(id, CULL_EXT_HIERARCHY) == 0 ? c->lent : NULL;
}

static const cull_option options[OPTION_COUNT] = {{"hierarchy", "1", NULL, "0 lends none"}};
static const cull_descriptor descriptor = {"testorder", "1", "lays the zone out backwards", options, OPTION_COUNT, CULL_CONSERVATIVE};
static const cull_plugin plugin = {.descriptor = &descriptor,
                                   .create = shell_create,
                                   .destroy = destroy,
                                   .build = build,
                                   .open = shell_open,
                                   .close = shell_close,
                                   .select = select_items,
                                   .get_extension = get_extension};
static const cull_plugin *const plugins[] = {&plugin};
CULL_ENTRY = {CULL_ABI, 1, plugins};
