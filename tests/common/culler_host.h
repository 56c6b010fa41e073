// A host for tests of cullers: its memory counts and fails one allocation as asked, what is logged is kept.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_CULLER_HOST_H
#define PORTCULLIS_TESTS_CULLER_HOST_H

#include "failing_allocator.h"

#include <portcullis/culler.h>

typedef struct culler_host {
    cull_host host; // runs tasks one after the other, has no extension
    failing_allocator memory;
    uint32_t lines; // logged
    char last_line[256];
} culler_host;
void culler_host_init(culler_host *h, uint64_t fail_at); // 0: no allocation fails; the struct must not move

#endif
