// Text of generated files: numbers written from integers, by hand, so that no rounding of printf is in them.
// SPDX-License-Identifier: MIT
// Invariant: after a failed allocation nothing is added any more and `failed` stays set.
#ifndef PORTCULLIS_BENCH_GENERATE_TEXT_H
#define PORTCULLIS_BENCH_GENERATE_TEXT_H

#include "../host/core/memory.h"
#include "../host/core/report.h"

typedef struct text_file {
    buffer bytes;
    int failed;
} text_file;

text_file text_open(const allocator *memory);
void text_free(text_file *t);
void text_add(text_file *t, const char *words);
void text_count(text_file *t, uint64_t count);
// value / 10^decimals, without trailing zeros: (12500, 4) is 1.25; decimals at most 9
void text_decimal(text_file *t, int64_t value, uint32_t decimals);
// Writes the file whole or not at all, and frees the text in any case.
result text_close(text_file *t, const char *path, report *r);

#endif
