// Choosing a chain for each group of zones: all groups alike first, then group by group, the heaviest first, from the costs
// that somebody measures. Knows nothing of scenes, so its rule can be tried with costs that are made up.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_BENCH_CHOOSE_H
#define PORTCULLIS_BENCH_CHOOSE_H

#include "../host/core/memory.h"
#include "../host/core/report.h"

typedef struct choose_candidate { uint32_t stages, options; } choose_candidate; // of its chain: fewer is simpler

typedef struct choose_cost {
    double ms;
    uint32_t is_exact; // nothing missed, and its chains promise so
} choose_cost;

// One assignment: by group the candidate that it has.
typedef struct choose_measurer {
    void *user;
    // All in one run, interleaved: only such costs compare. assignments: count * groups. A line was reported where it fails.
    result (*measure)(void *user, const uint32_t *assignments, uint32_t count, choose_cost *out);
    int (*is_over)(void *user); // the budget is spent: what is chosen so far stays
} choose_measurer;

// A difference counts where it is more than this share, and more than twice what the same assignment, measured twice in that run, differs by.
static const double CHOOSE_MARGIN = 0.03;

typedef enum choose_reason {
    CHOOSE_FASTEST, // by more than the margin
    CHOOSE_SIMPLER, // within the margin of the fastest, and simpler
    CHOOSE_ONLY,    // no other is exact
    CHOOSE_UNTRIED, // the budget was spent, or nothing of it is ever drawn: what is best for all alike
} choose_reason;

typedef struct choose_pick {
    choose_reason reason;
    uint32_t candidate, next; // next: the best of the others; UINT32_MAX: none
    double ms, next_ms, margin; // of the whole in the run that decided; margin: as a share
} choose_pick;

typedef struct choose_request {
    const choose_candidate *candidates;
    uint32_t candidate_count, group_count;
    const double *weights; // by group, heaviest first; 0: nothing of it is ever drawn
    choose_measurer measurer;
} choose_request;

// The rule. costs: one each of the candidates; those of ones that were not tried are not exact.
choose_pick choose_one(const choose_candidate *candidates, const choose_cost *costs, uint32_t count, double noise);
// out_uniform: of all groups alike. out: group_count. BAD_INPUT, without a line: no candidate is exact.
result choose_all(const choose_request *q, const allocator *memory, choose_pick *out_uniform, choose_pick *out);

#endif
