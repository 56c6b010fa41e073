// Import: chooses the reader by the file name's ending.
// SPDX-License-Identifier: MIT
#include "import.h"

#include "../core/file.h"

#include <string.h>

typedef enum format { FORMAT_MAP, FORMAT_OBJ, FORMAT_PLY, FORMAT_OFF, FORMAT_STL, FORMAT_BOXES, FORMAT_UNKNOWN } format;

static int ends_with(const char *path, const char *ending)
{
    const size_t length = strlen(path), ending_length = strlen(ending);
    if (length <= ending_length) return 0;
    for (size_t i = 0; i < ending_length; ++i) {
        const char c = path[length - ending_length + i];
        if ((c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c) != ending[i]) return 0;
    }
    return 1;
}

static format format_of(const char *path)
{
    static const char *const endings[] = {".map", ".obj", ".ply", ".off", ".stl", ".boxes"};
    for (int i = 0; i < FORMAT_UNKNOWN; ++i)
        if (ends_with(path, endings[i])) return (format)i;
    return FORMAT_UNKNOWN;
}

static result read_bytes(format f, const char *path, const char *text, size_t size, const import_options *options, const allocator *memory,
                         report *r, scene **out)
{
    if (size == 0) return report_error(r, path, 0, "the file is empty; name a scene");
    switch (f) {
    case FORMAT_MAP: return import_map(path, text, size, options, memory, r, out);
    case FORMAT_OBJ: return import_obj(path, text, size, memory, r, out);
    case FORMAT_PLY: return import_ply(path, text, size, memory, r, out);
    case FORMAT_OFF: return import_off(path, text, size, memory, r, out);
    case FORMAT_BOXES: return import_boxes(path, text, size, memory, r, out);
    case FORMAT_STL:
    case FORMAT_UNKNOWN: break;
    }
    return RESULT_BAD_INPUT;
}

result import_scene(const char *path, const import_options *options, const allocator *memory, report *r, scene **out)
{
    const format f = format_of(path);
    if (f == FORMAT_UNKNOWN) return report_error(r, path, 0, "unknown kind of scene; the name must end in .map, .obj, .ply, .off, .stl or .boxes");
    if (f == FORMAT_STL) return import_stl(path, memory, r, out);
    char *text;
    size_t size;
    result done = file_read(path, memory, r, &text, &size);
    if (done != RESULT_OK) return done;
    done = read_bytes(f, path, text, size, options, memory, r, out);
    memory_free(memory, text, size + 1, 1);
    return done;
}
