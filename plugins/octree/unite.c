// The union of two lists of runs: see unite.h.
// SPDX-License-Identifier: MIT
#include "unite.h"

void runs_unite(const run_list *a, const run_list *b, run_list *out)
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
