// .obj: index forms, groups, materials, line rules, and every refusal with its line.
// SPDX-License-Identifier: MIT
#include "fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SQUARE "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
#define UV "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n"

static void every_index_form_gives_the_same_square(void **state)
{
    static const char *const forms[] = {
        SQUARE UV "f 1/1 2/2 3/3 4/4\n",
        SQUARE UV "f 1//1 2//1 3//1 4//1\n",
        SQUARE UV "f 1/1/1 2/2/1 3/3/1 4/4/1\n",
        SQUARE UV "f 1 2/2 3//1 4/4/1\n",
        SQUARE UV "f -4 -3 -2 -1\n",
        SQUARE UV "f -4/-4/-1 2/-3/1 -2/3/-1 4/-1/1\n",
        SQUARE UV "f 1/ 2// 3/3/ 4\n",
        SQUARE UV "f +1 +2 +3 +4",
        UV "f 1 2 3 4\n" SQUARE, // named before it is written
    };
    (void)state;
    scene *plain = import_good("a.obj", SQUARE "f 1 2 3 4\n");
    assert_int_equal(plain->polygon_count, 1);
    assert_int_equal(plain->index_count, 6);
    for (size_t i = 0; i < sizeof forms / sizeof *forms; ++i) {
        scene *s = import_good("a.obj", forms[i]);
        assert_same_geometry(plain, s);
        remove_scene(s);
    }
    remove_scene(plain);
}

static void negative_indices_count_back_from_where_they_stand(void **state)
{
    (void)state;
    scene *a = import_good("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 0 0 5\nv 1 0 5\nv 0 1 5\nf -3 -2 -1\n");
    scene *b = import_good("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 5\nv 1 0 5\nv 0 1 5\nf 1 2 3\nf 4 5 6\n");
    assert_same_geometry(a, b);
    remove_scene(a);
    remove_scene(b);
}

static void lines_may_be_joined_end_anyhow_and_carry_comments(void **state)
{
    static const char *const texts[] = {
        "v 0 0 0\r\nv 1 0 0\r\nv 1 1 0\r\nv 0 1 0\r\nf 1 2 3 4\r\n",
        "v 0 0 0\rv 1 0 0\rv 1 1 0\rv 0 1 0\rf 1 2 3 4\r",
        "v 0 0\\\n 0\nv 1 \\\r\n0 0\nv 1 1 0\nv 0 1 0\nf 1 2 \\\n3\\\n 4",
        "# a file\nv 0 0 0#origin\nv 1 0 0 # x\n   # indented\nv\t1 1 0\nv 0 1 0\n\n \t f 1 2 3 4#end",
        "v 0 0 0 1 # weight\nv 1 0 0 0.5 0.5 0.5\nv 1 1 0 1 1 1 1\nv +0e0 1.0E0 .0\nf 1 2 3 4\n",
        "\xef\xbb\xbfv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n",
        "mtllib none.mtl\ns off\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvp 1\nl 1 2\np 1\ncurv 0 1 \\\n2 3\ng\nf 1 2 3 4\ns 1\nend",
        "# ends like a path \\\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n",
    };
    (void)state;
    scene *plain = import_good("a.obj", SQUARE "f 1 2 3 4\n");
    for (size_t i = 0; i < sizeof texts / sizeof *texts; ++i) {
        scene *s = import_good("a.obj", texts[i]);
        assert_same_geometry(plain, s);
        remove_scene(s);
    }
    remove_scene(plain);
}

static void groups_are_objects_only_where_no_o_line_stands(void **state)
{
    (void)state;
    scene *s = import_good("dir/town.obj", SQUARE "f 1 2 3\ng roof left # of two\nf 1 2 3\nf 1 3 4\ng empty\ng wall\nf 1 2 4\n");
    assert_int_equal(s->object_count, 3);
    assert_string_equal(s->objects[0].name, "town");
    assert_string_equal(s->objects[1].name, "roof left");
    assert_string_equal(s->objects[2].name, "wall");
    assert_int_equal(s->items[1].polygon_count, 2);
    remove_scene(s);
    s = import_good("town.obj", SQUARE "g roof\nf 1 2 3\ng wall\nf 1 3 4\no house\nf 1 2 3\ng door\nf 1 2 4\no house\nf 1 2 4\n");
    assert_int_equal(s->object_count, 3);
    assert_string_equal(s->objects[0].name, "town");
    assert_string_equal(s->objects[1].name, "house");
    assert_string_equal(s->objects[2].name, "house");
    remove_scene(s);
}

static void each_material_of_an_object_has_items_of_its_own(void **state)
{
    (void)state;
    scene *s = import_good("a.obj", SQUARE "f 1 2 3\nusemtl Water\nf 1 2 3\nusemtl brick #2\nf 1 3 4\nusemtl Water\nf 1 2 4\no b\nf 1 2 3\n");
    assert_int_equal(s->object_count, 2);
    assert_int_equal(s->item_count, 4);
    assert_int_equal(s->items[1].polygon_count, 2);
    assert_string_equal(s->materials[s->items[0].material].name, "default");
    assert_string_equal(s->materials[s->items[1].material].name, "Water");
    assert_string_equal(s->materials[s->items[2].material].name, "brick");
    assert_string_equal(s->materials[s->items[3].material].name, "Water");
    for (uint32_t m = 0; m < s->material_count; ++m) assert_int_equal(s->materials[m].flags, 0);
    remove_scene(s);
}

static void a_texture_seam_doubles_its_vertices_only(void **state)
{
    (void)state;
    scene *s = import_good("a.obj", SQUARE UV "f 1/1 2/2 3/3\nf 1/2 3/3 4/4\n");
    assert_int_equal(s->position_count, 5);
    remove_scene(s);
}

static void a_closed_mesh_is_one_sided_and_an_open_one_two_sided(void **state)
{
    static const char cube[] = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
                               "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    (void)state;
    if (!has_openmesh()) return;
    scene *s = import_good("a.obj", cube);
    assert_int_equal(s->items[0].flags, 0);
    assert_int_equal(s->items[0].polygon_count, 6);
    assert_int_equal(s->items[0].index_count, 36);
    remove_scene(s);
    char open[sizeof cube];
    memcpy(open, cube, sizeof cube);
    *strstr(open, "f 4 1 5 8") = '#';
    s = import_good("a.obj", open);
    assert_int_equal(s->items[0].flags, CULL_ITEM_TWO_SIDED);
    remove_scene(s);
}

static void faces_without_area_are_dropped_with_one_warning(void **state)
{
    static const char text[] = SQUARE "v 2 0 0\nf 1 2 5\nf 1 1 2\nf 1 2 3 4\nf 1 2 2 1\nf 1 2 2 3\n";
    captured c;
    scene *s = NULL;
    (void)state;
    captured_open(&c);
    assert_int_equal(import_bytes("a.obj", text, strlen(text), allocator_heap(), &c.report, &s), RESULT_OK);
    assert_string_equal(c.text, "a.obj: warning: 3 faces without area dropped\n");
    assert_int_equal(s->polygon_count, 2); // the last one is a triangle with a corner written twice
    assert_int_equal(s->index_count, 9);
    remove_scene(s);
    assert_refused("a.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "a.obj: error: none of its 1 faces has an area");
}

static void each_fault_is_told_with_its_line(void **state)
{
    static const struct { const char *text, *line; } faults[] = {
        {"", "a.obj:1: error: no faces"},
        {"\n\n# nothing\n", "a.obj:4: error: no faces"},
        {SQUARE, "a.obj:5: error: no faces"},
        {SQUARE "f 1 2\n", "a.obj:5: error: a face of 2 corners"},
        {SQUARE "f\n", "a.obj:5: error: a face of 0 corners"},
        {SQUARE "f 1 2 3\nf 1 2 0\n", "a.obj:6: error: f: vertex index 0 is out of range"},
        {SQUARE "f 1 2 5\nf 1 2 3\n", "a.obj:5: error: f: vertex index 5 is out of range, the file has 4"},
        {SQUARE "f 1 2 -5\n", "a.obj:5: error: f: vertex index -5 is out of range"},
        {SQUARE "f 1 2 99999999999999999999999\n", "a.obj:5: error: f: vertex index"},
        {SQUARE "f 1 2 4294967297\n", "a.obj:5: error: f: vertex index"},
        {SQUARE "f 1/1 2/1 3/1\n", "a.obj:5: error: f: texture index 1 is out of range, the file has 0"},
        {SQUARE "f 1//1 2//1 3//1\n", "a.obj:5: error: f: normal index 1 is out of range, the file has 0"},
        {SQUARE "f 1 2 \\\n 3 \\\n0\n", "a.obj:7: error: f: vertex index 0"},
        {SQUARE "f 1 2 three\n", "a.obj:5: error: f: the vertex index is not an integer"},
        {SQUARE "f 1 2 3.5\n", "a.obj:5: error: f: a corner is not i, i/t"},
        {SQUARE "f 1 2 3/1/1/1\n", "a.obj:5: error: f: a corner is not i, i/t"},
        {"v 0 0\n", "a.obj:1: error: v has 2 of 3 coordinates"},
        {"v 0 0 0\nv 0 nan 0\n", "a.obj:2: error: v: a coordinate is not a finite number"},
        {"v 0 0 0\nv -inf 0 0\n", "a.obj:2: error: v: a coordinate is not a finite number"},
        {"v 0 0 1e300\n", "a.obj:1: error: v: a coordinate lies beyond 1e9 m"},
        {"v 0 0 1e999\n", "a.obj:1: error: v: a coordinate is not a finite number"},
        {"v 0 -1000000001 0\n", "a.obj:1: error: v: a coordinate lies beyond 1e9 m"},
        {"v 0 0 x\n", "a.obj:1: error: v: coordinate 3 is not a number"},
        {"v 0,0 0 0\n", "a.obj:1: error: v: coordinate 1 is not a number"},
        {"v 0x10 0 0\n", "a.obj:1: error: v: coordinate 1 is not a number"},
        {"vt nan 0\n", "a.obj:1: error: vt: value 1"},
        {"vt\n", "a.obj:1: error: vt: value 1"},
        {"v 0 0 0\n\x01\x02\x03", "a.obj:2: error: a byte that no text has"},
        {"v 0 0 0\nf \x01", "a.obj:2: error: f: the vertex index is not an integer"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof faults / sizeof *faults; ++i) assert_refused("a.obj", faults[i].text, faults[i].line);
}

static void a_zero_byte_is_refused_with_its_line(void **state)
{
    static const char text[] = "v 0 0 0\nv 1 0 0\n\0v 1 1 0\nf 1 2 3\n";
    captured c;
    scene *s = NULL;
    (void)state;
    captured_open(&c);
    assert_int_equal(import_bytes("a.obj", text, sizeof text - 1, allocator_heap(), &c.report, &s), RESULT_BAD_INPUT);
    assert_string_equal(c.text, "a.obj:3: error: a byte that no text has; is this an .obj file?\n");
    assert_null(s);
}

static void a_line_of_a_million_indices_is_refused_with_its_line(void **state)
{
    const size_t indices = 1000000;
    char *text = malloc(64 + 2 * indices);
    (void)state;
    assert_non_null(text);
    char *at = text + sprintf(text, SQUARE "f");
    for (size_t i = 0; i < indices; ++i) {
        *at++ = ' ';
        *at++ = (char)('1' + i % 4);
    }
    *at = 0;
    assert_refused("a.obj", text, "a.obj:5: error: a face of over 65535 corners");
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_index_form_gives_the_same_square),
        cmocka_unit_test(negative_indices_count_back_from_where_they_stand),
        cmocka_unit_test(lines_may_be_joined_end_anyhow_and_carry_comments),
        cmocka_unit_test(groups_are_objects_only_where_no_o_line_stands),
        cmocka_unit_test(each_material_of_an_object_has_items_of_its_own),
        cmocka_unit_test(a_texture_seam_doubles_its_vertices_only),
        cmocka_unit_test(a_closed_mesh_is_one_sided_and_an_open_one_two_sided),
        cmocka_unit_test(faces_without_area_are_dropped_with_one_warning),
        cmocka_unit_test(each_fault_is_told_with_its_line),
        cmocka_unit_test(a_zero_byte_is_refused_with_its_line),
        cmocka_unit_test(a_line_of_a_million_indices_is_refused_with_its_line),
    };
    return cmocka_run_group_tests_name("obj", tests, NULL, NULL);
}
