// What method=chc remembers of a viewer beside the history, and its queue of tests; see method_chc.c.
// SPDX-License-Identifier: MIT
#ifndef OCCLUSION_CHC_H
#define OCCLUSION_CHC_H

#include "chc_model.h"
#include "chc_picture.h"
#include "walk.h"

enum { CHC_FAILURES_MOST = 5, CHC_PAIRS_MOST = 64 };

// Tags: with this bit an item's place or a mover's id, of what is drawn for seen; else a place in occlusion_chc.tests.
#define CHC_VISIBLE 0x40000000u
#define CHC_PAIR 0x20000000u    // a place in occlusion_chc.pairs
#define CHC_ALONE (UINT64_C(1) << 63) // a joint test of this frame did not hide it

// Of a node, an item or, by its id, a mover. looked is this frame and since too: its parent came into sight, nothing is known of it alone.
typedef struct chc_past {
    uint32_t since;  // the frame from which it has been hidden, or held for seen, without a gap
    uint32_t looked; // the last frame that knew
    uint32_t joint;  // the last of this frame's tests that had it among others
    uint32_t mate;   // 1 + the entry that it was tested together with last, and found hidden; 0: alone
    uint32_t due;    // seen: when it is tested again. Hidden: until then joint tests with it are doubted
    uint8_t sight;   // bucket of its pixels, as last counted
    uint8_t failures;
    uint8_t is_held;  // of a mover: seen when last looked at
    uint8_t is_fresh; // found seen in this frame, behind a part of it
} chc_past;

typedef struct chc_test {
    uint32_t first, count; // in members
    float chance;          // of the answer "hidden", by its parts alone
    uint32_t step_cost;    // its share of what a step of tests costs, as in ledger.h
    uint32_t pixels;       // the answer, when is_heard
    uint8_t growth, hides, is_open, is_heard, is_split, is_known, is_paired; // is_split: alone after a joint test; is_known: they stood so before; is_paired: tried with the next
} chc_test;

// Two tests of a frame that one box round both may do for in the next.
typedef struct chc_pair { uint32_t frame, leader, other, is_hidden; } chc_pair; // frame: the host's; leader, other: first members

typedef struct occlusion_chc {
    chc_past *past;     // by node, then by item, then by mover's id; see chc_past_of
    uint32_t *seen_now; // by entry: serial of the frame that answered "seen"
    uint64_t *queue;    // the invisible queue: CHC_ALONE or 0, place of its first item, entry
    chc_test *tests;    // of this frame
    tree_entry *members;
    tree_entry *due;    // the visible queue
    chc_model model;
    chc_picture picture; // of the first marked_count items drawn in this frame
    uint32_t queue_count, test_count, first_open, member_count, member_most, open_count, due_count, due_asked, waited, rounds, has_picture, marked_count;
    chc_pair pairs[CHC_PAIRS_MOST]; // the last that were tried
    uint32_t pair_next, pair_count, due_most; // pair_count: of this frame
    uint32_t fills; // steps since an answer came, without work that the frame needs
    uint32_t sample_first; // of the tests, in a frame that asks a sample
    uint32_t batches, is_first; // batches: tests are saved up; is_first: nothing to go by
} occlusion_chc;

typedef struct chc_request { uint32_t entries, batches; } chc_request;
// On failure nothing is left behind and *h has none.
cull_result chc_open(const cull_host *host, occlusion_history *h, const chc_request *q);
void chc_close(const cull_host *host, occlusion_history *h);

void chc_begin(occlusion_walk *w);
// Answers are entered: what is hidden is noted, what a joint test did not hide is queued again, each alone, and what is seen
// stands in h->heap, with seen_now.
void chc_hear(occlusion_walk *w);
void chc_queue_add(occlusion_walk *w, tree_entry e, uint64_t how); // how: CHC_ALONE or 0
// Asks for the queue's tests, neighbours likely to be hidden in one; at most `most` tests, of what there is room for.
void chc_ask(occlusion_walk *w, uint32_t most);
// Asks for a sample of the queue, see sample.h, which the tests from sample_first on are. There is room; nothing is open.
void chc_ask_sample(occlusion_walk *w);
// Of what was seen before: it is to be tested again; it is lost so likely that the test comes before the drawing.
int chc_is_due(const occlusion_walk *w, tree_entry e);
int chc_is_doubtful(const occlusion_walk *w, tree_entry e);
// Of what a test of this frame found seen: to be tested again at its end.
int chc_is_fresh(const occlusion_walk *w, tree_entry e);
// The mover was seen last frame; is drawn for seen in this one.
int chc_holds_mover(const occlusion_walk *w, uint32_t mover);
void chc_hold_mover(occlusion_walk *w, uint32_t mover);
chc_past *chc_past_of(const occlusion_walk *w, tree_entry e);
// What was asked and is not answered is given up: each member is as good as seen.
void chc_give_up(occlusion_walk *w);
void chc_note_seen(occlusion_walk *w, tree_entry e, uint32_t pixels);
// By what it is remembered: an item's place; a mover's id, which stands behind these. Not of a node.
uint32_t chc_known_place(const occlusion_walk *w, tree_entry e);
// Of an entry by itself, to be hidden.
float chc_chance(const occlusion_walk *w, tree_entry e);
static inline int chc_has_room(const occlusion_walk *w)
{
    return w->batch->test_count < w->h->test_most;
}

// Its parent came into sight: nothing is known of the entry alone, unless it was tested last frame.
void chc_pull_down(occlusion_walk *w, tree_entry e);

// ---- Work that nobody waits for (chc_spare.c) ----

// An item or mover drawn for seen is tested at the end of this frame or while answers are out.
void chc_due_add(occlusion_walk *w, tree_entry e);
uint32_t chc_ask_due(occlusion_walk *w, uint32_t most); // how many
int chc_fill(occlusion_walk *w); // some of it, for a step that has nothing else. 0: nothing is left
void chc_hear_pair(occlusion_walk *w, const cull_answer *a);
void chc_join_pairs(occlusion_walk *w); // the end of a frame: those found hidden stand together in the next

#endif
