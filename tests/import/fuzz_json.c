// Fuzz target: any bytes as a JSON scene. What it includes stands in memory, one small file of each kind.
// SPDX-License-Identifier: MIT
#include "host/import/import.h"
#include "host/import/views.h"
#include "tests/fuzz_driver.h"

#include <stdlib.h>
#include <string.h>

#define HEAD "{\"portcullis\": 1, \"boxes\": [{\"min\": [0,0,0], \"max\": [4,3,5], \"side\": \"in\", \"omit\": [\"+x\"]}],\n"

const char *const fuzz_seeds[] = {
    HEAD "\"zones\": [{\"name\": \"o\"}, {\"name\": \"a\", \"box\": [[0,0,0],[4,3,5]], \"in\": \"o\", \"chain\": \"frustum[backface=1]\"}, {\"name\": \"b\", \"box\": [[4,0,0],[8,3,5]]}],\n"
         "\"portals\": [{\"zones\": [\"a\",\"b\"], \"points\": [[4,0,2],[4,0,3],[4,2,3],[4,2,2]], \"door\": \"d\"}], \"doors\": [{\"name\": \"d\", \"mover\": \"m\"}],\n"
         "\"movers\": [{\"name\": \"m\", \"box\": {\"min\": [4,0,2], \"max\": [4.1,2,3]}, \"open\": [0,0,1]}]}",
    HEAD "\"zones\": [{\"name\": \"h\", \"hulls\": [[[0,0,0],[4,0,0],[4,0,4],[0,0,4],[2,3,2]], [[0,5,0],[1,5,0],[0,5,1],[0,6,0]]]}], \"walls\": [{\"points\": [[0,0,0],[1,0,0],[1,1,0]]}]}",
    HEAD "\"movers\": [{\"name\": \"m\", \"file\": \"a.boxes\", \"at\": [1,2,3], \"turn\": [10,20,30], \"scale\": 2, \"pivot\": [0,0,0], \"loop\": true,"
         " \"path\": [{\"time\": 0}, {\"time\": 1.5, \"at\": [1,0,0], \"turn\": [0,90,0]}]}], \"lights\": [{\"kind\": \"sun\", \"direction\": [0,-1,0]}]}",
    "{\"portcullis\": 1, \"include\": [{\"file\": \"a.json\", \"name\": \"x\", \"at\": [9,0,0]}, {\"file\": \"a.json\", \"name\": \"y\"}, {\"file\": \"a.map\"}],\n"
    "\"meshes\": [{\"file\": \"a.obj\", \"repeat\": {\"count\": 3, \"step\": [1,0,0]}}], \"paths\": [{\"name\": \"w\", \"views\": [{\"eye\": [1,1,1], \"forward\": [1,0,0]}]}]}",
    NULL,
};
const char *const fuzz_files[] = {NULL};

static result read_kind(void *user, const char *path, const allocator *memory, report *r, char **out_text, size_t *out_size)
{
    static const char *const texts[][2] = {
        {".json", "{\"portcullis\": 1, \"boxes\": [{\"min\": [0,0,0], \"max\": [1,1,1]}], \"zones\": [{\"name\": \"r\", \"box\": [[0,0,0],[1,1,1]]}]}"},
        {".obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
        {".boxes", "boxes 1\n0 0 0 1 1 1\n"},
        {".views", "0 1.7 -120 0 0 1 0 1 0 60 1.5 0.1 10000\n"},
        {".map", "{\n{\n( 0 0 0 ) ( 0 1 0 ) ( 0 0 1 ) a 0 0 0 1 1\n( 64 0 0 ) ( 64 0 1 ) ( 64 1 0 ) b 0 0 0 1 1\n( 0 0 0 ) ( 0 0 1 ) ( 1 0 0 ) c 0 0 0 1 1\n"
                  "( 0 64 0 ) ( 1 64 0 ) ( 0 64 1 ) d 0 0 0 1 1\n( 0 0 0 ) ( 1 0 0 ) ( 0 1 0 ) e 0 0 0 1 1\n( 0 0 64 ) ( 0 1 64 ) ( 1 0 64 ) f 0 0 0 1 1\n}\n}\n"}};
    (void)user;
    for (size_t i = 0; i < sizeof texts / sizeof *texts; ++i) {
        const size_t length = strlen(path), ending = strlen(texts[i][0]), size = strlen(texts[i][1]);
        if (length < ending || strcmp(path + length - ending, texts[i][0]) != 0) continue;
        *out_text = memory_alloc(memory, size + 1, 1);
        if (!*out_text) return report_no_memory(r, path);
        memcpy(*out_text, texts[i][1], size + 1);
        *out_size = size;
        return RESULT_OK;
    }
    return report_error(r, path, 0, "cannot open it; name another");
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const allocator *memory = allocator_heap();
    const import_options options = {size % 2 ? DOORS_OPEN : DOORS_SHUT};
    const import_files files = {read_kind, NULL};
    report silent = {0};
    scene *s = NULL;
    if (import_json("fuzz.json", (const char *)data, size, &options, &files, memory, &silent, &s) != RESULT_OK) {
        if (s || silent.errors != 1) abort();
        return 0;
    }
    for (uint32_t m = 0; m < s->mover_count; ++m) {
        double min[3], max[3];
        scene_pose pose;
        scene_pose_at(s, m, (double)size, DOORS_SHUT, &pose);
        scene_pose_box(s, m, &pose, min, max);
        for (int k = 0; k < 3; ++k)
            if (!(min[k] <= max[k])) abort();
    }
    camera_path path;
    if (s->path_count && camera_path_load("path:", s, 1.5, memory, &silent, &path) != RESULT_OK) abort();
    if (s->path_count) camera_path_free(&path, memory);
    scene_free(s, memory);
    return 0;
}
