// Whether a zone is worth its first tests: see sample.h.
// SPDX-License-Identifier: MIT
#include "sample.h"

#include "ledger.h"

int sample_is_due(const occlusion_walk *w, uint32_t waiting)
{
    const occlusion_history *h = w->h;
    const int is_proven = h->zone.tests >= LEDGER_TRIAL_TESTS && ledger_pays(&h->zone);
    return !is_proven && h->tried != h->serial && waiting > SAMPLE_WAITING && h->test_most - w->batch->test_count >= SAMPLE_TESTS;
}

void sample_begin(occlusion_walk *w)
{
    occlusion_history *h = w->h;
    h->tried = h->serial;
    h->sampled_step = w->visit->step;
    h->gained_before = h->zone.gained;
}

int sample_is_answered(const occlusion_walk *w)
{
    return w->h->tried == w->h->serial && w->h->sampled_step + 1 == w->visit->step;
}

int sample_pays(const occlusion_walk *w, uint32_t tests, uint32_t hidden)
{
    return w->h->zone.gained - w->h->gained_before >= tests * LEDGER_TEST && hidden >= tests / LEDGER_SHARE;
}

void sample_give_up(occlusion_walk *w)
{
    w->h->gave_up = w->h->serial;
}

int sample_gave_up(const occlusion_walk *w)
{
    return w->h->gave_up == w->h->serial;
}

void sample_draw(occlusion_walk *w, tree_entry e)
{
    if (tree_is_node(w->tree, e)) walk_draw_below(w, e);
    else walk_draw(w, e - w->tree->node_count);
}
