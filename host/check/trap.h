// What a library may not call in a step: its own table of imported functions is pointed at traps, and the kernel is told to
// stop what gets past them. Works without privileges, and without a library loaded before all others.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_CHECK_TRAP_H
#define PORTCULLIS_HOST_CHECK_TRAP_H

#include <stddef.h>
#include <stdint.h>

enum { TRAP_SLOTS_MOST = 256, TRAP_SEGMENTS_MOST = 8 };
typedef struct trap_slot { void **at; void *was, *trap; } trap_slot;
typedef struct trap_segment { char *begin; size_t size; } trap_segment;
typedef struct trap {
    trap_slot slots[TRAP_SLOTS_MOST];
    trap_segment writable[TRAP_SEGMENTS_MOST]; // of the library's own data
    uint32_t slot_count, segment_count;
} trap;

// entry: an address within the library. 0: its tables cannot be read here. Zeroed, a trap catches nothing.
int trap_find(trap *t, const void *entry);
void trap_set(const trap *t);
void trap_clear(const trap *t);
void trap_seal_data(const trap *t); // its own data, which no step may write
void trap_release_data(const trap *t);
int trap_kernel(void); // from now on this thread ends at any other system call than a write and an exit; 0: not possible here

#endif
