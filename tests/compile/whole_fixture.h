// A map's text through every stage of the compiler, for tests.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_WHOLE_FIXTURE_H
#define PORTCULLIS_TESTS_WHOLE_FIXTURE_H

#include "host/compile/compile.h"

typedef struct whole_map {
    const char *text;
    size_t size;
    double grid; // 0: the default
    portal_choice portals;
} whole_map;

typedef struct whole {
    compile_input *in;
    compiled_zones *zones;
    scene *scene;
    csg_counts counts;
    compile_checks checks;
} whole;

// On failure *out holds what was made; whole_free it all the same.
result whole_compile(const whole_map *m, report *r, const allocator *memory, whole *out);
void whole_free(whole *w, const allocator *memory);
// The scene's file, on the heap of `memory`; 0: it can't be written.
size_t whole_encode(const whole *w, const allocator *memory, void **out_bytes);

#endif
