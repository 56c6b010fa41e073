// Pictures of a select that stands before: see pictures.h.
// SPDX-License-Identifier: MIT
// Invariant: what is not tested, or not answered, is kept.
#include "pictures.h"

#include <string.h>

enum { SEEN_AGAIN = 8 }; // frames between two tests of what was seen

static int is_in(const uint64_t *bits, uint32_t slot)
{
    return bits[slot / 64 % HISTORY_SLOT_WORDS] >> (slot % 64) & 1;
}

static void put_in(uint64_t *bits, uint32_t slot)
{
    bits[slot / 64 % HISTORY_SLOT_WORDS] |= UINT64_C(1) << (slot % 64);
}

// Before the eye's near plane nothing is tested.
static int is_far(const occlusion_walk *w, const cull_box *box)
{
    return !walk_is_near(w, walk_key(w, box));
}

static int ask(occlusion_walk *w, const cull_box *box, uint32_t number)
{
    occlusion_history *h = w->h;
    if (h->picture_tests == pictures_tests(w->tree->item_count)) {
        w->batch->limits_hit++;
        return 0;
    }
    h->picture_tests++;
    walk_put_test(w, box, WALK_PICTURE | number);
    return 1;
}

int pictures_ask(occlusion_walk *w)
{
    occlusion_history *h = w->h;
    const cull_visit *visit = w->visit;
    uint64_t taken[HISTORY_SLOT_WORDS] = {0};
    h->picture_tests = 0;
    for (uint32_t i = 0; i < visit->capture_count; i++) put_in(taken, visit->captures[i].slot);
    for (uint32_t i = 0; i < visit->picture_count; i++) {
        const cull_picture *p = &visit->pictures[i];
        const int is_due = is_in(taken, p->slot) || is_in(h->hidden_slots, p->slot) || (p->slot + h->serial) % SEEN_AGAIN == 0;
        if (is_due && is_far(w, &p->box) && !ask(w, &p->box, i)) break;
    }
    for (uint32_t i = 0; i < visit->clipped_count; i++)
        if (is_far(w, &visit->clipped[i].box) && !ask(w, &visit->clipped[i].box, visit->picture_count + i)) break;
    memset(h->hidden_slots, 0, sizeof h->hidden_slots);
    if (!h->picture_tests) return 0;
    h->is_over = 1;
    h->pending_count = h->tested_count = 0; // of the method: all of it is settled
    h->counters.waited += h->picture_tests;
    h->counters.drops.tested += h->picture_tests;
    return 1;
}

void pictures_judge(occlusion_walk *w)
{
    const cull_visit *visit = w->visit;
    for (uint32_t i = 0; i < visit->answer_count; i++) {
        const cull_answer *a = &visit->answers[i];
        const uint32_t number = a->tag & ~WALK_PICTURE;
        if (!walk_is_of_picture(a->tag) || a->age != 0 || a->pixels) continue;
        if (number < visit->picture_count) {
            put_in(w->h->hidden_slots, visit->pictures[number].slot);
            drop_picture(visit, w->batch, number, &w->h->counters.drops);
        } else if (number - visit->picture_count < visit->clipped_count) w->batch->keep_clipped[number - visit->picture_count] = 0;
    }
}
