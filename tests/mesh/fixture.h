// What the mesh tests share: captured reports, imports from text, scene oracles.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_MESH_FIXTURE_H
#define PORTCULLIS_TESTS_MESH_FIXTURE_H

#include "host/import/import.h"
#include "tests/common/random.h"
#include "tests/common/test.h"

typedef struct captured { // every warning and error
    report report;
    char text[8192];
    size_t used;
} captured;
void captured_open(captured *c);

// Reads the bytes as a file of that name; the ending chooses the reader. They are copied to their exact size first.
result import_bytes(const char *path, const void *bytes, size_t size, const allocator *memory, report *r, scene **out);
scene *import_good(const char *path, const char *text);           // asserts that it works without a word
void assert_refused(const char *path, const char *text, const char *line); // asserts the error's beginning

int has_openmesh(void); // 0 after a loud skip()
// PORTCULLIS_SCENES/name read whole, or skip() with a line on stderr. Free with free().
char *scene_file(const char *name, size_t *size);

double scene_area(const scene *s);                     // of all triangles, square metres
void assert_same_geometry(const scene *a, const scene *b);
void assert_clusters_are_sound(const scene *s);        // at most 128 triangles or one polygon; nothing lost between items
void remove_scene(scene *s);

#endif
