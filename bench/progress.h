// A progress bar on stderr where that is a terminal; silent in a pipe.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_BENCH_PROGRESS_H
#define PORTCULLIS_BENCH_PROGRESS_H

#include <stdint.h>

typedef struct progress {
    uint64_t total, done;
    int shown, percent;
} progress;

progress progress_start(uint64_t total);
void progress_tell(progress *p, const char *what); // one more of `total` begins
void progress_end(progress *p);                    // wipes the line

#endif
