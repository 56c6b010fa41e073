// An allocator for tests: counts what lives, checks that each block is freed with the size it was asked for, and fails
// one chosen allocation, so that a loop over k = 1, 2, 3 ... takes every path out of memory.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_FAILING_ALLOCATOR_H
#define PORTCULLIS_TESTS_FAILING_ALLOCATOR_H

#include "host/core/memory.h"

typedef struct failing_allocator {
    allocator memory; // what the tested code takes; points back here, so the struct must not move
    uint64_t calls;   // allocations asked for so far
    uint64_t fail_at; // this one fails; 0: none does
    uint64_t failures;
    uint64_t live_blocks, live_bytes;
    uint64_t wrong_frees; // freed with another size than asked for
    size_t bytes_most;    // larger requests fail, so that tests of absurd sizes do not depend on the machine
} failing_allocator;

// fail_at 0: counts only.
void failing_allocator_init(failing_allocator *a, uint64_t fail_at);
// 1 when everything was freed, with the right sizes.
int failing_allocator_is_clean(const failing_allocator *a);

#endif
