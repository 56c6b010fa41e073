// Memory, tests and answers of method=chc: see chc.h.
// SPDX-License-Identifier: MIT
#include "chc.h"
#include "ledger.h"

#include <string.h>

enum { TESTS_AN_ENTRY = 3, PARTS_LEAST = 8, SMALL_SIGHT = 3 }; // SMALL_SIGHT: below 256 pixels, which hide little

static const float TEST_POLYGONS = 2;      // what a test costs, its state changes and the way back of its answer with it
static const float DRAW_POLYGONS = 2;      // what an item costs beside its polygons: a change of state, as a test does
static const float DELAY_POLYGONS = 2;     // what it costs to draw an item a step later: what it hides is not hidden in that step
static const float INTERVAL_MOST = 24;     // frames

// ---- Memory ----

typedef struct array_plan { void **array; size_t count, size; } array_plan;
enum { PLANS = 6, DUE_AN_ENTRY = 2 }; // due: once when its time has come, and about once before

static void plans_fill(const occlusion_history *h, occlusion_chc *c, array_plan plans[PLANS])
{
    const size_t seen = (size_t)h->tree->item_count + h->mover_capacity, all = h->tree->node_count + seen, tests = all * TESTS_AN_ENTRY, due = seen * DUE_AN_ENTRY;
    const array_plan made[PLANS] = {
        {(void **)&c->past, all, sizeof *c->past},       {(void **)&c->seen_now, all, sizeof *c->seen_now},
        {(void **)&c->queue, all, sizeof *c->queue},     {(void **)&c->tests, tests, sizeof *c->tests},
        {(void **)&c->members, tests, sizeof *c->members}, {(void **)&c->due, due, sizeof *c->due},
    };
    memcpy(plans, made, sizeof made);
}

static size_t plan_bytes(const array_plan *p)
{
    return (p->count ? p->count : 1) * p->size;
}

cull_result chc_open(const cull_host *host, occlusion_history *h, const chc_request *q)
{
    array_plan plans[PLANS];
    occlusion_chc *c = host->alloc(host, sizeof *c, _Alignof(occlusion_chc));
    if (!c) return CULL_ERR_MEMORY;
    *c = (occlusion_chc){.batches = q->batches, .member_most = q->entries * TESTS_AN_ENTRY, .due_most = (h->tree->item_count + h->mover_capacity) * DUE_AN_ENTRY};
    h->chc = c;
    plans_fill(h, c, plans);
    for (int i = 0; i < PLANS; i++) {
        *plans[i].array = host->alloc(host, plan_bytes(&plans[i]), 64);
        if (!*plans[i].array) {
            chc_close(host, h);
            return CULL_ERR_MEMORY;
        }
        memset(*plans[i].array, 0, plan_bytes(&plans[i]));
    }
    return CULL_OK;
}

void chc_close(const cull_host *host, occlusion_history *h)
{
    array_plan plans[PLANS];
    if (!h->chc) return;
    plans_fill(h, h->chc, plans);
    for (int i = 0; i < PLANS; i++)
        if (*plans[i].array) host->free(host, *plans[i].array, plan_bytes(&plans[i]));
    host->free(host, h->chc, sizeof *h->chc);
    h->chc = NULL;
}

void chc_begin(occlusion_walk *w)
{
    occlusion_chc *c = w->h->chc;
    c->queue_count = c->test_count = c->first_open = c->member_count = c->open_count = 0;
    c->waited = c->rounds = c->has_picture = c->marked_count = 0;
    c->is_first = w->h->seen_count == 0 || (w->visit->view->flags & CULL_VIEW_CUT);
    c->due_count = c->due_asked = c->fills = c->pair_count = 0;
}

// ---- What is known of an entry ----

static int is_mover(const occlusion_walk *w, tree_entry e)
{
    return e >= walk_mover_entry(w, 0);
}

uint32_t chc_known_place(const occlusion_walk *w, tree_entry e)
{
    return is_mover(w, e) ? w->visit->movers[e - walk_mover_entry(w, 0)].id : e - w->tree->node_count;
}

chc_past *chc_past_of(const occlusion_walk *w, tree_entry e)
{
    return &w->h->chc->past[tree_is_node(w->tree, e) ? e : w->tree->node_count + chc_known_place(w, e)];
}

static int is_known(const occlusion_walk *w, const chc_past *p)
{
    return p->looked && p->looked == w->h->serial - 1;
}

static int is_held(const occlusion_walk *w, tree_entry e)
{
    if (w->h->chc->is_first) return 0;
    if (is_mover(w, e)) return chc_past_of(w, e)->is_held && is_known(w, chc_past_of(w, e));
    return !tree_is_node(w->tree, e) && (w->h->items[e - w->tree->node_count] & ITEM_SEEN);
}

static uint32_t bucket_of(const occlusion_walk *w, tree_entry e)
{
    const chc_past *p = chc_past_of(w, e);
    const uint32_t serial = w->h->serial;
    if (is_held(w, e)) return KEEP_HELD;
    if (p->looked == serial) return KEEP_OPENED;
    if (is_known(w, p)) return keep_bucket(serial - p->since);
    return is_mover(w, e) ? KEEP_MOVER : KEEP_UNKNOWN;
}

float chc_chance(const occlusion_walk *w, tree_entry e)
{
    return model_keeps(&w->h->chc->model, bucket_of(w, e));
}

void chc_pull_down(occlusion_walk *w, tree_entry e)
{
    chc_past *p = &w->h->chc->past[e];
    if (p->looked != w->h->serial - 1) p->since = p->looked = w->h->serial;
}

// What drawing it costs.
static float polygons_of(const occlusion_walk *w, uint32_t place)
{
    const uint32_t polygons = place < w->tree->item_count ? w->tree->polygons[place] : MOVER_POLYGONS;
    return (float)polygons + DRAW_POLYGONS;
}

// After how many frames what is seen is looked at again: drawing it hidden for half of that, at the rate at which such are lost,
// costs as much as the test does.
static float frames_best(const occlusion_walk *w, uint32_t place)
{
    const float rate = model_loses(&w->h->chc->model, w->h->chc->past[w->tree->node_count + place].sight);
    return sqrtf(2 * TEST_POLYGONS / (rate * polygons_of(w, place)));
}

// Spread at random, so that they do not all come in one frame.
static uint32_t interval_of(const occlusion_walk *w, uint32_t place)
{
    const float spread = 0.5f + (float)(chc_random(place, w->h->serial) >> 8) / 16777216.0f, frames = frames_best(w, place) * spread + 0.5f;
    return frames < 1 ? 1 : (uint32_t)(frames < INTERVAL_MOST ? frames : INTERVAL_MOST);
}

int chc_is_due(const occlusion_walk *w, tree_entry e)
{
    return (int32_t)(w->h->serial - chc_past_of(w, e)->due) >= 0;
}

// The test is due in any case; before the drawing it delays that by a step, which other tests of the frame need as well.
int chc_is_doubtful(const occlusion_walk *w, tree_entry e)
{
    const chc_past *p = chc_past_of(w, e);
    const float frames = (float)(w->h->serial - p->since), lost = model_loses(&w->h->chc->model, p->sight) * frames;
    return p->sight <= SMALL_SIGHT && (lost < 1 ? lost : 1) * polygons_of(w, chc_known_place(w, e)) > DELAY_POLYGONS;
}

// Hidden by now it would be drawn until its time comes.
int chc_is_fresh(const occlusion_walk *w, tree_entry e)
{
    const uint32_t place = chc_known_place(w, e);
    const float frames = frames_best(w, place);
    return chc_past_of(w, e)->is_fresh && model_fresh(&w->h->chc->model) * polygons_of(w, place) * (frames < INTERVAL_MOST ? frames : INTERVAL_MOST) > TEST_POLYGONS;
}

static void note_hidden(occlusion_walk *w, tree_entry e)
{
    occlusion_chc *c = w->h->chc;
    chc_past *p = chc_past_of(w, e);
    ratio_count(&c->model.keep[bucket_of(w, e)], 1, 1);
    if (!is_known(w, p) || is_held(w, e)) p->since = w->h->serial;
    p->looked = w->h->serial;
    p->is_held = 0;
}

// Tested before it was drawn: as good an answer as one of the visible queue.
static void count_held(occlusion_walk *w, tree_entry e, uint32_t pixels)
{
    const chc_past *p = chc_past_of(w, e);
    const uint32_t frames = w->h->serial - p->since;
    if (is_held(w, e)) ratio_count(&w->h->chc->model.lost[p->sight], pixels == 0, frames && frames < 64 ? frames : 1);
}

void chc_note_seen(occlusion_walk *w, tree_entry e, uint32_t pixels)
{
    occlusion_chc *c = w->h->chc;
    const cull_box box = walk_box(w, e);
    const uint32_t serial = w->h->serial;
    const int was_held = is_held(w, e);
    chc_past *p = chc_past_of(w, e);
    ratio_count(&c->model.keep[bucket_of(w, e)], 0, 1);
    c->seen_now[e] = serial;
    heap_push(w->h->heap, &w->h->heap_count, (heap_entry){walk_key(w, &box), e});
    *p = (chc_past){.since = serial, .sight = (uint8_t)sight_bucket(pixels)};
    if (tree_is_node(w->tree, e)) return;
    p->due = serial + interval_of(w, chc_known_place(w, e));
    p->is_fresh = !was_held;
    if (!is_mover(w, e)) return;
    p->looked = serial;
    p->is_held = 1;
}

// ---- Movers ----

int chc_holds_mover(const occlusion_walk *w, uint32_t mover)
{
    return is_held(w, walk_mover_entry(w, mover));
}

void chc_hold_mover(occlusion_walk *w, uint32_t mover)
{
    chc_past_of(w, walk_mover_entry(w, mover))->looked = w->h->serial;
}

// ---- Answers ----

// place: an item's, or a mover's id.
static chc_past *held_past(const occlusion_walk *w, uint32_t place)
{
    const occlusion_history *h = w->h;
    if (place >= w->tree->item_count + h->mover_capacity) return NULL;
    chc_past *p = &h->chc->past[w->tree->node_count + place];
    if (place >= w->tree->item_count) return p->is_held ? p : NULL;
    return (h->items[place] & ITEM_SEEN) || h->drawn[place] == h->serial ? p : NULL;
}

// All are counted before one is judged by the counts.
static void count_visible(occlusion_walk *w, const cull_answer *a)
{
    const chc_past *p = held_past(w, a->tag & ~CHC_VISIBLE);
    if (!p) return;
    const uint32_t frames = w->h->serial - a->age - p->since;
    if (p->is_fresh && !frames) ratio_count(&w->h->chc->model.fresh, a->pixels == 0, 1);
    else ratio_count(&w->h->chc->model.lost[p->sight], a->pixels == 0, frames && frames < 64 ? frames : 1);
}

static void hear_mover(occlusion_walk *w, chc_past *p, uint32_t pixels)
{
    ledger_enter(&w->h->movers, LEDGER_TEST, pixels ? 0 : MOVER_POLYGONS);
    ledger_enter_zone(&w->h->zone, LEDGER_TEST, pixels ? 0 : MOVER_POLYGONS);
    p->is_held = pixels != 0;
}

static void hear_visible(occlusion_walk *w, const cull_answer *a)
{
    const uint32_t place = a->tag & ~CHC_VISIBLE, serial = w->h->serial, is_item = place < w->tree->item_count;
    chc_past *p = held_past(w, place);
    if (!p) return;
    if (is_item) walk_hear_drawn(w, place, a->pixels);
    else hear_mover(w, p, a->pixels);
    p->since = serial;
    if (is_item || !a->age) p->looked = serial;
    p->due = p->failures = p->is_fresh = 0;
    if (!a->pixels) return;
    p->sight = (uint8_t)sight_bucket(a->pixels);
    p->due = serial + interval_of(w, place);
}

// What stood together before is tested again in four parts, as one of them is to blame, or each for itself; what was brought
// together in this frame parts again.
static void part(occlusion_walk *w, const chc_test *t)
{
    occlusion_chc *c = w->h->chc;
    for (uint32_t i = 0; i < t->count; i++) {
        const tree_entry e = c->members[t->first + i];
        chc_past *p = chc_past_of(w, e);
        p->joint = (uint32_t)(t - c->tests);
        if (t->is_known) p->mate = t->count < PARTS_LEAST ? 0 : c->members[t->first + i * 4 / t->count * t->count / 4] + 1;
        if (t->is_known) continue;
        if (p->failures < CHC_FAILURES_MOST) p->failures++;
        const uint32_t pause = 1u << p->failures;
        p->due = w->h->serial + pause / 2 + chc_random(t->first, w->h->serial) % pause + 1;
    }
}

static void settle_joint(occlusion_walk *w, const chc_test *t, uint32_t pixels)
{
    occlusion_chc *c = w->h->chc;
    if (t->is_known && !t->is_split) ratio_count(&c->model.mates, pixels == 0, 1);
    else if (!t->is_known) ratio_count(&c->model.joint[t->hides][t->growth], pixels ? 0 : 1024, (uint32_t)(t->chance * 1024));
    w->h->counters.joint_hits += pixels == 0;
    if (pixels) {
        part(w, t);
        return;
    }
    for (uint32_t i = t->first; i < t->first + t->count; i++) {
        const tree_entry e = c->members[i];
        chc_past *p = chc_past_of(w, e);
        p->mate = c->members[t->first] + 1;
        if ((int32_t)(p->due - w->h->serial) <= 0) p->failures = 0;
    }
}

// One of a joint test's was seen, so the others may stand together.
static void explain_joint(occlusion_walk *w, tree_entry e)
{
    occlusion_chc *c = w->h->chc;
    const uint32_t joint = chc_past_of(w, e)->joint;
    if (joint >= c->test_count) return;
    const chc_test *t = &c->tests[joint];
    for (uint32_t i = t->first; i < t->first + t->count; i++) {
        chc_past *p = chc_past_of(w, c->members[i]);
        p->due = p->failures = 0;
    }
}

static void settle(occlusion_walk *w, chc_test *t, uint32_t pixels)
{
    occlusion_chc *c = w->h->chc;
    c->fills = t->is_open = 0;
    c->open_count--;
    if (t->count > 1) settle_joint(w, t, pixels);
    for (uint32_t i = t->first; i < t->first + t->count; i++) {
        const tree_entry e = c->members[i];
        walk_settle(w, &(walk_finding){e, pixels, t->count, t->step_cost});
        if (!pixels || t->count == 1) count_held(w, e, pixels);
        if (!pixels) note_hidden(w, e);
        else if (t->count == 1) {
            if (t->is_split) explain_joint(w, e);
            chc_note_seen(w, e, pixels);
        } else chc_queue_add(w, e, CHC_ALONE);
    }
}

// In the order in which they were asked, whatever order the answers came in.
static void settle_heard(occlusion_walk *w)
{
    occlusion_chc *c = w->h->chc;
    for (uint32_t i = c->first_open; i < c->test_count; i++)
        if (c->tests[i].is_open && c->tests[i].is_heard) settle(w, &c->tests[i], c->tests[i].pixels);
    while (c->first_open < c->test_count && !c->tests[c->first_open].is_open) c->first_open++;
}

void chc_give_up(occlusion_walk *w)
{
    occlusion_chc *c = w->h->chc;
    for (; c->first_open < c->test_count; c->first_open++) {
        chc_test *t = &c->tests[c->first_open];
        if (!t->is_open) continue;
        t->is_open = 0;
        c->open_count--;
        w->h->counters.unanswered++;
        for (uint32_t k = t->first; k < t->first + t->count; k++) chc_note_seen(w, c->members[k], 1);
    }
}

void chc_hear(occlusion_walk *w)
{
    occlusion_chc *c = w->h->chc;
    const cull_visit *visit = w->visit;
    for (uint32_t i = 0; i < visit->answer_count; i++) {
        const cull_answer *a = &visit->answers[i];
        if (walk_is_of_picture(a->tag)) continue;
        if (a->tag & CHC_VISIBLE) count_visible(w, a);
        else if (a->tag & CHC_PAIR) chc_hear_pair(w, a);
        else if (a->age == 0 && visit->step && a->tag < c->test_count) {
            c->tests[a->tag].is_heard = 1;
            c->tests[a->tag].pixels = a->pixels;
        }
    }
    for (uint32_t i = 0; i < visit->answer_count; i++)
        if ((visit->answers[i].tag & CHC_VISIBLE) && !walk_is_of_picture(visit->answers[i].tag)) hear_visible(w, &visit->answers[i]);
    settle_heard(w);
    if (c->waited) chc_give_up(w);
    c->waited = 0;
}
