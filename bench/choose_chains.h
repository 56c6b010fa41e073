// Choosing chains for the zones of a scene over a path: candidates measured by the bench, by the rule of choose.h.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_BENCH_CHOOSE_CHAINS_H
#define PORTCULLIS_BENCH_CHOOSE_CHAINS_H

#include "bench.h"
#include "choose.h"

enum { CHOOSE_GROUPS_MOST = 32 };

typedef struct chains_request {
    const bench_request *bench;            // scene, path, size, repeat; its strategies are the candidates, a chain each
    double budget_s;                       // wall clock; all groups alike are always measured
    uint32_t group_most;                   // zones chosen for alone, at most CHOOSE_GROUPS_MOST - 1; all others are one group
} chains_request;

typedef struct chains_candidate {
    const char *rejected;  // why it was not measured, NULL: it was
    const char *inexact;   // why it was not taken though it was measured; NULL: it is exact
    uint64_t missed_pixels, missed_items;
    double ms;             // all zones alike
} chains_candidate;

typedef struct chains_result {
    chains_candidate *candidates; // strategy_count of the request
    uint32_t candidate_count;
    uint32_t *group_of_zone;      // scene.zone_count; groups by weight, heaviest first
    double *shares;               // by group: of the polygons drawn where each zone is culled by its frustum alone
    choose_pick *picks;           // by group; candidates as in the request
    choose_pick uniform;
    uint32_t group_count, zone_count;
    double uniform_ms, chosen_ms; // both in one run, at the end; equal where they are the same
    uint32_t is_uniform;          // all groups have one chain, or mixing brought nothing in that last run
    const allocator *memory;
} chains_result;

// [main] Chains that promise neither CONSERVATIVE nor SAMPLED, show pictures of their own, or miss anything are never taken.
// BAD_INPUT with a line where none is left. Free with chains_result_free.
result chains_choose(const chains_request *q, report *r, chains_result *out);
void chains_result_free(chains_result *c);
// The candidate that a zone got.
uint32_t chains_of_zone(const chains_result *c, uint32_t zone);

#endif
