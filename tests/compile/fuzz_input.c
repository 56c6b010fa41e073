// Fuzz target: any bytes as a .map file into the scene compiler's input; what is read must be closed brushes on the grid.
// SPDX-License-Identifier: MIT
#include "host/compile/brush_shape.h"
#include "host/compile/compile.h"
#include "tests/fuzz_driver.h"

#include <stdlib.h>

#define CUBE                                                                                                                          \
    "{\n( 0 0 0 ) ( 0 1 0 ) ( 0 0 1 ) a 0 0 0 1 1\n( 64 0 0 ) ( 64 0 1 ) ( 64 1 0 ) b 0 0 45 1 1\n( 0 0 0 ) ( 0 0 1 ) ( 1 0 0 ) {c 0 0 0 1 1\n" \
    "( 0 64 0 ) ( 1 64 0 ) ( 0 64 1 ) *d 0 0 0 1 1\n( 0 0 0 ) ( 1 0 0 ) ( 0 1 0 ) sky 0 0 0 1 1 7 8 9\n( 0 0 64 ) ( 0 1 64 ) ( 1 0 64 ) clip 0 0 0 0 0\n}\n"

const char *const fuzz_seeds[] = {
    "// seed\n{\n\"classname\" \"worldspawn\"\n" CUBE "}\n{ \"classname\" \"info_player_start\" \"origin\" \"128 0 32\" }\n",
    "{\n\"classname\" \"csg_subtract\"\n\"targetname\" \"x\"\n" CUBE CUBE "}\n",
    "{ \"classname\" \"worldspawn\" { ( 0 0 0 ) ( 64 0 0 ) ( 0 64 0 ) base 0 0 0 1 1 ( 0 0 0 ) ( 32 32 48.01 ) ( 64 0 0 ) a 0 0 0 1 1\n"
    "( 64 0 0 ) ( 32 32 48 ) ( 64 64 0 ) a 0 0 0 1 1 ( 64 64 0 ) ( 32.004 32 47.996 ) ( 0 64 0 ) a 0 0 0 1 1\n"
    "( 0 64 0 ) ( 32 32 48e0 ) ( 0 0 0 ) w [ 1 0 0 0 ] [ 0 -1 0 0 ] 0 1 1 } }\n",
    NULL,
};
const char *const fuzz_files[] = {"quake/e1m1.map", "librequake/lqdm12.map", "librequake/lq_e3m4.map", NULL};

static void expect(int holds)
{
    if (!holds) abort();
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
    report silent = {0};
    compile_input *in = NULL;
    if (compile_input_map("fuzz.map", (const char *)data, size, &options, allocator_heap(), &silent, &in) != RESULT_OK) {
        expect(!in && silent.errors == 1);
        return 0;
    }
    expect(in->max_move <= 1.0 / 32);
    check_brushes(in);
    compile_input_free(in);
    return 0;
}
