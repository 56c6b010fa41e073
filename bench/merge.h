// Parts of a sharded bench put together again: the rows that one process would have told, from the same records by the same code.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_BENCH_MERGE_H
#define PORTCULLIS_BENCH_MERGE_H

#include "bench.h"

// What the outputs of a bench are made from. Scene and path are stubs: hash, count and name.
typedef struct merged {
    bench_request request;
    bench_labels labels;
    bench_result result;
    scene *scene;
    camera_path path;
    host_services services;
    bench_strategy_request *strategies;
    arena texts;
} merged;

// All parts, in any order. BAD_INPUT with a line where one is missing, stands twice, is not whole, or is of another bench; nothing is left then.
// Of figures of indices only those stay that all parts agree on: others count what each process walked. *out must not move.
result merge_open(const char *const *files, uint32_t count, const allocator *memory, report *r, merged *out);
void merge_close(merged *m); // zeroed is fine

#endif
