// What the tests of JSON scenes share: scenes from texts, with the files that they name in memory.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_IMPORT_JSON_SUPPORT_H
#define PORTCULLIS_TESTS_IMPORT_JSON_SUPPORT_H

#include "support.h"

typedef struct memory_file { const char *path, *text; } memory_file; // a list ends in {0}
import_files memory_files(const memory_file *files);

scene *json_of(const char *text, const memory_file *files); // doors as the file says; must import without a warning
scene *json_with_doors(const char *text, const import_options *options);
void expect_json_error(const char *text, const memory_file *files, const char *line); // the whole line, the path being t.json

// Names to numbers; fail when there is none.
uint32_t zone_of(const scene *s, const char *name);
uint32_t mover_of(const scene *s, const char *name);
// Same positions, indices, items and zones with their planes, portals, doors, movers, keys, cameras, lights: all bits.
void assert_same_scene(const scene *a, const scene *b);

#endif
