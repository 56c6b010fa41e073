// The compiler's input from maps: grid, axes, roles, textures, and every fault with its line.
// SPDX-License-Identifier: MIT
#include "input_fixture.h"

#include "host/compile/input_grid.h"
#include "tests/common/failing_allocator.h"
#include "tests/common/random.h"

#include <gmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double LOW[3] = {0, 0, 0}, HIGH[3] = {64, 32, 16};

// ---- The grid ----

static void decimals_round_once_half_to_even(void **state)
{
    (void)state;
    static const struct { const char *text; uint32_t steps; int64_t out; grid_fit fit; } cases[] = {
        {"0", 256, 0, GRID_ON},
        {"-12.5", 256, -3200, GRID_ON},
        {"+1.", 256, 256, GRID_ON},
        {".00390625", 256, 1, GRID_ON},
        {"0.001953125", 256, 0, GRID_ROUNDED},                       // half a step: to even
        {"0.005859375", 256, 2, GRID_ROUNDED},                       // one and a half
        {"0.0019531250000000000000000000000000001", 256, 1, GRID_ROUNDED}, // what a double can't tell from half
        {"0.0019531249999999999999999999999999999", 256, 0, GRID_ROUNDED},
        {"-0.5", 1, 0, GRID_ROUNDED},
        {"-1.5", 1, -2, GRID_ROUNDED},
        {"2.5", 1, 2, GRID_ROUNDED},
        {"12e-1", 5, 6, GRID_ON},
        {"1.5E+3", 1, 1500, GRID_ON},
        {"1e-400", 256, 0, GRID_ROUNDED},
        {"0e999999999", 256, 0, GRID_ON},
        {"4192.4475524510435", 256, 1073267, GRID_ROUNDED},
        {"1e30", 256, GRID_BEYOND, GRID_ON},
        {"-1e30", 256, -GRID_BEYOND, GRID_ON},
        {"65535.99999", 65536, 4294967295, GRID_ROUNDED},
        {"000000000000000000000000000000000007.25", 4, 29, GRID_ON},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        int64_t out = 77;
        const grid_fit fit = grid_round(cases[i].text, strlen(cases[i].text), cases[i].steps, &out);
        if (out != cases[i].out || fit != cases[i].fit) fprintf(stderr, "%s: %lld\n", cases[i].text, (long long)out);
        assert_true(out == cases[i].out && fit == cases[i].fit);
    }
}

// steps * digits / 10^places by GMP.
static int64_t rounded_by_gmp(uint64_t digits, uint32_t places, uint32_t steps)
{
    mpz_t value, unit, rest;
    mpz_inits(value, unit, rest, NULL);
    mpz_set_ui(value, digits);
    mpz_mul_ui(value, value, steps);
    mpz_ui_pow_ui(unit, 10, places);
    mpz_fdiv_qr(value, rest, value, unit);
    mpz_mul_ui(rest, rest, 2);
    const int over = mpz_cmp(rest, unit);
    const int64_t out = (int64_t)mpz_get_ui(value);
    mpz_clears(value, unit, rest, NULL);
    return out + (over > 0 || (over == 0 && out % 2));
}

static void random_decimals_round_as_gmp_rounds_them(void **state)
{
    (void)state;
    uint64_t seed = 11;
    for (int i = 0; i < 200000; ++i) {
        const uint32_t places = random_below(&seed, 15), steps = 1 + random_below(&seed, i % 2 ? 65536 : 8);
        uint64_t digits = random_below(&seed, 1u << 20), scale = 1;
        for (uint32_t k = 0; k < places; ++k) scale *= 10;
        digits = digits % 65536 * scale + (i % 3 ? random_bits(&seed) % scale : scale / 2);
        char text[64];
        snprintf(text, sizeof text, "-%llu.%0*llu", (unsigned long long)(digits / scale), (int)places, (unsigned long long)(digits % scale));
        if (!places) *strchr(text, '.') = 0;
        int64_t out;
        grid_round(text, strlen(text), steps, &out);
        assert_true(out == -rounded_by_gmp(digits, places, steps));
    }
}

// ---- Axes, planes, textures ----

static void a_box_stands_in_scene_axes_with_its_fronts_outside(void **state)
{
    (void)state;
    map_writer w = {.size = 0};
    open_entity(&w, "worldspawn");
    write_box(&w, LOW, HIGH, "wall");
    close_entity(&w);
    compile_input *in = input_of(w.text, NULL);
    assert_int_equal(in->brush_count, 1);
    assert_int_equal(in->face_count, 6);
    assert_true(in->steps_per_metre == 8192);
    static const int32_t min[3] = {0, 0, -32 * 256}, max[3] = {64 * 256, 16 * 256, 0};
    assert_memory_equal(in->brushes[0].min, min, sizeof min);
    assert_memory_equal(in->brushes[0].max, max, sizeof max);
    static const int32_t inside[3] = {100, 100, -100};
    for (uint32_t f = 0; f < 6; ++f) assert_int_equal(plane_table_side_of_point(in->planes, inside, in->faces[f].plane), -1);
    assert_int_equal(in->faces[0].line, 4);
    assert_int_equal(in->faces[5].line, 9);
    assert_brushes_are_sound(in);
    compile_input_free(in);
}

static void texture_rows_take_metres_for_both_formats(void **state)
{
    (void)state;
    // floor, seen from above: s along x, t along -y; both scaled and shifted; then Valve's axes as written
    compile_input *in = input_of("{\n\"classname\" \"worldspawn\"\n{\n( 0 0 0 ) ( 0 1 0 ) ( 0 0 1 ) a 0 0 0 1 1\n( 32 0 0 ) ( 32 0 1 ) ( 32 1 0 ) a 0 0 0 1 1\n"
                                 "( 0 0 0 ) ( 0 0 1 ) ( 1 0 0 ) a 0 0 0 1 1\n( 0 32 0 ) ( 1 32 0 ) ( 0 32 1 ) a 0 0 0 1 1\n"
                                 "( 0 0 0 ) ( 1 0 0 ) ( 0 1 0 ) a [ 0 1 0 8 ] [ 0 0 -1 16 ] 0 0.5 2\n( 0 0 32 ) ( 0 1 32 ) ( 1 0 32 ) b 32 16 0 2 0.5\n}\n}\n",
                                 NULL);
    const compile_face *top = &in->faces[5], *bottom = &in->faces[4];
    static const double standard[2][4] = {{0.25, 0, 0, 0.5}, {0, 0, 1, 0.25}}; // t = -y / 0.5 texels, and map y = -32 z
    static const double valve[2][4] = {{0, 0, -1, 0.125}, {0, -0.25, 0, 0.25}};
    for (int i = 0; i < 2; ++i)
        for (int k = 0; k < 4; ++k) {
            assert_true(top->texture[i][k] == standard[i][k]);
            assert_true(bottom->texture[i][k] == valve[i][k]);
        }
    assert_string_equal(in->materials[top->material].name, "b");
    assert_int_equal(in->material_count, 2);
    compile_input_free(in);
}

// ---- Roles ----

static void classes_and_textures_say_what_a_brush_is(void **state)
{
    (void)state;
    static const struct { const char *class_name, *texture; int kept; brush_kind kind; brush_role role; } cases[] = {
        {"worldspawn", "wall", 1, BRUSH_ADD, BRUSH_STRUCTURE},
        {"worldspawn", "sky1", 1, BRUSH_ADD, BRUSH_STRUCTURE},
        {"worldspawn", "*water0", 1, BRUSH_ADD, BRUSH_LIQUID},
        {"worldspawn", "{grate", 1, BRUSH_ADD, BRUSH_ENTITY},
        {"worldspawn", "clip", 0, BRUSH_ADD, BRUSH_STRUCTURE},
        {"worldspawn", "SKIP", 0, BRUSH_ADD, BRUSH_STRUCTURE},
        {"worldspawn", "hint", 0, BRUSH_ADD, BRUSH_STRUCTURE},
        {"worldspawn", "common/trigger", 0, BRUSH_ADD, BRUSH_STRUCTURE},
        {"worldspawn", "origin", 0, BRUSH_ADD, BRUSH_STRUCTURE},
        {"func_group", "wall", 1, BRUSH_ADD, BRUSH_STRUCTURE},
        {"func_detail_wall", "wall", 1, BRUSH_ADD, BRUSH_STRUCTURE},
        {"func_detail_illusionary", "wall", 1, BRUSH_ADD, BRUSH_ENTITY},
        {"func_door", "wall", 1, BRUSH_ADD, BRUSH_ENTITY},
        {"func_wall", "wall", 1, BRUSH_ADD, BRUSH_ENTITY},
        {"trigger_once", "wall", 0, BRUSH_ADD, BRUSH_ENTITY},
        {"zone_portal", "skip", 1, BRUSH_ADD, BRUSH_PORTAL},
        {"csg_add", "wall", 1, BRUSH_ADD, BRUSH_STRUCTURE},
        {"csg_subtract", "wall", 1, BRUSH_SUBTRACT, BRUSH_STRUCTURE},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        map_writer w = {.size = 0};
        open_entity(&w, cases[i].class_name);
        write_box(&w, LOW, HIGH, cases[i].texture);
        close_entity(&w);
        compile_input *in = input_of(w.text, NULL);
        if ((int)in->brush_count != cases[i].kept) fprintf(stderr, "%s %s\n", cases[i].class_name, cases[i].texture);
        assert_int_equal(in->brush_count, cases[i].kept);
        assert_int_equal(in->brushes_dropped, !cases[i].kept);
        if (cases[i].kept) assert_true(in->brushes[0].kind == cases[i].kind && in->brushes[0].role == cases[i].role);
        if (cases[i].role == BRUSH_PORTAL) assert_true(in->faces[0].material == COMPILE_NOTHING);
        assert_int_equal(in->entity_count, 1);
        assert_int_equal(in->entities[0].brush_count, cases[i].kept);
        compile_input_free(in);
    }
}

static void entities_keep_their_keys_names_and_places(void **state)
{
    (void)state;
    compile_input *in = input_of("{\n\"classname\" \"worldspawn\"\n\"message\" \"\"\n}\n"
                                 "{\n\"origin\" \"32 64 -96\"\n\"targetname\" \"t1\"\n\"classname\" \"light\"\n}\n",
                                 NULL);
    assert_int_equal(in->entity_count, 2);
    const compile_entity *light = &in->entities[1];
    assert_string_equal(light->class_name, "light");
    assert_string_equal(light->name, "t1");
    assert_null(in->entities[0].name);
    assert_int_equal(light->key_count, 3);
    assert_string_equal(light->keys[0], "origin");
    assert_string_equal(light->keys[1], "32 64 -96");
    assert_true(light->has_origin && light->origin[0] == 1 && light->origin[1] == -3 && light->origin[2] == -2);
    assert_int_equal(light->line, 5);
    assert_int_equal(in->entities[0].has_origin, 0);
    compile_input_free(in);
}

// ---- Faults ----

#define HEAD "{\n\"classname\" \"worldspawn\"\n{\n" // faces begin on line 4
#define FIVE                                                                                                                        \
    "( 0 0 0 ) ( 0 1 0 ) ( 0 0 1 ) a 0 0 0 1 1\n( 32 0 0 ) ( 32 0 1 ) ( 32 1 0 ) a 0 0 0 1 1\n( 0 0 0 ) ( 0 0 1 ) ( 1 0 0 ) a 0 0 0 1 1\n" \
    "( 0 32 0 ) ( 1 32 0 ) ( 0 32 1 ) a 0 0 0 1 1\n( 0 0 0 ) ( 1 0 0 ) ( 0 1 0 ) a 0 0 0 1 1\n"
#define SIXTH "( 0 0 32 ) ( 0 1 32 ) ( 1 0 32 ) a 0 0 0 1 1\n"
#define TAIL "}\n}\n"

static void wrong_maps_are_refused_with_their_line(void **state)
{
    (void)state;
    expect_input_error("", "t.map:1: error: no entity in it; is this a .map file?");
    expect_input_error(HEAD FIVE TAIL, "t.map:3: error: entity 0 brush 0: its faces leave it open; add the side that is missing");
    expect_input_error(HEAD "( 0 0 0 ) ( 0 1 0 ) ( 0 0 1 ) a 0 0 0 1 1\n" SIXTH SIXTH TAIL,
                       "t.map:3: error: entity 0 brush 0: 3 faces enclose nothing; give it 4 or more");
    expect_input_error(HEAD FIVE "( 0 0 32 ) ( 0 1 32 ) ( 0 2 32 ) a 0 0 0 1 1\n" TAIL,
                       "t.map:9: error: entity 0 brush 0: the three points of a face lie on one line; move one");
    expect_input_error(HEAD FIVE "( 0 0 32 ) ( 0 0.001 32 ) ( 0.001 0 32 ) a 0 0 0 1 1\n" TAIL,
                       "t.map:9: error: entity 0 brush 0: the three points of a face lie on one line of the grid; move one or take a finer grid");
    expect_input_error(HEAD FIVE "( 0 0 65536.002 ) ( 0 1 32 ) ( 1 0 32 ) a 0 0 0 1 1\n" TAIL,
                       "t.map:9: error: entity 0 brush 0: a coordinate beyond 65536 units (2^24 steps of the grid); move it or take a coarser grid");
    expect_input_error(HEAD FIVE "( 0 0 nan ) ( 0 1 32 ) ( 1 0 32 ) a 0 0 0 1 1\n" TAIL,
                       "t.map:9: error: entity 0 brush 0: expected a decimal number, found 'nan'; repair the line");
    expect_input_error(HEAD FIVE SIXTH, "t.map:10: error: entity 0: the file ends within the brush of line 3; close it with '}'");
    expect_input_error("{\n\"classname\" \"light\"\n\"origin\" \"1 2\"\n}\n",
                       "t.map:3: error: entity 0: \"origin\" takes three numbers within 2^20; repair its value");
}

// A slope so flat that it meets the others far outside: the body is closed, but not on the grid.
static void a_brush_that_closes_beyond_the_grid_is_open(void **state)
{
    (void)state;
    expect_input_error(HEAD "( 0 0 0 ) ( 0 1 0 ) ( 0 0 1 ) a 0 0 0 1 1\n( 0 0 0 ) ( 0 0 1 ) ( 1 0 0 ) a 0 0 0 1 1\n"
                            "( 0 32 0 ) ( 1 32 0 ) ( 0 32 1 ) a 0 0 0 1 1\n( 0 0 0 ) ( 1 0 0 ) ( 0 1 0 ) a 0 0 0 1 1\n"
                            "( 0 0 4096 ) ( 0 1 4096 ) ( 1024 0 4095 ) a 0 0 0 1 1\n" TAIL,
                       "t.map:3: error: entity 0 brush 0: its faces leave it open; add the side that is missing");
}

static void one_warning(const char *text, const char *line, uint32_t brushes, uint32_t faces)
{
    report_lines lines;
    report_lines_init(&lines);
    compile_input *in = NULL;
    assert_int_equal(compile_input_map("t.map", text, strlen(text), NULL, allocator_heap(), &lines.report, &in), RESULT_OK);
    assert_string_equal(report_lines_only(&lines), line);
    assert_int_equal(in->brush_count, brushes);
    assert_int_equal(in->face_count, faces);
    compile_input_free(in);
}

static void what_editors_write_is_dropped_with_a_warning(void **state)
{
    (void)state;
    one_warning(HEAD FIVE SIXTH "( 8 8 32 ) ( 8 9 32 ) ( 9 8 32 ) b 0 0 0 1 1\n" TAIL,
                "t.map:10: warning: entity 0 brush 0: a face on the same plane as an earlier one; dropped", 1, 6);
    one_warning(HEAD FIVE "( 0 0 0 ) ( 0 1 0 ) ( 1 0 0 ) a 0 0 0 1 1\n" TAIL, "t.map:3: warning: entity 0 brush 0: its faces leave nothing; dropped", 0, 0);
    one_warning(HEAD FIVE "( 0 0 -5 ) ( 0 1 -5 ) ( 1 0 -5 ) a 0 0 0 1 1\n" TAIL, "t.map:3: warning: entity 0 brush 0: its faces leave nothing; dropped", 0,
                0);
}

static void a_face_that_cuts_nothing_off_is_left_out(void **state)
{
    (void)state;
    compile_input *in = input_of(HEAD FIVE SIXTH "( 0 0 48 ) ( 0 1 48 ) ( 1 0 48 ) b 0 0 0 1 1\n" // above the box
                                                 "( 32 0 32 ) ( 32 1 32 ) ( 33 0 31 ) c 0 0 0 1 1\n" TAIL, // touches an edge
                                 NULL);
    assert_int_equal(in->face_count, 6);
    compile_input_free(in);
}

static void a_grid_or_weld_out_of_range_is_refused(void **state)
{
    (void)state;
    static const input_options wrong[] = {{0.5, 0}, {-1, 0}, {65537, 0}, {1.5, 0}, {256, -1}, {256, 2}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; ++i) {
        report_lines lines;
        report_lines_init(&lines);
        compile_input *in = NULL;
        assert_int_equal(compile_input_map("t.map", "{}", 2, &wrong[i], allocator_heap(), &lines.report, &in), RESULT_BAD_INPUT);
        assert_true(report_lines_is_one_with(&lines, i < 4 ? "t.map: error: a grid of" : "t.map: error: a weld of"));
    }
}

static void a_map_cut_anywhere_is_read_or_refused(void **state)
{
    (void)state;
    static const char text[] = HEAD FIVE SIXTH "}\n}\n{\n\"classname\" \"light\"\n\"origin\" \"1e0 2 3\"\n}\n";
    uint32_t refused = 0;
    for (size_t size = 0; size < sizeof text; ++size) {
        char *part = malloc(size + 1);
        memcpy(part, text, size);
        report_lines lines;
        report_lines_init(&lines);
        compile_input *in = NULL;
        const result done = compile_input_map("t.map", part, size, NULL, allocator_heap(), &lines.report, &in);
        refused += done != RESULT_OK;
        assert_int_equal(done == RESULT_OK, in != NULL);
        assert_int_equal(done != RESULT_OK, lines.report.errors == 1);
        compile_input_free(in);
        free(part);
    }
    assert_true(refused > 250);
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    static const char text[] = HEAD FIVE SIXTH "}\n{\n( 32 0 0 ) ( 32 1 0 ) ( 32 0 1 ) a 0 0 0 1 1\n( 64 0 0 ) ( 64 0 1 ) ( 64 1 0 ) a 0 0 0 1 1\n"
                                               "( 0 0 0 ) ( 0 0 1 ) ( 1 0 0 ) a 0 0 0 1 1\n( 0 32 0 ) ( 1 32 0 ) ( 0 32 1 ) a 0 0 0 1 1\n"
                                               "( 0 0 0 ) ( 1 0 0 ) ( 0 1 0 ) a 0 0 0 1 1\n( 0 0 32.0039 ) ( 0 100 32 ) ( 1000 0 32.0039 ) b 0 0 0 1 1\n" TAIL;
    uint64_t fail_at = 1;
    for (int finished = 0; !finished; ++fail_at) {
        failing_allocator a;
        report_lines lines;
        failing_allocator_init(&a, fail_at);
        report_lines_init(&lines);
        compile_input *in = NULL;
        const result done = compile_input_map("t.map", text, sizeof text - 1, NULL, &a.memory, &lines.report, &in);
        finished = a.failures == 0;
        assert_int_equal(done, finished ? RESULT_OK : RESULT_NO_MEMORY);
        assert_int_equal(lines.report.errors, !finished);
        if (finished) assert_int_equal(in->weld_moves, 1);
        compile_input_free(in);
        assert_true(failing_allocator_is_clean(&a));
    }
    assert_true(fail_at > 20);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(decimals_round_once_half_to_even),
        cmocka_unit_test(random_decimals_round_as_gmp_rounds_them),
        cmocka_unit_test(a_box_stands_in_scene_axes_with_its_fronts_outside),
        cmocka_unit_test(texture_rows_take_metres_for_both_formats),
        cmocka_unit_test(classes_and_textures_say_what_a_brush_is),
        cmocka_unit_test(entities_keep_their_keys_names_and_places),
        cmocka_unit_test(wrong_maps_are_refused_with_their_line),
        cmocka_unit_test(a_brush_that_closes_beyond_the_grid_is_open),
        cmocka_unit_test(what_editors_write_is_dropped_with_a_warning),
        cmocka_unit_test(a_face_that_cuts_nothing_off_is_left_out),
        cmocka_unit_test(a_grid_or_weld_out_of_range_is_refused),
        cmocka_unit_test(a_map_cut_anywhere_is_read_or_refused),
        cmocka_unit_test(every_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
