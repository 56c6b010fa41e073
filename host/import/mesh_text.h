// The scanner of the text formats of meshes: words and numbers on counted lines, no locale, no copy.
// SPDX-License-Identifier: MIT
// Invariant: `at` never passes `end`, and *end is 0, so that one byte may always be read.
#ifndef PORTCULLIS_IMPORT_MESH_TEXT_H
#define PORTCULLIS_IMPORT_MESH_TEXT_H

#include "../core/report.h"

#include <stddef.h>
#include <stdint.h>

typedef struct mesh_text {
    const char *at, *end;
    size_t line; // of `at`, from 1
    const char *path;
    report *report;
    int joins_lines; // .obj: a backslash at the end of a line makes the next one part of it
} mesh_text;

typedef enum number_state { NUMBER_OK, NUMBER_MISSING, NUMBER_BAD, NUMBER_NOT_FINITE } number_state;

mesh_text text_make(const char *path, const char *text, size_t size, report *r);
void text_skip_blanks(mesh_text *t);          // and a backslash at the end of a line that is joined
int text_line_ended(mesh_text *t);            // after blanks: 1 at the end of the line, at a comment or at the end of the file
int text_ended(const mesh_text *t);           // 1 at the end of the file
void text_next_line(mesh_text *t);            // past the rest of this line
void text_skip_empty_lines(mesh_text *t);     // to the next word of any line
size_t text_word(mesh_text *t, const char **out); // up to a blank, the line's end or `#`; 0 at the end of the line
size_t text_rest(mesh_text *t, const char **out); // the rest of the line without blanks around it, up to a comment
int text_word_ended(const mesh_text *t);     // 1 where no word goes on
int text_is_noise(const mesh_text *t);        // 1 where `at` stands on a byte that no text has

// The nearest double of the decimal number at `at`; `at` moves behind it only when it is one.
number_state text_number(mesh_text *t, double *out);
// A decimal integer: 1 and past it, or 0. Beyond 2^62 it stays there.
int text_integer(mesh_text *t, int64_t *out);
// Three coordinates, each within 1e9 m. `what` names the statement in the error.
result text_position(mesh_text *t, const char *what, double out[3]);
// NULL, or why a coordinate is refused.
const char *coordinate_fault(double metres);

#endif
