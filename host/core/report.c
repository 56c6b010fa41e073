// Reports: see report.h.
// SPDX-License-Identifier: MIT
#include "report.h"

#include <stdarg.h>
#include <stdio.h>

enum { LINE_BYTES = 1024, FILE_BYTES = LINE_BYTES / 2, WARNINGS_SHOWN = 20 };

static void line_to_stderr(void *user, report_level level, const char *text)
{
    (void)user;
    (void)level;
    fprintf(stderr, "%s\n", text);
}

report report_to_stderr(void)
{
    return (report){.line = line_to_stderr};
}

static void say(const report *r, report_level level, const char *file, size_t line, const char *format, va_list values)
{
    static const char *const words[] = {"note: ", "warning: ", "error: "};
    if (!r->line) return;
    char text[LINE_BYTES];
    int used = 0;
    if (file && line) used = snprintf(text, sizeof text, "%.*s:%zu: %s", FILE_BYTES, file, line, words[level]);
    else if (file) used = snprintf(text, sizeof text, "%.*s: %s", FILE_BYTES, file, words[level]);
    else used = snprintf(text, sizeof text, "portcullis: %s", level == REPORT_NOTE ? "" : words[level]);
    if (used < 0 || used >= LINE_BYTES) used = 0;
    vsnprintf(text + used, sizeof text - (size_t)used, format, values);
    for (char *c = text; *c; ++c)
        if ((unsigned char)*c < 32 || *c == 127) *c = '?'; // names in untrusted files may hold anything
    r->line(r->user, level, text);
}

result report_error(report *r, const char *file, size_t line, const char *format, ...)
{
    va_list values;
    va_start(values, format);
    say(r, REPORT_ERROR, file, line, format, values);
    va_end(values);
    (void)__atomic_fetch_add(&r->errors, 1, __ATOMIC_RELAXED); // a count, it orders nothing
    return RESULT_BAD_INPUT;
}

void report_warning(report *r, const char *file, size_t line, const char *format, ...)
{
    if (__atomic_fetch_add(&r->warnings, 1, __ATOMIC_RELAXED) >= WARNINGS_SHOWN) return;
    va_list values;
    va_start(values, format);
    say(r, REPORT_WARNING, file, line, format, values);
    va_end(values);
}

void report_note(report *r, const char *format, ...)
{
    va_list values;
    va_start(values, format);
    say(r, REPORT_NOTE, NULL, 0, format, values);
    va_end(values);
}

result report_no_memory(report *r, const char *file)
{
    report_error(r, file, 0, "out of memory; use a smaller scene or a larger machine");
    return RESULT_NO_MEMORY;
}
