// Shards: which views of a path a process measures when several share a bench, and what they must agree on.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_BENCH_SHARD_H
#define PORTCULLIS_BENCH_SHARD_H

#include "bench.h"

typedef struct view_range { uint32_t first, end; } view_range;
// All without shards. As even as can be: no two differ by more than a view.
view_range shard_range(const bench_shard *s, uint32_t views);

enum { SHARDS_MOST = 1000000 };
// "3/8": 0 when it is none.
int shard_parse(const char *text, bench_shard *out);
// What Slurm, Open MPI or another starter by PMI tells a process of its rank: the first of them that names more than one. variable: as getenv.
// 1: *out is set. 0: started alone, or numbers that make no sense.
int shard_of_environment(const char *(*variable)(const char *name), bench_shard *out);

// What the results depend on, but for the machine, as a JSON object; free with memory_free(q->services->memory, text, strlen + 1, 1). NULL: no memory.
char *shard_identity(const bench_request *q, const bench_labels *labels);

#endif
