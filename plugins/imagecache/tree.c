// The quadtree of homes: see tree.h.
// SPDX-License-Identifier: MIT
#include "tree.h"

#include <portcullis/box.h>
#include <portcullis/plane.h>

#include <string.h>

// ---- Build ----

static void fill_leaf(const cells *c, uint32_t cell, tree_node *node)
{
    for (uint32_t r = c->firsts[cell]; r < c->firsts[cell + 1]; r++) {
        if (c->runs[r].home != cell) continue;
        node->first = c->runs[r].first;
        node->count = c->runs[r].count;
        for (uint32_t p = node->first; p < node->first + node->count; p++) node->box = cull_box_union(node->box, c->items[p]);
    }
}

static void fill_parent(tree *t, uint32_t node)
{
    tree_node *const to = &t->nodes[node];
    for (uint32_t k = 0; k < 4; k++) { // in Morton order: their runs follow one another
        const tree_node *child = &t->nodes[nodes_child(node, k)];
        if (child->count == 0) continue;
        if (to->count == 0) to->first = child->first;
        to->count += child->count;
        to->box = cull_box_union(to->box, child->box);
    }
}

int tree_build(const cull_host *host, const cells *c, tree *out)
{
    const ground *g = &c->ground;
    memset(out, 0, sizeof *out);
    out->node_count = nodes_count(g);
    out->bytes = out->node_count * sizeof *out->nodes;
    out->nodes = host->alloc(host, out->bytes, _Alignof(tree_node));
    if (!out->nodes) return 0;
    for (uint32_t n = 0; n < out->node_count; n++) out->nodes[n] = (tree_node){cull_box_none(), 0, 0};
    for (uint32_t cell = 0; cell < c->cell_count; cell++) {
        const ground_cell at = {(int32_t)(cell % g->columns), (int32_t)(cell / g->columns)};
        fill_leaf(c, cell, &out->nodes[nodes_of_cell(g, at)]);
    }
    for (uint32_t node = nodes_first(g->level); node-- > 0;) fill_parent(out, node);
    return 1;
}

void tree_free(const cull_host *host, tree *t)
{
    if (t->nodes) host->free(host, t->nodes, t->bytes);
    memset(t, 0, sizeof *t);
}

// ---- Walk ----

typedef struct tree_at {
    nodes_square square;
    uint32_t node, mask; // mask: volumes that touch what is above
} tree_at;

typedef struct walker {
    const tree_query *query;
    cull_run *runs;
    uint32_t run_count, judged, leaves; // leaves: nodes from here on are cells
} walker;

static void put_run(walker *w, uint32_t first, uint32_t count)
{
    cull_run *const last = w->run_count ? &w->runs[w->run_count - 1] : NULL;
    if (last && last->first + last->count == first) last->count += count;
    else w->runs[w->run_count++] = (cull_run){first, count};
}

// What of the mask touches the box; *inside: one of these holds all of it.
static uint32_t judge(walker *w, cull_box box, uint32_t mask, int *inside)
{
    *inside = 0;
    w->judged++;
    for (uint32_t v = 0, left = mask; left && !*inside; v++, left >>= 1) {
        if (!(left & 1)) continue;
        if (!cull_volume_touches(&w->query->volumes[v], box)) mask &= ~((uint32_t)1 << v);
        else *inside = cull_volume_contains(&w->query->volumes[v], box);
    }
    return mask;
}

static void walk_items(walker *w, const tree_node *node, uint32_t mask)
{
    for (uint32_t p = node->first; p < node->first + node->count; p++) {
        int inside;
        if (judge(w, w->query->cells->items[p], mask, &inside)) put_run(w, p, 1);
    }
}

static uint32_t push_children(const walker *w, const tree_at *at, uint32_t mask, tree_at *stack, uint32_t depth)
{
    const int32_t half = at->square.side / 2, i = at->square.first.i, j = at->square.first.j;
    const ground_cell eye = w->query->eye;
    const uint32_t near = (eye.i >= i + half ? 1u : 0u) | (eye.j >= j + half ? 2u : 0u);
    for (uint32_t k = 4; k-- > 0;) { // the last put on is the next taken
        const uint32_t quadrant = near ^ k, child = nodes_child(at->node, quadrant);
        if (w->query->tree->nodes[child].count == 0) continue;
        const nodes_square s = {{i + (quadrant & 1 ? half : 0), j + (quadrant & 2 ? half : 0)}, half};
        stack[depth++] = (tree_at){s, child, mask};
    }
    return depth;
}

uint32_t tree_walk(const tree_query *q, cull_run *runs, uint32_t *judged)
{
    const ground *g = &q->cells->ground;
    walker w = {.query = q, .runs = runs, .leaves = nodes_first(g->level)};
    tree_at stack[NODES_STACK] = {{{{0, 0}, (int32_t)1 << g->level}, 0, q->volume_count < 32 ? ((uint32_t)1 << q->volume_count) - 1 : UINT32_MAX}};
    uint32_t depth = q->tree->nodes[0].count > 0 ? 1 : 0;
    while (depth > 0) {
        const tree_at at = stack[--depth];
        const tree_node *node = &q->tree->nodes[at.node];
        int inside;
        const uint32_t mask = judge(&w, node->box, at.mask, &inside);
        if (!mask) continue;
        if (inside) put_run(&w, node->first, node->count);
        else if (node->count <= TREE_ITEMS || at.node >= w.leaves) walk_items(&w, node, mask);
        else depth = push_children(&w, &at, mask, stack, depth);
    }
    *judged += w.judged;
    return w.run_count;
}
