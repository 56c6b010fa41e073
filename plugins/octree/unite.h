// Lists of runs, ascending and never touching: their union.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_OCTREE_UNITE_H
#define PORTCULLIS_OCTREE_UNITE_H

#include <portcullis/culler.h>

typedef struct run_list {
    cull_run *runs;
    uint32_t count;
} run_list;

// Fills out->runs, which is none of the inputs', with the items of a, b or both.
void runs_unite(const run_list *a, const run_list *b, run_list *out);

#endif
