// Reader of .stl: checked here, because OpenMesh takes any bytes for numbers; ascii is made binary; then OpenMesh reads it.
// SPDX-License-Identifier: MIT
#include "../mesh/mesh.h"
#include "mesh_soup.h"
#include "mesh_text.h"

#include <string.h>

enum { STL_TITLE_BYTES = 80, STL_HEAD_BYTES = 84, STL_TRIANGLE_BYTES = 50, STL_NORMAL_BYTES = 12 };

static uint32_t little32(const char *bytes)
{
    const unsigned char *b = (const unsigned char *)bytes;
    return (uint32_t)b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

// The size that a binary file of this count has, 0 where the bytes don't reach that far: then it is text. Text never reaches
// it, four printable bytes being a count of over 7 GB.
static size_t binary_size(const char *bytes, size_t size)
{
    if (size < STL_HEAD_BYTES) return 0;
    const uint32_t count = little32(bytes + STL_TITLE_BYTES);
    const uint64_t needed = STL_HEAD_BYTES + (uint64_t)STL_TRIANGLE_BYTES * count;
    return needed == size || (count > 0 && needed < size) ? (size_t)needed : 0;
}

static result check_binary(const char *path, const char *bytes, size_t size, report *r)
{
    for (size_t at = STL_HEAD_BYTES; at < size; at += STL_TRIANGLE_BYTES)
        for (size_t k = 0; k < 9; ++k) {
            const size_t place = at + STL_NORMAL_BYTES + 4 * k;
            const uint32_t bits = little32(bytes + place);
            float value;
            memcpy(&value, &bits, sizeof value);
            const char *fault = coordinate_fault((double)value);
            if (fault) return report_error(r, path, 0, "at byte %zu: %s", place, fault);
        }
    return RESULT_OK;
}

static int word_is(const char *word, size_t length, const char *lower_case) // letter case is ignored
{
    if (length != strlen(lower_case)) return 0;
    for (size_t i = 0; i < length; ++i)
        if ((word[i] >= 'A' && word[i] <= 'Z' ? word[i] - 'A' + 'a' : word[i]) != lower_case[i]) return 0;
    return 1;
}

static void put_little32(char *bytes, uint32_t value)
{
    for (int k = 0; k < 4; ++k) bytes[k] = (char)(unsigned char)(value >> (8 * k));
}

// The three vertex lines behind "outer loop", appended as a binary triangle without a normal.
static result read_loop(mesh_text *t, buffer *binary)
{
    const char *word;
    double p[3];
    char triangle[STL_TRIANGLE_BYTES] = {0};
    for (int i = 0; i < 9; ++i) {
        if (i % 3 == 0) {
            text_next_line(t);
            const size_t length = text_word(t, &word);
            if (length == 0 || !word_is(word, length, "vertex"))
                return report_error(t->report, t->path, t->line, "not the vertex that an outer loop goes on with; is the file whole?");
            const result done = text_position(t, "vertex", p);
            if (done != RESULT_OK) return done;
            if (!text_line_ended(t)) return report_error(t->report, t->path, t->line, "vertex: more than 3 coordinates; write x y z");
        }
        const float value = (float)p[i % 3];
        uint32_t bits;
        memcpy(&bits, &value, sizeof bits);
        put_little32(triangle + STL_NORMAL_BYTES + 4 * i, bits);
    }
    return buffer_append(binary, triangle, STL_TRIANGLE_BYTES) ? RESULT_OK : report_no_memory(t->report, t->path);
}

static result read_ascii(mesh_text t, buffer *binary)
{
    static const char head[STL_HEAD_BYTES] = {0};
    const char *word = NULL;
    size_t length = text_word(&t, &word);
    if (length == 0 || !word_is(word, length, "solid")) return report_error(t.report, t.path, 1, "neither begins with solid nor has the size of a binary .stl; is the file whole?");
    if (!buffer_append(binary, head, STL_HEAD_BYTES)) return report_no_memory(t.report, t.path);
    for (text_next_line(&t); !text_ended(&t); text_next_line(&t)) {
        length = text_word(&t, &word);
        if (text_is_noise(&t)) return report_error(t.report, t.path, t.line, "a byte that no text has; is this an .stl file?");
        if (length == 0 || !word_is(word, length, "outer")) continue;
        const result done = read_loop(&t, binary);
        if (done != RESULT_OK) return done;
    }
    put_little32((char *)binary->items + STL_TITLE_BYTES, (uint32_t)((binary->count - STL_HEAD_BYTES) / STL_TRIANGLE_BYTES));
    return RESULT_OK;
}

static result fill_soup(mesh_soup *soup, const char *path, const double *triangles, uint32_t count)
{
    const soup_name fallback = {"default", 7};
    const soup_object object = {soup_file_stem(path), 0};
    if (!buffer_append(&soup->materials, &fallback, 1) || !buffer_append(&soup->objects, &object, 1)) return RESULT_NO_MEMORY;
    if (!buffer_append(&soup->positions, triangles, 3 * (size_t)count)) return RESULT_NO_MEMORY;
    for (uint32_t i = 0; i < count; ++i) {
        const soup_corner corners[3] = {{3 * i, SOUP_NO_TEXCOORD}, {3 * i + 1, SOUP_NO_TEXCOORD}, {3 * i + 2, SOUP_NO_TEXCOORD}};
        if (!buffer_append(&soup->corners, corners, 3) || soup_polygon_end(soup, 3 * (size_t)i, 0) != RESULT_OK) return RESULT_NO_MEMORY;
    }
    return RESULT_OK;
}

static result read_soup(mesh_soup *soup, const char *path, const char *bytes, size_t size, const allocator *memory, report *r)
{
    double *triangles;
    uint32_t count = 0;
    buffer binary = buffer_make(memory, 1);
    arena scratch = arena_make(memory);
    const size_t binary_bytes = binary_size(bytes, size);
    const int was_binary = binary_bytes > 0;
    if (was_binary && binary_bytes < size)
        report_warning(r, path, 0, "%zu bytes behind the last triangle that it counts are left out", size - binary_bytes);
    result done = was_binary ? check_binary(path, bytes, binary_bytes, r) : read_ascii(text_make(path, bytes, size, r), &binary);
    if (done == RESULT_OK && was_binary) done = mesh_read_stl(path, bytes, binary_bytes, &scratch, r, &triangles, &count);
    if (done == RESULT_OK && !was_binary) done = mesh_read_stl(path, binary.items, binary.count, &scratch, r, &triangles, &count);
    if (done == RESULT_OK && count == 0) done = report_error(r, path, 0, "no facets with area; is it an .stl file?");
    if (done == RESULT_OK && fill_soup(soup, path, triangles, count) != RESULT_OK) done = report_no_memory(r, path);
    arena_free(&scratch);
    buffer_free(&binary);
    return done;
}

result stl_into(const reader_job *j)
{
    mesh_soup soup = soup_make(j->memory);
    result done = read_soup(&soup, j->path, j->text, j->size, j->memory, j->report);
    if (done == RESULT_OK) done = mesh_scene_into(&soup, j);
    soup_free(&soup);
    return done;
}
