// What occlusion tells of itself: see figures.h.
// SPDX-License-Identifier: MIT
#include "figures.h"

void figures_begin(const occlusion_tree *tree, occlusion_figures *out)
{
    static const char *const names[FIGURE_COUNT] = {
        "nodes", "depth", "units", "frames", "tests", "tests_waited_for", "tests_wasted", "tests_unanswered", "answer_age_frames", "units_off_a_frame",
        "frames_at_rest",
        "tests_joint", "tests_joint_hidden", "tests_early", "turns_a_frame",
        "rectangles_tested", "items_rastered", "polygons_rastered",
        "pictures_tested", "pictures_hidden", "captures_saved",
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
    list[FIGURE_RESTS].value += (double)c->rests;
    list[FIGURE_JOINT].value += (double)c->joint;
    list[FIGURE_JOINT_HITS].value += (double)c->joint_hits;
    list[FIGURE_EARLY].value += (double)c->early;
    list[FIGURE_RECTANGLES].value += (double)c->hiz.rectangles;
    list[FIGURE_HIZ_ITEMS].value += (double)c->hiz.items;
    list[FIGURE_HIZ_POLYGONS].value += (double)c->hiz.polygons;
    list[FIGURE_PICTURES_TESTED].value += (double)(c->drops.tested + c->hiz.drops.tested);
    list[FIGURE_PICTURES_HIDDEN].value += (double)(c->drops.pictures + c->hiz.drops.pictures);
    list[FIGURE_CAPTURES_SAVED].value += (double)(c->drops.captures + c->hiz.drops.captures);
    f->turns += (double)c->turns;
    f->late_answers += (double)c->late_answers;
    f->age_sum += (double)c->age_sum;
    f->off_sum += (double)c->off_units;
    if (f->late_answers > 0) list[FIGURE_AGE].value = f->age_sum / f->late_answers;
    if (list[FIGURE_FRAMES].value > 0) list[FIGURE_OFF].value = f->off_sum / list[FIGURE_FRAMES].value;
    if (list[FIGURE_FRAMES].value > 0) list[FIGURE_TURNS].value = f->turns / list[FIGURE_FRAMES].value;
}
