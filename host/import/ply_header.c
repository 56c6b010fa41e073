// The header of a .ply file: see mesh_ply.h.
// SPDX-License-Identifier: MIT
#include "mesh_ply.h"

#include <string.h>

static const int64_t COUNT_MOST = (int64_t)1 << 32; // more than a file of 4 GiB can hold

static int word_is(const char *word, size_t length, const char *text)
{
    return strlen(text) == length && memcmp(word, text, length) == 0;
}

static int type_of_word(const char *word, size_t length)
{
    static const char *const names[][2] = {{"char", "int8"}, {"uchar", "uint8"}, {"short", "int16"},   {"ushort", "uint16"},
                                           {"int", "int32"}, {"uint", "uint32"}, {"float", "float32"}, {"double", "float64"}};
    for (int type = PLY_INT8; type <= PLY_FLOAT64; ++type)
        if (word_is(word, length, names[type][0]) || word_is(word, length, names[type][1])) return type;
    return -1;
}

static result read_type(mesh_text *t, ply_type *out)
{
    const char *word;
    const size_t length = text_word(t, &word);
    const int type = type_of_word(word, length);
    if (length == 0 || type < 0)
        return report_error(t->report, t->path, t->line, "property: not a type; write char, uchar, short, ushort, int, uint, float or double");
    *out = (ply_type)type;
    return RESULT_OK;
}

static result read_format(mesh_text *t, ply_format *out)
{
    const char *word;
    const size_t length = text_word(t, &word);
    if (length && word_is(word, length, "ascii")) *out = PLY_ASCII;
    else if (length && word_is(word, length, "binary_little_endian")) *out = PLY_LITTLE_ENDIAN;
    else if (length && word_is(word, length, "binary_big_endian")) *out = PLY_BIG_ENDIAN;
    else return report_error(t->report, t->path, t->line, "format: not ascii, binary_little_endian or binary_big_endian; write one of them");
    return RESULT_OK;
}

static result read_element(mesh_text *t, ply_header *h)
{
    const char *word;
    const size_t length = text_word(t, &word);
    int64_t count = -1;
    text_skip_blanks(t);
    if (length == 0 || !text_integer(t, &count) || count < 0 || count >= COUNT_MOST)
        return report_error(t->report, t->path, t->line, "element: no count from 0 to 2^32; write: element NAME COUNT");
    ply_element *e = buffer_push(&h->elements, 1);
    if (!e) return report_no_memory(t->report, t->path);
    *e = (ply_element){.first_property = (uint32_t)h->properties.count, .count = (uint64_t)count};
    if (word_is(word, length, "vertex")) e->kind = PLY_VERTEX;
    if (word_is(word, length, "face")) e->kind = PLY_FACE;
    return RESULT_OK;
}

static ply_role role_of(const ply_element *e, const ply_property *p, const char *word, size_t length)
{
    if (e->kind == PLY_VERTEX && !p->is_list && length == 1 && *word >= 'x' && *word <= 'z') return (ply_role)(PLY_X + (*word - 'x'));
    if (e->kind == PLY_FACE && p->is_list && (word_is(word, length, "vertex_indices") || word_is(word, length, "vertex_index"))) return PLY_CORNERS;
    return PLY_SKIPPED;
}

static result read_property(mesh_text *t, ply_header *h)
{
    if (h->elements.count == 0) return report_error(t->report, t->path, t->line, "property before any element; put it behind one");
    ply_element *e = (ply_element *)h->elements.items + h->elements.count - 1;
    ply_property p = {.count_type = PLY_UINT8};
    mesh_text ahead = *t;
    const char *word;
    size_t length = text_word(&ahead, &word);
    if (length && word_is(word, length, "list")) {
        *t = ahead;
        p.is_list = 1;
        const result done = read_type(t, &p.count_type);
        if (done != RESULT_OK) return done;
        if (!ply_type_is_integer(p.count_type)) return report_error(t->report, t->path, t->line, "property list: its count is no integer type; use uchar");
    }
    const result done = read_type(t, &p.type);
    if (done != RESULT_OK) return done;
    length = text_word(t, &word);
    if (length == 0) return report_error(t->report, t->path, t->line, "property without a name; give it one");
    p.role = role_of(e, &p, word, length);
    if (p.role == PLY_CORNERS && !ply_type_is_integer(p.type))
        return report_error(t->report, t->path, t->line, "vertex_indices are no integers; use int");
    e->property_count++;
    return buffer_append(&h->properties, &p, 1) ? RESULT_OK : report_no_memory(t->report, t->path);
}

static result check_vertex(const mesh_text *t, const ply_header *h)
{
    const ply_element *elements = h->elements.items;
    const ply_property *properties = h->properties.items;
    for (size_t i = 0; i < h->elements.count; ++i) {
        uint32_t found[PLY_CORNERS + 1] = {0};
        for (uint32_t k = 0; k < elements[i].property_count; ++k) found[properties[elements[i].first_property + k].role]++;
        if (elements[i].kind == PLY_VERTEX && (found[PLY_X] != 1 || found[PLY_Y] != 1 || found[PLY_Z] != 1))
            return report_error(t->report, t->path, t->line, "the vertex element has not one x, one y and one z; add them");
        if (elements[i].kind == PLY_FACE && found[PLY_CORNERS] != 1)
            return report_error(t->report, t->path, t->line, "the face element has not one list vertex_indices; add it");
    }
    return RESULT_OK;
}

result ply_header_read(mesh_text *t, ply_header *h)
{
    const char *word;
    if (text_word(t, &word) != 3 || memcmp(word, "ply", 3) != 0) return report_error(t->report, t->path, 1, "does not begin with ply; is this a .ply file?");
    int has_format = 0;
    for (text_next_line(t); !text_ended(t); text_next_line(t)) {
        if (text_is_noise(t)) break;
        const size_t length = text_word(t, &word);
        result done = RESULT_OK;
        if (length == 0 || word_is(word, length, "comment") || word_is(word, length, "obj_info")) continue;
        if (word_is(word, length, "format")) done = read_format(t, &h->format);
        else if (word_is(word, length, "element")) done = read_element(t, h);
        else if (word_is(word, length, "property")) done = read_property(t, h);
        else if (word_is(word, length, "end_header")) {
            if (!has_format) return report_error(t->report, t->path, t->line, "no format line; add: format ascii 1.0");
            text_next_line(t);
            return check_vertex(t, h);
        } else return report_error(t->report, t->path, t->line, "not a word of a .ply header; write format, element, property, comment or end_header");
        has_format |= word_is(word, length, "format");
        if (done != RESULT_OK) return done;
    }
    return report_error(t->report, t->path, t->line, "the header has no end_header; is the file whole?");
}
