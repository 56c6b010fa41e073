// Inputs for tests: see input_fixture.h.
// SPDX-License-Identifier: MIT
#include "input_fixture.h"

#include "host/compile/brush_shape.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void write_text(map_writer *w, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(w->text + w->size, MAP_BYTES - w->size, format, arguments);
    va_end(arguments);
    assert_true(length >= 0 && w->size + (size_t)length < MAP_BYTES);
    w->size += (size_t)length;
}

void open_entity(map_writer *w, const char *class_name)
{
    write_text(w, "{\n\"classname\" \"%s\"\n", class_name);
}

void close_entity(map_writer *w)
{
    write_text(w, "}\n");
}

void write_box(map_writer *w, const double min[3], const double max[3], const char *texture)
{
    write_text(w, "{\n");
    for (int axis = 0; axis < 3; ++axis)
        for (int high = 0; high < 2; ++high) {
            const int b = (axis + 1) % 3, c = (axis + 2) % 3;
            double p[3][3];
            for (int i = 0; i < 3; ++i) {
                p[i][axis] = high ? max[axis] : min[axis];
                p[i][b] = min[b] + (i == 1 + high);
                p[i][c] = min[c] + (i == 2 - high);
            }
            for (int i = 0; i < 3; ++i) write_text(w, "( %.15g %.15g %.15g ) ", p[i][0], p[i][1], p[i][2]);
            write_text(w, "%s 0 0 0 1 1\n", texture);
        }
    write_text(w, "}\n");
}

compile_input *input_of(const char *text, const input_options *o)
{
    report_lines lines;
    report_lines_init(&lines);
    compile_input *in = NULL;
    const result done = compile_input_map("t.map", text, strlen(text), o, allocator_heap(), &lines.report, &in);
    if (lines.count) fprintf(stderr, "%s\n", lines.lines[0]);
    assert_int_equal(done, RESULT_OK);
    assert_int_equal(lines.count, 0);
    return in;
}

void expect_input_error(const char *text, const char *line)
{
    report_lines lines;
    report_lines_init(&lines);
    compile_input *in = NULL;
    assert_int_equal(compile_input_map("t.map", text, strlen(text), NULL, allocator_heap(), &lines.report, &in), RESULT_BAD_INPUT);
    assert_null(in);
    assert_string_equal(report_lines_only(&lines), line);
}

const char *const real_map_names[REAL_MAPS] = {"quake/dm4.map",         "quake/e1m1.map",          "quake/e1m4.map",         "quake/e3m5.map",
                                               "librequake/lqdm12.map", "librequake/lq_e0m8.map", "librequake/lqdm7.map", "librequake/lq_e3m4.map"};

char *real_map(const char *name, size_t *out_size)
{
    const char *folder = getenv("PORTCULLIS_SCENES");
    char path[1024];
    snprintf(path, sizeof path, "%s/%s", folder ? folder : "", name);
    FILE *file = folder ? fopen(path, "rb") : NULL;
    if (!file) {
        fprintf(stderr, "SKIPPED: no %s\n", path);
        return NULL;
    }
    fseek(file, 0, SEEK_END);
    *out_size = (size_t)ftell(file);
    rewind(file);
    char *text = malloc(*out_size + 1);
    assert_non_null(text);
    assert_int_equal(fread(text, 1, *out_size, file), *out_size);
    text[*out_size] = 0;
    fclose(file);
    return text;
}

void assert_brushes_are_sound(const compile_input *in)
{
    plane_ref cube[6], planes[512];
    brush_shape shape = brush_shape_make(allocator_heap());
    assert_true(brush_shape_cube(in->planes, cube));
    for (uint32_t b = 0; b < in->brush_count; ++b) {
        const compile_brush *brush = &in->brushes[b];
        assert_true(brush->face_count >= 4 && brush->face_count <= 512);
        for (uint32_t f = 0; f < brush->face_count; ++f) planes[f] = in->faces[brush->first_face + f].plane;
        assert_int_equal(brush_shape_cut(&shape, in->planes, cube, planes, brush->face_count), SHAPE_SOUND);
        assert_int_equal(shape.faces.count, brush->face_count);
        const shape_corner *c = shape.corners.items;
        for (size_t i = 0; i < shape.corners.count; ++i) {
            for (uint32_t f = 0; f < brush->face_count; ++f) assert_true(plane_table_side(in->planes, c[i].planes, planes[f]) <= 0);
            for (int k = 0; k < 3; ++k) assert_true(c[i].position[k] > brush->min[k] - 1e-6 && c[i].position[k] < brush->max[k] + 1e-6);
        }
        const size_t edges = shape.corners.count / 2, corners = 2 + edges - shape.faces.count; // Euler
        assert_true(shape.corners.count % 2 == 0 && corners >= 4);
    }
    brush_shape_free(&shape);
}
