// What one view holds of one zone: the queries of its chain and the lists of a frame; and the engine that runs them step
// by step, so that a view can step all its zones in rounds. viewer.c sizes it once, viewer_step.c runs it.
// SPDX-License-Identifier: MIT
// Invariant: what a culler writes is used only after batch_check.c found it sound; nonsense draws the zone whole.
#ifndef PORTCULLIS_HOST_VIEWER_H
#define PORTCULLIS_HOST_VIEWER_H

#include "list.h"
#include "runs.h"
#include "visible.h"

typedef struct viewer_stage {
    cull_query *query;
    list runs;              // cull_run, max_runs (+ mover_capacity for who takes movers)
    uint32_t run_capacity;
    uint32_t run_count;     // of the last frame: those of a stage before the last, for explain
} viewer_stage;

// What is of meaning only within one call of a culler or one check, so that all zones of a view share it. Each zone uses
// the tail of these lists, so that each ends at the guard page.
typedef struct viewer_room_size {
    size_t early_tests, early_captures, early_pictures, early_clipped; // room for what a stage before the last may not give, so that it harms nobody
    size_t slot_marks; // one byte a slot, while a batch or a filter's choice is looked at
    size_t seen;       // bytes; one bit an item and mover, for VIEWER_CHECK_ALL of cullers of one step
    size_t scratch;
} viewer_room_size;
typedef struct viewer_room {
    viewer_room_size size;
    list early_tests, early_captures, early_pictures, early_clipped, slot_marks, seen;
    void *scratch;
} viewer_room;

void viewer_room_size_add(viewer_room_size *size, const chain *c); // the larger of each
// Grows to the larger of each. RESULT_NO_MEMORY: the room is as it was.
result viewer_room_fit(viewer_room *room, const viewer_room_size *size, const allocator *memory);
void viewer_room_close(viewer_room *room, const allocator *memory); // zeroed is fine

// A bit an item and mover for VIEWER_CHECK_ALL of a stage; three where it clips: in runs, in clipped ones, in one of these.
static inline size_t viewer_seen_words(const chain *c)
{
    return ((size_t)c->zone.item_count + c->zone.mover_capacity + 63) / 64;
}
static inline size_t viewer_seen_bytes(const chain *c, uint32_t stage)
{
    return viewer_seen_words(c) * sizeof(uint64_t) * (c->stages[stage].built.max_clipped ? 3 : 1);
}

// An item that other zones list too, by its place in the chain's order; numbers count the world's shared items.
typedef struct shared_place { uint32_t place, number; } shared_place;
// By shared number: who has drawn it in this frame of the view.
typedef struct shared_stamp { uint32_t serial, zone; } shared_stamp;

// What a frame of a view shows its movers by: each once.
typedef struct mover_marks {
    uint32_t *stamps;  // by mover: the frame that last showed it
    uint32_t *visible; // numbers
    uint32_t count, serial;
} mover_marks;

static inline void mover_mark(mover_marks *m, uint32_t mover)
{
    if (m->stamps[mover] == m->serial) return;
    m->stamps[mover] = m->serial;
    m->visible[m->count++] = mover;
}

// A frame of a view, for all its zones.
typedef struct viewer_frame {
    const frame_input *input;
    frame_stats *stats;
    shared_stamp *stamps;
    mover_marks *movers;
    uint32_t serial; // of the view, counts from 1
} viewer_frame;

typedef enum viewer_state {
    VIEWER_STARTS, // begun, no stage called yet
    VIEWER_STEPS,  // it said MORE or WAIT
    VIEWER_DONE,
    VIEWER_FAULTY, // drawn whole
} viewer_state;

// One stage's frame as checked so far: what stands in earlier steps is not looked at again.
typedef struct batch_check {
    uint32_t stage;
    cull_batch lent;                     // the batch before the first call: its lists are the host's and stay
    uint32_t runs, pictures, clipped, mover_runs; // of earlier steps
    uint64_t items;                      // in those runs
} batch_check;

typedef struct viewer {
    const chain *chain;
    const cull_sight *sight;    // of its select, where it has one and a crosser
    const shared_place *shared; // chain->data->shared_count, ascending
    const allocator *memory;
    report *log;
    const runs_kernel *kernel;
    viewer_room *room;
    viewer_checks checks;
    uint32_t last;  // the stage that may step: the last select or filter
    uint32_t first; // the stage that starts: 0, or a filter that walks the hierarchy
    list tests, captures, pictures, clipped; // of the stepping stage
    list drawn;     // cull_run: the host's own copy of what was drawn: of stepping stages, shared items and movers
    // Of a select behind which a filter stands:
    list select_captures, select_pictures, select_clipped, keep_captures, keep_pictures, keep_clipped;
    list answers;
    list slot_movers;  // uint32_t: the mover that each slot names; empty: the slot is the number
    list slot_lent;    // uint32_t: the frame's serial in which each slot was lent last
    list seen;         // as in the room, of a stepping culler
    uint8_t *slots;
    cull_box *slot_boxes; // of each slot's last capture
    uint32_t slot_count, answer_capacity;
    cull_run whole;    // all items of the zone
    uint32_t told_fault;

    // The frame.
    uint32_t serial;   // of the last frame that this zone was in
    uint32_t first_frame; // number of the first that it was in: answers to older tests are another query's
    viewer_state state;
    cull_visit visit;
    cull_batch batch;
    batch_check check;
    cull_progress progress;
    const cull_run *out; // what is drawn so far
    uint32_t out_count, fresh;      // of them in this step: from `fresh` on
    uint32_t is_crowded;            // they did not fit: an item was given twice
    uint32_t full_serial;           // frame in which every slot was found taken
    uint32_t fresh_pictures, fresh_clipped; // of the batch: from here on
    viewer_stage stages[];          // chain->stage_count
} viewer;

typedef struct viewer_request {
    const chain *chain;          // borrowed, like all here
    const shared_place *shared;
    viewer_room *room;           // that fits the chain
    const host_services *services;
    viewer_checks checks;
    list_kind lists;
    uint32_t mover_numbers;      // of the world
} viewer_request;

// [main]
result viewer_open(const viewer_request *q, report *r, viewer **out);
void viewer_close(viewer *v); // NULL is fine

// One frame of the zone: begin; the movers put into v->visit by who knows them; then rounds of step, draw, test and
// collect while viewer_is_stepping. All [step].
typedef struct viewer_visit { const cull_view *view; const cull_volume *volumes; uint32_t volume_count; } viewer_visit;
void viewer_begin(viewer *v, const viewer_frame *f, const viewer_visit *seen);
void viewer_step(viewer *v, const viewer_frame *f); // no driver in it
static inline int viewer_is_stepping(const viewer *v)
{
    return v->state == VIEWER_STARTS || v->state == VIEWER_STEPS;
}
static inline int viewer_takes_movers(const viewer *v)
{
    return v->chain->stages[v->last].built.takes_movers != 0;
}
int viewer_has_work(const viewer *v, const frame_driver *d); // drawing or testing would call the driver
void viewer_draw(viewer *v, const viewer_frame *f);    // runs, clipped items, captures, pictures of the last step
void viewer_test(viewer *v, const viewer_frame *f);    // its tests
void viewer_collect(viewer *v, const viewer_frame *f); // answers for its next step

// [main, no view being culled] Something in the box changed, relative to the zone's origin: what pictures show of it is stale.
void viewer_empty_slots(viewer *v, const cull_box *box);

// NULL when what the culler wrote in this step may be used, and is then counted into the check; else what is wrong.
const char *batch_fault(viewer *v, const cull_batch *batch, batch_check *check);

#endif
