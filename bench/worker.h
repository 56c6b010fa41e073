// One thread that does jobs in the order they were given, so that results are those of doing them at once.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_BENCH_WORKER_H
#define PORTCULLIS_BENCH_WORKER_H

#include "../host/core/memory.h"

typedef struct worker worker;
typedef struct worker_request {
    void (*run)(void *context, uint64_t job); // on that thread, job 1, 2, 3 ...
    void *context;
} worker_request;

// [one thread, as all below] NULL: no memory. Where no thread can be had, jobs are done as they are given.
worker *worker_open(const worker_request *q, const allocator *memory);
void worker_close(worker *w); // does what was given first; NULL is fine
uint64_t worker_give(worker *w);             // the next job's number; whatever it reads must stand by now
void worker_wait(worker *w, uint64_t job); // until that one and all before it are done; 0: none

#endif
