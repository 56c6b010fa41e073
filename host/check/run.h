// One check as it runs in its own process: the culler, its random numbers, and how it says what it found.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_CHECK_RUN_H
#define PORTCULLIS_HOST_CHECK_RUN_H

#include "check.h"

enum { RUN_TEXT_BYTES = 512 };

typedef struct check_run {
    const cull_plugin *plugin;
    void *library; // of dlopen; NULL: built in
    const char *file;
    uint64_t seed, random;
    char place[RUN_TEXT_BYTES];   // where the check is: said with every fault, a crash too
    char message[RUN_TEXT_BYTES];
} check_run;

#if defined(__GNUC__)
#define RUN_FORMAT __attribute__((format(printf, 2, 3)))
#else
#define RUN_FORMAT
#endif
RUN_FORMAT void run_at(check_run *r, const char *format, ...);              // where it is from now on
RUN_FORMAT check_verdict run_fail(check_run *r, const char *format, ...);   // with the place; returns CHECK_FAIL
RUN_FORMAT check_verdict run_skip(check_run *r, const char *format, ...);   // returns CHECK_SKIP

typedef check_verdict check_function(check_run *r);

// splitmix64, as in the tests: the same numbers on every machine.
static inline uint64_t run_bits(check_run *r)
{
    uint64_t z = r->random += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}
static inline uint32_t run_below(check_run *r, uint32_t count)
{
    return (uint32_t)(run_bits(r) % count);
}
static inline double run_between(check_run *r, double low, double high)
{
    return low + (high - low) * ((double)(run_bits(r) >> 32) / 4294967296.0);
}

void run_ids(const check_run *r, char *ids, size_t size); // of all cullers of the library, a space between

// The library opened, its entry looked at, the culler found. NULL, or what is wrong.
const char *run_open(check_run *r, const char *id);

#endif
