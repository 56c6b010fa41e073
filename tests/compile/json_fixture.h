// JSON scenes with brushes as text into the compiler's input, and on to a scene, for tests.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_JSON_FIXTURE_H
#define PORTCULLIS_TESTS_JSON_FIXTURE_H

#include "host/compile/brush_shape.h"
#include "host/compile/compile.h"
#include "tests/common/report_lines.h"
#include "tests/common/test.h"
#include "tests/import/json_support.h"

#define HEAD "{\"portcullis\": 1,\n"
#define STEPS 8192.0 // a metre, at the default grid

compile_input *brushes_of(const char *text, const memory_file *files); // must be read without a line
compile_input *brush_of(const char *entry);                            // the only one
void expect_brush_error(const char *entry, const char *line);          // the entry begins at line 2, column 14
void expect_brushes_error(const char *text, const memory_file *files, const char *line);

typedef struct compiled { compile_input *in; compiled_zones *zones; scene *scene; compile_checks checks; } compiled;
compiled compiled_of(compile_input *in); // takes it; must go well, without a hole
void compiled_free(compiled *c);

typedef struct corner_list { double (*at)[3]; size_t count; } corner_list; // metres, each once
corner_list corners_of(const compile_input *in, uint32_t brush);
double corners_apart(const corner_list *from, const double (*to)[3], size_t count); // steps: the farthest from its nearest, both ways

#endif
