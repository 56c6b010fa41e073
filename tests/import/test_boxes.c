// Box files: geometry, flat boxes, every fault with its line.
// SPDX-License-Identifier: MIT
#include "support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static scene *boxes_of(const char *text)
{
    heard h;
    report r = hear(&h);
    scene *s = NULL;
    if (import_boxes("t.boxes", text, strlen(text), allocator_heap(), &r, &s) != RESULT_OK) fail_msg("%s", h.text);
    return s;
}

static void expect_error(const char *text, const char *line)
{
    heard h;
    report r = hear(&h);
    scene *s = NULL;
    assert_int_equal(import_boxes("t.boxes", text, strlen(text), allocator_heap(), &r, &s), RESULT_BAD_INPUT);
    assert_null(s);
    assert_int_equal(r.errors, 1);
    assert_string_equal(h.text, line);
}

static double volume_within(const scene *s, const scene_item *item) // by the divergence theorem: above 0 when all faces look out
{
    double six = 0;
    for (uint32_t i = item->first_index; i < item->first_index + item->index_count; i += 3) {
        const cull_vec3 a = s->positions[s->indices[i]], b = s->positions[s->indices[i + 1]], c = s->positions[s->indices[i + 2]];
        six += a.x * ((double)b.y * c.z - (double)b.z * c.y) + a.y * ((double)b.z * c.x - (double)b.x * c.z) +
               a.z * ((double)b.x * c.y - (double)b.y * c.x);
    }
    return six / 6;
}

static void a_box_is_one_item_of_six_polygons_that_look_out(void **state)
{
    (void)state;
    scene *s = boxes_of("boxes 2\n0 0 0 1 2 3\n\n  -2.5\t0 3e1 -1 0.5 31.5\r\n");
    assert_int_equal(s->item_count, 2);
    assert_int_equal(s->polygon_count, 12);
    assert_int_equal(s->index_count, 72);
    assert_int_equal(s->position_count, 16);
    assert_int_equal(s->object_count, 1);
    assert_int_equal(s->is_map, 0);
    assert_true(s->items[0].flags & CULL_ITEM_BOX);
    assert_true(fabs(volume_within(s, &s->items[0]) - 6) < 1e-4);
    assert_true(fabs(volume_within(s, &s->items[1]) - 1.5 * 0.5 * 1.5) < 1e-4);
    assert_true(s->whole.origin[0] + s->boxes.min_x[1] == -2.5);
    assert_true(s->whole.origin[2] + s->boxes.max_z[1] == 31.5);
    scene_free(s, allocator_heap());
}

static void a_flat_box_keeps_the_sides_that_have_area(void **state)
{
    (void)state;
    scene *s = boxes_of("boxes 3\n0 0 0 1 0 1\n5 5 5 5 5 6\n0 0 0 1 1 1\n");
    assert_int_equal(s->item_count, 2);
    assert_int_equal(s->items[0].polygon_count, 2);
    assert_int_equal(s->items[1].polygon_count, 6);
    assert_int_equal(s->flat_triangles, 0);
    scene_free(s, allocator_heap());
}

static void each_fault_has_its_line(void **state)
{
    (void)state;
    expect_error("", "t.boxes:1: error: the first line must be `boxes N`; is this a .boxes file?");
    expect_error("\n\x01\x02", "t.boxes:2: error: the first line must be `boxes N`; is this a .boxes file?");
    expect_error("boxes\n", "t.boxes:1: error: `boxes` takes a whole number from 1 on; write how many lines follow");
    expect_error("boxes 0\n", "t.boxes:1: error: `boxes` takes a whole number from 1 on; write how many lines follow");
    expect_error("boxes 1.5\n", "t.boxes:1: error: `boxes` takes a whole number from 1 on; write how many lines follow");
    expect_error("boxes 1 0 0 0 1 1 1\n", "t.boxes:1: error: more than `boxes N` on the first line; begin a new line");
    expect_error("boxes 2\n0 0 0 1 1 1\n", "t.boxes:3: error: the file ends after 1 of 2 boxes; correct the count or add the rest");
    expect_error("boxes 1\n0 0 0 1 1 1\n0 0 0 1 1 1\n", "t.boxes:3: error: more lines than `boxes N` says; correct the count");
    expect_error("boxes 1\n0 0 0 1 1\n", "t.boxes:2: error: not six decimal numbers; write minx miny minz maxx maxy maxz");
    expect_error("boxes 1\n0 0 0 1 1 1 1\n", "t.boxes:2: error: more than six numbers; write one box a line");
    expect_error("boxes 1\n0 0 nan 1 1 1\n", "t.boxes:2: error: not six decimal numbers; write minx miny minz maxx maxy maxz");
    expect_error("boxes 1\n0 0 0 1 1 1e300\n", "t.boxes:2: error: a coordinate beyond 1e9 m; move the boxes nearer to the origin");
    expect_error("boxes 2\n0 0 0 1 1 1\n0 2 0 1 1 1\n", "t.boxes:3: error: a min above its max; write the three least coordinates first");
}

static void numbers_are_the_nearest_doubles_however_long(void **state)
{
    (void)state;
    static const char *const numbers[] = {"0.1", "123456.789", "-0.000001", "9007199254740993e-10", "0.30000000000000000000000000000000000001",
                                          "1e-22", "1e-23", "179769313486231570000e-15", "2.2250738585072014e-308", "4.9e-324", "1e-400", "123456789012345678e-9",
                                          "0.500000000000000166533453693773481063544750213623046875", "00000000000000000000000000001.5e0"};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; ++i) {
        char text[256];
        const double expected = strtod(numbers[i], NULL);
        camera_path path;
        heard h;
        report r = hear(&h);
        const int length = snprintf(text, sizeof text, "%s 0 0 1 0 0 0 1 0 60 1 1 2\n", numbers[i]);
        assert_int_equal(camera_path_parse("t.views", text, (size_t)length, allocator_heap(), &r, &path), RESULT_OK);
        assert_memory_equal(&path.cameras[0].eye[0], &expected, sizeof expected);
        camera_path_free(&path, allocator_heap());
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_box_is_one_item_of_six_polygons_that_look_out),
        cmocka_unit_test(a_flat_box_keeps_the_sides_that_have_area),
        cmocka_unit_test(each_fault_has_its_line),
        cmocka_unit_test(numbers_are_the_nearest_doubles_however_long),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
