// method=wait: a test a node, nearest first; each is waited for before anything farther is looked at. What it draws is the
// least that box tests can come to, and its stalls are as many as its tests: the baseline.
// SPDX-License-Identifier: MIT
#include "method.h"

static void push(occlusion_walk *w, tree_entry e)
{
    const cull_box box = walk_box(w, e);
    heap_push(w->h->heap, &w->h->heap_count, (heap_entry){walk_key(w, &box), e});
}

static void open_node(occlusion_walk *w, uint32_t node)
{
    const tree_node *n = &w->tree->nodes[node];
    for (uint32_t i = 0; i < n->item_count; i++)
        if (walk_wants(w, n->first_item + i, WALK_CUT)) push(w, tree_entry_of_item(w->tree, n->first_item + i));
    for (uint32_t c = n->first_child; c < n->first_child + n->child_count; c++)
        if (walk_has(w, c) && walk_place_of(w, &w->tree->nodes[c].box) != WALK_OUT) push(w, c);
}

static void take(occlusion_walk *w, tree_entry e)
{
    if (e >= walk_mover_entry(w, 0)) walk_draw_mover(w, e - walk_mover_entry(w, 0));
    else if (!tree_is_node(w->tree, e)) walk_draw(w, e - w->tree->node_count);
    else open_node(w, e);
}

static void begin(occlusion_walk *w)
{
    if (w->tree->node_count && walk_has(w, 0) && walk_place_of(w, &w->tree->nodes[0].box) != WALK_OUT) push(w, 0);
    w->h->phase = 0;
}

// The movers are looked at when all that stands still is drawn.
static int movers_follow(occlusion_walk *w)
{
    if (w->h->phase) return 0;
    w->h->phase = 1;
    for (uint32_t m = 0; m < w->visit->mover_count; m++) push(w, walk_mover_entry(w, m));
    return w->visit->mover_count > 0;
}

static uint32_t steps_most(uint32_t entries)
{
    return entries < CULL_MAX_STEPS - 2 ? entries + 2 : CULL_MAX_STEPS;
}

static uint32_t tests_most(uint32_t entries)
{
    (void)entries;
    return 1;
}

static cull_progress step(occlusion_walk *w)
{
    occlusion_history *h = w->h;
    const uint32_t entries = w->tree->node_count + w->tree->item_count + w->visit->mover_count;
    const int is_last = w->visit->step + 1 >= steps_most(entries);
    if (w->visit->step == 0) begin(w);
    else if (h->tested_count && h->pixels[0]) take(w, h->pending[0]);
    h->pending_count = h->tested_count = 0;
    w->batch->limits_hit += is_last && h->heap_count;
    while (h->heap_count || movers_follow(w)) {
        const heap_entry top = heap_pop(h->heap, &h->heap_count);
        w->batch->nodes_visited++;
        if (is_last || walk_is_near(w, top.key)) {
            take(w, top.entry);
            continue;
        }
        walk_pend(w, top.entry);
        walk_ask(w, 1);
        return CULL_WAIT;
    }
    history_turn(h);
    return CULL_DONE;
}

const occlusion_method method_wait = {"wait", CULL_SAMPLED, steps_most, tests_most, step};
