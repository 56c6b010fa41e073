// Work of method=chc that nobody waits for, for the steps in which answers are out: the visible queue of CHC++ (Mattausch, Bittner,
// Wimmer 2008, section 3), then tests that find out what may stand under one test in the next frame.
// Invariant: no answer to these takes an item away in the frame that asked.
// SPDX-License-Identifier: MIT
#include "chc.h"

enum { SHARES = 4, FILLS_MOST = 16, PAIRS = 8, LOOKED_MOST = 1024, ANSWER_FRAMES = 2 };
// SHARES: parts of the visible queue, of which a step takes one. FILLS_MOST: steps in a row with nothing but such work; then the
// host is so far behind that more work is more to wait for. PAIRS: looked at, of which the one that grows least is tried.
// LOOKED_MOST: entries looked at for one that can be asked.
// ANSWER_FRAMES: until when an answer is to be there

// ---- The visible queue ----

void chc_due_add(occlusion_walk *w, tree_entry e)
{
    occlusion_chc *c = w->h->chc;
    if (c->due_count < c->due_most) c->due[c->due_count++] = e;
}

uint32_t chc_ask_due(occlusion_walk *w, uint32_t most)
{
    occlusion_chc *c = w->h->chc;
    uint32_t asked = 0;
    for (; c->due_asked < c->due_count && asked < most && chc_has_room(w); asked++) {
        const tree_entry e = c->due[c->due_asked++];
        const cull_box box = walk_box(w, e);
        chc_past_of(w, e)->due = w->h->serial + ANSWER_FRAMES; // unless the answer says otherwise
        walk_put_test(w, &box, CHC_VISIBLE | chc_known_place(w, e));
    }
    return asked;
}

// One whose time has not come, which then comes later; maybe one that was answered in this frame: more stands in front of it by now. 0: none.
static uint32_t ask_early(occlusion_walk *w)
{
    occlusion_history *h = w->h;
    const uint32_t first = h->drawn_count ? chc_random(h->serial, w->visit->step) % h->drawn_count : 0;
    for (uint32_t i = 0; i < h->drawn_count && i < LOOKED_MOST && chc_has_room(w); i++) {
        const tree_entry e = tree_entry_of_item(w->tree, h->drawn_list[(first + i) % h->drawn_count]);
        chc_past *p = chc_past_of(w, e);
        if ((int32_t)(p->due - h->serial) <= ANSWER_FRAMES) continue; // asked, or to be soon
        if (h->chc->due_count == h->chc->due_most) return 0;
        chc_due_add(w, e);
        h->counters.early++;
        return chc_ask_due(w, 1);
    }
    return 0;
}

// ---- What may stand together ----

// Not known to be seen.
static int may_pair(const occlusion_walk *w, const chc_test *t)
{
    const tree_entry leader = w->h->chc->members[t->first];
    return (t->is_open || !t->pixels) && leader < walk_mover_entry(w, 0);
}

static cull_box box_of(const occlusion_walk *w, const chc_test *t)
{
    const occlusion_chc *c = w->h->chc;
    cull_box box = walk_box(w, c->members[t->first]);
    for (uint32_t i = 1; i < t->count; i++) box = cull_box_union(box, walk_box(w, c->members[t->first + i]));
    return box;
}

// Of neighbours in the queue, some pair whose common box is not much larger than theirs. 0: none.
static int find_pair(occlusion_walk *w, chc_pair *out, cull_box *box)
{
    occlusion_chc *c = w->h->chc;
    chc_test *found = NULL;
    const uint32_t pairs = c->test_count ? c->test_count - 1 : 0, first = pairs ? chc_random(w->h->serial, w->visit->step) % pairs : 0;
    float least = INFINITY;
    for (uint32_t i = 0, looked = 0; i < pairs && i < LOOKED_MOST && looked < PAIRS; i++) {
        chc_test *a = &c->tests[(first + i) % pairs], *b = a + 1;
        if (a->is_paired || !may_pair(w, a) || !may_pair(w, b)) continue;
        const cull_box one = box_of(w, a), other = box_of(w, b), both = cull_box_union(one, other);
        const float growth = box_surface(&both) / (box_surface(&one) + box_surface(&other));
        looked++;
        if (!(growth < least) || walk_is_near(w, walk_key(w, &both))) continue;
        least = growth;
        *box = both;
        out->leader = c->members[a->first];
        out->other = c->members[b->first];
        found = a;
    }
    if (!found) return 0;
    found->is_paired = 1;
    return 1;
}

// The answer counts for the next frame: here a failure would cost a step that is waited for.
static uint32_t ask_pair(occlusion_walk *w)
{
    occlusion_chc *c = w->h->chc;
    cull_box box;
    chc_pair pair = {.frame = w->visit->view->frame};
    if (c->pair_count == CHC_PAIRS_MOST || !chc_has_room(w) || !find_pair(w, &pair, &box)) return 0;
    const uint32_t at = c->pair_next++ % CHC_PAIRS_MOST;
    c->pair_count++;
    c->pairs[at] = pair;
    walk_put_test(w, &box, CHC_PAIR | at);
    w->h->counters.early++;
    return 1;
}

void chc_hear_pair(occlusion_walk *w, const cull_answer *a)
{
    chc_pair *pair = &w->h->chc->pairs[(a->tag & ~CHC_PAIR) % CHC_PAIRS_MOST];
    if (a->age <= 1 && pair->frame == w->visit->view->frame - a->age) pair->is_hidden = a->pixels == 0;
}

static int is_among(const uint32_t *entries, uint32_t count, uint32_t entry)
{
    for (uint32_t i = 0; i < count; i++)
        if (entries[i] == entry) return 1;
    return 0;
}

void chc_join_pairs(occlusion_walk *w)
{
    occlusion_chc *c = w->h->chc;
    uint32_t joined[2 * CHC_PAIRS_MOST], count = 0; // of neighbouring pairs the first stands
    for (uint32_t i = 0; i < CHC_PAIRS_MOST; i++) {
        chc_pair *pair = &c->pairs[i];
        if (!pair->is_hidden) continue;
        pair->is_hidden = 0;
        if (c->past[pair->leader].looked != w->h->serial || c->past[pair->other].looked != w->h->serial) continue; // seen by now
        if (is_among(joined, count, pair->leader) || is_among(joined, count, pair->other)) continue;
        joined[count++] = pair->leader;
        joined[count++] = pair->other;
        c->past[pair->leader].mate = c->past[pair->other].mate = pair->leader + 1;
    }
}

// ---- A step in which answers are out ----

int chc_fill(occlusion_walk *w)
{
    occlusion_chc *c = w->h->chc;
    if (c->fills >= FILLS_MOST) return 0;
    if (!chc_ask_due(w, (c->due_count - c->due_asked) / SHARES + 1) && !ask_pair(w) && !ask_early(w)) return 0;
    c->fills++;
    return 1;
}
