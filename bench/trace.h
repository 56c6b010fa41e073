// A trace of frames for Chrome's about:tracing and Perfetto (Trace Event Format): spans of the flow, of each zone's steps and of what the driver carries out.
// SPDX-License-Identifier: MIT
// Invariant: a pass of its own, after those that are timed; nobody who asks for no trace pays for one.
#ifndef PORTCULLIS_BENCH_TRACE_H
#define PORTCULLIS_BENCH_TRACE_H

#include "strategy.h"

typedef struct trace trace;

trace *trace_open(const allocator *memory); // NULL: no memory
void trace_close(trace *t);                 // NULL is fine
// [main] All views of the path once, from an empty history. Spans are of wall time.
result trace_strategy(trace *t, strategy *s, report *r);
// All that was traced, as JSON.
result trace_write(trace *t, const char *path, report *r);

#endif
