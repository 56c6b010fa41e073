// Reader of Stanford .ply: ascii and binary of both byte orders, positions of any numeric type, faces of any size.
// SPDX-License-Identifier: MIT
// Invariant: each value read is one that the header tells of and takes at least a byte, so the file's size bounds the work.
#include "mesh_ply.h"
#include "mesh_soup.h"

#include <string.h>

typedef struct ply_reader {
    mesh_text text; // binary: `at` only
    const char *first;
    ply_header header;
    mesh_soup *soup;
    soup_largest largest;
    uint64_t vertices;
} ply_reader;

// Ascii files are told by line, binary ones by byte.
static result fault(const ply_reader *p, const char *what)
{
    const mesh_text *t = &p->text;
    if (p->header.format == PLY_ASCII) return report_error(t->report, t->path, t->line, "%s", what);
    return report_error(t->report, t->path, 0, "at byte %zu: %s", (size_t)(t->at - p->first), what);
}

static result out_of_memory(ply_reader *p)
{
    return report_no_memory(p->text.report, p->text.path);
}

static result read_ascii(ply_reader *p, double *out)
{
    text_skip_empty_lines(&p->text);
    const number_state state = text_number(&p->text, out);
    if (state == NUMBER_OK) return RESULT_OK;
    if (state == NUMBER_MISSING) return fault(p, "the file ends before its last element; is it whole?");
    return fault(p, state == NUMBER_BAD ? "not a number; correct it" : "not a finite number; correct it");
}

static uint64_t read_bits(const unsigned char *bytes, size_t size, ply_format format)
{
    uint64_t bits = 0;
    for (size_t i = 0; i < size; ++i) bits = bits << 8 | bytes[format == PLY_BIG_ENDIAN ? i : size - 1 - i];
    return bits;
}

static double value_of_bits(uint64_t bits, ply_type type)
{
    float single;
    double value;
    const uint32_t low = (uint32_t)bits;
    switch (type) {
    case PLY_INT8: return bits < 0x80 ? (double)bits : (double)bits - 0x100;
    case PLY_INT16: return bits < 0x8000 ? (double)bits : (double)bits - 0x10000;
    case PLY_INT32: return bits < 0x80000000u ? (double)bits : (double)bits - 4294967296.0;
    case PLY_FLOAT32: memcpy(&single, &low, sizeof single); return (double)single;
    case PLY_FLOAT64: memcpy(&value, &bits, sizeof value); return value;
    default: return (double)bits;
    }
}

static result read_value(ply_reader *p, ply_type type, double *out)
{
    static const size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
    if (p->header.format == PLY_ASCII) return read_ascii(p, out);
    if ((size_t)(p->text.end - p->text.at) < sizes[type]) return fault(p, "the file ends before its last element; is it whole?");
    *out = value_of_bits(read_bits((const unsigned char *)p->text.at, sizes[type], p->header.format), type);
    p->text.at += sizes[type];
    return RESULT_OK;
}

static result read_corners(ply_reader *p, const ply_property *property, double count)
{
    if (count < 3) return fault(p, "a face of fewer than 3 corners; drop it");
    if (count > POLYGON_CORNERS_MOST) return fault(p, "a face of over 65535 corners; split it into smaller ones");
    const size_t first = p->soup->corners.count;
    for (uint32_t i = 0; i < (uint32_t)count; ++i) {
        double index;
        const result done = read_value(p, property->type, &index);
        if (done != RESULT_OK) return done;
        if (!(index >= 0 && index < (double)p->vertices) || (double)(uint32_t)index != index)
            return fault(p, "a vertex index is out of range; count from 0 up to the vertex element's count less 1");
        const soup_corner corner = {(uint32_t)index, SOUP_NO_TEXCOORD};
        if (!buffer_append(&p->soup->corners, &corner, 1)) return out_of_memory(p);
    }
    const result done = soup_polygon_end(p->soup, first, 0);
    if (done == RESULT_NO_MEMORY) return out_of_memory(p);
    return done == RESULT_OK ? done : fault(p, "over 2^32 corners or faces; split the file");
}

static result read_list(ply_reader *p, const ply_property *property)
{
    double count, skipped;
    result done = read_value(p, property->count_type, &count);
    if (done != RESULT_OK) return done;
    if (!(count >= 0 && count <= UINT32_MAX) || (double)(uint32_t)count != count) return fault(p, "a list's length is no integer from 0 to 2^32 - 1; correct it");
    if (property->role == PLY_CORNERS) return read_corners(p, property, count);
    for (uint32_t i = 0; i < (uint32_t)count && done == RESULT_OK; ++i) done = read_value(p, property->type, &skipped);
    return done;
}

static result read_record(ply_reader *p, const ply_element *e)
{
    const ply_property *properties = (const ply_property *)p->header.properties.items + e->first_property;
    double position[3] = {0, 0, 0};
    for (uint32_t k = 0; k < e->property_count; ++k) {
        double value;
        const result done = properties[k].is_list ? read_list(p, &properties[k]) : read_value(p, properties[k].type, &value);
        if (done != RESULT_OK) return done;
        if (properties[k].role < PLY_X || properties[k].role > PLY_Z) continue;
        if (coordinate_fault(value)) return fault(p, coordinate_fault(value));
        position[properties[k].role - PLY_X] = value;
    }
    if (e->kind == PLY_VERTEX && !buffer_append(&p->soup->positions, position, 1)) return out_of_memory(p);
    return RESULT_OK;
}

static result read_elements(ply_reader *p)
{
    const ply_element *elements = p->header.elements.items;
    for (size_t i = 0; i < p->header.elements.count; ++i)
        if (elements[i].kind == PLY_VERTEX) p->vertices += elements[i].count;
    if (p->vertices > UINT32_MAX) return fault(p, "over 2^32 vertices; split the file");
    for (size_t i = 0; i < p->header.elements.count; ++i) {
        if (elements[i].property_count == 0) continue; // nothing is written of it
        for (uint64_t k = 0; k < elements[i].count; ++k) {
            const result done = read_record(p, &elements[i]);
            if (done != RESULT_OK) return done;
        }
    }
    if (p->soup->polygons.count == 0) return fault(p, "no faces up to the end of the file; is it a point cloud?");
    return RESULT_OK;
}

static result read_all(ply_reader *p)
{
    const soup_name fallback = {"default", 7};
    const soup_object object = {soup_file_stem(p->text.path), 0};
    if (!buffer_append(&p->soup->materials, &fallback, 1) || !buffer_append(&p->soup->objects, &object, 1)) return out_of_memory(p);
    const result done = ply_header_read(&p->text, &p->header);
    return done == RESULT_OK ? read_elements(p) : done;
}

result ply_into(const reader_job *j)
{
    mesh_soup soup = soup_make(j->memory);
    ply_reader p = {.text = text_make(j->path, j->text, j->size, j->report), .first = j->text, .soup = &soup};
    p.header.elements = buffer_make(j->memory, sizeof(ply_element));
    p.header.properties = buffer_make(j->memory, sizeof(ply_property));
    result done = read_all(&p);
    if (done == RESULT_OK) done = mesh_scene_into(&soup, j);
    buffer_free(&p.header.elements);
    buffer_free(&p.header.properties);
    soup_free(&soup);
    return done;
}
