// Maps as text into the compiler's input, for tests; and an exact check of what came out.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_INPUT_FIXTURE_H
#define PORTCULLIS_TESTS_INPUT_FIXTURE_H

#include "host/compile/compile.h"
#include "host/compile/plane_table.h"
#include "tests/common/report_lines.h"
#include "tests/common/test.h"

enum { MAP_BYTES = 1 << 16 };

typedef struct map_writer { // fails the test when it is full
    char text[MAP_BYTES];
    size_t size;
} map_writer;
#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
void write_text(map_writer *w, const char *format, ...);
void write_box(map_writer *w, const double min[3], const double max[3], const char *texture); // decimals as short as they are
void open_entity(map_writer *w, const char *class_name);
void close_entity(map_writer *w);

compile_input *input_of(const char *text, const input_options *o); // must be read without a line
void expect_input_error(const char *text, const char *line);       // the only line, the path being t.map

// The file below PORTCULLIS_SCENES, on the heap; NULL, with a line on stderr, when it isn't there.
char *real_map(const char *name, size_t *out_size);
enum { REAL_MAPS = 8, ID_MAPS = 4 }; // those of id first
extern const char *const real_map_names[REAL_MAPS];

// Every brush closed and convex: each face has corners, none in front of another face, and its box holds them.
void assert_brushes_are_sound(const compile_input *in);

#endif
