// Import: chooses the reader by the file name's ending, and makes a scene of what it reads.
// SPDX-License-Identifier: MIT
#include "pcs.h"
#include "reader.h"

#include "../core/file.h"

#include <string.h>

typedef struct format { const char *ending; reader read; } format;

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

reader reader_of_file(const char *path)
{
    static const format formats[] = {{".json", json_into}, {".map", map_into}, {".obj", obj_into},     {".ply", ply_into},
                                     {".off", off_into},   {".stl", stl_into}, {".boxes", boxes_into}};
    for (size_t i = 0; i < sizeof formats / sizeof *formats; ++i)
        if (ends_with(path, formats[i].ending)) return formats[i].read;
    return NULL;
}

result reader_text(const import_files *files, const char *path, const allocator *memory, report *r, char **out_text, size_t *out_size)
{
    char *text;
    size_t size;
    const result done = files ? files->read(files->user, path, memory, r, &text, &size) : file_read(path, memory, r, &text, &size);
    if (done != RESULT_OK) return done;
    if (size == 0) {
        memory_free(memory, text, 1, 1);
        return report_error(r, path, 0, "the file is empty; name a scene");
    }
    *out_text = text;
    *out_size = size;
    return RESULT_OK;
}

result reader_make_scene(reader read, const reader_job *without_builder, scene **out)
{
    reader_job j = *without_builder;
    if (scene_builder_open(j.memory, &j.builder) != RESULT_OK) return report_no_memory(j.report, j.path);
    result done = read(&j);
    if (done == RESULT_OK) done = scene_builder_finish(j.builder, j.path, j.report, out);
    scene_builder_close(j.builder);
    return done;
}

result import_scene(const char *path, const import_options *options, const allocator *memory, report *r, scene **out)
{
    if (ends_with(path, ".pcs")) return pcs_load(path, memory, r, out); // its doors stay as they were compiled: a world moves them
    const reader read = reader_of_file(path);
    if (!read) return report_error(r, path, 0, "unknown kind of scene; the name must end in .pcs, " READER_ENDINGS);
    char *text = NULL;
    size_t size = 0;
    result done = reader_text(NULL, path, memory, r, &text, &size);
    if (done != RESULT_OK) return done;
    done = reader_make_scene(read, &(reader_job){.path = path, .text = text, .size = size, .options = options, .memory = memory, .report = r}, out);
    memory_free(memory, text, size + 1, 1);
    return done;
}

// ---- From bytes ----

static const import_options as_the_file_says = {DOORS_OPEN};

result import_json(const char *path, const char *text, size_t size, const import_options *options, const import_files *files,
                   const allocator *memory, report *r, scene **out)
{
    const reader_job j = {.path = path, .text = text, .size = size, .options = options, .files = files, .memory = memory, .report = r};
    return reader_make_scene(json_into, &j, out);
}

result import_map(const char *path, const char *text, size_t size, const import_options *options, const allocator *memory, report *r, scene **out)
{
    const reader_job j = {.path = path, .text = text, .size = size, .options = options, .memory = memory, .report = r};
    return reader_make_scene(map_into, &j, out);
}

static result make_plain(reader read, const char *path, const char *text, size_t size, const allocator *memory, report *r, scene **out)
{
    const reader_job j = {.path = path, .text = text, .size = size, .options = &as_the_file_says, .memory = memory, .report = r};
    return reader_make_scene(read, &j, out);
}

result import_boxes(const char *path, const char *text, size_t size, const allocator *memory, report *r, scene **out)
{
    return make_plain(boxes_into, path, text, size, memory, r, out);
}

result import_obj(const char *path, const char *text, size_t size, const allocator *memory, report *r, scene **out)
{
    return make_plain(obj_into, path, text, size, memory, r, out);
}

result import_ply(const char *path, const char *text, size_t size, const allocator *memory, report *r, scene **out)
{
    return make_plain(ply_into, path, text, size, memory, r, out);
}

result import_off(const char *path, const char *text, size_t size, const allocator *memory, report *r, scene **out)
{
    return make_plain(off_into, path, text, size, memory, r, out);
}

result import_stl(const char *path, const allocator *memory, report *r, scene **out)
{
    char *text;
    size_t size;
    result done = file_read(path, memory, r, &text, &size);
    if (done != RESULT_OK) return done;
    done = make_plain(stl_into, path, text, size, memory, r, out);
    memory_free(memory, text, size + 1, 1);
    return done;
}
