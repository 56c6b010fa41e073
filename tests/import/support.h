// What the tests of import share: reports that are kept, memory that fails on demand, real scenes.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_IMPORT_SUPPORT_H
#define PORTCULLIS_TESTS_IMPORT_SUPPORT_H

#include "host/import/import.h"
#include "host/import/views.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

typedef struct heard { // the last line of a report
    char text[1024];
    report_level level;
    uint32_t notes;
} heard;
report hear(heard *h);

typedef struct shaky_memory { // fails allocation number `fail_at`, counted from 1; 0 never
    uint64_t allocations, fail_at, live_bytes;
} shaky_memory;
allocator shaky_allocator(shaky_memory *m);

extern const import_options doors_open, doors_shut;
scene *map_of(const char *text, const import_options *options); // must import without a warning
void expect_map_error(const char *text, const char *line);      // the whole line, the path being t.map

// The bytes of a real scene, closed by a zero, on the heap; NULL (and a line on stderr) when the folder isn't there.
char *real_scene(const char *name, size_t *out_size);
extern const char *const real_maps[8];

#endif
