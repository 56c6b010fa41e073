// Maps that are wrong: each fault has its line, its words, and leaves nothing behind.
// SPDX-License-Identifier: MIT
#include "support.h"

#include <stdio.h>
#include <string.h>

// A box of 32 units with one face (the last) left to the test.
#define FIVE                                                                                                                        \
    "( 0 0 0 ) ( 0 1 0 ) ( 0 0 1 ) a 0 0 0 1 1\n( 32 0 0 ) ( 32 0 1 ) ( 32 1 0 ) a 0 0 0 1 1\n( 0 0 0 ) ( 0 0 1 ) ( 1 0 0 ) a 0 0 0 1 1\n" \
    "( 0 32 0 ) ( 1 32 0 ) ( 0 32 1 ) a 0 0 0 1 1\n( 0 0 0 ) ( 1 0 0 ) ( 0 1 0 ) a 0 0 0 1 1\n"
#define SIXTH "( 0 0 32 ) ( 0 1 32 ) ( 1 0 32 ) a 0 0 0 1 1\n"
#define HEAD "{\n\"classname\" \"worldspawn\"\n{\n" // faces begin on line 4

static void numbers_out_of_range_or_no_numbers_are_refused_with_their_line(void **state)
{
    (void)state;
    static const struct { const char *number, *says; } cases[] = {
        {"nan", "entity 0 brush 0: expected a decimal number, found 'nan'; repair the line"},
        {"-inf", "entity 0 brush 0: expected a decimal number, found '-inf'; repair the line"},
        {"1e300", "entity 0 brush 0: expected a coordinate within 2^20 units, found '1e300'; move or repair it"},
        {"1e999", "entity 0 brush 0: expected a decimal number, found '1e999'; repair the line"},
        {"-1048577", "entity 0 brush 0: expected a coordinate within 2^20 units, found '-1048577'; move or repair it"},
        {"0x20", "entity 0 brush 0: expected a decimal number, found '0x20'; repair the line"},
        {"1.5.2", "entity 0 brush 0: expected a decimal number, found '1.5.2'; repair the line"},
    };
    for (size_t c = 0; c < sizeof cases / sizeof *cases; ++c) {
        char text[1024], line[256];
        snprintf(text, sizeof text, HEAD FIVE "( 0 0 %s ) ( 0 1 32 ) ( 1 0 32 ) a 0 0 0 1 1\n}\n}\n", cases[c].number);
        snprintf(line, sizeof line, "t.map:9: error: %s", cases[c].says);
        expect_map_error(text, line);
    }
}

static void texture_numbers_are_checked_too(void **state)
{
    (void)state;
    expect_map_error(HEAD FIVE "( 0 0 32 ) ( 0 1 32 ) ( 1 0 32 ) a 0 0 nan 1 1\n}\n}\n",
                     "t.map:9: error: entity 0 brush 0: expected a decimal number, found 'nan'; repair the line");
    expect_map_error(HEAD FIVE "( 0 0 32 ) ( 0 1 32 ) ( 1 0 32 ) a 0 0 0 1e300 1\n}\n}\n",
                     "t.map:9: error: entity 0 brush 0: expected a number within 1e9, found '1e300'; move or repair it");
    expect_map_error(HEAD FIVE "( 0 0 32 ) ( 0 1 32 ) ( 1 0 32 ) a [ 1 0 0 0 ] [ 0 1 0 ] 0 1 1\n}\n}\n",
                     "t.map:9: error: entity 0 brush 0: expected a decimal number, found ']'; repair the line");
    expect_map_error(HEAD FIVE "( 0 0 32 ) ( 0 1 32 ) ( 1 0 32 ) a 0 0 0 1\n}\n}\n",
                     "t.map:10: error: entity 0 brush 0: expected a decimal number, found '}'; repair the line");
    expect_map_error(HEAD FIVE "( 0 0 32 ) ( 0 1 32 ) ( 1 0 32 )\n}\n}\n",
                     "t.map:11: error: entity 0 brush 0: expected a decimal number, found '}'; repair the line");
}

static void what_is_left_open_is_named(void **state)
{
    (void)state;
    expect_map_error(HEAD FIVE SIXTH, "t.map:10: error: entity 0: the file ends within the brush of line 3; close it with '}'");
    expect_map_error(HEAD FIVE SIXTH "}\n", "t.map:11: error: entity 0: the file ends within the entity of line 1; close it with '}'");
    expect_map_error("{\n\"classname\" \"world\n}\n",
                     "t.map:2: error: entity 0: expected a closing quote on the same line, found the end of the line; close the string");
    expect_map_error("{\n}\n}\n", "t.map:3: error: entity 1: expected '{' of an entity, found '}'; is this a .map file?");
    expect_map_error("{\n\"alone\"\n}\n", "t.map:3: error: entity 0: expected a value in quotes, found '}'; write \"key\" \"value\"");
    expect_map_error(HEAD "( 0 0 0 ) ( 0 1 0", "t.map:4: error: entity 0 brush 0: expected ')' behind three coordinates, found the end of the file; repair the point");
}

static void brushes_that_enclose_nothing_are_refused(void **state)
{
    (void)state;
    expect_map_error("{}\n" HEAD FIVE SIXTH "}\n{\n" FIVE "}\n}\n",
                     "t.map:12: error: entity 1 brush 1: its faces leave it open; add the side that is missing");
    expect_map_error(HEAD "( 0 0 0 ) ( 0 1 0 ) ( 0 0 1 ) a 0 0 0 1 1\n}\n}\n",
                     "t.map:3: error: entity 0 brush 0: 1 faces enclose nothing; give it 4 or more");
    expect_map_error(HEAD FIVE "( 0 0 32 ) ( 0 1 32 ) ( 0 2 32 ) a 0 0 0 1 1\n}\n}\n",
                     "t.map:9: error: entity 0 brush 0: the three points of a face lie on one line; move one");
}

static void a_brush_turned_inside_out_is_dropped_with_a_warning(void **state)
{
    (void)state;
    heard h;
    report r = hear(&h);
    scene *s = NULL;
    const char *text = HEAD FIVE SIXTH "}\n{\n" FIVE "( 0 0 -8 ) ( 0 1 -8 ) ( 1 0 -8 ) a 0 0 0 1 1\n}\n}\n";
    assert_int_equal(import_map("t.map", text, strlen(text), &doors_open, allocator_heap(), &r, &s), RESULT_OK);
    assert_int_equal(r.warnings, 1);
    assert_string_equal(h.text, "t.map:11: warning: entity 0 brush 1: its faces leave nothing; dropped");
    assert_int_equal(s->item_count, 6);
    scene_free(s, allocator_heap());
}

static void other_games_formats_are_named(void **state)
{
    (void)state;
    expect_map_error(HEAD "brushDef\n{\n( 0 0 0 ) ...", "t.map:4: error: entity 0 brush 0: expected faces, found 'brushDef'; this is Quake 3's format: "
                                                      "save the map as Standard or Valve 220");
    expect_map_error(HEAD "patchDef2\n{\n", "t.map:4: error: entity 0 brush 0: expected faces, found 'patchDef2'; this is Quake 3's format: "
                                           "save the map as Standard or Valve 220");
}

static void what_is_no_map_is_refused(void **state)
{
    (void)state;
    expect_map_error("", "t.map:1: error: no entity in it; is this a .map file?");
    expect_map_error("// only this\n\n", "t.map:3: error: no entity in it; is this a .map file?");
    expect_map_error("\x7f" "ELF\x02\x01\x01", "t.map:1: error: entity 0: expected '{' of an entity, found '\\x7fELF\\x02\\x01\\x01'; is this a .map file?");
    expect_map_error("{\n\"classname\" \"worldspawn\"\n}\n", "t.map: error: no polygon to draw; the scene is empty or holds tool surfaces only");
}

static void keys_that_must_be_numbers_are_checked(void **state)
{
    (void)state;
    expect_map_error("{\n\"origin\" \"0 zero 0\"\n}\n", "t.map:2: error: entity 0: \"origin\" takes three numbers within 2^20; repair its value");
    expect_map_error("{\n\"origin\" \"0 0 1e300\"\n}\n", "t.map:2: error: entity 0: \"origin\" takes three numbers within 2^20; repair its value");
    expect_map_error("{\n\"classname\" \"func_door\"\n\"angle\" \"up\"\n{\n" FIVE SIXTH "}\n}\n",
                     "t.map:3: error: entity 0: \"angle\" takes 1 number; repair its value");
    expect_map_error("{\n\"classname\" \"func_door\"\n\"lip\" \"1e300\"\n{\n" FIVE SIXTH "}\n}\n",
                     "t.map:3: error: entity 0: a lip within 2^20 units is needed; repair it");
}

static void a_message_shows_foreign_bytes_as_numbers_and_at_most_40_of_them(void **state)
{
    (void)state;
    expect_map_error("\x1b[31mr\xc3\xa9\xff", "t.map:1: error: entity 0: expected '{' of an entity, found '\\x1b[31mr\\xc3\\xa9\\xff'; is this a .map file?");
    char text[64], line[512];
    int used = snprintf(line, sizeof line, "t.map:1: error: entity 0: expected '{' of an entity, found '");
    for (int i = 0; i < 63; ++i) text[i] = (char)(unsigned char)0x9b; // a terminal's one-byte escape
    text[63] = 0;
    for (int i = 0; i < 40; ++i) used += snprintf(line + used, sizeof line - (size_t)used, "\\x9b");
    snprintf(line + used, sizeof line - (size_t)used, "'; is this a .map file?");
    expect_map_error(text, line);
}

static void an_empty_angle_of_a_door_is_taken_as_0_with_a_warning(void **state)
{
    (void)state;
    heard h;
    report r = hear(&h);
    scene *s = NULL;
    const char *text = "{\n\"classname\" \"func_door\"\n\"angle\" \"\"\n{\n" FIVE SIXTH "}\n}\n";
    assert_int_equal(import_map("t.map", text, strlen(text), &doors_open, allocator_heap(), &r, &s), RESULT_OK);
    assert_int_equal(r.warnings, 1);
    assert_string_equal(h.text, "t.map:3: warning: entity 0: \"angle\" is empty; taken as 0");
    assert_int_equal(s->mover_count, 1);
    assert_true(s->movers[0].open_offset[0] == 24 / 32.0 && s->movers[0].open_offset[1] == 0 && s->movers[0].open_offset[2] == 0);
    scene_free(s, allocator_heap());
}

static void a_scene_file_is_chosen_by_its_ending(void **state)
{
    (void)state;
    heard h;
    report r = hear(&h);
    scene *s = NULL;
    assert_int_equal(import_scene("level.bsp", &doors_open, allocator_heap(), &r, &s), RESULT_BAD_INPUT);
    assert_string_equal(h.text, "level.bsp: error: unknown kind of scene; the name must end in .pcs, .json, .map, .obj, .ply, .off, .stl or .boxes");
    assert_int_equal(import_scene(".map", &doors_open, allocator_heap(), &r, &s), RESULT_BAD_INPUT);
    assert_int_equal(import_scene("no/such/file.MAP", &doors_open, allocator_heap(), &r, &s), RESULT_BAD_INPUT);
    assert_non_null(strstr(h.text, "no/such/file.MAP: error: cannot open it"));
    assert_null(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_out_of_range_or_no_numbers_are_refused_with_their_line),
        cmocka_unit_test(texture_numbers_are_checked_too),
        cmocka_unit_test(what_is_left_open_is_named),
        cmocka_unit_test(brushes_that_enclose_nothing_are_refused),
        cmocka_unit_test(a_brush_turned_inside_out_is_dropped_with_a_warning),
        cmocka_unit_test(other_games_formats_are_named),
        cmocka_unit_test(what_is_no_map_is_refused),
        cmocka_unit_test(keys_that_must_be_numbers_are_checked),
        cmocka_unit_test(a_message_shows_foreign_bytes_as_numbers_and_at_most_40_of_them),
        cmocka_unit_test(an_empty_angle_of_a_door_is_taken_as_0_with_a_warning),
        cmocka_unit_test(a_scene_file_is_chosen_by_its_ending),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
