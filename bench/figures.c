// Figures of indices: see figures.h.
// SPDX-License-Identifier: MIT
#include "figures.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static int is_word(const char *name)
{
    const size_t length = name ? strspn(name, "abcdefghijklmnopqrstuvwxyz0123456789_") : 0;
    return length > 0 && name[length] == 0;
}

static bench_figure *figure_named(bench_figures *figures, const char *id, const char *name)
{
    char whole[FIGURE_NAME_BYTES];
    const int length = snprintf(whole, sizeof whole, "%s.%s", id, name);
    if (length < 0 || (size_t)length >= sizeof whole) return NULL;
    for (uint32_t i = 0; i < figures->count; ++i)
        if (strcmp(figures->list[i].name, whole) == 0) return &figures->list[i];
    if (figures->count == FIGURES_MOST) return NULL;
    bench_figure *made = &figures->list[figures->count++];
    memcpy(made->name, whole, (size_t)length + 1);
    made->value = 0;
    return made;
}

static void add_stage(bench_figures *figures, const chain_stage *s)
{
    const cull_figures *told = s->plugin->get_extension ? s->plugin->get_extension(s->culler, CULL_EXT_FIGURES) : NULL;
    for (uint32_t i = 0; told && i < told->count; ++i) {
        const cull_figure *f = &told->figures[i];
        bench_figure *sum = is_word(f->name) && isfinite(f->value) ? figure_named(figures, s->plugin->descriptor->id, f->name) : NULL;
        if (!sum) continue;
        if (f->sort == CULL_FIGURE_MAX) sum->value = f->value > sum->value ? f->value : sum->value;
        else sum->value += f->value;
    }
}

void figures_add_chain(bench_figures *figures, const chain *c)
{
    for (uint32_t i = 0; i < c->stage_count; ++i) add_stage(figures, &c->stages[i]);
}
