// What `bench` and `merge` tell: the table, JSON, CSV, a line a view, and which strategies failed.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_APP_BENCH_RESULTS_H
#define PORTCULLIS_HOST_APP_BENCH_RESULTS_H

#include "../../bench/bench.h"
#include "app.h"

typedef struct bench_output {
    const bench_request *bench;
    const bench_labels *labels;
    const char *json, *csv, *frames; // files, "-" or NULL
} bench_output;

int is_stdout(const char *file); // file may be NULL
// Whether they could be written, before long work.
result bench_results_check(report *r, const bench_output *o);
// The table goes to stdout, to stderr where another result goes there.
result bench_results_write(const allocator *memory, report *r, const bench_output *o, const bench_result *b);
// A line each; how many there are.
uint32_t bench_results_tell_failures(report *r, const bench_request *q, const bench_result *b);

#endif
