// Import: any scene file into a scene. By the name's ending: .pcs .json .map .obj .ply .off .stl .boxes.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_IMPORT_H
#define PORTCULLIS_HOST_IMPORT_H

#include "../core/scene.h"

typedef struct import_options {
    door_state doors; // DOORS_OPEN: as the file says, a .map's all open; DOORS_SHUT: all shut. A .pcs keeps its own
} import_options;

// Where the files come from that a JSON scene names. `read` is as file_read.
typedef struct import_files {
    result (*read)(void *user, const char *path, const allocator *memory, report *r, char **out_text, size_t *out_size);
    void *user;
} import_files;

// Reports `file:line: error: ...` and leaves *out untouched on failure.
result import_scene(const char *path, const import_options *options, const allocator *memory, report *r, scene **out);

// The readers behind it, from bytes (text[size] is 0): what the fuzz targets call. `path` is for messages only, and for
// what a JSON scene names from its own folder on. files NULL: the disk.
result import_json(const char *path, const char *text, size_t size, const import_options *options, const import_files *files,
                   const allocator *memory, report *r, scene **out);
result import_map(const char *path, const char *text, size_t size, const import_options *options, const allocator *memory, report *r, scene **out);
result import_boxes(const char *path, const char *text, size_t size, const allocator *memory, report *r, scene **out);
result import_obj(const char *path, const char *text, size_t size, const allocator *memory, report *r, scene **out);
result import_ply(const char *path, const char *text, size_t size, const allocator *memory, report *r, scene **out);
result import_off(const char *path, const char *text, size_t size, const allocator *memory, report *r, scene **out);
result import_stl(const char *path, const allocator *memory, report *r, scene **out); // OpenMesh's reader

#endif
