// What occlusion tells of itself: see figures.h.
// SPDX-License-Identifier: MIT
#include "figures.h"

void figures_begin(const occlusion_tree *tree, occlusion_figures *out)
{
    static const char *const names[FIGURE_COUNT] = {
        "nodes", "depth", "units", "frames", "tests", "tests_waited_for", "tests_wasted", "tests_unanswered", "answer_age_frames", "units_off_a_frame",
    };
    *out = (occlusion_figures){.lent = {out->list, FIGURE_COUNT, 0}};
    for (int i = 0; i < FIGURE_COUNT; i++) out->list[i].name = names[i];
    out->list[FIGURE_NODES].value = tree->node_count;
    out->list[FIGURE_DEPTH].value = tree->depth;
    out->list[FIGURE_DEPTH].sort = out->list[FIGURE_AGE].sort = CULL_FIGURE_MAX;
    out->list[FIGURE_UNITS].value = tree->unit_count;
}

void figures_add(occlusion_figures *f, const occlusion_counters *c)
{
    cull_figure *list = f->list;
    list[FIGURE_FRAMES].value += (double)c->frames;
    list[FIGURE_TESTS].value += (double)c->tests;
    list[FIGURE_WAITED].value += (double)c->waited;
    list[FIGURE_WASTED].value += (double)c->wasted;
    list[FIGURE_UNANSWERED].value += (double)c->unanswered;
    f->late_answers += (double)c->late_answers;
    f->age_sum += (double)c->age_sum;
    f->off_sum += (double)c->off_units;
    if (f->late_answers > 0) list[FIGURE_AGE].value = f->age_sum / f->late_answers;
    if (list[FIGURE_FRAMES].value > 0) list[FIGURE_OFF].value = f->off_sum / list[FIGURE_FRAMES].value;
}
