// Many copies of a map, apart, have as many zones, portals and brushes as one copy, each times their number.
// SPDX-License-Identifier: MIT
#include "input_fixture.h"
#include "map_tile.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct counts { uint32_t brushes, entities, polygons, zones, reached, portals, shells, leak, weld_moves; } counts;

static counts counts_of(const char *text, size_t size, portal_choice choice)
{
    report_lines lines;
    report_lines_init(&lines);
    compile_input *in = NULL;
    compile_mesh *mesh = NULL;
    compiled_zones *z = NULL;
    csg_counts csg;
    assert_int_equal(compile_input_map("t.map", text, size, NULL, allocator_heap(), &lines.report, &in), RESULT_OK);
    assert_int_equal(compile_csg(in, &lines.report, allocator_heap(), &mesh, &csg), RESULT_OK);
    assert_int_equal(compile_zones(in, mesh, choice, &lines.report, allocator_heap(), &z), RESULT_OK);
    const counts c = {.brushes = in->brush_count,
                      .entities = in->entity_count,
                      .polygons = csg.polygons_in,
                      .zones = z->zone_count,
                      .reached = z->zone_count - z->zones_sealed,
                      .portals = z->portal_count,
                      .shells = z->shells,
                      .leak = z->leak,
                      .weld_moves = in->weld_moves};
    compiled_zones_free(z);
    compile_input_free(in);
    return c;
}

static void expect_times(const char *name, const char *text, size_t size, unsigned side, portal_choice choice)
{
    char *tiled;
    size_t tiled_size;
    assert_int_equal(map_tile(text, size, side, &tiled, &tiled_size), TILE_SOUND);
    const counts one = counts_of(text, size, choice), all = counts_of(tiled, tiled_size, choice);
    const uint32_t n = side * side;
    print_message("%s: %u copies of %u brushes, %u zones, %u reached, %u portals\n", name, n, one.brushes, one.zones, one.reached, one.portals);
    free(tiled);
    assert_int_equal(one.leak, 0);
    assert_int_equal(all.leak, 0);
    assert_int_equal(all.brushes, n * one.brushes);
    assert_int_equal(all.entities, n * (one.entities - 1) + 1);
    assert_int_equal(all.polygons, n * one.polygons);
    assert_int_equal(all.zones, n * one.zones);
    assert_int_equal(all.reached, n * one.reached);
    assert_int_equal(all.portals, n * one.portals);
    assert_int_equal(all.shells, n * one.shells);
    assert_int_equal(all.weld_moves, n * one.weld_moves);
}

// ---- A map of its own ----

static void box(map_writer *w, double x, double y, double z, double dx, double dy, double dz)
{
    write_box(w, (double[3]){x, y, z}, (double[3]){x + dx, y + dy, z + dz}, "stone");
}

static void point(map_writer *w, const char *class_name, double x, double y, double z)
{
    open_entity(w, class_name);
    write_text(w, "\"origin\" \"%g %g %g\"\n\"targetname\" \"here\"\n", x, y, z);
    close_entity(w);
}

// Two rooms of 256 with a doorway 64 wide and a door in it, a block in one; a sealed hollow beside them. Off whole units by `off`.
static void write_rooms(map_writer *w, double off)
{
    open_entity(w, "worldspawn");
    box(w, off, 0, 0, 544, 288, 16);
    box(w, off, 0, 272, 544, 288, 16);
    box(w, off, 0, 16, 16, 288, 256);
    box(w, off + 528, 0, 16, 16, 288, 256);
    box(w, off + 16, 0, 16, 512, 16, 256);
    box(w, off + 16, 272, 16, 512, 16, 256);
    box(w, off + 264, 16, 16, 16, 96, 256);
    box(w, off + 264, 176, 16, 16, 96, 256);
    box(w, off + 264, 112, 144, 16, 64, 128);
    box(w, off + 64, 64, 16, 32, 32, 32);
    for (int high = 0; high < 2; ++high) {
        box(w, off + 600, 0, 48.0 * high, 64, 64, 16);
        box(w, off + 600, 48.0 * high, 16, 64, 16, 32);
        box(w, off + 600 + 48.0 * high, 16, 16, 16, 32, 32);
    }
    close_entity(w);
    open_entity(w, "func_door");
    box(w, off + 268, 112, 16, 8, 64, 128);
    close_entity(w);
    point(w, "info_player_start", off + 160, 144, 64);
    point(w, "light", off + 400, 144, 64);
}

static void rooms_tiled_have_each_zone_and_portal_as_often(void **state)
{
    (void)state;
    static const double offs[] = {0, -1000, 0.125, -300.37109375};
    for (int i = 0; i < 4; ++i) {
        static map_writer w;
        w.size = 0;
        write_rooms(&w, offs[i]);
        expect_times("rooms", w.text, w.size, 1, PORTALS_DOORS);
        expect_times("rooms", w.text, w.size, 4, PORTALS_DOORS);
        expect_times("rooms", w.text, w.size, 3, PORTALS_NONE);
        const counts c = counts_of(w.text, w.size, PORTALS_DOORS);
        assert_int_equal(c.zones, 3);
        assert_int_equal(c.reached, 2);
        assert_int_equal(c.portals, 1);
    }
}

static void copies_keep_their_decimals_and_their_targets_apart(void **state)
{
    (void)state;
    static const char map[] = "{ \"classname\" \"worldspawn\"\n{\n( -0.25 0 0 ) ( 1 0.5000000001 0 ) ( 0 1 7.125 ) a{b 0 0 0 1 1\n}\n}\n"
                              "{ // a comment with a } in it\n\"target\" \"x\" \"origin\" \"1 -2.5 3\" }\n";
    static const char expected[] = "{\n\"classname\" \"worldspawn\"\n\n{ \n(  -160.25 -160 0) (  -159 -159.4999999999 0) (  -160 -159 7.125) a{b 0 0 0 1 1 \n} "
                                   "\n{ \n(  159.75 -160 0) (  161 -159.4999999999 0) (  160 -159 7.125) a{b 0 0 0 1 1 \n} "
                                   "\n{ \n(  -160.25 160 0) (  -159 160.5000000001 0) (  -160 161 7.125) a{b 0 0 0 1 1 \n} "
                                   "\n{ \n(  159.75 160 0) (  161 160.5000000001 0) (  160 161 7.125) a{b 0 0 0 1 1 \n} \n}\n"
                                   "{\n\"target\" \"x_0\"\n\"origin\" \" -159 -162.5 3\"\n\n}\n{\n\"target\" \"x_1\"\n\"origin\" \" 161 -162.5 3\"\n\n}\n"
                                   "{\n\"target\" \"x_2\"\n\"origin\" \" -159 157.5 3\"\n\n}\n{\n\"target\" \"x_3\"\n\"origin\" \" 161 157.5 3\"\n\n}\n";
    char *out;
    size_t size;
    assert_int_equal(map_tile(map, strlen(map), 2, &out, &size), TILE_SOUND);
    assert_int_equal(size, strlen(expected));
    assert_memory_equal(out, expected, size);
    free(out);
}

static void what_is_no_map_or_too_wide_is_not_tiled(void **state)
{
    (void)state;
    static const char wide[] = "{ { ( -9000 0 0 ) ( 9000 1 0 ) ( 0 1 1 ) a 0 0 0 1 1 } }", cut[] = "{ { ( 0 0 0 ) ( 1 1 0 ) ( 0 1";
    char *out;
    size_t size;
    assert_int_equal(map_tile(wide, strlen(wide), 8, &out, &size), TILE_TOO_WIDE);
    assert_int_equal(map_tile(cut, strlen(cut), 2, &out, &size), TILE_NO_MAP);
    assert_int_equal(map_tile("", 0, 2, &out, &size), TILE_NO_MAP);
}

static void a_real_map_tiled_has_each_zone_and_portal_as_often(void **state)
{
    (void)state;
    const char *long_tier = getenv("PORTCULLIS_LONG");
    const int is_long = long_tier && *long_tier && *long_tier != '0';
    const char *name = is_long ? "librequake/lq_e3m4.map" : "quake/dm4.map";
    size_t size;
    char *text = real_map(name, &size);
    if (!text) skip();
    expect_times(name, text, size, is_long ? 4 : 2, PORTALS_DOORS);
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rooms_tiled_have_each_zone_and_portal_as_often),
        cmocka_unit_test(copies_keep_their_decimals_and_their_targets_apart),
        cmocka_unit_test(what_is_no_map_or_too_wide_is_not_tiled),
        cmocka_unit_test(a_real_map_tiled_has_each_zone_and_portal_as_often),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
