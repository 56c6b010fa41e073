// What the mesh tests share: captured reports, allocators that count and fail, imports from text, scene oracles.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_MESH_FIXTURE_H
#define PORTCULLIS_TESTS_MESH_FIXTURE_H

#include "host/import/import.h"

#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>

typedef struct captured { // every line that was reported
    report report;
    char text[8192];
    size_t used;
} captured;
void captured_open(captured *c);

typedef struct counting_heap { // fails its `fail_at`-th allocation, from 1; 0: none
    allocator allocator;
    long made, live, fail_at;
} counting_heap;
void counting_heap_open(counting_heap *h, long fail_at);

// Reads the bytes as a file of that name; the ending chooses the reader. They are copied to their exact size first.
result import_bytes(const char *path, const void *bytes, size_t size, const allocator *memory, report *r, scene **out);
scene *import_good(const char *path, const char *text);           // asserts that it works without a word
void assert_refused(const char *path, const char *text, const char *line); // asserts the error's beginning

// PORTCULLIS_SCENES/name read whole, or skip() with a line on stderr. Free with free().
char *scene_file(const char *name, size_t *size);

double scene_area(const scene *s);                     // of all triangles, square metres
void assert_same_geometry(const scene *a, const scene *b);
void assert_clusters_are_sound(const scene *s);        // at most 128 triangles or one polygon; nothing lost between items
void remove_scene(scene *s);

typedef struct seeded { uint64_t state; } seeded; // splitmix64
uint64_t seeded_next(seeded *s);
double seeded_unit(seeded *s); // 0 up to 1

#endif
