// Batch check: what a culler wrote is used only when every number of it is sound.
// SPDX-License-Identifier: MIT
#include "viewer.h"

#include <math.h>
#include <string.h>

enum { PICTURE_PX_MOST = 16384 };

// The lists are the host's: one that a culler put there instead may be anything.
static const char *lists_fault(const cull_batch *lent, const cull_batch *batch)
{
    const int is_lent = batch->runs == lent->runs && batch->pictures == lent->pictures && batch->tests == lent->tests &&
                        batch->captures == lent->captures && batch->keep_pictures == lent->keep_pictures &&
                        batch->keep_captures == lent->keep_captures && batch->clipped == lent->clipped && batch->keep_clipped == lent->keep_clipped;
    return is_lent ? NULL : "it replaced a list of the batch";
}

static const char *counts_fault(const viewer *v, const cull_batch *batch, const batch_check *check)
{
    const cull_built *b = &v->chain->stages[check->stage].built;
    const int takes_back = batch->run_count < check->runs || batch->picture_count < check->pictures || batch->clipped_count < check->clipped;
    if (takes_back) return "it took runs or pictures back";
    if (batch->run_count > v->stages[check->stage].run_capacity) return "more runs than it told";
    if (batch->test_count > b->max_tests) return "more tests than it told";
    if (batch->capture_count > b->max_captures) return "more captures than it told";
    if (batch->clipped_count > b->max_clipped) return "more clipped items than it told";
    return batch->picture_count > b->max_pictures ? "more pictures than it told" : NULL;
}

// A slot that was not lent in this frame names no mover, or one that is elsewhere.
static int are_lent(const viewer *v, cull_run run)
{
    const uint32_t *lent = v->slot_lent.items, items = v->chain->zone.item_count;
    for (uint32_t i = run.first - items; i < run.first - items + run.count; ++i)
        if (lent[i] != v->serial) return 0;
    return 1;
}

// Items and movers in one run would be drawn as items that do not exist.
static const char *runs_fault(const viewer *v, const cull_batch *batch, batch_check *check)
{
    const chain *c = v->chain;
    const uint32_t items = c->zone.item_count;
    const uint32_t movers = check->stage == v->last && c->stages[check->stage].built.takes_movers ? c->zone.mover_capacity : 0;
    uint64_t sum;
    if (!v->kernel->check(batch->runs + check->runs, batch->run_count - check->runs, items + movers, &sum)) return "a run outside the zone, or an empty one";
    check->items += sum;
    if (check->items > (uint64_t)items + movers) return "an item given twice";
    for (uint32_t i = check->runs; movers && i < batch->run_count; ++i) {
        if (batch->runs[i].first < items && batch->runs[i].first + batch->runs[i].count > items) return "a run over items and movers";
        check->mover_runs += batch->runs[i].first >= items;
    }
    if (check->mover_runs > movers) return "a mover given twice";
    for (uint32_t i = check->runs; movers && i < batch->run_count; ++i)
        if (batch->runs[i].first >= items && !are_lent(v, batch->runs[i])) return "a mover that it was not lent";
    return NULL;
}

// 1: one of the run was marked before.
static int mark_twice(uint64_t *seen, cull_run run)
{
    for (uint32_t i = run.first; i < run.first + run.count; ++i) {
        if (seen[i / 64] >> (i % 64) & 1) return 1;
        seen[i / 64] |= (uint64_t)1 << (i % 64);
    }
    return 0;
}

// Once in each: `one` is empty before and after, `clipped` holds those of all.
static const char *clipped_repeat_fault(const cull_clipped *c, uint64_t *clipped, uint64_t *one)
{
    const char *fault = NULL;
    uint32_t marked = 0;
    while (!fault && marked < c->run_count)
        if (mark_twice(one, c->runs[marked++])) fault = "an item given twice";
    for (uint32_t r = 0; r < marked; ++r)
        for (uint32_t i = c->runs[r].first; i < c->runs[r].first + c->runs[r].count; ++i) {
            clipped[i / 64] |= (uint64_t)1 << (i % 64);
            one[i / 64] &= ~((uint64_t)1 << (i % 64));
        }
    return fault;
}

static const char *repeat_fault(viewer *v, const cull_batch *batch, const batch_check *check)
{
    const size_t bytes = viewer_seen_bytes(v->chain, check->stage);
    uint64_t *seen = v->seen.size && check->stage == v->last ? v->seen.items : list_tail(&v->room->seen, bytes);
    if (check->runs == 0 && check->clipped == 0) memset(seen, 0, bytes);
    for (uint32_t r = check->runs; r < batch->run_count; ++r)
        if (mark_twice(seen, batch->runs[r])) return "an item given twice";
    if (!batch->clipped_count) return NULL;
    const size_t words = viewer_seen_words(v->chain);
    const char *fault = NULL;
    for (uint32_t i = check->clipped; !fault && i < batch->clipped_count; ++i)
        fault = clipped_repeat_fault(&batch->clipped[i], seen + words, seen + 2 * words);
    for (size_t w = 0; !fault && w < words; ++w)
        if (seen[w] & seen[words + w]) fault = "an item given clipped and whole";
    return fault;
}

static int point_is_finite(cull_vec3 p)
{
    return isfinite(p.x) && isfinite(p.y) && isfinite(p.z);
}

static int box_is_sound(const cull_box *b)
{
    return point_is_finite(b->min) && point_is_finite(b->max) && b->min.x <= b->max.x && b->min.y <= b->max.y && b->min.z <= b->max.z;
}

static const char *tests_fault(const cull_batch *batch)
{
    for (uint32_t i = 0; i < batch->test_count; ++i)
        if (!box_is_sound(&batch->tests[i].box)) return "a test whose box is not finite or is inside out";
    return NULL;
}

static const char *lent_runs_fault(const viewer *v, const cull_run *runs, uint32_t count, uint64_t *sum)
{
    if (count && !runs) return "a picture or a clip without its runs";
    if (count > v->chain->zone.item_count) return "a picture or a clip of more runs than there are items";
    return v->kernel->check(runs, count, v->chain->zone.item_count, sum) ? NULL : "a picture or a clip of a run outside the zone";
}

static const char *planes_fault(const cull_plane *planes, uint32_t count)
{
    if (count > 4) return "over 4 clip planes";
    for (uint32_t i = 0; i < count; ++i)
        if (!point_is_finite(planes[i].normal) || !isfinite(planes[i].offset)) return "clip planes are not finite";
    return NULL;
}

static const char *clipped_fault(const viewer *v, const cull_batch *batch, const batch_check *check)
{
    for (uint32_t i = check->clipped; i < batch->clipped_count; ++i) {
        const cull_clipped *c = &batch->clipped[i];
        uint64_t sum;
        const char *fault = box_is_sound(&c->box) ? planes_fault(c->planes, c->plane_count) : "clipped items whose box is not finite or is inside out";
        if (!fault) fault = lent_runs_fault(v, c->runs, c->run_count, &sum);
        if (fault) return fault;
        if (sum > v->chain->zone.item_count) return "an item given twice";
    }
    return NULL;
}

// Captures run in order: one may be composed of what those before it fill, marked as they are checked.
static int is_filled(const viewer *v, uint32_t slot)
{
    const uint8_t *marks = v->room->slot_marks.items;
    return v->slots[slot] || marks[slot];
}

static const char *composed_fault(const viewer *v, const cull_capture *c, uint32_t slot_count)
{
    if (c->slot_count > slot_count || (c->slot_count && !c->slots)) return "a capture of slots that are not there";
    for (uint32_t i = 0; i < c->slot_count; ++i)
        if (c->slots[i] >= slot_count || c->slots[i] == c->slot || !is_filled(v, c->slots[i])) return "a capture of a slot that is empty";
    return NULL;
}

static const char *capture_fault(const viewer *v, uint32_t slot_count, const cull_capture *c)
{
    if (c->slot >= slot_count) return "a capture into a slot that is not there";
    if (c->width_px < 1 || c->height_px < 1 || c->width_px > PICTURE_PX_MOST || c->height_px > PICTURE_PX_MOST) return "a capture of no or too many pixels";
    if (!point_is_finite(c->corner) || !point_is_finite(c->right) || !point_is_finite(c->up) || !box_is_sound(&c->box)) return "a capture whose numbers are not finite";
    if (c->eye_is_said && !point_is_finite(c->eye)) return "a capture whose numbers are not finite";
    uint64_t sum;
    const char *fault = planes_fault(c->clip_planes, c->clip_plane_count);
    if (!fault) fault = composed_fault(v, c, slot_count);
    return fault ? fault : lent_runs_fault(v, c->runs, c->run_count, &sum);
}

static const char *picture_fault(const viewer *v, uint32_t slot_count, const cull_picture *p)
{
    if (p->slot >= slot_count) return "a picture of a slot that is not there";
    if (!is_filled(v, p->slot)) return "a picture of a slot that is empty";
    uint64_t sum;
    if (!(p->error_px >= 0) || !isfinite(p->error_px) || !box_is_sound(&p->box)) return "a picture whose numbers are not finite";
    if (p->place_is_said && !(point_is_finite(p->corner) && point_is_finite(p->right) && point_is_finite(p->up))) return "a picture whose numbers are not finite";
    return lent_runs_fault(v, p->runs, p->run_count, &sum);
}

// Captures first: what they fill the pictures may show.
static const char *pictures_fault(viewer *v, uint32_t slot_count, const cull_batch *batch, const batch_check *check)
{
    uint8_t *marks = v->room->slot_marks.items;
    const char *fault = NULL;
    if (!batch->capture_count && batch->picture_count == check->pictures) return NULL;
    memset(marks, 0, v->slot_count);
    for (uint32_t i = 0; !fault && i < batch->capture_count; ++i) {
        fault = capture_fault(v, slot_count, &batch->captures[i]);
        if (!fault) marks[batch->captures[i].slot] = 1;
    }
    for (uint32_t i = check->pictures; !fault && i < batch->picture_count; ++i) fault = picture_fault(v, slot_count, &batch->pictures[i]);
    return fault;
}

const char *batch_fault(viewer *v, const cull_batch *batch, batch_check *check)
{
    const uint32_t slot_count = v->chain->stages[check->stage].built.slot_count;
    const char *fault = lists_fault(&check->lent, batch);
    if (!fault) fault = counts_fault(v, batch, check);
    if (!fault) fault = runs_fault(v, batch, check);
    if (!fault) fault = clipped_fault(v, batch, check);
    if (!fault && v->checks == VIEWER_CHECK_ALL) fault = repeat_fault(v, batch, check);
    if (!fault) fault = tests_fault(batch);
    if (!fault) fault = pictures_fault(v, slot_count, batch, check);
    check->runs = batch->run_count;
    check->pictures = batch->picture_count;
    check->clipped = batch->clipped_count;
    return fault;
}
