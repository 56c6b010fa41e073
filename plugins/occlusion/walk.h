// What the methods share: one step's view of the tree, volumes, candidates and movers; how entries are drawn and tested.
// SPDX-License-Identifier: MIT
#ifndef OCCLUSION_WALK_H
#define OCCLUSION_WALK_H

#include "history.h"

#include <portcullis/plane.h>

#include <float.h>

typedef struct occlusion_walk {
    const occlusion_tree *tree;
    occlusion_history *h;
    const cull_visit *visit;
    cull_batch *batch;
    float eye[3], near2; // near2: square of the distance within which a box may reach the near plane; below 0 for a far viewer
    const uint32_t *ids, *places; // of items as said to the host, by place, and back; NULL: ids are places
    uint32_t takes_candidates;    // these stand for the volumes
} occlusion_walk;

typedef enum walk_place { WALK_OUT, WALK_CUT, WALK_IN } walk_place; // of a box in the volumes

// Tags of tests: FINAL and an item's place, asked when the frame was complete; else a place in h->pending.
#define WALK_FINAL 0x80000000u
#define WALK_PICTURE 0xC0000000u // and a picture's number, behind them a clipped one's; places and movers' ids are below 2^30
#define WALK_NO_NUMBER (-FLT_MAX) // a key
static inline int walk_is_of_picture(uint32_t tag)
{
    return (tag & WALK_PICTURE) == WALK_PICTURE;
}

// Begins a frame (step 0): serial, marks of candidates and pictures. Call once before all else.
void walk_begin(occlusion_walk *w);
walk_place walk_place_of(const occlusion_walk *w, const cull_box *box);

// The square of the distance to the nearest point of the box, or how far it lies along the view for an infinitely far
// viewer. WALK_NO_NUMBER for what is none: that comes first, and counts as near.
float walk_key(const occlusion_walk *w, const cull_box *box);

static inline int walk_is_near(const occlusion_walk *w, float key)
{
    return key == WALK_NO_NUMBER || (w->near2 >= 0 && !(key > w->near2));
}

// The node has something to look at: of a walk over candidates, one of them lies below.
static inline int walk_has(const occlusion_walk *w, uint32_t node)
{
    return w->tree->nodes[node].below_count && (!w->takes_candidates || w->h->node_marks[node] == w->h->serial);
}

static inline int walk_is_masked(const occlusion_walk *w, uint32_t place)
{
    return w->h->mask_used && (w->h->masked[place / 64] >> (place % 64) & 1);
}

enum { MOVER_POLYGONS = 6 }; // a mover's polygons are not told: a box
void walk_put_run(occlusion_walk *w, uint32_t first, uint32_t count); // as said to the host
// Drawn in this step; an item that the frame has drawn is not drawn again.
void walk_draw(occlusion_walk *w, uint32_t place);
uint32_t walk_draw_below(occlusion_walk *w, uint32_t node); // all items of the subtree that touch the volumes; how many
// Draws a unit that the ledger says does not pay, or that is to be looked at afterwards. 0: it is no such unit. While it is
// off it counts as something kept.
int walk_draw_untested(occlusion_walk *w, uint32_t node);
void walk_draw_mover(occlusion_walk *w, uint32_t mover); // its place in visit.movers

// The entry of a mover, and back.
static inline tree_entry walk_mover_entry(const occlusion_walk *w, uint32_t mover)
{
    return w->tree->node_count + w->tree->item_count + mover;
}

cull_box walk_box(const occlusion_walk *w, tree_entry e);

// A stackless walk of a subtree that knows what lies whole inside the volumes.
typedef struct walk_cursor { uint32_t start, node, inside_from; } walk_cursor;
static inline walk_cursor walk_from(uint32_t start)
{
    const walk_cursor c = {start, start, TREE_NONE};
    return c;
}

// Where the cursor's node lies.
walk_place walk_look(const occlusion_walk *w, walk_cursor *c);
// On to the next node; 0 at the end.
int walk_go(const occlusion_walk *w, walk_cursor *c, tree_way way);
// The item of a node that lies so is to be looked at.
int walk_wants(const occlusion_walk *w, uint32_t place, walk_place node_at);

// Puts the entry among those that this step tests.
void walk_pend(occlusion_walk *w, tree_entry e);
void walk_pend_below(occlusion_walk *w, uint32_t node); // items of the subtree, each on its own; units that are off are drawn
// Asks for the tests of the first pending entries, as many as there is room for, `most` of them. Returns how many.
uint32_t walk_ask(occlusion_walk *w, uint32_t most);
// Reads answers to them into h->pixels; entries without an answer have 1.
void walk_hear(occlusion_walk *w);
// A test of an item, or with item_count for its place of all of them, after all draws; the answer comes in a later frame. 0: no room.
int walk_ask_final(occlusion_walk *w, uint32_t place);

// The end of a step: how often the host goes from drawing to testing, or back.
void walk_count_turns(occlusion_walk *w);

// For who keeps tests of his own. There is room; tag below WALK_FINAL.
void walk_put_test(occlusion_walk *w, const cull_box *box, uint32_t tag);
// An answer that the frame needed: to the ledger, and to what is opened next time.
typedef struct walk_finding { tree_entry entry; uint32_t pixels, shared_by, step_cost; } walk_finding; // shared_by: entries under the test
void walk_settle(occlusion_walk *w, const walk_finding *f);
// The answer to a test of an item held for seen, or drawn in this frame.
void walk_hear_drawn(occlusion_walk *w, uint32_t place, uint32_t pixels);

#endif
