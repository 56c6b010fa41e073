// See json_fixture.h.
// SPDX-License-Identifier: MIT
#include "json_fixture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

compile_input *brushes_of(const char *text, const memory_file *files)
{
    report_lines lines;
    report_lines_init(&lines);
    compile_input *in = NULL;
    const import_files from = memory_files(files);
    const result done = compile_input_json("t.json", text, strlen(text), NULL, &from, allocator_heap(), &lines.report, &in);
    if (lines.count) fail_msg("%s", lines.lines[0]);
    assert_int_equal(done, RESULT_OK);
    return in;
}

compile_input *brush_of(const char *entry)
{
    char text[4096];
    assert_true(snprintf(text, sizeof text, HEAD "\"brushes\": [%s]}", entry) < (int)sizeof text);
    compile_input *in = brushes_of(text, NULL);
    assert_int_equal(in->brush_count, 1);
    return in;
}

void expect_brushes_error(const char *text, const memory_file *files, const char *line)
{
    report_lines lines;
    report_lines_init(&lines);
    compile_input *in = NULL;
    const import_files from = memory_files(files);
    assert_int_equal(compile_input_json("t.json", text, strlen(text), NULL, &from, allocator_heap(), &lines.report, &in), RESULT_BAD_INPUT);
    assert_null(in);
    assert_string_equal(report_lines_only(&lines), line);
}

void expect_brush_error(const char *entry, const char *line)
{
    char text[4096];
    assert_true(snprintf(text, sizeof text, HEAD "\"brushes\": [%s]}", entry) < (int)sizeof text);
    expect_brushes_error(text, NULL, line);
}

compiled compiled_of(compile_input *in)
{
    const allocator *heap = allocator_heap();
    report r = report_to_stderr();
    compiled c = {.in = in};
    compile_mesh *mesh = NULL;
    csg_counts counts;
    assert_int_equal(compile_csg(in, &r, heap, &mesh, &counts), RESULT_OK);
    assert_int_equal(compile_zones(in, mesh, PORTALS_DOORS, &r, heap, &c.zones), RESULT_OK);
    assert_int_equal(compile_items(in, c.zones, &r, heap, &c.scene, &c.checks), RESULT_OK);
    assert_int_equal(c.checks.t_junctions_left, 0);
    assert_int_equal(c.checks.open_edges, 0);
    assert_int_equal(c.checks.degenerate_triangles, 0);
    return c;
}

void compiled_free(compiled *c)
{
    scene_free(c->scene, allocator_heap());
    compiled_zones_free(c->zones);
    compile_input_free(c->in);
}

corner_list corners_of(const compile_input *in, uint32_t brush)
{
    const compile_brush *b = &in->brushes[brush];
    brush_shape shape = brush_shape_make(allocator_heap());
    plane_ref cube[6], planes[512];
    assert_true(b->face_count <= 512 && brush_shape_cube(in->planes, cube));
    for (uint32_t f = 0; f < b->face_count; ++f) planes[f] = in->faces[b->first_face + f].plane;
    assert_int_equal(brush_shape_cut(&shape, in->planes, cube, planes, b->face_count), SHAPE_SOUND);
    assert_int_equal(shape.faces.count, b->face_count);
    corner_list list = {malloc((shape.corners.count + 1) * sizeof *list.at), 0};
    assert_non_null(list.at);
    const shape_corner *corners = shape.corners.items;
    for (size_t i = 0; i < shape.corners.count; ++i) {
        size_t same = 0;
        for (; same < list.count; ++same) {
            double apart = 0;
            for (int k = 0; k < 3; ++k) apart = fmax(apart, fabs(list.at[same][k] * STEPS - corners[i].position[k]));
            if (apart < 1e-3) break; // steps: corners of three faces each are a step apart or the same
        }
        if (same < list.count) continue;
        for (int k = 0; k < 3; ++k) list.at[list.count][k] = corners[i].position[k] / STEPS;
        list.count++;
    }
    brush_shape_free(&shape);
    return list;
}

static double farthest(const double (*from)[3], size_t from_count, const double (*to)[3], size_t to_count)
{
    double most = 0;
    for (size_t i = 0; i < from_count; ++i) {
        double least = INFINITY;
        for (size_t j = 0; j < to_count; ++j) {
            double sum = 0;
            for (int k = 0; k < 3; ++k) sum += (from[i][k] - to[j][k]) * (from[i][k] - to[j][k]);
            least = fmin(least, sqrt(sum));
        }
        most = fmax(most, least);
    }
    return most * STEPS;
}

double corners_apart(const corner_list *from, const double (*to)[3], size_t count)
{
    const double(*at)[3] = (const double(*)[3])from->at;
    return fmax(farthest(at, from->count, to, count), farthest(to, count, at, from->count));
}
