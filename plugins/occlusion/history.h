// One viewer's memory of a zone: what was seen, what the ledger says, and the lists of the frame under way.
// Invariant: it is a guess about what to do first. Only answers of this frame (age 0) take an item away.
// SPDX-License-Identifier: MIT
#ifndef OCCLUSION_HISTORY_H
#define OCCLUSION_HISTORY_H

#include "drop.h"
#include "heap.h"
#include "hiz_counters.h"
#include "tree.h"

// What became of the tests, summed over the frames of a viewer.
typedef struct occlusion_counters {
    uint64_t frames, tests;
    uint64_t waited;     // of them, in steps that waited for their answers
    uint64_t wasted;     // answered "seen" for an entry not drawn yet: it took nothing away
    uint64_t unanswered; // in a frame that needed them
    uint64_t age_sum, late_answers; // of answers to tests of earlier frames
    uint64_t off_units;  // units drawn without tests, summed over frames
    uint64_t rests;      // frames in which nothing was tested before it was drawn
    uint64_t joint, joint_hits; // of the tests, several entries under one; answered "hidden"
    uint64_t early;             // of the tests, for the next frame, asked as there was no other work while answers were out
    uint64_t turns;             // from drawing to testing, and back
    drop_counters drops;        // of hiz: in hiz.drops
    hiz_counters hiz;
} occlusion_counters;

// What a unit's tests removed, against what they cost; see ledger.h.
typedef struct ledger_page {
    uint32_t tests, spent, gained; // answered; what they cost and took away
    uint32_t shown;                // of a zone: what was drawn all the same
    uint32_t off_until, on_since;  // serials of frames
    uint32_t level;                // the next pause: 2^level frames
    uint32_t drawn;                // items, when it was switched off
    uint32_t is_off, is_known;     // known: looked at before
} ledger_page;

// Flags of an item: seen, how often in a row, and found hidden in the frame that had drawn it already.
enum { ITEM_SEEN = 1, ITEM_LOST = 2, ITEM_CALM_SHIFT = 2 };

enum { HISTORY_SLOT_WORDS = 8 };

struct occlusion_chc;
typedef struct occlusion_history {
    const occlusion_tree *tree;
    uint8_t *items;       // by place: flags of the method
    uint8_t *nodes;       // by node: flags of the method
    uint32_t *open_until; // by node: the frame until which its parts are tested and not itself
    uint32_t *kept_below; // by node: items seen and units off, at and under it
    uint32_t *drawn;      // by place: serial of the frame that drew it last
    uint32_t *seen_list, *drawn_list; // places seen last frame; drawn in this one
    ledger_page *pages;   // by node, of units
    uint64_t *masked;     // by place: not a candidate, or a picture or a clipped part stands for it. Empty without mask_used
    uint32_t *node_marks; // by node: serial of the frame that has candidates below it; candidates only
    heap_entry *heap;     // room for every entry
    tree_entry *pending;  // entries tested and not decided
    uint32_t *pixels;     // the answers to them
    ledger_page movers, zone;
    occlusion_counters counters;
    struct occlusion_chc *chc; // of method=chc, else NULL
    uint32_t seen_count, drawn_count, heap_count, pending_count, tested_count;
    uint32_t rested; // serial of the last frame that drew all without tests
    uint32_t tried, sampled_step, gained_before; // serial of the last frame that tested a sample first, in which step, and the zone's gain until then
    uint32_t gave_up; // serial of the last frame in which the sample said no
    uint32_t sampled_items, sample_every; // of a frame at rest: items looked at; of which one in so many is tested
    uint32_t serial, last_frame, first_run, mask_used, says_places, phase, mover_capacity, test_most, is_testing;
    uint32_t is_over, picture_tests; // the method is done with this frame, and pictures are tested: so many
    uint64_t hidden_slots[HISTORY_SLOT_WORDS]; // of pictures found hidden in the last frame; several share a bit: a guess
} occlusion_history;

typedef struct history_request {
    const occlusion_tree *tree;
    uint32_t mover_capacity;
} history_request;

// On failure nothing is left behind.
cull_result history_open(const cull_host *host, const history_request *q, occlusion_history *out);
void history_close(const cull_host *host, occlusion_history *h);

// Marks an item seen, or not, in all nodes above it.
void history_see(occlusion_history *h, uint32_t place);
void history_lose(occlusion_history *h, uint32_t place);
void history_keep(occlusion_history *h, uint32_t node, int change); // change: +1 or -1, at the node and above
void history_forget(occlusion_history *h); // what was seen, and what the frame drew
// Ends a frame: what was seen and is not drawn any more is forgotten, the drawn is the seen of the next.
void history_turn(occlusion_history *h);

#endif
