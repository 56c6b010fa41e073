// method=twophase: what was seen last frame is drawn, then the rest is tested in rounds near to far, at most eight steps;
// what is seen now is drawn now. Where there is no last frame to go by, a coarse picture of boxes says what stands in front.
// Invariant: an item that touches the volumes is drawn, or a test of this frame that covers it was answered 0.
// SPDX-License-Identifier: MIT
#include "cover.h"
#include "ledger.h"
#include "method.h"
#include "rest.h"
#include "sample.h"

enum { STEPS = 8, DIRECT_ITEMS = 64 }; // DIRECT_ITEMS: a node seen with no more is tested item by item

enum { MOVERS_OPEN, MOVERS_ASKED }; // a phase

typedef struct twophase {
    occlusion_walk *w;
    cover *cover;
    uint32_t steps_left; // after this one
} twophase;

// ---- Opening nodes ----

// A node that was seen: its parts are tested in this step.
static void open_node(twophase *t, uint32_t node)
{
    occlusion_walk *w = t->w;
    const tree_node *n = &w->tree->nodes[node];
    if (walk_draw_untested(w, node)) return;
    if (t->steps_left == 0) {
        walk_draw_below(w, node);
        return;
    }
    if (t->steps_left == 1 || n->below_count <= DIRECT_ITEMS) {
        walk_pend_below(w, node);
        return;
    }
    for (uint32_t i = 0; i < n->item_count; i++)
        if (walk_wants(w, n->first_item + i, WALK_CUT)) walk_pend(w, tree_entry_of_item(w->tree, n->first_item + i));
    for (uint32_t c = n->first_child; c < n->first_child + n->child_count; c++) {
        if (!walk_has(w, c) || walk_place_of(w, &w->tree->nodes[c].box) == WALK_OUT) continue;
        if (!walk_draw_untested(w, c)) walk_pend(w, c);
    }
}

// ---- The first step ----

static void look_at_items(occlusion_walk *w, const tree_node *n, walk_place at)
{
    for (uint32_t i = 0; i < n->item_count; i++) {
        const uint32_t place = n->first_item + i;
        if (!walk_wants(w, place, at)) continue;
        if ((w->h->items[place] & ITEM_SEEN) || walk_is_near(w, walk_key(w, &w->tree->boxes[place]))) walk_draw(w, place);
        else walk_pend(w, tree_entry_of_item(w->tree, place));
    }
}

// Nothing was seen below it, and it was not found seen itself of late. Where the zone does not pay nothing above its units is
// tested.
static int is_worth_a_test(const occlusion_walk *w, uint32_t node)
{
    const occlusion_history *h = w->h;
    const tree_node *n = &w->tree->nodes[node];
    if (h->kept_below[node] || (n->unit == TREE_NONE && !ledger_pays(&h->zone))) return 0;
    return (int32_t)(h->serial - h->open_until[node]) >= 0 && !walk_is_near(w, walk_key(w, &n->box));
}

// Draws what was seen; the largest subtrees of which nothing was seen are tested whole.
static void draw_seen(occlusion_walk *w)
{
    walk_cursor c = walk_from(0);
    tree_way way;
    do {
        const tree_node *n = &w->tree->nodes[c.node];
        const walk_place at = walk_has(w, c.node) ? walk_look(w, &c) : WALK_OUT;
        w->batch->nodes_visited++;
        way = TREE_PASS;
        if (at == WALK_OUT) continue;
        if (walk_draw_untested(w, c.node)) continue;
        if (is_worth_a_test(w, c.node)) walk_pend(w, c.node);
        else {
            look_at_items(w, n, at);
            way = TREE_ENTER;
        }
    } while (walk_go(w, &c, way));
}

static void push(occlusion_walk *w, tree_entry e)
{
    const cull_box box = tree_entry_box(w->tree, e);
    heap_push(w->h->heap, &w->h->heap_count, (heap_entry){walk_key(w, &box), e});
}

static void push_parts(occlusion_walk *w, const tree_node *n)
{
    for (uint32_t i = 0; i < n->item_count; i++)
        if (walk_wants(w, n->first_item + i, WALK_CUT)) push(w, tree_entry_of_item(w->tree, n->first_item + i));
    for (uint32_t c = n->first_child; c < n->first_child + n->child_count; c++)
        if (walk_has(w, c) && walk_place_of(w, &w->tree->nodes[c].box) != WALK_OUT) push(w, c);
}

static void draw_item(twophase *t, uint32_t place)
{
    walk_draw(t->w, place);
    if (t->w->tree->solid[place]) cover_mark(t->cover, &t->w->tree->boxes[place]);
}

static int is_left_for_tests(const twophase *t, const cull_box *box)
{
    const cover_state state = cover_look(t->cover, box);
    return state == COVER_FULL || state == COVER_SMALL;
}

// With nothing to go by, below the root: large items that no nearer box stands before are drawn untested, all others wait for the next
// round.
static void draw_foremost(twophase *t)
{
    occlusion_walk *w = t->w;
    if (walk_draw_untested(w, 0)) return;
    cover_begin(t->cover, w->visit->view);
    push_parts(w, &w->tree->nodes[0]);
    while (w->h->heap_count) {
        const heap_entry top = heap_pop(w->h->heap, &w->h->heap_count);
        const cull_box box = tree_entry_box(w->tree, top.entry);
        const int is_node = tree_is_node(w->tree, top.entry);
        w->batch->nodes_visited++;
        if (is_node && walk_draw_untested(w, top.entry)) continue;
        if (!walk_is_near(w, top.key) && is_left_for_tests(t, &box)) walk_pend(w, top.entry);
        else if (is_node) push_parts(w, &w->tree->nodes[top.entry]);
        else draw_item(t, top.entry - w->tree->node_count);
    }
}

// From outside of a zone what hides it may stand in others, which nobody has drawn yet: it is tested whole before anything.
static void begin_anew(twophase *t)
{
    if (!walk_has(t->w, 0) || walk_place_of(t->w, &t->w->tree->nodes[0].box) == WALK_OUT) return;
    if (walk_is_near(t->w, walk_key(t->w, &t->w->tree->nodes[0].box))) draw_foremost(t);
    else walk_pend(t->w, 0);
}

// The zone was seen whole. What stands in front of a small one, as rooms are, is in other zones: its items are tested one by one.
static int is_begun_by_test(const occlusion_walk *w)
{
    return w->tree->item_count > TREE_UNIT_ITEMS && w->visit->step == 1 && w->h->tested_count == 1 && w->h->pending[0] == 0 && !w->h->drawn_count;
}

// ---- Later steps ----

// What a test found seen comes nearest first; what could not be tested yet waits again.
static void sort_answers(twophase *t)
{
    occlusion_walk *w = t->w;
    occlusion_history *h = w->h;
    const uint32_t count = h->pending_count, tested = h->tested_count;
    h->pending_count = 0;
    for (uint32_t i = 0; i < count; i++) {
        const tree_entry e = h->pending[i];
        if (i >= tested && t->steps_left) walk_pend(w, e); // never ahead of i
        else if (e >= walk_mover_entry(w, 0)) {
            if (h->pixels[i]) walk_draw_mover(w, e - walk_mover_entry(w, 0));
        } else if (h->pixels[i]) push(w, e);
    }
    w->batch->limits_hit += count > tested && tested == h->test_most;
}

static void draw_layer(twophase *t)
{
    occlusion_walk *w = t->w;
    cover_begin(t->cover, w->visit->view);
    sort_answers(t);
    while (w->h->heap_count) {
        const heap_entry top = heap_pop(w->h->heap, &w->h->heap_count);
        const cull_box box = tree_entry_box(w->tree, top.entry);
        w->batch->nodes_visited++;
        if (t->steps_left && cover_look(t->cover, &box) == COVER_FULL) walk_pend(w, top.entry);
        else if (tree_is_node(w->tree, top.entry)) open_node(t, top.entry);
        else draw_item(t, top.entry - w->tree->node_count);
    }
}

// ---- Whether a zone is worth its first tests ----

// Spreads those that are asked over all that is pending, which came near to far.
static void ask_sample(occlusion_walk *w)
{
    occlusion_history *h = w->h;
    const uint32_t stride = sample_stride(h->pending_count);
    for (uint32_t i = 0; i < SAMPLE_TESTS; i++) {
        const tree_entry e = h->pending[i];
        h->pending[i] = h->pending[i * stride];
        h->pending[i * stride] = e;
    }
    sample_begin(w);
    walk_ask(w, SAMPLE_TESTS);
}

static uint32_t hidden_of_sample(const occlusion_walk *w)
{
    uint32_t hidden = 0;
    for (uint32_t i = 0; i < w->h->tested_count; i++) hidden += w->h->pixels[i] == 0;
    return hidden;
}

// All that is pending is drawn, but for what the sample found hidden. Of what is drawn the sample alone counts, as of what is hidden.
static void give_up(twophase *t)
{
    occlusion_walk *w = t->w;
    occlusion_history *h = w->h;
    for (uint32_t i = 0; i < h->pending_count; i++) {
        const tree_entry e = h->pending[i];
        if (i < h->tested_count && h->pixels[i] == 0) continue;
        if (i < h->tested_count) ledger_show(&h->zone, tree_entry_polygons(w->tree, e));
        sample_draw(w, e);
    }
    h->pending_count = 0;
    sample_give_up(w);
}

static int is_worth_a_sample(const twophase *t)
{
    return t->w->h->phase == MOVERS_OPEN && t->steps_left > 2 && sample_is_due(t->w, t->w->h->pending_count);
}

static void go_on(twophase *t)
{
    occlusion_history *h = t->w->h;
    if (sample_is_answered(t->w) && !sample_pays(t->w, h->tested_count, hidden_of_sample(t->w))) {
        give_up(t);
        return;
    }
    if (!is_begun_by_test(t->w)) {
        draw_layer(t);
        return;
    }
    h->pending_count = 0;
    if (h->pixels[0]) draw_foremost(t);
}

// ---- Movers ----

// Tested once, when nothing else is open: by then all that hides them is drawn.
static void look_at_movers(twophase *t)
{
    occlusion_walk *w = t->w;
    const uint32_t count = w->visit->mover_count;
    if (w->h->phase == MOVERS_ASKED || !count || (w->h->pending_count && t->steps_left > 1)) return;
    w->h->phase = MOVERS_ASKED;
    const int is_off = ledger_look(&w->h->movers, &w->h->movers, w->h->serial, 0) == LEDGER_OFF;
    for (uint32_t m = 0; m < count; m++)
        if (is_off || !t->steps_left || walk_is_near(w, walk_key(w, &w->visit->movers[m].box))) walk_draw_mover(w, m);
        else walk_pend(w, walk_mover_entry(w, m));
}

// ---- The end of a frame ----

// Items drawn are tested against the whole frame, those long seen less often: the answer says who is drawn first next time.
static void ask_for_next_frame(occlusion_walk *w)
{
    occlusion_history *h = w->h;
    if (w->visit->view->flags & CULL_VIEW_CUT) return; // one frame without coming back for it
    for (uint32_t i = 0; i < h->drawn_count; i++) {
        const uint32_t place = h->drawn_list[i], calm = h->items[place] >> ITEM_CALM_SHIFT, spread = place * 2654435761u / 65536u;
        if (((h->serial + spread) & ((1u << calm) - 1)) == 0 && !walk_ask_final(w, place)) return;
    }
}

static void end_frame(occlusion_walk *w)
{
    if (sample_gave_up(w)) history_forget(w->h);
    else {
        ask_for_next_frame(w);
        rest_count_drawn(w);
    }
    history_turn(w->h);
}

static uint32_t steps_most(uint32_t entries)
{
    (void)entries;
    return STEPS;
}

static cull_progress step(occlusion_walk *w)
{
    occlusion_history *h = w->h;
    twophase t = {w, w->visit->scratch, STEPS - 1 - w->visit->step};
    if (w->visit->step == 0) h->phase = MOVERS_OPEN;
    if (w->visit->step == 0 && rest_frame(w)) return CULL_DONE;
    if (w->visit->step) go_on(&t);
    else if (w->tree->node_count && (h->seen_count == 0 || (w->visit->view->flags & CULL_VIEW_CUT))) begin_anew(&t);
    else if (w->tree->node_count) draw_seen(w);
    look_at_movers(&t);
    if (h->pending_count && t.steps_left) {
        if (is_worth_a_sample(&t)) ask_sample(w);
        else walk_ask(w, UINT32_MAX);
        return CULL_WAIT;
    }
    end_frame(w);
    return CULL_DONE;
}

const occlusion_method method_twophase = {"twophase", CULL_SAMPLED, steps_most, method_tests, step};
