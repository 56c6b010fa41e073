// Reports: how bad data is told to a person, one line `file:line: error: what, and what to do`.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_REPORT_H
#define PORTCULLIS_HOST_REPORT_H

#include <stddef.h>
#include <stdint.h>

// What a call that can fail on data returns. Bugs assert instead.
typedef enum result {
    RESULT_OK = 0,
    RESULT_BAD_INPUT, // the file, argument or plugin is wrong; a line was reported
    RESULT_NO_MEMORY, // an allocation failed; nothing is left behind
    RESULT_NO_GL,     // no usable OpenGL context
} result;

typedef enum report_level { REPORT_NOTE, REPORT_WARNING, REPORT_ERROR } report_level;

// Where lines go. `line` NULL drops them; text has no newline. After 20 warnings of a file the rest are only counted.
// [any thread] Cullers log from several at once: `line` must bear that where several viewers run; the counters do.
typedef struct report {
    void (*line)(void *user, report_level level, const char *text);
    void *user;
    uint32_t warnings, errors;
} report;

report report_to_stderr(void);

// file NULL: no place. line 0: only the file. Always returns RESULT_BAD_INPUT.
#if defined(__GNUC__)
__attribute__((format(printf, 4, 5)))
#endif
result report_error(report *r, const char *file, size_t line, const char *format, ...);
#if defined(__GNUC__)
__attribute__((format(printf, 4, 5)))
#endif
void report_warning(report *r, const char *file, size_t line, const char *format, ...);
#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
void report_note(report *r, const char *format, ...);
result report_no_memory(report *r, const char *file); // one line; returns RESULT_NO_MEMORY

#endif
