// JSON scenes that are too much: each is refused at once, with the place that asks for it; files are read once however often named.
// SPDX-License-Identifier: MIT
#include "json_support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define HEAD "{\"portcullis\": 1,\n"
#define BOX "\"boxes\": [{\"min\": [0,0,0], \"max\": [1,1,1]}]"

#define TRIANGLE "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"

// ---- Files that are counted ----

typedef struct counted_files { import_files from; uint32_t reads; } counted_files;

static result read_counted(void *user, const char *path, const allocator *memory, report *r, char **out_text, size_t *out_size)
{
    counted_files *c = user;
    c->reads++;
    return c->from.read(c->from.user, path, memory, r, out_text, out_size);
}

// A text that grows on the heap.
typedef struct long_text { char *text; size_t size, capacity; } long_text;

static void add(long_text *t, const char *more)
{
    const size_t length = strlen(more);
    if (t->size + length + 1 > t->capacity) {
        t->capacity = 2 * (t->size + length + 1);
        char *grown = realloc(t->text, t->capacity);
        assert_non_null(grown);
        t->text = grown;
    }
    memcpy(t->text + t->size, more, length + 1);
    t->size += length;
}

static uint32_t reads_of(const char *text, const memory_file *files)
{
    heard h;
    report r = hear(&h);
    scene *s = NULL;
    counted_files counted = {memory_files(files), 0};
    const import_files from = {read_counted, &counted};
    if (import_json("t.json", text, strlen(text), &doors_open, &from, allocator_heap(), &r, &s) != RESULT_OK) fail_msg("%s", h.text);
    scene_free(s, allocator_heap());
    return counted.reads;
}

static void a_file_is_read_once_however_often_it_is_named(void **state)
{
    (void)state;
    const memory_file files[] = {{"h.json", HEAD BOX ", \"meshes\": [{\"file\": \"t.obj\"}]}"}, {"t.obj", TRIANGLE}, {0}};
    assert_int_equal(reads_of(HEAD "\"include\": [{\"file\": \"h.json\"}, {\"file\": \"./h.json\", \"at\": [5,0,0]}, {\"file\": \"t.obj\"}],\n"
                                   "\"meshes\": [{\"file\": \"t.obj\", \"repeat\": {\"count\": 9, \"step\": [2,0,0]}}, {\"file\": \"t.obj\"}]}",
                              files),
                     2);
}

static void a_mesh_that_is_shared_has_the_bits_of_one_read_alone(void **state)
{
    (void)state;
    static const char obj[] = "o a\nv 0 0 0\nv 1 0.1 0\nv 0 1 0.3\nvn 0.6 0 0.8\nf 1//1 2//1 3//1\no b\nusemtl m\nv 0 0 7\nf 1 2 4\n";
    const memory_file once[] = {{"t.obj", obj}, {0}}, thrice[] = {{"t.obj", obj}, {"u.obj", obj}, {"v.obj", obj}, {0}};
    scene *shared = json_of(HEAD
                            "\"meshes\": [{\"file\": \"t.obj\"}, {\"file\": \"t.obj\", \"at\": [3,0,0]},"
                            " {\"file\": \"t.obj\", \"turn\": [0,90,0], \"at\": [0,9,0]}]}", once);
    scene *apart = json_of(HEAD
                            "\"meshes\": [{\"file\": \"t.obj\"}, {\"file\": \"u.obj\", \"at\": [3,0,0]},"
                            " {\"file\": \"v.obj\", \"turn\": [0,90,0], \"at\": [0,9,0]}]}", thrice);
    assert_same_scene(shared, apart);
    assert_memory_equal(shared->normals, apart->normals, shared->position_count * sizeof *shared->normals);
    assert_true(shared->hash == apart->hash);
    assert_int_equal(shared->object_count, 6);
    scene *plain = NULL;
    heard h;
    report r = hear(&h);
    assert_int_equal(import_obj("t.obj", obj, sizeof obj - 1, allocator_heap(), &r, &plain), RESULT_OK);
    scene *one = json_of(HEAD "\"meshes\": [{\"file\": \"t.obj\"}]}", once);
    assert_true(one->hash == plain->hash);
    assert_memory_equal(one->normals, plain->normals, one->position_count * sizeof *one->normals);
    scene *const all[] = {shared, apart, plain, one};
    for (int i = 0; i < 4; ++i) scene_free(all[i], allocator_heap());
}

// ---- Limits ----

static void copies_beyond_what_a_scene_holds_are_refused_before_one_is_made(void **state)
{
    (void)state;
    long_text obj = {0};
    add(&obj, "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
    for (int i = 0; i < 4000; ++i) add(&obj, "f 1 2 3\n");
    const memory_file files[] = {{"t.obj", obj.text}, {0}};
    expect_json_error(HEAD "\"meshes\": [{\"file\": \"t.obj\"},\n"
                           "{\"file\": \"t.obj\", \"repeat\": {\"count\": 65536, \"step\": [0.001,0,0]}}]}", files,
                      "t.json:3:1: error: /meshes/1: 65536 times 12000 triangles or vertices; "
                      "a scene holds 200000000, so use fewer copies or a simpler file");
    free(obj.text);
}

static void includes_that_stand_for_too_much_text_are_refused(void **state)
{
    (void)state;
    long_text note = {0}, top = {0};
    add(&note, HEAD "\"note\": \"");
    for (int i = 0; i < 32768; ++i) add(&note, "0123456789abcdef0123456789abcdef0123456789abcdef0123456789abcdef");
    add(&note, "\"}");
    add(&top, HEAD BOX ", \"include\": [");
    for (int i = 0; i < 600; ++i) add(&top, i ? ",\n{\"file\": \"n.json\"}" : "\n{\"file\": \"n.json\"}");
    add(&top, "]}");
    const memory_file files[] = {{"n.json", note.text}, {0}};
    expect_json_error(top.text, files, // the 512th of 2 MiB and some bytes
                      "t.json:514:10: error: /include/511/file: with this, all includes together stand for over 1073741824 bytes of JSON; "
                      "include fewer or smaller scenes");
    free(note.text);
    free(top.text);
}

static void a_coordinate_beyond_the_world_is_told_at_its_entry(void **state)
{
    (void)state;
    const memory_file files[] = {{"h.json", HEAD BOX "}"}, {"t.obj", TRIANGLE}, {0}};
    expect_json_error(HEAD "\"include\": [{\"file\": \"h.json\", \"at\": [1e9,0,0]}]}", files,
                      "h.json:2:11: error: /boxes/0: a coordinate beyond 1e9 m; move this nearer to the scene's origin");
    expect_json_error(HEAD "\"meshes\": [{\"file\": \"t.obj\", \"at\": [0,1e9,0]}]}", files,
                      "t.json:2:12: error: /meshes/0: a coordinate beyond 1e9 m; move this nearer to the scene's origin");
}

static void a_scene_too_wide_is_told_at_the_entry_that_makes_it_so(void **state)
{
    (void)state;
    expect_json_error(HEAD "\"boxes\": [{\"min\": [0,0,0], \"max\": [1,1,1]},\n {\"min\": [40000,0,0], \"max\": [40001,1,1]}]}", NULL,
                      "t.json:3:2: error: /boxes/1: with this the scene is 40001 m wide; one zone holds 32,768 m at 1 mm, so split or scale it");
}

static void names_grow_with_includes_up_to_a_limit(void **state)
{
    (void)state;
    char name[1001], inner[1200], text[1200];
    memset(name, 'n', 1000);
    name[1000] = 0;
    snprintf(inner, sizeof inner, HEAD BOX ",\n\"zones\": [{\"name\": \"%s\"}]}", name);
    memory_file files[] = {{"0.json", NULL}, {"1.json", NULL}, {"2.json", NULL}, {"3.json", inner}, {"9.json", NULL}, {0}};
    char texts[3][1200];
    for (int i = 0; i < 3; ++i) {
        snprintf(texts[i], sizeof texts[i], HEAD "\"include\": [{\"file\": \"%d.json\", \"name\": \"%s\"}]}", i + 1, name);
        files[i].text = texts[i];
    }
    scene *s = json_of(texts[0], files); // 3 prefixes and the name: 4,003 bytes
    assert_int_equal(strlen(s->zones[0].name), 4003);
    scene_free(s, allocator_heap());
    snprintf(text, sizeof text, HEAD "\"include\": [{\"file\": \"0.json\", \"name\": \"%.93s\"}]}", name);
    expect_json_error(text, files, "3.json:3:11: error: /zones/0: with the includes round it a name of over 4095 bytes; shorten it");
    char outer[1200];
    snprintf(outer, sizeof outer, HEAD "\"include\": [{\"file\": \"0.json\", \"name\": \"%s\"}]}", name);
    snprintf(text, sizeof text, HEAD "\"include\": [{\"file\": \"9.json\", \"name\": \"%s\"}]}", name);
    files[4].text = outer;
    expect_json_error(text, files, "2.json:2:40: error: /include/0/name: with the includes round it a name of over 4095 bytes; shorten it");
}

static void add_hull(long_text *t, int first)
{
    char point[64];
    add(t, first ? "[" : ",\n[");
    for (int i = 0; i < 64; ++i) { // two rings: 32 sides and two lids
        const int k = i % 32, quarter = k / 8, along = k % 8;
        const double arc = along / 8.0, u = (1 - arc) * (1 + arc), v = arc * (2 - arc); // convex, not round
        const double x = quarter == 0 ? u : quarter == 1 ? -v : quarter == 2 ? -u : v;
        const double z = quarter == 0 ? v : quarter == 1 ? u : quarter == 2 ? -v : -u;
        snprintf(point, sizeof point, "%s[%.6f,%d,%.6f]", i ? "," : "", x, i / 32, z);
        add(t, point);
    }
    add(t, "]");
}

static void hulls_of_more_points_than_can_be_worked_through_are_refused(void **state)
{
    (void)state;
    long_text t = {0};
    add(&t, HEAD BOX ",\n\"zones\": [{\"name\": \"a\", \"hulls\": [");
    for (int i = 0; i < 1601; ++i) add_hull(&t, i == 0);
    add(&t, "]}]}");
    heard h;
    report r = hear(&h);
    scene *s = NULL;
    assert_int_equal(import_json("t.json", t.text, t.size, &doors_open, NULL, allocator_heap(), &r, &s), RESULT_BAD_INPUT);
    assert_non_null(strstr(h.text, "error: /zones/0/hulls/1600: over 1,600 hulls of 64 points, or their like, in one scene; "
                                   "use boxes, or fewer points a hull"));
    free(t.text);
}

// ---- A portal's normal ----

static void a_normal_tells_the_sides_that_zones_do_not(void **state)
{
    (void)state;
    static const char text[] = HEAD BOX ",\n\"zones\": [{\"name\": \"a\", \"box\": [[0,0,0],[0.001,1,1]]},\n"
                               "{\"name\": \"b\", \"box\": [[0.001,0,0],[0.002,1,1]]}],\n"
                               "\"portals\": [{\"zones\": [\"a\", \"b\"], \"points\": [[0.001,0,0],[0.001,1,0],[0.001,1,1],[0.001,0,1]],\n"
                               "\"normal\": [%s,0,0]}]}";
    char towards[sizeof text + 8];
    snprintf(towards, sizeof towards, text, "-1");
    scene *s = json_of(towards, NULL);
    assert_int_equal(s->portal_count, 1);
    assert_true(s->portals[0].plane[0] < 0); // towards a
    scene_free(s, allocator_heap());
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_file_is_read_once_however_often_it_is_named),
        cmocka_unit_test(a_mesh_that_is_shared_has_the_bits_of_one_read_alone),
        cmocka_unit_test(copies_beyond_what_a_scene_holds_are_refused_before_one_is_made),
        cmocka_unit_test(includes_that_stand_for_too_much_text_are_refused),
        cmocka_unit_test(a_coordinate_beyond_the_world_is_told_at_its_entry),
        cmocka_unit_test(a_scene_too_wide_is_told_at_the_entry_that_makes_it_so),
        cmocka_unit_test(names_grow_with_includes_up_to_a_limit),
        cmocka_unit_test(hulls_of_more_points_than_can_be_worked_through_are_refused),
        cmocka_unit_test(a_normal_tells_the_sides_that_zones_do_not),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
