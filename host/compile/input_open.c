// The compiler's input from a file, by the ending of its name.
// SPDX-License-Identifier: MIT
#include "compile.h"

#include "../core/file.h"
#include "../import/import.h"

#include <string.h>

typedef enum input_format { INPUT_MAP, INPUT_JSON, INPUT_OTHER } input_format;

static int ending_is(const char *ending, const char *lower_case)
{
    for (; *ending && *lower_case; ++ending, ++lower_case)
        if ((*ending >= 'A' && *ending <= 'Z' ? *ending - 'A' + 'a' : *ending) != *lower_case) return 0;
    return *ending == *lower_case;
}

static input_format format_of(const char *path)
{
    const char *dot = strrchr(path, '.');
    if (dot && ending_is(dot, ".map")) return INPUT_MAP;
    return dot && ending_is(dot, ".json") ? INPUT_JSON : INPUT_OTHER;
}

result compile_input_open(const char *path, const input_options *o, const allocator *memory, report *r, compile_input **out)
{
    char *text = NULL;
    size_t size = 0;
    const input_format format = format_of(path);
    if (format == INPUT_OTHER) return report_error(r, path, 0, "compile takes a .map or a .json of brushes; other scenes need no compiling");
    result done = file_read(path, memory, r, &text, &size);
    if (done != RESULT_OK) return done;
    if (format == INPUT_MAP) done = compile_input_map(path, text, size, o, memory, r, out);
    else done = compile_input_json(path, text, size, o, NULL, memory, r, out);
    memory_free(memory, text, size + 1, 1);
    return done;
}
