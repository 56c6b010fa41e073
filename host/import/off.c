// Reader of .off and its kin (COFF, NOFF, STOFF, ...): positions and faces, the rest of each line is skipped.
// SPDX-License-Identifier: MIT
#include "mesh_soup.h"
#include "mesh_text.h"

#include <string.h>

typedef struct off_reader {
    mesh_text text;
    mesh_soup *soup;
    int64_t vertices, faces;
} off_reader;

static result fault(const off_reader *o, const char *what)
{
    return report_error(o->text.report, o->text.path, o->text.line, "%s", what);
}

static result out_of_memory(off_reader *o)
{
    return report_no_memory(o->text.report, o->text.path);
}

// [ST][C][N]OFF. With 4 or n the space has another number of dimensions.
static result read_keyword(off_reader *o)
{
    const char *word = NULL;
    text_skip_empty_lines(&o->text);
    if (text_is_noise(&o->text)) return fault(o, "a byte that no text has; is this an ascii .off file?");
    size_t length = text_word(&o->text, &word);
    if (length >= 2 && memcmp(word, "ST", 2) == 0) word += 2, length -= 2;
    if (length >= 1 && *word == 'C') word++, length--;
    if (length >= 1 && *word == 'N') word++, length--;
    if (length >= 4 && (*word == '4' || *word == 'n')) return fault(o, "a mesh of other than 3 dimensions; write it as OFF");
    if (length != 3 || memcmp(word, "OFF", 3) != 0) return fault(o, "does not begin with OFF; is this an .off file?");
    mesh_text ahead = o->text;
    if (text_word(&ahead, &word) == 6 && memcmp(word, "BINARY", 6) == 0) return fault(o, "a binary .off; write it as ascii");
    return RESULT_OK;
}

static int read_count(off_reader *o, int64_t *out)
{
    text_skip_blanks(&o->text);
    return text_integer(&o->text, out) && text_word_ended(&o->text) && *out >= 0;
}

// "VERTICES FACES EDGES" stands behind the keyword or on the next line; the edges don't matter.
static result read_counts(off_reader *o)
{
    text_skip_empty_lines(&o->text);
    if (!read_count(o, &o->vertices) || !read_count(o, &o->faces)) return fault(o, "no counts; write: VERTICES FACES 0");
    if (o->faces == 0) return fault(o, "no faces; is it a point cloud?");
    const int64_t bytes = o->text.end - o->text.at; // a vertex takes at least 6 bytes, a face of three corners 8
    if (o->vertices > bytes / 5 || o->faces > bytes / 7) return fault(o, "counts that a file of this size cannot hold; correct them, or is it cut short?");
    text_next_line(&o->text);
    return RESULT_OK;
}

static result read_corner(off_reader *o)
{
    int64_t index;
    if (text_line_ended(&o->text)) return fault(o, "a face has fewer corners than it says; correct it");
    if (!text_integer(&o->text, &index) || !text_word_ended(&o->text)) return fault(o, "a vertex index is not an integer; correct it");
    if (index < 0 || index >= o->vertices) return fault(o, "a vertex index is out of range; count from 0 up to the number of vertices less 1");
    const soup_corner corner = {(uint32_t)index, SOUP_NO_TEXCOORD};
    return buffer_append(&o->soup->corners, &corner, 1) ? RESULT_OK : out_of_memory(o);
}

static result read_face(off_reader *o)
{
    int64_t count;
    const size_t first = o->soup->corners.count;
    if (!read_count(o, &count)) return fault(o, "a face begins with its number of corners; write it");
    if (count < 3) return fault(o, "a face of fewer than 3 corners; drop it");
    if (count > POLYGON_CORNERS_MOST) return fault(o, "a face of over 65535 corners; split it into smaller ones");
    for (int64_t i = 0; i < count; ++i) {
        const result done = read_corner(o);
        if (done != RESULT_OK) return done;
    }
    const result done = soup_polygon_end(o->soup, first, 0);
    if (done == RESULT_NO_MEMORY) return out_of_memory(o);
    return done == RESULT_OK ? done : fault(o, "over 2^32 corners or faces; split the file");
}

static result read_lines(off_reader *o)
{
    for (int64_t i = 0; i < o->vertices + o->faces; ++i) {
        text_skip_empty_lines(&o->text);
        if (text_ended(&o->text)) return fault(o, "the file ends before its last face; is it whole?");
        double p[3];
        const result done = i < o->vertices ? text_position(&o->text, "vertex", p) : read_face(o);
        if (done != RESULT_OK) return done;
        if (i < o->vertices && !buffer_append(&o->soup->positions, p, 1)) return out_of_memory(o);
        text_next_line(&o->text);
    }
    return RESULT_OK;
}

static result read_all(off_reader *o)
{
    const soup_name fallback = {"default", 7};
    const soup_object object = {soup_file_stem(o->text.path), 0};
    if (!buffer_append(&o->soup->materials, &fallback, 1) || !buffer_append(&o->soup->objects, &object, 1)) return out_of_memory(o);
    result done = read_keyword(o);
    if (done == RESULT_OK) done = read_counts(o);
    return done == RESULT_OK ? read_lines(o) : done;
}

result off_into(const reader_job *j)
{
    mesh_soup soup = soup_make(j->memory);
    off_reader o = {.text = text_make(j->path, j->text, j->size, j->report), .soup = &soup};
    result done = read_all(&o);
    if (done == RESULT_OK) done = mesh_scene_into(&soup, j);
    soup_free(&soup);
    return done;
}
