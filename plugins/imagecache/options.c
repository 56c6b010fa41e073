// Options read: see options.h.
// SPDX-License-Identifier: MIT
#include "options.h"

#include <stdio.h>
#include <string.h>

const cull_option options_table[OPTION_COUNT] = {
    [OPTION_LEVEL] = {"level", "auto", "4 5 6 7 8", "the ground is parted into 2^level x 2^level cells, 0 to 10, with pictures to 7; auto: about 8 items a cell, coarser while items lie in too many"},
    [OPTION_WALK] = {"walk", "rings", "rings tree bresenham", "rings: cells in view, none lost; tree: a quadtree, for a zone that is all geometry; bresenham: the 1998 report's border, LOSES cells"},
    [OPTION_ORDER] = {"order", "rings", "rings slope", "rings: exact front to back; slope: the report's single slope, WRONG where the view crosses an axis"},
    [OPTION_SHOW] = {"show", "quad", "quad centre geometry", "far cells: quad: as cached pictures, parallelograms in the world, exact under rotation; centre: the 1998 report's, moved and scaled by the centre; geometry: as they are"},
    [OPTION_TREE] = {"tree", "on", "on off", "on: a node of the quadtree over the cells is one picture where that costs less; off: a picture a cell"},
    [OPTION_TOLERANCE] = {"tolerance", "1", "0.25 0.5 1 2 4 8 16", "pixels that a point of a picture may sit from its place, at most, 0.0625 to 64"},
    [OPTION_HIDDEN] = {"hidden", "tested", "tested shown", "pictures that geometry hides: tested: neither taken nor shown, where no filter stands behind; shown: as all"},
    [OPTION_BUDGET] = {"budget", "bounded", "bounded steady", "where a frame's time is spent: bounded: pictures are taken all the same; steady: older ones are shown, and what they are off is said"},
    [OPTION_MEMORY] = {"memory_mib", "256", NULL, "that the pictures of a view take at most, 1 to 65536; less where the host has less"},
    [OPTION_DETAIL] = {"detail", "coarser", "coarser full", "items in pictures: coarser: with fewer polygons where that saves more than its error costs; full: with all"},
};

static cull_result refused(const cull_host *host, const char *key, const char *value, const char *legal)
{
    char line[200];
    snprintf(line, sizeof line, "imagecache: %s=%.32s: must be %s", key, value, legal);
    host->log(host, CULL_LOG_ERROR, line);
    return CULL_ERR_OPTION;
}

static int read_level(const char *value, uint32_t *out)
{
    if (strcmp(value, "auto") == 0) {
        *out = CELLS_LEVEL_AUTO;
        return 1;
    }
    uint32_t number = 0;
    for (const char *c = value; *c; c++) {
        if (*c < '0' || *c > '9' || number > GROUND_LEVELS_MOST) return 0;
        number = number * 10 + (uint32_t)(*c - '0');
    }
    *out = number;
    return *value && number <= GROUND_LEVELS_MOST;
}

// Digits, and a point among them: the same whatever language the process speaks.
static int read_pixels(const char *value, double *out)
{
    double number = 0, place = 1;
    int points = 0, digits = 0;
    for (const char *c = value; *c; c++) {
        if (*c == '.' && points++ == 0) continue;
        if (*c < '0' || *c > '9' || digits++ > 12) return 0;
        number = number * 10 + (*c - '0');
        if (points) place *= 10;
    }
    *out = number / place;
    return digits > 0 && *out >= 0.0625 && *out <= 64;
}

static int read_mib(const char *value, uint64_t *out)
{
    uint64_t number = 0;
    for (const char *c = value; *c; c++) {
        if (*c < '0' || *c > '9' || number > 65536) return 0;
        number = number * 10 + (uint64_t)(*c - '0');
    }
    *out = number << 20;
    return number >= 1 && number <= 65536;
}

// The place of the value among the words, or -1.
static int word_of(const char *value, const char *const *words, int count)
{
    for (int i = 0; i < count; i++)
        if (strcmp(value, words[i]) == 0) return i;
    return -1;
}

cull_result options_read(const cull_host *host, const char *const *values, options *out)
{
    static const char *const walks[] = {"rings", "bresenham", "tree"}, *const orders[] = {"rings", "slope"};
    static const char *const shows[] = {"quad", "centre", "geometry"}, *const switches[] = {"on", "off"};
    static const char *const hiddens[] = {"tested", "shown"}, *const budgets[] = {"bounded", "steady"}, *const details[] = {"coarser", "full"};
    const int walk = word_of(values[OPTION_WALK], walks, 3), order = word_of(values[OPTION_ORDER], orders, 2);
    const int shown = word_of(values[OPTION_SHOW], shows, 3), tree = word_of(values[OPTION_TREE], switches, 2);
    const int hidden = word_of(values[OPTION_HIDDEN], hiddens, 2), budget = word_of(values[OPTION_BUDGET], budgets, 2);
    const int detail = word_of(values[OPTION_DETAIL], details, 2);
    if (!read_level(values[OPTION_LEVEL], &out->level)) return refused(host, "level", values[OPTION_LEVEL], "auto, or a number from 0 to 10");
    if (walk < 0) return refused(host, "walk", values[OPTION_WALK], "rings, tree or bresenham");
    if (order < 0) return refused(host, "order", values[OPTION_ORDER], "rings or slope");
    if (shown < 0) return refused(host, "show", values[OPTION_SHOW], "quad, centre or geometry");
    if (tree < 0) return refused(host, "tree", values[OPTION_TREE], "on or off");
    if (!read_pixels(values[OPTION_TOLERANCE], &out->show.tolerance_px)) return refused(host, "tolerance", values[OPTION_TOLERANCE], "a number of pixels from 0.0625 to 64");
    if (hidden < 0) return refused(host, "hidden", values[OPTION_HIDDEN], "tested or shown");
    if (budget < 0) return refused(host, "budget", values[OPTION_BUDGET], "bounded or steady");
    if (!read_mib(values[OPTION_MEMORY], &out->show.bytes_most)) return refused(host, "memory_mib", values[OPTION_MEMORY], "a number from 1 to 65536");
    if (detail < 0) return refused(host, "detail", values[OPTION_DETAIL], "coarser or full");
    out->ways.walk = walk == 0 ? INVIEW_RINGS : walk == 1 ? INVIEW_BRESENHAM : INVIEW_TREE;
    out->ways.order = order == 0 ? INVIEW_BY_RINGS : INVIEW_BY_SLOPE;
    // The report's forms, and the tree of what is all geometry, are compared by themselves.
    out->show.show = shown == 2 || walk != 0 || order != 0 ? SHOW_GEOMETRY : shown == 0 ? SHOW_QUADS : SHOW_CENTRED;
    out->show.hidden = hidden == 0 ? SHOW_HIDDEN_TESTED : SHOW_HIDDEN_TOO;
    out->show.budget = budget == 0 ? SHOW_BOUNDED : SHOW_STEADY;
    out->show.detail = detail == 0 ? SHOW_COARSER : SHOW_FULL;
    out->show.nodes = tree == 0 ? SHOW_TREE : SHOW_CELLS;
    return CULL_OK;
}
