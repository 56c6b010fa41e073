// A culler made and built for a check: see stand.h.
// SPDX-License-Identifier: MIT
#include "stand.h"

#include <portcullis/box.h>

#include <stdlib.h>
#include <string.h>

stand_role stand_role_of(const cull_plugin *p)
{
    return p->select ? ROLE_SELECT : p->filter ? ROLE_FILTER : ROLE_CROSS;
}

void stand_defaults(const cull_plugin *p, stand_values *out)
{
    for (uint32_t i = 0; i < p->descriptor->option_count && i < STAND_OPTIONS_MOST; ++i) out->values[i] = p->descriptor->options[i].fallback;
}

int stand_backface(const cull_plugin *p, const stand_values *values)
{
    for (uint32_t i = 0; i < p->descriptor->option_count && i < STAND_OPTIONS_MOST; ++i)
        if (strcmp(p->descriptor->options[i].key, "backface") == 0) return strcmp(values->values[i], "1") == 0;
    return 0;
}

// A binary tree over items as they stand: halves of runs, so every subtree is a run.
static void node_fill(stand *s, uint32_t node, cull_run run, uint32_t depth)
{
    enum { LEAF = 8 };
    cull_hierarchy *h = &s->hierarchy;
    cull_box box = cull_box_none();
    for (uint32_t i = run.first; i < run.first + run.count; ++i) box = cull_box_union(box, s->scene->boxes[i]);
    if (!run.count) box = s->scene->zone.box;
    s->nodes[node] = (cull_node){.box = box, .first_item = run.first, .item_count = run.count, .subtree = run};
    if (depth > h->depth) h->depth = depth;
    if (run.count <= LEAF) return;
    const uint32_t half = run.count / 2, first = h->node_count;
    h->node_count += 2;
    s->nodes[node].first_child = first;
    s->nodes[node].child_count = 2;
    s->nodes[node].item_count = 0;
    node_fill(s, first, (cull_run){run.first, half}, depth + 1);
    node_fill(s, first + 1, (cull_run){run.first + half, run.count - half}, depth + 1);
}

static int hierarchy_make(stand *s)
{
    const uint32_t items = s->scene->zone.item_count;
    s->nodes = calloc(2u * items + 2, sizeof *s->nodes);
    if (!s->nodes) return 0;
    s->hierarchy = (cull_hierarchy){.node_count = 1};
    node_fill(s, 0, (cull_run){0, items}, 1);
    s->hierarchy.nodes = s->nodes;
    return 1;
}

static const char *built_fault(const stand *s)
{
    enum { LIST_MOST = 1 << 28 };
    const cull_built *b = &s->built;
    const uint32_t counts[] = {b->max_runs, b->max_tests, b->max_captures, b->max_pictures, b->max_clipped, b->slot_count};
    if (s->role != ROLE_CROSS && (b->max_steps < 1 || b->max_steps > CULL_MAX_STEPS)) return "max_steps is not 1 .. 1,000,000";
    for (size_t i = 0; i < sizeof counts / sizeof *counts; ++i)
        if (counts[i] > LIST_MOST) return "a capacity is over 2^28";
    if (b->scratch_size > (size_t)1 << 32) return "it wants over 4 GiB of scratch";
    if (b->promises & ~s->plugin->descriptor->may_promise) return "it promises more than its descriptor's may_promise";
    if (b->max_captures && !b->slot_count) return "it captures without slots";
    return NULL;
}

// A permutation, copied: what is used from here on stays what it was.
static const char *order_take(stand *s)
{
    const uint32_t count = s->scene->zone.item_count;
    if (!s->built.order || s->role != ROLE_SELECT) return NULL;
    uint8_t *seen = calloc(count + 1u, 1);
    s->own_order = calloc(count + 1u, sizeof *s->own_order);
    const char *fault = seen && s->own_order ? NULL : "no memory for the check itself";
    for (uint32_t i = 0; !fault && i < count; ++i) {
        s->own_order[i] = s->built.order[i];
        if (s->own_order[i] >= count || seen[s->own_order[i]]++) fault = "its order is no permutation of the zone's items";
    }
    free(seen);
    if (fault) {
        free(s->own_order);
        s->own_order = NULL;
    }
    return fault;
}

cull_result stand_open(stand *s, const stand_request *q)
{
    memset(s, 0, sizeof *s);
    lender_open(&s->lender);
    s->plugin = q->plugin;
    s->scene = q->scene;
    s->role = stand_role_of(q->plugin);
    s->backs = stand_backface(q->plugin, q->values) ? SIGHT_BACKS_LEFT_OUT : SIGHT_BACKS_SEEN;
    s->lender.fail_at = q->fail_at;
    s->lender.blob = q->blob;
    s->lender.zone = &q->scene->zone;
    s->lender.tasks = q->tasks;
    if (q->fill) s->lender.fill = q->fill;
    if (s->role != ROLE_SELECT && !hierarchy_make(s)) return CULL_ERR_MEMORY;
    cull_result result = q->plugin->create(&s->lender.host, q->values->values, &s->culler);
    if (result != CULL_OK) return result;
    if (!s->culler) {
        s->fault = "create said good and gave no culler";
        return CULL_ERR_ZONE;
    }
    result = q->plugin->build(s->culler, &q->scene->zone, s->role == ROLE_SELECT ? NULL : &s->hierarchy, &s->built);
    if (result != CULL_OK) return result;
    s->fault = built_fault(s);
    if (!s->fault) s->fault = order_take(s);
    return s->fault ? CULL_ERR_ZONE : CULL_OK;
}

void stand_close(stand *s)
{
    lender_release(&s->lender);
    if (s->culler) s->plugin->destroy(s->culler);
    s->culler = NULL;
    free(s->nodes);
    free(s->own_order);
    s->nodes = NULL;
    s->own_order = NULL;
}
