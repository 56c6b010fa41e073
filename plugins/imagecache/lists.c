// What each node of the quadtree stands for: see lists.h.
// SPDX-License-Identifier: MIT
#include "lists.h"

#include <portcullis/box.h>
#include <portcullis/runs.h>

#include <string.h>

typedef struct builder {
    const cull_host *host;
    const cull_zone *zone;
    const cells *cells;
    lists *out;
    size_t room;        // runs that out->runs has room for
    cull_run *spare[2]; // each room for as many runs as all cells have
    uint32_t *listed;   // by place: cells that list it
} builder;

// Room for `more` runs behind those there are.
static int reserve(builder *b, uint32_t more)
{
    lists *l = b->out;
    const size_t needed = (size_t)l->run_count + more;
    if (needed <= b->room) return 1;
    const size_t room = needed + needed / 2;
    if (room > INT32_MAX) return 0;
    cull_run *runs = b->host->alloc(b->host, room * sizeof *runs, _Alignof(cull_run));
    if (!runs) return 0;
    if (l->run_count) memcpy(runs, l->runs, l->run_count * sizeof *runs);
    if (l->runs) b->host->free(b->host, l->runs, l->run_bytes);
    l->runs = runs;
    l->run_bytes = room * sizeof *runs;
    b->room = room;
    return 1;
}

static void count_items(builder *b, lists_node *node)
{
    for (uint32_t r = node->first_run; r < node->first_run + node->run_count; r++) {
        const cull_run run = b->out->runs[r];
        node->item_count += run.count;
        for (uint32_t p = run.first; p < run.first + run.count; p++) node->polygon_count += b->zone->items[b->cells->order[p]].polygon_count;
    }
}

static void share_items(const builder *b, lists_node *node)
{
    double share = 0;
    for (uint32_t r = node->first_run; r < node->first_run + node->run_count; r++) {
        const cull_run run = b->out->runs[r];
        for (uint32_t p = run.first; p < run.first + run.count; p++) share += (double)b->zone->items[b->cells->order[p]].polygon_count / b->listed[p];
    }
    node->polygon_share = (float)share;
}

static void count_cells(builder *b)
{
    const cells *c = b->cells;
    memset(b->listed, 0, c->item_count * sizeof *b->listed);
    for (uint32_t r = 0; r < c->run_count; r++)
        for (uint32_t p = c->runs[r].first; p < c->runs[r].first + c->runs[r].count; p++) b->listed[p]++;
}

// Runs of two homes may touch in a cell; in a node they are one.
static int list_cell(builder *b, uint32_t cell, lists_node *node)
{
    const cells *c = b->cells;
    lists *l = b->out;
    if (!reserve(b, c->firsts[cell + 1] - c->firsts[cell])) return 0;
    node->first_run = l->run_count;
    node->box = c->boxes[cell];
    for (uint32_t r = c->firsts[cell]; r < c->firsts[cell + 1]; r++) {
        const cells_run run = c->runs[r];
        cull_run *const last = l->run_count > node->first_run ? &l->runs[l->run_count - 1] : NULL;
        if (last && last->first + last->count == run.first) last->count += run.count;
        else l->runs[l->run_count++] = (cull_run){run.first, run.count};
    }
    node->run_count = l->run_count - node->first_run;
    count_items(b, node);
    share_items(b, node);
    return 1;
}

static cull_run_list runs_of(const lists *l, uint32_t node)
{
    const cull_run_list list = {l->runs + l->nodes[node].first_run, l->nodes[node].run_count};
    return list;
}

static int list_children(builder *b, uint32_t node)
{
    lists *l = b->out;
    lists_node *const to = &l->nodes[node];
    uint32_t most = 0;
    to->box = cull_box_none();
    for (uint32_t k = 0; k < 4; k++) {
        const lists_node *child = &l->nodes[nodes_child(node, k)];
        most += child->run_count;
        to->box = cull_box_union(to->box, child->box);
    }
    to->first_run = l->run_count;
    if (most == 0) return 1;
    if (!reserve(b, most)) return 0;
    const cull_run_list from[4] = {runs_of(l, nodes_child(node, 0)), runs_of(l, nodes_child(node, 1)), runs_of(l, nodes_child(node, 2)),
                                   runs_of(l, nodes_child(node, 3))};
    cull_run_list low = {b->spare[0], 0}, high = {b->spare[1], 0}, all = {l->runs + l->run_count, 0};
    cull_runs_unite(&from[0], &from[1], &low);
    cull_runs_unite(&from[2], &from[3], &high);
    cull_runs_unite(&low, &high, &all);
    to->run_count = all.count;
    l->run_count += all.count;
    count_items(b, to);
    return 1;
}

static int list_all(builder *b)
{
    const ground *g = &b->cells->ground;
    for (uint32_t cell = 0; cell < b->cells->cell_count; cell++) {
        const ground_cell at = {(int32_t)(cell % g->columns), (int32_t)(cell / g->columns)};
        if (!list_cell(b, cell, &b->out->nodes[nodes_of_cell(g, at)])) return 0;
    }
    for (uint32_t node = nodes_first(g->level); node-- > 0;)
        if (!list_children(b, node)) return 0;
    return 1;
}

cull_result lists_build(const cull_host *host, const cull_zone *zone, const cells *c, lists *out)
{
    builder b = {.host = host, .zone = zone, .cells = c, .out = out};
    const size_t spare_bytes = 2 * (c->run_count + (size_t)1) * sizeof(cull_run);
    memset(out, 0, sizeof *out);
    out->node_count = nodes_count(&c->ground);
    out->node_bytes = out->node_count * sizeof *out->nodes;
    out->nodes = host->alloc(host, out->node_bytes, _Alignof(lists_node));
    b.spare[0] = host->alloc(host, spare_bytes, _Alignof(cull_run));
    const size_t listed_bytes = (c->item_count + (size_t)1) * sizeof *b.listed;
    b.listed = host->alloc(host, listed_bytes, _Alignof(uint32_t));
    int is_done = out->nodes && b.spare[0] && b.listed;
    if (is_done) {
        b.spare[1] = b.spare[0] + c->run_count + 1;
        memset(out->nodes, 0, out->node_bytes);
        for (uint32_t n = 0; n < out->node_count; n++) out->nodes[n].box = cull_box_none();
        count_cells(&b);
        is_done = list_all(&b);
    }
    if (b.spare[0]) host->free(host, b.spare[0], spare_bytes);
    if (b.listed) host->free(host, b.listed, listed_bytes);
    if (is_done) return CULL_OK;
    lists_free(host, out);
    return CULL_ERR_MEMORY;
}

void lists_free(const cull_host *host, lists *l)
{
    if (l->nodes) host->free(host, l->nodes, l->node_bytes);
    if (l->runs) host->free(host, l->runs, l->run_bytes);
    memset(l, 0, sizeof *l);
}
