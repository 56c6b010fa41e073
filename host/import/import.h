// Import: any scene file into a scene. By the name's ending: .map .obj .ply .off .stl .boxes.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_IMPORT_H
#define PORTCULLIS_HOST_IMPORT_H

#include "../core/scene.h"

typedef struct import_options {
    door_state doors;
} import_options;

// Reports `file:line: error: ...` and leaves *out untouched on failure.
result import_scene(const char *path, const import_options *options, const allocator *memory, report *r, scene **out);

// The readers behind it, from bytes (text[size] is 0): what the fuzz targets call. `path` is for messages only.
result import_map(const char *path, const char *text, size_t size, const import_options *options, const allocator *memory, report *r, scene **out);
result import_boxes(const char *path, const char *text, size_t size, const allocator *memory, report *r, scene **out);
result import_obj(const char *path, const char *text, size_t size, const allocator *memory, report *r, scene **out);
result import_ply(const char *path, const char *text, size_t size, const allocator *memory, report *r, scene **out);
result import_off(const char *path, const char *text, size_t size, const allocator *memory, report *r, scene **out);
result import_stl(const char *path, const allocator *memory, report *r, scene **out); // OpenMesh's reader

#endif
