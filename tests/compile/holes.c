// Holes of a raw map, filled: see holes.h. The text is read line by line and written again with other texture names.
// SPDX-License-Identifier: MIT
#include "holes.h"

#include "host/core/file.h"
#include "host/import/import.h"
#include "host/import/map_entity.h"
#include "host/import/map_texture.h"

#include <string.h>

typedef struct hole_text {
    const char *at, *end;
    buffer out;
    int depth, is_structure; // of the entity that is open
} hole_text;

// The texture's name: behind the third closing bracket of the line.
static map_word texture_of(const char *line, const char *end)
{
    int brackets = 0;
    const char *at = line;
    for (; at < end && brackets < 3; ++at) brackets += *at == ')';
    while (at < end && *at == ' ') ++at;
    const char *from = at;
    while (at < end && *at != ' ' && *at != '\t') ++at;
    return (map_word){from, brackets == 3 ? (size_t)(at - from) : 0};
}

static int is_face(const char *line, const char *end)
{
    return line < end && *line == '(';
}

static int is_tool(const char *line, const char *end)
{
    const map_word texture = texture_of(line, end);
    return texture.length && texture_kind_of(texture) == TEXTURE_TOOL;
}

static const char *line_end(const char *at, const char *end)
{
    const char *found = memchr(at, '\n', (size_t)(end - at));
    return found ? found : end;
}

// Of the brush that begins at the line: 1 when a face of it shows something and none is a liquid's, which is open.
static int is_solid(const char *at, const char *end)
{
    int walls = 0;
    for (const char *stop; at < end && *at != '}'; at = stop < end ? stop + 1 : end) {
        stop = line_end(at, end);
        const texture_kind kind = is_face(at, stop) ? texture_kind_of(texture_of(at, stop)) : TEXTURE_TOOL;
        if (kind == TEXTURE_LIQUID) return 0;
        walls += kind != TEXTURE_TOOL;
    }
    return walls > 0;
}

static int write_face(hole_text *t, const char *line, const char *stop)
{
    const map_word texture = texture_of(line, stop);
    const char *rest = texture.text + texture.length;
    return buffer_append(&t->out, line, (size_t)(texture.text - line)) && buffer_append(&t->out, HOLE_MATERIAL, strlen(HOLE_MATERIAL)) &&
           buffer_append(&t->out, rest, (size_t)(stop - rest));
}

static void read_class(hole_text *t, const char *line, const char *stop)
{
    static const char key[] = "\"classname\" \"";
    const size_t length = sizeof key - 1;
    if ((size_t)(stop - line) <= length || memcmp(line, key, length) != 0) return;
    const char *from = line + length, *quote = memchr(from, '"', (size_t)(stop - from));
    if (quote) t->is_structure = entity_body_of((map_word){from, (size_t)(quote - from)}) == BODY_STRUCTURE;
}

static int write_all(hole_text *t)
{
    int fills = 0;
    for (const char *stop; t->at < t->end; t->at = stop < t->end ? stop + 1 : t->end) {
        stop = line_end(t->at, t->end);
        if (*t->at == '{' && ++t->depth == 2) fills = t->is_structure && is_solid(t->at, t->end);
        if (*t->at == '}') t->depth--;
        if (t->depth == 1) read_class(t, t->at, stop);
        const int is_hole = t->depth == 2 && fills && is_face(t->at, stop) && is_tool(t->at, stop);
        if (!(is_hole ? write_face(t, t->at, stop) : buffer_append(&t->out, t->at, (size_t)(stop - t->at)) != NULL)) return 0;
        if (!buffer_append(&t->out, "\n", 1)) return 0;
    }
    return buffer_append(&t->out, "", 1) != NULL;
}

result holes_import(const char *path, const allocator *memory, report *r, scene **out)
{
    const import_options import = {.doors = DOORS_OPEN};
    char *text;
    size_t size;
    result done = file_read(path, memory, r, &text, &size);
    if (done != RESULT_OK) return done;
    hole_text t = {.at = text, .end = text + size, .out = buffer_make(memory, 1)};
    done = write_all(&t) ? import_map(path, t.out.items, t.out.count - 1, &import, memory, r, out) : RESULT_NO_MEMORY;
    buffer_free(&t.out);
    memory_free(memory, text, size + 1, 1);
    return done;
}
