// What the two sources of the test culler `testbad` share.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_TESTBAD_H
#define PORTCULLIS_TESTS_TESTBAD_H

#include <portcullis/culler.h>

// What testbad tells after build; its faults go over these.
enum { BAD_RUNS = 4, BAD_TESTS = 2, BAD_CAPTURES = 2, BAD_PICTURES = 2, BAD_CLIPPED = 2, BAD_SLOTS = 2, BAD_STEPS = 8 };

typedef struct bad_step { // one step that was answered well, to be spoilt
    const cull_host *host;
    const cull_zone *zone;
    const cull_visit *visit;
    cull_batch *batch;
    cull_progress progress;
    uint32_t run_capacity; // BAD_RUNS, or that and the movers
} bad_step;

typedef struct bad_fault {
    const char *name;
    void (*spoil)(bad_step *s);
} bad_fault;

// The faults of a step by name; NULL: no such.
const bad_fault *bad_fault_find(const char *name);

#endif
