// Loops over runs that every frame takes: bounds check, and expansion to ids. One body, compiled for each instruction
// set, chosen at run time; all give the same bytes.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_RUNS_H
#define PORTCULLIS_HOST_RUNS_H

#include <portcullis/culler.h>

enum { RUNS_OVERWRITE = 16 }; // ids that runs_kernel.expand may scribble behind the last one it returns

typedef struct runs_kernel {
    // 1 when every run is non-empty and ends at or below `limit`. *out_items: sum of the counts.
    uint32_t (*check)(const cull_run *runs, uint32_t run_count, uint32_t limit, uint64_t *out_items);
    // Writes order[place] (or the place where order is NULL) of every place of every run; returns how many. order has
    // RUNS_OVERWRITE readable ids behind the last place. Runs must be checked.
    uint32_t (*expand)(const cull_run *runs, uint32_t run_count, const uint32_t *order, uint32_t *ids);
} runs_kernel;

const runs_kernel *runs_kernel_best(void); // [any thread] the widest that this CPU has
extern const runs_kernel runs_kernel_plain;
#if defined(__x86_64__)
extern const runs_kernel runs_kernel_avx2, runs_kernel_avx512; // only for a CPU that has them
#endif

#endif
