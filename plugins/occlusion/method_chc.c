// method=chc: Bittner, Wimmer, Piringer, Purgathofer, "Coherent Hierarchical Culling: Hardware Occlusion Queries Made Useful",
// 2004, and Mattausch, Bittner, Wimmer, "CHC++: Coherent Hierarchical Culling Revisited", 2008. What was seen is drawn, near to
// far, while the tests of what was hidden are under way; these are saved up in a queue, and several stand under one test.
// Invariant: an item that touches the volumes is drawn, or a test of this frame that covers it was answered 0.
// SPDX-License-Identifier: MIT
#include "chc.h"
#include "cover.h"
#include "ledger.h"
#include "method.h"
#include "rest.h"
#include "sample.h"

enum { QUEUE_MOST = 256, DIRECT_ITEMS = 64, ROUNDS_MOST = 8 };
// QUEUE_MOST: tests saved up. DIRECT_ITEMS: a node come into sight with no more is tested item by item. ROUNDS_MOST: after which
// nothing is guessed any more

typedef struct chc_walk {
    occlusion_walk *w;
    occlusion_chc *c;
    cover *cover;
    uint32_t is_covering, is_last; // covering: what this step draws is marked
} chc_walk;

// ---- Drawing ----

static void draw_item(chc_walk *t, uint32_t place)
{
    walk_draw(t->w, place);
    if (t->is_covering && t->w->tree->solid[place]) cover_mark(t->cover, &t->w->tree->boxes[place]);
}

// Was seen before: drawn without a test, and looked at again when its time has come; before it is drawn where it is likely lost.
static void draw_seen(chc_walk *t, uint32_t place)
{
    const tree_entry e = tree_entry_of_item(t->w->tree, place);
    const int is_due = chc_is_due(t->w, e);
    if (is_due && chc_is_doubtful(t->w, e)) {
        chc_queue_add(t->w, e, 0);
        return;
    }
    draw_item(t, place);
    if (is_due) chc_due_add(t->w, e);
}

// Seen behind what was drawn by then, which is not all: looked at again at the end of the frame.
static void draw_found(chc_walk *t, tree_entry e)
{
    if (e >= walk_mover_entry(t->w, 0)) walk_draw_mover(t->w, e - walk_mover_entry(t->w, 0));
    else draw_item(t, e - t->w->tree->node_count);
    if (chc_is_fresh(t->w, e)) chc_due_add(t->w, e);
}

// ---- Opening nodes ----

static void queue_opened(chc_walk *t, tree_entry e)
{
    chc_pull_down(t->w, e);
    chc_queue_add(t->w, e, 0);
}

static void queue_items_below(chc_walk *t, uint32_t node)
{
    occlusion_walk *w = t->w;
    walk_pend_below(w, node);
    for (uint32_t i = 0; i < w->h->pending_count; i++) queue_opened(t, w->h->pending[i]);
    w->h->pending_count = 0;
}

// It came into sight: its parts are tested, each for itself.
static void open_node(chc_walk *t, uint32_t node)
{
    occlusion_walk *w = t->w;
    const tree_node *n = &w->tree->nodes[node];
    if (walk_draw_untested(w, node)) return;
    if (n->below_count <= DIRECT_ITEMS) {
        queue_items_below(t, node);
        return;
    }
    for (uint32_t i = 0; i < n->item_count; i++)
        if (walk_wants(w, n->first_item + i, WALK_CUT)) queue_opened(t, tree_entry_of_item(w->tree, n->first_item + i));
    for (uint32_t c = n->first_child; c < n->first_child + n->child_count; c++) {
        if (!walk_has(w, c) || walk_place_of(w, &w->tree->nodes[c].box) == WALK_OUT) continue;
        if (!walk_draw_untested(w, c)) queue_opened(t, c);
    }
}

// ---- The distance queue ----

static void push(chc_walk *t, tree_entry e)
{
    const cull_box box = tree_entry_box(t->w->tree, e);
    heap_push(t->w->h->heap, &t->w->h->heap_count, (heap_entry){walk_key(t->w, &box), e});
}

static void push_children(chc_walk *t, const tree_node *n)
{
    for (uint32_t c = n->first_child; c < n->first_child + n->child_count; c++)
        if (walk_has(t->w, c) && walk_place_of(t->w, &t->w->tree->nodes[c].box) != WALK_OUT) push(t, c);
}

static void push_parts(chc_walk *t, const tree_node *n)
{
    for (uint32_t i = 0; i < n->item_count; i++)
        if (walk_wants(t->w, n->first_item + i, WALK_CUT)) push(t, tree_entry_of_item(t->w->tree, n->first_item + i));
    push_children(t, n);
}

// Nothing was seen below it, and it was not found seen itself of late.
static int is_worth_a_test(const occlusion_walk *w, uint32_t node)
{
    const occlusion_history *h = w->h;
    const tree_node *n = &w->tree->nodes[node];
    if (h->kept_below[node] || (n->unit == TREE_NONE && !ledger_pays(&h->zone))) return 0;
    return (int32_t)(h->serial - h->open_until[node]) >= 0;
}

static void look_at_node(chc_walk *t, heap_entry top)
{
    occlusion_walk *w = t->w;
    const tree_node *n = &w->tree->nodes[top.entry];
    if (walk_draw_untested(w, top.entry)) return;
    if (!walk_is_near(w, top.key) && is_worth_a_test(w, top.entry)) {
        chc_queue_add(w, top.entry, 0);
        return;
    }
    for (uint32_t place = n->first_item; place < n->first_item + n->item_count; place++) {
        if (!walk_wants(w, place, WALK_CUT)) continue;
        if (w->h->items[place] & ITEM_SEEN) draw_seen(t, place);
        else if (walk_is_near(w, walk_key(w, &w->tree->boxes[place]))) draw_item(t, place);
        else chc_queue_add(w, tree_entry_of_item(w->tree, place), 0);
    }
    push_children(t, n);
}

// With nothing to go by: large items that no nearer box stands before are drawn untested, all others are tested.
static void look_first(chc_walk *t, heap_entry top)
{
    occlusion_walk *w = t->w;
    const int is_node = tree_is_node(w->tree, top.entry);
    if (is_node && walk_draw_untested(w, top.entry)) return;
    if (!walk_is_near(w, top.key)) {
        const cull_box box = tree_entry_box(w->tree, top.entry);
        const cover_state state = cover_look(t->cover, &box);
        if (state == COVER_FULL || state == COVER_SMALL) {
            chc_queue_add(w, top.entry, 0);
            return;
        }
    }
    if (!is_node) {
        draw_item(t, top.entry - w->tree->node_count);
        chc_due_add(w, top.entry);
        return;
    }
    push_parts(t, &w->tree->nodes[top.entry]);
}

// With nothing to go by, a large zone that was seen whole: what is in front in it is guessed. What stands in front of a small one,
// as rooms are, is in other zones: its parts are tested.
static int begins_here(const chc_walk *t, tree_entry e)
{
    return e == 0 && t->c->is_first && t->w->tree->item_count > TREE_UNIT_ITEMS && !t->w->h->drawn_count;
}

// A test of this frame found it seen. What nearer ones of this step cover is tested again behind them.
static void take_seen(chc_walk *t, tree_entry e)
{
    occlusion_walk *w = t->w;
    const cull_box box = walk_box(w, e);
    if (begins_here(t, e)) push_parts(t, &w->tree->nodes[0]);
    else if (t->is_covering && cover_look(t->cover, &box) == COVER_FULL) chc_queue_add(w, e, 0);
    else if (tree_is_node(w->tree, e)) open_node(t, e);
    else draw_found(t, e);
}

static void traverse(chc_walk *t)
{
    occlusion_walk *w = t->w;
    const uint32_t queue_most = t->c->batches ? QUEUE_MOST : 1;
    while (w->h->heap_count && (t->c->queue_count < queue_most || t->c->is_first)) {
        const heap_entry top = heap_pop(w->h->heap, &w->h->heap_count);
        w->batch->nodes_visited++;
        if (t->c->seen_now[top.entry] == w->h->serial) take_seen(t, top.entry);
        else if (t->c->is_first) look_first(t, top);
        else look_at_node(t, top);
    }
}

// ---- Steps ----

// With nothing to go by and from outside of the zone, what hides it may stand in others, which nobody has drawn yet: it is tested
// whole before anything.
static void begin(chc_walk *t)
{
    occlusion_walk *w = t->w;
    chc_begin(w);
    w->h->phase = 0;
    if (!w->tree->node_count || !walk_has(w, 0) || walk_place_of(w, &w->tree->nodes[0].box) == WALK_OUT) return;
    if (t->c->is_first && !walk_is_near(w, walk_key(w, &w->tree->nodes[0].box))) chc_queue_add(w, 0, 0);
    else push(t, 0);
}

// As draw_seen: what was seen of it, by its id, holds for a while.
static void draw_mover_seen(chc_walk *t, uint32_t m)
{
    const tree_entry e = walk_mover_entry(t->w, m);
    const int is_due = chc_is_due(t->w, e);
    if (is_due && chc_is_doubtful(t->w, e)) {
        chc_queue_add(t->w, e, 0);
        return;
    }
    walk_draw_mover(t->w, m);
    chc_hold_mover(t->w, m);
    if (is_due) chc_due_add(t->w, e);
}

// Looked at when all that was seen is drawn; with nothing to go by, when all that stands still is.
static void look_at_movers(chc_walk *t)
{
    occlusion_walk *w = t->w;
    const uint32_t count = w->visit->mover_count;
    if (w->h->phase || !count || w->h->heap_count || (t->c->is_first && (t->c->queue_count || t->c->open_count))) return;
    w->h->phase = 1;
    const int is_off = ledger_look(&w->h->movers, &w->h->movers, w->h->serial, 0) == LEDGER_OFF;
    for (uint32_t m = 0; m < count; m++)
        if (is_off || walk_is_near(w, walk_key(w, &w->visit->movers[m].box))) walk_draw_mover(w, m);
        else if (chc_holds_mover(w, m)) draw_mover_seen(t, m);
        else chc_queue_add(w, walk_mover_entry(w, m), 0);
}

// ---- Whether a zone is worth its first tests ----

// All that was open is drawn, but for what the sample found hidden. Of what is drawn the sample alone counts, as of what is hidden.
static void give_up(chc_walk *t)
{
    occlusion_walk *w = t->w;
    while (w->h->heap_count) {
        const tree_entry e = heap_pop(w->h->heap, &w->h->heap_count).entry;
        ledger_show(&w->h->zone, tree_entry_polygons(w->tree, e));
        sample_draw(w, e);
    }
    for (uint32_t i = 0; i < t->c->queue_count; i++) sample_draw(w, (tree_entry)t->c->queue[i]);
    t->c->queue_count = 0;
    sample_give_up(w);
}

// The heap holds what the sample found seen: before it the first frame's walk was done, and nothing else was under way.
static void judge_sample(chc_walk *t)
{
    const uint32_t first = t->c->sample_first, tests = t->c->test_count - first;
    uint32_t hidden = 0;
    if (!sample_is_answered(t->w)) return;
    for (uint32_t i = first; i < t->c->test_count; i++) hidden += t->c->tests[i].is_heard && t->c->tests[i].pixels == 0;
    if (!sample_pays(t->w, tests, hidden)) give_up(t);
}

static int is_worth_a_sample(const chc_walk *t)
{
    const int is_alone = t->c->is_first && !t->w->h->phase && !t->w->h->heap_count && !t->c->open_count && !t->is_last;
    return is_alone && t->c->member_most - t->c->member_count >= SAMPLE_TESTS && sample_is_due(t->w, t->c->queue_count);
}

// The last step there is: all that is open is drawn.
static void draw_all(chc_walk *t)
{
    occlusion_walk *w = t->w;
    w->batch->limits_hit++;
    chc_give_up(w);
    while (t->c->queue_count || w->h->heap_count) {
        const tree_entry e = t->c->queue_count ? (tree_entry)t->c->queue[--t->c->queue_count] : heap_pop(w->h->heap, &w->h->heap_count).entry;
        if (e >= walk_mover_entry(w, 0)) walk_draw_mover(w, e - walk_mover_entry(w, 0));
        else if (tree_is_node(w->tree, e)) walk_draw_below(w, e);
        else walk_draw(w, e - w->tree->node_count);
    }
}

static uint32_t steps_most(uint32_t entries)
{
    return entries < CULL_MAX_STEPS / 4 - 64 ? entries * 4 + 64 : CULL_MAX_STEPS;
}

static int is_open(const chc_walk *t)
{
    return t->w->h->heap_count || t->c->queue_count || t->c->open_count;
}

// What was seen and is due is tested now at the latest: these answers nobody waits for.
static cull_progress end(chc_walk *t)
{
    occlusion_walk *w = t->w;
    if (sample_gave_up(w)) history_forget(w->h);
    else {
        if (!(w->visit->view->flags & CULL_VIEW_CUT)) chc_ask_due(w, UINT32_MAX);
        chc_join_pairs(w);
        rest_count_drawn(w);
    }
    history_turn(w->h);
    return CULL_DONE;
}

static cull_progress wait_for(occlusion_walk *w, uint32_t tests)
{
    w->h->chc->waited = 1;
    w->h->counters.waited += tests;
    return CULL_WAIT;
}

// While answers are out, what is of use to the next frame is done. With nothing left it waits.
static cull_progress go_on(chc_walk *t)
{
    occlusion_walk *w = t->w;
    occlusion_chc *c = t->c;
    if (!is_open(t)) return end(t);
    if (w->h->heap_count || c->queue_count || w->batch->test_count || w->batch->run_count > w->h->first_run) return CULL_MORE;
    if (chc_fill(w)) return CULL_MORE;
    return wait_for(w, c->open_count);
}

static cull_progress step(occlusion_walk *w)
{
    occlusion_chc *c = w->h->chc;
    chc_walk t = {w, c, w->visit->scratch, 0, w->visit->step + 1 >= steps_most(w->tree->node_count + w->tree->item_count + w->visit->mover_count)};
    if (w->visit->step == 0 && rest_frame(w)) return CULL_DONE;
    if (w->visit->step == 0) begin(&t);
    const uint32_t known = w->h->heap_count;
    chc_hear(w);
    judge_sample(&t);
    const uint32_t has_news = w->visit->step && w->h->heap_count > known;
    c->rounds += has_news != 0;
    t.is_covering = (has_news && c->rounds <= ROUNDS_MOST) || (c->is_first && w->visit->step == 0);
    if (t.is_covering) cover_begin(t.cover, w->visit->view);
    if (t.is_last) draw_all(&t);
    traverse(&t);
    look_at_movers(&t);
    if (is_worth_a_sample(&t)) {
        chc_ask_sample(w);
        return wait_for(w, SAMPLE_TESTS);
    }
    if (t.is_last) draw_all(&t);
    else if (c->queue_count && (!w->h->heap_count || c->queue_count >= (c->batches ? QUEUE_MOST : 1))) chc_ask(w, c->batches ? UINT32_MAX : 1);
    return go_on(&t);
}

const occlusion_method method_chc = {"chc", CULL_SAMPLED, steps_most, method_tests, step};
