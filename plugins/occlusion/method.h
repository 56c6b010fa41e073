// The methods: one file each. A method is asked step by step; the common work of a frame's begin is done by then.
// SPDX-License-Identifier: MIT
#ifndef OCCLUSION_METHOD_H
#define OCCLUSION_METHOD_H

#include "walk.h"

typedef struct occlusion_method {
    const char *name;
    cull_promises promises;
    uint32_t (*steps_most)(uint32_t entries); // in a frame; entries: nodes, items and movers
    uint32_t (*tests_most)(uint32_t entries); // in a step
    cull_progress (*step)(occlusion_walk *);
} occlusion_method;

extern const occlusion_method method_wait, method_last, method_twophase, method_chc, method_hiz;

enum { METHOD_TESTS_MOST = 32768 }; // in a step: the host keeps room for them several times over
static inline uint32_t method_tests(uint32_t entries)
{
    return entries < METHOD_TESTS_MOST ? entries + 1 : METHOD_TESTS_MOST;
}

#endif
