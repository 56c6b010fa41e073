// The invisible queue of method=chc, and what stands under one test: see chc.h. CHC++, sections 4.1 and 4.2.
// SPDX-License-Identifier: MIT
#include "chc.h"
#include "ledger.h"
#include "sample.h"

enum { ROUND_TESTS = 2, PICTURE_MARKS = 1024, JOIN_TRIES = 12 }; // a joint test that fails costs a round more: as many tests
static const float FUTURE_MOST = 8;                             // frames that a new joint test is reckoned to save a test in

// ---- The queue ----

static uint32_t place_of_entry(const occlusion_walk *w, tree_entry e)
{
    if (e >= walk_mover_entry(w, 0)) return e - w->tree->node_count; // behind all items
    return tree_is_node(w->tree, e) ? w->tree->nodes[e].first_below : e - w->tree->node_count;
}

// With whom it was tested last frame; itself where with none.
static tree_entry leader_of(const occlusion_walk *w, tree_entry e)
{
    if (e >= walk_mover_entry(w, 0)) return e; // a mate's place may be another's in the next frame
    const chc_past *past = w->h->chc->past, *p = &past[e];
    if (!p->mate || !p->looked || p->looked != w->h->serial - 1) return e;
    const tree_entry leader = p->mate - 1;
    if (leader >= walk_mover_entry(w, 0) || !past[leader].mate || past[leader].looked != p->looked) return leader;
    return past[leader].mate - 1; // joined with others since
}

void chc_queue_add(occlusion_walk *w, tree_entry e, uint64_t how)
{
    occlusion_chc *c = w->h->chc;
    const tree_entry leader = leader_of(w, e);
    c->queue[c->queue_count++] = how | (uint64_t)place_of_entry(w, leader) << 32 | e;
}

static void sift(uint64_t *list, uint32_t at, uint32_t count)
{
    const uint64_t value = list[at];
    for (uint32_t child = 2 * at + 1; child < count; child = 2 * at + 1) {
        if (child + 1 < count && list[child + 1] > list[child]) child++;
        if (list[child] <= value) break;
        list[at] = list[child];
        at = child;
    }
    list[at] = value;
}

static void sort(uint64_t *list, uint32_t count)
{
    for (uint32_t i = count / 2; i-- > 0;) sift(list, i, count);
    for (uint32_t end = count; end > 1; end--) {
        const uint64_t last = list[end - 1];
        list[end - 1] = list[0];
        list[0] = last;
        sift(list, 0, end - 1);
    }
}

#define QUEUE_TAKEN (CHC_ALONE - 1) // no entry has this place

// ---- Several under one test ----

// The box round some entries, the chance that they are hidden, and what they are expected to cost in tests.
typedef struct joint {
    cull_box box;
    float surface, chance, doubt, cost;
    uint32_t count, growth, hides, is_split, is_known;
} joint;

// Of an entry that joint tests failed with of late: what that makes of the chance of the next.
static float doubt_of(const occlusion_walk *w, tree_entry e)
{
    static const float doubts[CHC_FAILURES_MOST + 1] = {1, 0.8f, 0.7f, 0.6f, 0.5f, 0.5f};
    const chc_past *p = chc_past_of(w, e);
    return (int32_t)(p->due - w->h->serial) > 0 ? doubts[p->failures] : 1;
}

static joint joint_of_one(const occlusion_walk *w, tree_entry e)
{
    const cull_box box = walk_box(w, e);
    return (joint){.box = box, .surface = box_surface(&box), .chance = chc_chance(w, e), .doubt = doubt_of(w, e), .cost = 1, .count = 1};
}

// The entry of the queue there, and those behind it that stood with it last frame. *end: behind them.
static joint unit_at(const occlusion_walk *w, uint32_t at, uint32_t *end)
{
    const occlusion_chc *c = w->h->chc;
    const tree_entry e = (tree_entry)c->queue[at], leader = leader_of(w, e);
    joint j = joint_of_one(w, e);
    *end = at + 1;
    j.is_split = (c->queue[at] & CHC_ALONE) != 0;
    for (; *end < c->queue_count && (c->queue[*end] & CHC_ALONE) == (c->queue[at] & CHC_ALONE); (*end)++) {
        const tree_entry next = (tree_entry)c->queue[*end];
        if (leader_of(w, next) != leader) break;
        const cull_box box = walk_box(w, next);
        const float doubt = doubt_of(w, next);
        j.box = cull_box_union(j.box, box);
        j.doubt = doubt < j.doubt ? doubt : j.doubt;
        j.count++;
    }
    if (j.count == 1) return j;
    j.is_known = 1;
    j.surface = box_surface(&j.box);
    j.chance = model_mates(&c->model);
    j.cost = 1 + (1 - j.chance) * (float)(j.count + ROUND_TESTS);
    return j;
}

// What is drawn by now.
static void picture_fill(const occlusion_walk *w)
{
    const occlusion_history *h = w->h;
    occlusion_chc *c = h->chc;
    if (!c->has_picture) picture_begin(&c->picture, w->visit->view);
    c->has_picture = 1;
    for (; c->marked_count < h->drawn_count && c->marked_count < PICTURE_MARKS; c->marked_count++) {
        const uint32_t place = h->drawn_list[c->marked_count];
        if (w->tree->solid[place]) picture_mark(&c->picture, &w->tree->boxes[place]);
    }
}

static float future_of(const occlusion_chc *c)
{
    const float mates = model_mates(&c->model), frames = mates < 1 ? mates / (1 - mates) : FUTURE_MOST;
    return c->is_first ? 0 : frames < FUTURE_MOST ? frames : FUTURE_MOST;
}

// In tests, of this frame and of those behind it: where it is hidden it is likely to be so again.
static float reckon(const occlusion_chc *c, joint *j, uint32_t hides)
{
    const float hidden = j->chance * j->doubt * model_joint(&c->model, hides, j->growth);
    j->hides = hides;
    j->cost = 1 + (1 - hidden) * (float)(j->count + ROUND_TESTS);
    return j->cost - hidden * future_of(c);
}

// CHC++ 4.2: a joint test costs one, and one more for each member when it fails. The members stand here under one box, as a test has
// one, so what counts is also how much larger that is, and whether it stands behind what is drawn.
static int joint_add(const occlusion_walk *w, joint *j, const joint *unit)
{
    occlusion_chc *c = w->h->chc;
    joint both = {.box = cull_box_union(j->box, unit->box), .count = j->count + unit->count};
    both.surface = j->surface + unit->surface;
    both.chance = j->chance * unit->chance;
    both.doubt = j->doubt * unit->doubt;
    const float surface = box_surface(&both.box), apart = j->cost + unit->cost;
    both.growth = growth_bucket(both.surface > 0 ? surface / both.surface : surface > 0 ? INFINITY : 1);
    if (!(reckon(c, &both, PICTURE_HIDDEN) < apart) || walk_is_near(w, walk_key(w, &both.box))) return 0;
    picture_fill(w);
    if (!(reckon(c, &both, picture_look(&c->picture, &both.box)) < apart)) return 0;
    *j = both;
    return 1;
}

// ---- Asking ----

// Tests beyond the frame's room are not asked: what they stand for counts as seen.
static int take_unasked(occlusion_walk *w, tree_entry e)
{
    occlusion_chc *c = w->h->chc;
    if (c->member_count < c->member_most) return 0;
    w->batch->limits_hit++;
    chc_note_seen(w, e, 1);
    return 1;
}

static void take(occlusion_chc *c, uint32_t from, uint32_t end)
{
    for (uint32_t i = from; i < end; i++) {
        c->members[c->member_count++] = (tree_entry)c->queue[i];
        c->queue[i] = QUEUE_TAKEN;
    }
}

static void put(occlusion_walk *w, const joint *j, uint32_t first)
{
    occlusion_chc *c = w->h->chc;
    chc_test *t = &c->tests[c->test_count];
    *t = (chc_test){.first = first, .count = j->count, .chance = j->chance, .is_open = 1};
    t->growth = (uint8_t)j->growth;
    t->hides = (uint8_t)j->hides;
    t->is_split = (uint8_t)j->is_split;
    t->is_known = (uint8_t)j->is_known;
    walk_put_test(w, &j->box, c->test_count++);
    c->open_count++;
    w->h->counters.joint += j->count > 1;
}

// A test of the entry there and of what stands behind it in the queue and goes with it.
static void ask_one(occlusion_walk *w, uint32_t at, int may_join)
{
    occlusion_chc *c = w->h->chc;
    const uint32_t first = c->member_count, most = c->member_most - first; // members
    uint32_t end = at + 1;
    joint j = may_join ? unit_at(w, at, &end) : joint_of_one(w, (tree_entry)c->queue[at]);
    if (j.count > most) j = joint_of_one(w, (tree_entry)c->queue[(end = at + 1) - 1]);
    take(c, at, end);
    uint32_t tries = j.is_split || !may_join ? 0 : JOIN_TRIES;
    for (uint32_t next = end; next < c->queue_count && tries && c->queue[next] < CHC_ALONE; next = end) {
        end = next + 1;
        if (c->queue[next] == QUEUE_TAKEN) continue;
        const joint unit = unit_at(w, next, &end);
        if (j.count + unit.count > most || !joint_add(w, &j, &unit)) {
            tries--;
            continue;
        }
        take(c, next, end);
        tries = JOIN_TRIES;
    }
    put(w, &j, first);
}

void chc_ask(occlusion_walk *w, uint32_t most)
{
    occlusion_chc *c = w->h->chc;
    const uint32_t count = c->queue_count, first = c->test_count;
    uint32_t kept = 0, asked = 0;
    if (most > 1 && count > 1) sort(c->queue, count);
    for (uint32_t at = 0; at < count; at++) {
        if (c->queue[at] == QUEUE_TAKEN) continue;
        if (asked == most || !chc_has_room(w)) c->queue[kept++] = c->queue[at];
        else if (!take_unasked(w, (tree_entry)c->queue[at])) {
            ask_one(w, at, most > 1 && count > 1);
            asked++;
        }
    }
    c->queue_count = kept;
    for (uint32_t i = first; i < c->test_count; i++) c->tests[i].step_cost = LEDGER_ROUND / 4 / (c->test_count - first); // nobody waits
}

void chc_ask_sample(occlusion_walk *w)
{
    occlusion_chc *c = w->h->chc;
    const uint32_t count = c->queue_count, stride = sample_stride(count);
    uint32_t kept = 0;
    c->sample_first = c->test_count;
    for (uint32_t i = 0; i < SAMPLE_TESTS; i++) ask_one(w, i * stride, 0);
    for (uint32_t at = 0; at < count; at++)
        if (c->queue[at] != QUEUE_TAKEN) c->queue[kept++] = c->queue[at];
    c->queue_count = kept;
    for (uint32_t i = c->sample_first; i < c->test_count; i++) c->tests[i].step_cost = LEDGER_ROUND / SAMPLE_TESTS;
    sample_begin(w);
}
