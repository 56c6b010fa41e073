// Writes scene files, .pcs: any scene, whoever made it, and the indices that were baked for it.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_COMPILE_PCS_WRITE_H
#define PORTCULLIS_COMPILE_PCS_WRITE_H

#include "../core/scene.h"

typedef struct pcs_request {
    const scene *scene;      // its own `bakes` are not written
    const scene_bake *bakes; // bake_count, by zone, as baked_zones_make gives them
    uint32_t bake_count;
} pcs_request;

// [any thread] The file's bytes, the same for the same scene whatever compiled this; free with memory_free(memory, bytes,
// size, 1). `path` is for messages. Refuses a scene that reading would refuse.
result pcs_encode(const pcs_request *q, const char *path, const allocator *memory, report *r, void **out_bytes, size_t *out_size);
// All of it under that name, or nothing.
result pcs_write(const pcs_request *q, const char *path, const allocator *memory, report *r);

#endif
