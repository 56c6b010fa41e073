// Text of any bytes as a JSON string: what is no UTF-8, such as a file's name may hold, stands there as '?'.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_BENCH_JSON_TEXT_H
#define PORTCULLIS_BENCH_JSON_TEXT_H

#include <jansson.h>

enum { JSON_TEXT_BYTES = 16384 }; // the rest is dropped: over twice what any name, path or reason takes

// [any thread] A new string, or NULL without memory. text NULL: JSON's null.
json_t *json_text(const char *text);

#endif
