// One strategy's row as a JSON object: what the bench's JSON and CSV both tell.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_BENCH_JSON_ENTRY_H
#define PORTCULLIS_BENCH_JSON_ENTRY_H

#include "bench.h"

#include <jansson.h>

// A new object, its keys in the order of the results; NULL: no memory.
json_t *bench_json_entry(const bench_result *b, const bench_request *q, const bench_labels *labels, const bench_row *row);

#endif
