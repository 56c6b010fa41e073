// Says of each JSON scene named by an argument, a line each, whether the reader takes it, or of one with brushes the
// compiler's: "yes", or the error.
// SPDX-License-Identifier: MIT
#include "host/compile/compile.h"
#include "host/import/import.h"

#include <stdio.h>
#include <string.h>

static void keep_error(void *user, report_level level, const char *text)
{
    if (level == REPORT_ERROR) snprintf(user, 1024, "%s", text);
}

int main(int argc, char **argv)
{
    const import_options as_the_file_says = {DOORS_OPEN};
    for (int i = 1; i < argc; ++i) {
        char line[1024] = "yes";
        report r = {.line = keep_error, .user = line};
        scene *s = NULL;
        compile_input *in = NULL;
        if (import_scene(argv[i], &as_the_file_says, allocator_heap(), &r, &s) == RESULT_OK) scene_free(s, allocator_heap());
        if (strstr(line, "to be compiled first")) {
            strcpy(line, "yes");
            if (compile_input_open(argv[i], NULL, allocator_heap(), &r, &in) == RESULT_OK) compile_input_free(in);
        }
        puts(line);
    }
    return 0;
}
