// Fuzz target: any bytes as a .map file through the whole compiler into a .pcs file, which must open as the same scene, and
// whose surface must be closed by the compiler's own checks. Bytes that begin with 1 are boxes and wedges, so that mutations
// make solids rather than mistakes of syntax.
// SPDX-License-Identifier: MIT
#include "host/compile/compile.h"
#include "host/compile/pcs_write.h"
#include "host/import/pcs.h"
#include "tests/fuzz_driver.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SIX(x0, y0, z0, x1, y1, z1, texture)                                                                                              \
    "{\n( " x0 " 0 0 ) ( " x0 " 1 0 ) ( " x0 " 0 1 ) " texture " 0 0 0 1 1\n( " x1 " 0 0 ) ( " x1 " 0 1 ) ( " x1 " 1 0 ) " texture " 0 0 45 1 1\n" \
    "( 0 " y0 " 0 ) ( 0 " y0 " 1 ) ( 1 " y0 " 0 ) " texture " 0 0 0 1 1\n( 0 " y1 " 0 ) ( 1 " y1 " 0 ) ( 0 " y1 " 1 ) " texture " 0 0 0 1 1\n"      \
    "( 0 0 " z0 " ) ( 1 0 " z0 " ) ( 0 1 " z0 " ) " texture " 0 0 0 1 1\n( 0 0 " z1 " ) ( 0 1 " z1 " ) ( 1 0 " z1 " ) " texture " 0 0 0 1 1\n}\n"
#define PYRAMID                                                                                                                      \
    "{ ( 0 0 0 ) ( 64 0 0 ) ( 0 64 0 ) base 0 0 0 1 1 ( 0 0 0 ) ( 32 32 48.01 ) ( 64 0 0 ) a 0 0 0 1 1\n"                             \
    "( 64 0 0 ) ( 32 32 48 ) ( 64 64 0 ) a 0 0 0 1 1 ( 64 64 0 ) ( 32.004 32 47.996 ) ( 0 64 0 ) a 0 0 0 1 1\n"                       \
    "( 0 64 0 ) ( 32 32 48e0 ) ( 0 0 0 ) w [ 1 0 0 0 ] [ 0 -1 0 0 ] 0 1 1 }\n"
#define START "{ \"classname\" \"info_player_start\" \"origin\" \"16 32 32\" }\n"

const char *const fuzz_seeds[] = {
    // a hollow block, parted by a door; water, a block and a light in it
    "{\n\"classname\" \"worldspawn\"\n" SIX("-16", "-16", "-16", "144", "80", "80", "wall") "}\n{\n\"classname\" \"csg_subtract\"\n"
    SIX("0", "0", "0", "128", "64", "64", "wall") "}\n{\n\"classname\" \"func_group\"\n" SIX("60", "0", "0", "68", "24", "64", "frame")
    SIX("60", "40", "0", "68", "64", "64", "frame") SIX("90", "10", "0", "100", "20", "32", "block") SIX("0", "0", "0", "60", "64", "8", "*water")
    "}\n{\n\"classname\" \"func_door\"\n\"angle\" \"90\"\n" SIX("62", "24", "0", "66", "40", "64", "door") "}\n" START
    "{ \"classname\" \"light\" \"origin\" \"120 32 32\" }\n{ \"classname\" \"zone_info\" \"origin\" \"120 32 40\" \"zone\" \"b\" \"chain\" \"frustum\" }\n",
    "{\n\"classname\" \"worldspawn\"\n" PYRAMID SIX("10", "10", "5", "20", "80", "30", "c") SIX("10", "10", "30", "20", "80", "64", "sky") "}\n"
    "{\n\"classname\" \"func_train\"\n\"targetname\" \"x\"\n" SIX("0", "0", "0", "8", "8", "8", "c") "}\n" START,
    "{\n\"classname\" \"csg_subtract\"\n" PYRAMID "}\n{\n\"classname\" \"zone_portal\"\n" SIX("0", "0", "0", "4", "64", "64", "p") "}\n",
    // boxes; no byte is 0, for the driver takes a seed as a string
    "\1\6\20\20\20\17\17\17\10\1\1\1\1\16\16\16\10\6\7\1\1\10\16\5\10\2\7\1\5\10\16\16\10\6\3\3\1\5\5\4\17", // a hollow block, a door, a wedge
    "\1\6\20\20\20\17\17\17\10\1\1\1\1\16\16\16\10\3\7\1\1\10\16\16\10\4\1\1\1\16\16\4\10\6\2\2\1\4\4\11\32", // an authored portal, water, a wedge in it
    "\1\6\20\20\20\17\17\17\10\1\1\1\1\16\16\16\10\6\1\1\6\16\16\7\10\1\5\5\6\11\11\7\10\3\5\5\6\11\11\7\15\5\2\2\2\3\3\3\10", // a floor with a hole
    "\1\6\20\10\10\17\17\17\10\1\20\11\3\16\16\16\12\4\5\1\2\13\10\13\16\2\11\5\3\15\17\17\10\4\4\5\14\17\14\16\10", // water against the void
    NULL,
};
const char *const fuzz_files[] = {"quake/e1m1.map", "librequake/lqdm12.map", "librequake/lq_e3m4.map", NULL};

static void expect(int holds)
{
    if (!holds) abort();
}

// ---- Maps of boxes: of each a byte of kind, 6 of sides, one that slants a side ----

enum { BOX_BYTES = 8, BOXES_MOST = 40, MAP_BYTES = 40000 };

typedef struct map_text { char text[MAP_BYTES]; size_t size; } map_text;

static void side(map_text *m, const int p[3], const int q[3], const int r[3], const char *texture)
{
    m->size += (size_t)snprintf(m->text + m->size, sizeof m->text - m->size, "( %d %d %d ) ( %d %d %d ) ( %d %d %d ) %s 0 0 0 1 1\n", p[0], p[1], p[2], q[0],
                                q[1], q[2], r[0], r[1], r[2], texture);
}

static void box(map_text *m, const uint8_t *b, const char *texture)
{
    static const int order[6][3] = {{0, 2, 4}, {1, 5, 3}, {0, 4, 1}, {2, 3, 6}, {0, 1, 2}, {4, 6, 5}}; // corners: bit k set, the far side along axis k
    int corner[8][3];
    for (int c = 0; c < 8; ++c)
        for (int k = 0; k < 3; ++k) {
            const int low = 8 * (b[k] % 16), high = 8 * (b[3 + k] % 16);
            const int least = low < high ? low : high, most = low < high ? high : low;
            corner[c][k] = c >> k & 1 ? (most > least ? most : least + 8) : least;
        }
    for (int f = 0; f < 6; ++f) {
        int points[3][3];
        for (int i = 0; i < 3; ++i) memcpy(points[i], corner[order[f][i]], sizeof points[i]);
        if (b[6] % 8 == f + 1) points[2][f / 2] += f % 2 ? -(b[6] / 8) : b[6] / 8; // a corner inward: a slanted side
        side(m, points[0], points[1], points[2], texture);
    }
}

static void write_map(const uint8_t *data, size_t size, map_text *m)
{
    static const char *const classes[] = {"worldspawn", "csg_subtract", "func_door", "zone_portal", "func_group", "func_wall"};
    static const char *const places[] = {"16 16 16", "64 64 64", "100 20 100"};
    m->size = 0;
    for (size_t i = 0; i < size / BOX_BYTES && i < BOXES_MOST; ++i) {
        const uint8_t *b = data + i * BOX_BYTES;
        m->size += (size_t)snprintf(m->text + m->size, sizeof m->text - m->size, "{\n\"classname\" \"%s\"\n{\n", classes[b[0] % 6]);
        box(m, b + 1, b[0] % 6 == 4 ? "*water" : b[0] & 64 ? "sky" : "wall");
        m->size += (size_t)snprintf(m->text + m->size, sizeof m->text - m->size, "}\n}\n");
    }
    for (int i = 0; i < 3; ++i)
        m->size += (size_t)snprintf(m->text + m->size, sizeof m->text - m->size, "{\n\"classname\" \"light\"\n\"origin\" \"%s\"\n}\n", places[i]);
}

// ---- The compiler ----

typedef struct run {
    report report;
    compile_input *in;
    compile_mesh *mesh;
    compiled_zones *zones;
    scene *scene;
} run;

static result compile(run *c, const char *text, size_t size)
{
    static const double grids[3] = {256, 1, 65536};
    static const portal_choice choices[3] = {PORTALS_DOORS, PORTALS_AUTHORED, PORTALS_NONE};
    const input_options options = {grids[size % 3], 0};
    const allocator *memory = allocator_heap();
    csg_counts counts;
    compile_checks checks;
    result done = compile_input_map("fuzz.map", text, size, &options, memory, &c->report, &c->in);
    if (done == RESULT_OK) done = compile_csg(c->in, &c->report, memory, &c->mesh, &counts);
    if (done == RESULT_OK) done = compile_zones(c->in, c->mesh, choices[size / 3 % 3], &c->report, memory, &c->zones);
    if (done == RESULT_OK) done = compile_items(c->in, c->zones, &c->report, memory, &c->scene, &checks);
    if (done == RESULT_OK) expect(!checks.t_junctions_left && !checks.open_edges && !checks.degenerate_triangles);
    return done;
}

static void goes_round(const scene *s)
{
    const allocator *memory = allocator_heap();
    report silent = {0};
    void *file = NULL, *again = NULL;
    size_t size = 0, again_size = 0;
    scene *back = NULL;
    expect(pcs_encode(&(pcs_request){.scene = s}, "fuzz.pcs", memory, &silent, &file, &size) == RESULT_OK);
    expect(pcs_open("fuzz.pcs", file, size, memory, &silent, &back) == RESULT_OK);
    expect(pcs_encode(&(pcs_request){.scene = back}, "fuzz.pcs", memory, &silent, &again, &again_size) == RESULT_OK);
    expect(size == again_size && memcmp(file, again, size) == 0);
    memory_free(memory, again, again_size, 1);
    scene_free(back, memory);
    memory_free(memory, file, size, 1);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static map_text boxes; // too large for a stack
    run c = {0};
    const int is_boxes = size > 0 && data[0] == 1;
    if (is_boxes) write_map(data + 1, size - 1, &boxes);
    const result done = is_boxes ? compile(&c, boxes.text, boxes.size) : compile(&c, (const char *)data, size);
    expect((done == RESULT_OK) == (c.report.errors == 0));
    if (done == RESULT_OK) goes_round(c.scene);
    scene_free(c.scene, allocator_heap());
    compiled_zones_free(c.zones); // holds the mesh
    compile_input_free(c.in);
    return 0;
}
