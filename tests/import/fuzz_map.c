// Fuzz target: any bytes as a .map file. Also walks through what was imported.
// SPDX-License-Identifier: MIT
#include "host/import/import.h"
#include "host/import/views.h"
#include "tests/fuzz_driver.h"

#include <stdlib.h>

#define CUBE                                                                                                                          \
    "{\n( 0 0 0 ) ( 0 1 0 ) ( 0 0 1 ) a 0 0 0 1 1\n( 64 0 0 ) ( 64 0 1 ) ( 64 1 0 ) b 0 0 45 1 1\n( 0 0 0 ) ( 0 0 1 ) ( 1 0 0 ) {c 0 0 0 1 1\n" \
    "( 0 64 0 ) ( 1 64 0 ) ( 0 64 1 ) *d 0 0 0 1 1\n( 0 0 0 ) ( 1 0 0 ) ( 0 1 0 ) sky 0 0 0 1 1 7 8 9\n( 0 0 64 ) ( 0 1 64 ) ( 1 0 64 ) clip 0 0 0 0 0\n}\n"

const char *const fuzz_seeds[] = {
    "// seed\n{\n\"classname\" \"worldspawn\"\n" CUBE "}\n{ \"classname\" \"info_player_start\" \"origin\" \"128 0 32\" }\n",
    "{\n\"classname\" \"func_door\"\n\"angle\" \"-1\" \"lip\" \"4\"\n" CUBE CUBE "}\n",
    "{ \"classname\" \"worldspawn\" { ( 0 0 0 ) ( 0 1 0 ) ( 0 0 1 ) w [ 0 1 0 0 ] [ 0 0 -1 0 ] 0 1 1\n"
    "( 0 0 0 ) ( 0 0 1 ) ( 1 0 0 ) w [ 1 0 0 0 ] [ 0 0 -1 0 ] 0 1 1\n( 0 0 0 ) ( 1 0 0 ) ( 0 1 0 ) w [ 1 0 0 0 ] [ 0 -1 0 0 ] 0 1 1\n"
    "( 99.5 0 0 ) ( 0 0 77.25 ) ( 0 88.125 0 ) w [ 1 0 0 0 ] [ 0 -1 0 0 ] 0 1 1 } }\n",
    "{ { brushDef { ( 0 0 0 ) } } }",
    NULL,
};
const char *const fuzz_files[] = {"quake/e1m1.map", "librequake/lqdm12.map", "librequake/lq_e3m4.map", NULL};

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const allocator *memory = allocator_heap();
    const import_options options = {size % 2 ? DOORS_OPEN : DOORS_SHUT};
    report silent = {0};
    scene *s = NULL;
    if (import_map("fuzz.map", (const char *)data, size, &options, memory, &silent, &s) != RESULT_OK) {
        if (s || silent.errors == 0) abort();
        return 0;
    }
    camera_path path;
    const char *const what = size % 3 ? "auto:3" : "auto:walk:12";
    if (camera_path_load(what, s, 1.5, memory, &silent, &path) != RESULT_OK) abort();
    camera_path_free(&path, memory);
    scene_free(s, memory);
    return 0;
}
