// runs.h: lists of runs. Strict C11, reads as C++17.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_RUNS_H
#define PORTCULLIS_RUNS_H

#include "culler.h"

#include <stddef.h>

typedef struct cull_run_list { cull_run *runs; uint32_t count; } cull_run_list;

// Fills out->runs, which is none of the inputs', with the items of a, b or both. Lists ascend, and their runs never touch.
static inline void cull_runs_unite(const cull_run_list *a, const cull_run_list *b, cull_run_list *out)
{
    const cull_run *x = a->runs, *y = b->runs;
    const cull_run *const x_end = x + a->count, *const y_end = y + b->count;
    cull_run *last = NULL;
    uint32_t end = 0; // of the last run
    while (x < x_end || y < y_end) {
        const int take_x = y == y_end || (x < x_end && x->first <= y->first);
        const cull_run next = take_x ? *x++ : *y++;
        const uint32_t next_end = next.first + next.count;
        if (last && next.first <= end) {
            if (next_end > end) end = next_end;
            last->count = end - last->first;
        } else {
            last = last ? last + 1 : out->runs;
            *last = next;
            end = next_end;
        }
    }
    out->count = last ? (uint32_t)(last - out->runs) + 1 : 0;
}

// Places that come one by one, ascending, as runs; those that there is no room for are counted.
typedef struct cull_run_writer {
    cull_run *runs, last;
    uint32_t count, most; // count: runs there are, written or not
} cull_run_writer;

static inline void cull_run_put(cull_run_writer *w, uint32_t place)
{
    if (w->count && place == w->last.first + w->last.count) {
        w->last.count++;
    } else {
        w->last.first = place;
        w->last.count = 1;
        w->count++;
    }
    if (w->count <= w->most) w->runs[w->count - 1] = w->last;
}

#endif
