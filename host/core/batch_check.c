// Batch check: what a culler wrote is used only when every number of it is sound.
// SPDX-License-Identifier: MIT
#include "viewer.h"

#include <math.h>
#include <string.h>

enum { PICTURE_PX_MOST = 16384 };

// Items and movers in one run would be drawn as items that do not exist.
static const char *runs_fault(viewer *v, uint32_t stage, const cull_batch *batch)
{
    const chain *c = v->chain;
    const uint32_t items = c->zone.item_count;
    const uint32_t movers = stage == v->last && c->stages[stage].built.takes_movers ? c->zone.mover_capacity : 0;
    uint64_t sum;
    if (batch->run_count > v->stages[stage].run_capacity) return "more runs than it told";
    if (!v->kernel->check(batch->runs, batch->run_count, items + movers, &sum)) return "a run outside the zone, or an empty one";
    if (sum > (uint64_t)items + movers) return "an item given twice";
    uint32_t mover_runs = 0;
    for (uint32_t i = 0; movers && i < batch->run_count; ++i) {
        if (batch->runs[i].first < items && batch->runs[i].first + batch->runs[i].count > items) return "a run over items and movers";
        mover_runs += batch->runs[i].first >= items;
    }
    return mover_runs > movers ? "a mover given twice" : NULL; // more would not fit where they go apart from the items'
}

static const char *repeat_fault(viewer *v, const cull_batch *batch)
{
    uint64_t *seen = v->seen.items;
    memset(seen, 0, v->seen.size);
    for (uint32_t r = 0; r < batch->run_count; ++r)
        for (uint32_t i = batch->runs[r].first; i < batch->runs[r].first + batch->runs[r].count; ++i) {
            if (seen[i / 64] >> (i % 64) & 1) return "an item given twice";
            seen[i / 64] |= (uint64_t)1 << (i % 64);
        }
    return NULL;
}

static int point_is_finite(cull_vec3 p)
{
    return isfinite(p.x) && isfinite(p.y) && isfinite(p.z);
}

static int box_is_sound(const cull_box *b)
{
    return point_is_finite(b->min) && point_is_finite(b->max) && b->min.x <= b->max.x && b->min.y <= b->max.y && b->min.z <= b->max.z;
}

static const char *tests_fault(const viewer *v, uint32_t stage, const cull_batch *batch)
{
    if (batch->test_count > v->chain->stages[stage].built.max_tests) return "more tests than it told";
    for (uint32_t i = 0; i < batch->test_count; ++i)
        if (!box_is_sound(&batch->tests[i].box)) return "a test whose box is not finite or is inside out";
    return NULL;
}

static const char *lent_runs_fault(const viewer *v, const cull_run *runs, uint32_t count)
{
    uint64_t sum;
    if (count && !runs) return "a picture without its runs";
    if (count > v->chain->zone.item_count) return "a picture of more runs than there are items";
    return v->kernel->check(runs, count, v->chain->zone.item_count, &sum) ? NULL : "a picture of a run outside the zone";
}

static const char *capture_fault(const viewer *v, uint32_t stage, const cull_capture *c)
{
    const uint32_t slot_count = v->chain->stages[stage].built.slot_count;
    if (c->slot >= slot_count) return "a capture into a slot that is not there";
    if (c->width_px < 1 || c->height_px < 1 || c->width_px > PICTURE_PX_MOST || c->height_px > PICTURE_PX_MOST) return "a capture of no or too many pixels";
    if (!point_is_finite(c->corner) || !point_is_finite(c->right) || !point_is_finite(c->up) || !box_is_sound(&c->box)) return "a capture whose numbers are not finite";
    if (c->clip_plane_count > 4) return "a capture with over 4 clip planes";
    for (uint32_t i = 0; i < c->clip_plane_count; ++i)
        if (!point_is_finite(c->clip_planes[i].normal) || !isfinite(c->clip_planes[i].offset)) return "a capture whose clip planes are not finite";
    if (c->slot_count > slot_count || (c->slot_count && !c->slots)) return "a capture of slots that are not there";
    for (uint32_t i = 0; i < c->slot_count; ++i)
        if (c->slots[i] >= slot_count || c->slots[i] == c->slot || !v->slots[c->slots[i]]) return "a capture of a slot that is empty";
    return lent_runs_fault(v, c->runs, c->run_count);
}

static const char *picture_fault(const viewer *v, uint32_t stage, const cull_batch *batch, const cull_picture *p)
{
    if (p->slot >= v->chain->stages[stage].built.slot_count) return "a picture of a slot that is not there";
    uint32_t filled = v->slots[p->slot];
    for (uint32_t i = 0; i < batch->capture_count; ++i) filled |= batch->captures[i].slot == p->slot;
    if (!filled) return "a picture of a slot that is empty";
    if (!(p->error_px >= 0) || !isfinite(p->error_px) || !box_is_sound(&p->box)) return "a picture whose numbers are not finite";
    return lent_runs_fault(v, p->runs, p->run_count);
}

const char *batch_fault(viewer *v, uint32_t stage, const cull_batch *batch, uint32_t earlier_runs, uint32_t earlier_pictures)
{
    const cull_built *b = &v->chain->stages[stage].built;
    if (batch->run_count < earlier_runs || batch->picture_count < earlier_pictures) return "it took runs or pictures back";
    const char *fault = runs_fault(v, stage, batch);
    if (!fault && v->checks == VIEWER_CHECK_ALL) fault = repeat_fault(v, batch);
    if (!fault) fault = tests_fault(v, stage, batch);
    if (!fault && batch->capture_count > b->max_captures) fault = "more captures than it told";
    if (!fault && batch->picture_count > b->max_pictures) fault = "more pictures than it told";
    for (uint32_t i = 0; !fault && i < batch->capture_count; ++i) fault = capture_fault(v, stage, &batch->captures[i]);
    for (uint32_t i = earlier_pictures; !fault && i < batch->picture_count; ++i) fault = picture_fault(v, stage, batch, &batch->pictures[i]);
    return fault;
}
