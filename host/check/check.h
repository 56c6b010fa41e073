// The check of a culler: each promise of culler.h that a program can try, each in a process of its own.
// SPDX-License-Identifier: MIT
// Invariant: the caller runs no code of the culler; what it does to its process is found out by another.
#ifndef PORTCULLIS_HOST_CHECK_H
#define PORTCULLIS_HOST_CHECK_H

#include <portcullis/culler.h>

typedef enum check_verdict { CHECK_PASS, CHECK_FAIL, CHECK_SKIP } check_verdict;

typedef struct check_line {
    const char *name, *proves; // proves: for a person, half a sentence
    check_verdict verdict;
    const char *message; // FAIL: what and where; SKIP: why; PASS: empty
    double seconds;
} check_line;

typedef struct check_request {
    const char *file;          // the library; NULL: built in
    const char *id;            // which culler of it; NULL: the only one
    const cull_plugin *plugin; // where file is NULL
    uint64_t seed;
    const char *only; // the one check to run, beside those that it rests on; NULL: all
    void (*tell)(void *user, const check_line *line);
    void *user;
} check_request;

typedef struct check_count { uint32_t passed, failed, skipped; } check_count;

// [main, no other thread] Needs fork. What a failed check rests on is told too; what rests on a failed one is skipped.
check_count check_culler(const check_request *q);
int check_is_known(const char *name);
void check_each_name(void (*tell)(void *user, const char *name, const char *proves), void *user);

// The ids of a library's cullers, found in a process of its own, a space between. Returns 0 when none can be read.
int check_ids(const char *file, char *ids, size_t size);

#endif
