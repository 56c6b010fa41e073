// The body of a runs_kernel, included once for each instruction set with RUNS_KERNEL set to its name.
// SPDX-License-Identifier: MIT
#include "runs.h"

#include <string.h>

static uint32_t check(const cull_run *runs, uint32_t run_count, uint32_t limit, uint64_t *out_items)
{
    uint32_t bad = 0;
    uint64_t items = 0;
    while (run_count) { // in blocks whose sum of good counts cannot overflow unnoticed: each is at most limit
        const uint32_t block = run_count < 1024 ? run_count : 1024;
        uint64_t sum = 0;
        for (uint32_t i = 0; i < block; ++i) {
            const uint32_t first = runs[i].first, count = runs[i].count;
            bad |= (uint32_t)(count - 1 >= limit) | (uint32_t)(first > limit - count);
            sum += count;
        }
        items += sum;
        runs += block;
        run_count -= block;
    }
    *out_items = items;
    return bad == 0;
}

// Sixteen ids at a time whatever the run's length: a short run costs no mispredicted branch.
static uint32_t expand(const cull_run *runs, uint32_t run_count, const uint32_t *order, uint32_t *ids)
{
    static const uint32_t ramp[16] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    uint32_t *to = ids;
    for (uint32_t r = 0; r < run_count; ++r) {
        const uint32_t first = runs[r].first, count = runs[r].count;
        uint32_t at = 0;
        do {
            if (order) memcpy(to + at, order + first + at, 16 * sizeof *to);
            else
                for (uint32_t i = 0; i < 16; ++i) to[at + i] = first + at + ramp[i];
            at += 16;
        } while (at < count);
        to += count;
    }
    return (uint32_t)(to - ids);
}

const runs_kernel RUNS_KERNEL = {check, expand};
