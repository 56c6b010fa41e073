// The test culler `testorder`: a select that has the zone laid out backwards and lends a hierarchy of a root and two
// leaves over it. It draws everything.
// SPDX-License-Identifier: MIT
#define OPTION_COUNT 2
#define QUERY_FIELDS
#include "shell.h"

#include <math.h>
#include <portcullis/box.h>

enum { NODES = 3 };

typedef struct index {
    cull_hierarchy hierarchy;
    cull_node nodes[NODES];
    uint32_t *items;
    uint32_t order[]; // and `items` behind it: every item and one more
} index;

static size_t index_bytes(uint32_t item_count)
{
    return sizeof(index) + (2 * (size_t)item_count + 1) * sizeof(uint32_t);
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

static void spoil_tree(const char *how, index *x)
{
    cull_node *nodes = x->nodes;
    if (strcmp(how, "no_nodes") == 0) x->hierarchy.node_count = 0;
    if (strcmp(how, "null_nodes") == 0) x->hierarchy.nodes = NULL;
    if (strcmp(how, "child_before") == 0) nodes[2].first_child = nodes[2].child_count = 1;
    if (strcmp(how, "child_itself") == 0) nodes[0].first_child = 0;
    if (strcmp(how, "child_past_end") == 0) nodes[0].child_count = 3;
    if (strcmp(how, "child_wraps") == 0) nodes[0].child_count = UINT32_MAX;
    if (strcmp(how, "child_twice") == 0) nodes[1].first_child = 2, nodes[1].child_count = 1;
    if (strcmp(how, "child_lost") == 0) nodes[0].child_count = 1;
    if (strcmp(how, "depth") == 0) x->hierarchy.depth = 3;
    if (strcmp(how, "box_nan") == 0) nodes[1].box.min.z = NAN;
    if (strcmp(how, "box_inside_out") == 0) nodes[2].box.max.y = nextafterf(nodes[2].box.min.y, -INFINITY);
    if (strcmp(how, "box_small") == 0) nodes[0].box.max.x = nextafterf(nodes[0].box.max.x, -INFINITY);
}

static void spoil_lists(const char *how, index *x, uint32_t count)
{
    cull_node *nodes = x->nodes;
    if (strncmp(how, "listed", 6) == 0) x->hierarchy.items = x->items;
    if (strcmp(how, "list_past_end") == 0) nodes[2].item_count++;
    if (strcmp(how, "list_wraps") == 0) nodes[2].first_item = UINT32_MAX;
    if (strcmp(how, "item_lost") == 0) nodes[2].item_count--;
    if (strcmp(how, "item_twice") == 0) nodes[2].first_item--;
    if (strcmp(how, "list_again") == 0) nodes[0].item_count = 1;
    if (strcmp(how, "item_uncovered") == 0) nodes[1].box.max = nodes[1].box.min;
    if (strcmp(how, "subtree_past_end") == 0) nodes[0].subtree.count++;
    if (strcmp(how, "subtree_wraps") == 0) nodes[2].subtree.count = UINT32_MAX;
    if (strcmp(how, "subtree_short") == 0) nodes[1].subtree.count--;
    if (strcmp(how, "subtree_shifted") == 0) nodes[1].subtree.first++;
    if (strcmp(how, "no_subtrees") == 0) nodes[0].subtree.count = nodes[1].subtree.count = nodes[2].subtree.count = 0;
    if (strcmp(how, "listed_wild") == 0) x->items[3] = count; // a mover
    if (strcmp(how, "listed_lost") == 0) x->items[3] = 2;
    if (strcmp(how, "listed_past_end") == 0) nodes[2].item_count++;
    if (strcmp(how, "listed_twice") == 0) {
        x->hierarchy.item_count++;
        nodes[2].item_count++;
        nodes[2].subtree.count = 0;
    }
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
    x->items = x->order + count;
    for (uint32_t i = 0; i <= count; ++i) x->items[i] = i < count ? i : 0;
    spoil_tree(c->values[1], x);
    spoil_lists(c->values[1], x, count);
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

static const cull_option options[OPTION_COUNT] = {{"hierarchy", "1", NULL, "0 lends none"}, {"spoil", "none", NULL, "what is wrong, or unusual, in the hierarchy"}};
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
