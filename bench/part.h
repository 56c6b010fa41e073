// A part: one shard's records as a file, with what all parts must agree on. A line of JSON, then the records as they stand, then a hash of all.
// SPDX-License-Identifier: MIT
// Invariant: a part is whole or it isn't there.
#ifndef PORTCULLIS_BENCH_PART_H
#define PORTCULLIS_BENCH_PART_H

#include "records.h"

#include <jansson.h>

// To q->shard.part. result.records: of the shard's views.
result part_write(const bench_request *q, const bench_result *b, report *r);

typedef struct part {
    const char *path; // as given
    json_t *head;     // "identity", "shard", "shards", "first", "count", "facts", "rows"
    char *bytes;
    size_t size, records_at;
    const allocator *memory;
} part;

// On failure a line, and nothing is left.
result part_read(const char *path, const allocator *memory, report *r, part *out);
void part_close(part *p); // zeroed is fine
// Into records of the whole path, of as many strategies and passes as the part has.
result part_take(const part *p, report *r, records *out);
json_int_t part_number(const part *p, const char *key); // of the head; -1: none

#endif
