// Fuzz target: any bytes as a JSON scene of brushes into the scene compiler's input; what is read must be closed brushes on the grid.
// SPDX-License-Identifier: MIT
#include "host/compile/brush_shape.h"
#include "host/compile/compile.h"
#include "host/import/import.h"
#include "tests/fuzz_driver.h"

#include <stdlib.h>

const char *const fuzz_seeds[] = {
    "{\"portcullis\": 1, \"brushes\": [{\"box\": {\"min\": [-1,-1,-1], \"max\": [9,4,5]}, \"material\": \"rock\", \"texture\": {\"scale\": 2, \"offset\": [0,1]}},\n"
    "{\"operation\": \"subtract\", \"cylinder\": {\"base\": [1,0,1], \"top\": [1,2,1], \"radius\": 0.5, \"segments\": 5}, \"turn\": [10,20,30]},\n"
    "{\"cone\": {\"base\": [0,0,0], \"apex\": [0.1,2,0.3], \"radius\": 0.003}, \"at\": [1,2,3], \"scale\": 2}],\n"
    "\"zone_info\": [{\"name\": \"a\", \"at\": [1,1,1], \"chain\": \"frustum\"}], \"starts\": [{\"at\": [2,2,2]}]}",
    "{\"portcullis\": 1, \"brushes\": [{\"plane\": {\"point\": [0,0,0], \"normal\": [0.1,1,0.3]}}, {\"convex\": {\"points\": [[0,0,0],[1,0,0],[0,1,0],[0,0,1]]}},\n"
    "{\"convex\": {\"planes\": [{\"point\": [0,0,0], \"normal\": [-1,0,0]}, {\"point\": [0,0,0], \"normal\": [0,-2,0]},\n"
    "{\"point\": [5,0,0], \"normal\": [0,0,-0.5]}, {\"points\": [[1,0,0],[0,1,0],[0,0,1]]}]}},\n"
    "{\"operation\": \"portal\", \"name\": \"p\", \"door\": \"d\", \"box\": {\"min\": [0,0,0], \"max\": [1,1,0.1]}}], \"doors\": [{\"name\": \"d\"}]}",
    NULL,
};
const char *const fuzz_files[] = {NULL};

static void expect(int holds)
{
    if (!holds) abort();
}

static result no_file(void *user, const char *path, const allocator *memory, report *r, char **out_text, size_t *out_size)
{
    (void)user, (void)memory, (void)out_text, (void)out_size;
    return report_error(r, path, 0, "cannot open it: there are no files here; check the name");
}

static void check_brushes(const compile_input *in)
{
    plane_ref cube[6];
    expect(brush_shape_cube(in->planes, cube));
    brush_shape shape = brush_shape_make(allocator_heap());
    for (uint32_t b = 0; b < in->brush_count; ++b) {
        const compile_brush *brush = &in->brushes[b];
        plane_ref *planes = malloc(brush->face_count * sizeof *planes);
        expect(planes && brush->face_count >= 4 && brush->entity < in->entity_count);
        const compile_entity *entity = &in->entities[brush->entity];
        expect(b >= entity->first_brush && b < entity->first_brush + entity->brush_count);
        for (uint32_t f = 0; f < brush->face_count; ++f) planes[f] = in->faces[brush->first_face + f].plane;
        expect(brush_shape_cut(&shape, in->planes, cube, planes, brush->face_count) == SHAPE_SOUND && shape.faces.count == brush->face_count);
        for (int k = 0; k < 3; ++k) expect(brush->min[k] < brush->max[k] && brush->min[k] >= -CULL_GRID_MOST && brush->max[k] <= CULL_GRID_MOST);
        free(planes);
    }
    brush_shape_free(&shape);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const double grids[3] = {256, 1, 65536};
    const input_options options = {grids[size % 3], 0};
    const import_files files = {no_file, NULL};
    report silent = {0};
    compile_input *in = NULL;
    char *text = malloc(size + 1); // closed by a zero, as from a file
    expect(text != NULL);
    for (size_t i = 0; i < size; ++i) text[i] = (char)data[i];
    text[size] = 0;
    if (compile_input_json("fuzz.json", text, size, &options, &files, allocator_heap(), &silent, &in) != RESULT_OK) expect(!in && silent.errors == 1);
    if (in) check_brushes(in);
    compile_input_free(in);
    free(text);
    return 0;
}
