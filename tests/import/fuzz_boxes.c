// Fuzz target: any bytes as a .boxes file.
// SPDX-License-Identifier: MIT
#include "host/import/import.h"
#include "host/import/views.h"
#include "tests/fuzz_driver.h"

#include <stdlib.h>

const char *const fuzz_seeds[] = {
    "boxes 2\n0 0 0 1 1 1\n-2.5 0 3e1 -1 0 31.5\n",
    "boxes 3\r\n\r\n 1 2 3 4 5 6 \r\n1 1 1 1 2 2\n-1e3 -1 -1 1 1 1",
    NULL,
};
const char *const fuzz_files[] = {"boxes/city-1000.boxes", NULL};

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const allocator *memory = allocator_heap();
    report silent = {0};
    scene *s = NULL;
    if (import_boxes("fuzz.boxes", (const char *)data, size, memory, &silent, &s) != RESULT_OK) {
        if (s || silent.errors == 0) abort();
        return 0;
    }
    camera_path path;
    if (camera_path_load("auto:walk:8", s, 1.5, memory, &silent, &path) != RESULT_OK) abort();
    camera_path_free(&path, memory);
    scene_free(s, memory);
    return 0;
}
