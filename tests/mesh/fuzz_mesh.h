// What the mesh fuzz targets check of any bytes: a refusal says why and leaves nothing, a scene is sound.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_MESH_FUZZ_MESH_H
#define PORTCULLIS_TESTS_MESH_FUZZ_MESH_H

#include "host/import/import.h"
#include "tests/fuzz_driver.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef result mesh_reader(const char *path, const char *text, size_t size, const allocator *memory, report *r, scene **out);

static inline void fuzz_check(int holds)
{
    if (!holds) abort();
}

static inline void fuzz_check_scene(const scene *s)
{
    uint32_t index = 0;
    fuzz_check(s->item_count > 0 && s->index_count % 3 == 0);
    for (uint32_t i = 0; i < s->item_count; ++i) {
        fuzz_check(s->items[i].first_index == index && s->items[i].object < s->object_count && s->items[i].material < s->material_count);
        fuzz_check(s->items[i].index_count / 3 <= 128 || s->items[i].polygon_count == 1);
        index += s->items[i].index_count;
    }
    fuzz_check(index == s->index_count);
    for (uint32_t i = 0; i < index; ++i) fuzz_check(s->indices[i] < s->position_count);
    for (uint32_t v = 0; v < s->position_count; ++v)
        fuzz_check(isfinite(s->positions[v].x) && isfinite(s->positions[v].y) && isfinite(s->positions[v].z));
}

static inline int fuzz_mesh(mesh_reader *reader, const uint8_t *data, size_t size)
{
    report silent = {0};
    scene *s = NULL;
    char *text = malloc(size + 1); // readers are promised a zero behind the text
    if (!text) abort();
    if (size) memcpy(text, data, size);
    text[size] = 0;
    const result done = reader("fuzz.mesh", text, size, allocator_heap(), &silent, &s);
    free(text);
    if (done == RESULT_OK) fuzz_check_scene(s);
    else fuzz_check(!s && silent.errors == 1);
    scene_free(s, allocator_heap());
    return 0;
}

#endif
