// What every reader of a scene file is given: its text, and the builder that it adds to. Readers open and finish nothing.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_IMPORT_READER_H
#define PORTCULLIS_IMPORT_READER_H

#include "import.h"

typedef struct reader_job {
    const char *path, *text; // text[size] is 0; path is for messages and names
    size_t size;
    const import_options *options;
    const import_files *files; // where what it includes comes from; NULL: the disk
    const allocator *memory;
    report *report;
    scene_builder *builder; // what is added goes through the builder's transform
} reader_job;

typedef result (*reader)(const reader_job *j); // reports what it says no to

result map_into(const reader_job *j);
result boxes_into(const reader_job *j);
result obj_into(const reader_job *j);
result ply_into(const reader_job *j);
result off_into(const reader_job *j);
result stl_into(const reader_job *j);
result json_into(const reader_job *j);

reader reader_of_file(const char *path); // by the name's ending, any letter case; NULL: of no kind that is known
#define READER_ENDINGS ".json, .map, .obj, .ply, .off, .stl or .boxes"

// Opens a builder, reads into it, finishes it.
result reader_make_scene(reader read, const reader_job *without_builder, scene **out);
// The same from the files' own bytes: reads, refuses an empty one. Free as file_read says.
result reader_text(const import_files *files, const char *path, const allocator *memory, report *r, char **out_text, size_t *out_size);

#endif
