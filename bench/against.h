// A bench beside an earlier run of the same: what got slower by the rule of against_rule.h, and which counters changed.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_BENCH_AGAINST_H
#define PORTCULLIS_BENCH_AGAINST_H

#include "bench.h"

typedef struct against_request {
    const char *path;      // JSON of bench --times
    const char *reference; // the strategy that times are compared by; NULL: brute, or none where that is not in both
    double least_percent;  // that counts as slower
} against_request;

// Whether the file is such a JSON: asked before long work.
result against_check(const against_request *a, report *r);
// Lines for people into *out, to be freed as other texts. BAD_INPUT with a line where the earlier run is of another scene, path or size.
typedef struct against_found {
    uint32_t regressions; // strategies slower, or with worse counters
    uint32_t slower;      // times that are, of one or two a strategy: worth measuring again
} against_found;
typedef struct against_run {
    const bench_request *bench;
    const bench_labels *labels;
    const bench_result *result;
} against_run;
result against_tell(const against_request *a, const against_run *now, report *r, bench_text *out, against_found *found);
// The least times of both runs of one bench into the first.
void against_fold(bench_result *first, const bench_result *again);

#endif
