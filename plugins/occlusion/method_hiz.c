// method=hiz among the methods: one step, no tests; the work is hiz_step's, which needs no history but whether to rest.
// SPDX-License-Identifier: MIT
#include "method.h"

static uint32_t steps_most(uint32_t entries)
{
    (void)entries;
    return 1;
}

static uint32_t tests_most(uint32_t entries)
{
    (void)entries;
    return 0;
}

static cull_progress step(occlusion_walk *w)
{
    (void)w;
    return CULL_DONE;
}

const occlusion_method method_hiz = {"hiz", CULL_SAMPLED, steps_most, tests_most, step};
