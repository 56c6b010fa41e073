// method=last: what the last answers said is believed. One step, no wait, and wrong where something comes into sight: it
// promises nothing. What was never tested is drawn.
// SPDX-License-Identifier: MIT
#include "method.h"

enum { LAST_UNKNOWN, LAST_HIDDEN, LAST_SEEN }; // h->items and h->nodes

static uint8_t *flags_of(occlusion_walk *w, tree_entry e)
{
    return tree_is_node(w->tree, e) ? &w->h->nodes[e] : &w->h->items[e - w->tree->node_count];
}

static void forget_parts(occlusion_walk *w, const tree_node *n)
{
    for (uint32_t i = 0; i < n->item_count; i++) w->h->items[n->first_item + i] = LAST_UNKNOWN;
    for (uint32_t c = n->first_child; c < n->first_child + n->child_count; c++) w->h->nodes[c] = LAST_UNKNOWN;
}

// The parts of a node that comes into sight are unknown: they were not asked about while it was hidden.
static void hear(occlusion_walk *w)
{
    const uint32_t known = w->tree->node_count + w->tree->item_count;
    for (uint32_t i = 0; i < w->visit->answer_count; i++) {
        const cull_answer *a = &w->visit->answers[i];
        if (a->tag >= known) continue;
        uint8_t *flags = flags_of(w, a->tag);
        if (a->pixels && tree_is_node(w->tree, a->tag) && *flags != LAST_SEEN) forget_parts(w, &w->tree->nodes[a->tag]);
        *flags = a->pixels ? LAST_SEEN : LAST_HIDDEN;
    }
}

static void ask(occlusion_walk *w, tree_entry e)
{
    if (w->batch->test_count == w->h->test_most) {
        *flags_of(w, e) = LAST_UNKNOWN; // what cannot be tested is not believed to be hidden for ever
        w->batch->limits_hit++;
        return;
    }
    w->batch->tests[w->batch->test_count++] = (cull_test){walk_box(w, e), e, 0};
    w->h->counters.tests++;
}

// A node of which all parts are hidden is hidden from the next frame on.
static void look_at_items(occlusion_walk *w, const tree_node *n, walk_place at)
{
    for (uint32_t i = 0; i < n->item_count; i++) {
        const uint32_t place = n->first_item + i;
        if (!walk_wants(w, place, at)) continue;
        const int is_near = walk_is_near(w, walk_key(w, &w->tree->boxes[place]));
        if (is_near || w->h->items[place] != LAST_HIDDEN) walk_draw(w, place);
        if (!is_near) ask(w, tree_entry_of_item(w->tree, place));
    }
}

static int is_all_hidden(const occlusion_walk *w, const tree_node *n)
{
    uint32_t hidden = 0, parts = n->item_count;
    for (uint32_t i = 0; i < n->item_count; i++) hidden += w->h->items[n->first_item + i] == LAST_HIDDEN;
    for (uint32_t c = n->first_child; c < n->first_child + n->child_count; c++) {
        parts += w->tree->nodes[c].below_count != 0;
        hidden += w->tree->nodes[c].below_count && w->h->nodes[c] == LAST_HIDDEN;
    }
    return hidden == parts;
}

static cull_progress step(occlusion_walk *w)
{
    walk_cursor c = walk_from(0);
    hear(w);
    if (!w->tree->node_count) return CULL_DONE;
    tree_way way;
    do {
        const tree_node *n = &w->tree->nodes[c.node];
        const walk_place at = walk_has(w, c.node) ? walk_look(w, &c) : WALK_OUT;
        w->batch->nodes_visited++;
        way = TREE_PASS;
        if (at == WALK_OUT) continue;
        const int is_near = walk_is_near(w, walk_key(w, &n->box));
        uint8_t *flags = &w->h->nodes[c.node];
        if (is_near) *flags = LAST_SEEN;
        else if (*flags == LAST_SEEN && is_all_hidden(w, n)) *flags = LAST_HIDDEN;
        if (*flags != LAST_SEEN) {
            if (*flags == LAST_UNKNOWN) walk_draw_below(w, c.node);
            ask(w, c.node);
            continue;
        }
        way = TREE_ENTER;
        look_at_items(w, n, at);
    } while (walk_go(w, &c, way));
    for (uint32_t m = 0; m < w->visit->mover_count; m++) walk_draw_mover(w, m);
    w->h->drawn_count = 0; // no lists of what was seen
    return CULL_DONE;
}

static uint32_t steps_most(uint32_t entries)
{
    (void)entries;
    return 1;
}

const occlusion_method method_last = {"last", 0, steps_most, method_tests, step};
