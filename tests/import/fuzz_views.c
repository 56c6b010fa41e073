// Fuzz target: any bytes as a .views file. What is read must be written and read again bit for bit.
// SPDX-License-Identifier: MIT
#include "host/import/views.h"
#include "tests/fuzz_driver.h"

#include <stdlib.h>
#include <string.h>

const char *const fuzz_seeds[] = {
    "0 1.7 -120 0 0 1 0 1 0 60 1.777778 0.1 10000\n# a comment\n\n1 2 3 .5 0 -1e-3 0 1 0 90 1 0.0625 inf\n",
    "1e-300 -0 123456789.123456789 1 0 0 0 1 0 60 1 .1 1e3 # behind\r\n",
    NULL,
};
const char *const fuzz_files[] = {"boxes/city.views", "boxes/city-aerial.views", NULL};

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const allocator *memory = allocator_heap();
    report silent = {0};
    camera_path first, again;
    if (camera_path_parse("fuzz.views", (const char *)data, size, memory, &silent, &first) != RESULT_OK) {
        if (silent.errors == 0) abort();
        return 0;
    }
    char *text;
    size_t text_size;
    if (camera_path_text(&first, memory, &text, &text_size) != RESULT_OK) abort();
    if (camera_path_parse("again.views", text, text_size, memory, &silent, &again) != RESULT_OK) abort();
    if (again.count != first.count || memcmp(again.cameras, first.cameras, first.count * sizeof *first.cameras) != 0) abort();
    memory_free(memory, text, text_size + 1, 1);
    camera_path_free(&first, memory);
    camera_path_free(&again, memory);
    return 0;
}
