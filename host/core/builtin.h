// Cullers that are always there: `none` draws everything, `brute` is the plain loop that every
// tree is measured against, `flood` passes portals unclipped.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_BUILTIN_H
#define PORTCULLIS_HOST_BUILTIN_H

#include <portcullis/culler.h>

// [any thread] Constant, in the same contract as a library's.
const cull_plugin *const *builtin_plugins(uint32_t *count);

extern const cull_plugin builtin_none, builtin_brute, builtin_flood;

#endif
