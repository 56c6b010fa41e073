// A function run in a process of its own, with limits, and what became of it.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_CHECK_PROCESS_H
#define PORTCULLIS_HOST_CHECK_PROCESS_H

#include "run.h"

typedef struct process_request {
    check_function *task;
    const char *id;     // the culler to open first; NULL: whichever
    check_run run;      // copied into the process
    uint32_t cpu_s, wall_s; // CPU time bears a busy machine; wall time ends what sleeps
} process_request;

typedef struct process_result {
    check_verdict verdict;
    char message[RUN_TEXT_BYTES];
    double seconds;
} process_result;

void process_run(const process_request *q, process_result *out);

// [in the process] A name for memory, said when it is touched against the rules. The text stays the caller's.
typedef struct process_region { const char *begin, *end, *name; } process_region;
void process_name_region(const void *begin, size_t size, const char *name);
void process_forget_regions(void);
// [in the process, signal safe] Ends it at once: failed, with this text and the place.
_Noreturn void process_fail_now(const char *text);
_Noreturn void process_pass_now(void);

#endif
