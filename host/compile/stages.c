// Names of the stages: see stages.h.
// SPDX-License-Identifier: MIT
#include "stages.h"

#include <string.h>

static const char *const names[STAGE_COUNT] = {"input", "relations", "csg", "weld", "merge", "portals", "zones", "t_junctions", "items", "bake", "write"};

const char *compile_stage_name(compile_stage s)
{
    return names[s];
}

compile_stage compile_stage_of(const char *name)
{
    for (int s = 0; s < STAGE_COUNT; ++s)
        if (strcmp(name, names[s]) == 0) return (compile_stage)s;
    return STAGE_COUNT;
}

void compile_stage_names(compile_stage end, char out[128])
{
    *out = 0;
    for (int s = 0; s < (int)end; ++s) {
        if (s) strcat(out, " ");
        strcat(out, names[s]);
    }
}

void compile_tell(const compile_view *made)
{
    const compile_watch *watch = made->in->watch;
    if (watch) watch->ended(watch->user, made);
}
