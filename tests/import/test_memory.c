// Every allocation of an import and of a path fails once: no crash, no leak, RESULT_NO_MEMORY and one line.
// SPDX-License-Identifier: MIT
#include "brushes.h"
#include "support.h"

#include <string.h>

typedef result (*load)(const allocator *memory, report *r); // leaves nothing allocated

static const char *map_source(void)
{
    static map_text m;
    const double low[3] = {0, 0, 0}, high[3] = {64, 64, 64};
    if (m.size) return m.text;
    map_add(&m, "{\n\"classname\" \"worldspawn\"\n");
    map_add_box(&m, low, high, "{grate");
    map_add_box(&m, low, high, "*water");
    map_add(&m, "}\n{\n\"classname\" \"func_door\"\n");
    map_add_box(&m, low, high, "door");
    map_add(&m, "}\n{ \"classname\" \"light\" \"origin\" \"100 10 10\" }\n");
    return m.text;
}

static result load_map(const allocator *memory, report *r)
{
    scene *s = NULL;
    const result done = import_map("t.map", map_source(), strlen(map_source()), &doors_open, memory, r, &s);
    assert_true((done == RESULT_OK) == (s != NULL));
    scene_free(s, memory);
    return done;
}

static result load_boxes(const allocator *memory, report *r)
{
    static const char text[] = "boxes 3\n0 0 0 1 1 1\n2 0 0 3 1 1\n4 0 0 5 3 1\n";
    scene *s = NULL;
    const result done = import_boxes("t.boxes", text, sizeof text - 1, memory, r, &s);
    assert_true((done == RESULT_OK) == (s != NULL));
    scene_free(s, memory);
    return done;
}

static result load_views(const allocator *memory, report *r)
{
    static const char text[] = "0 1.7 -120 0 0 1 0 1 0 60 1.777778 0.1 10000\n";
    camera_path path = {0};
    result done = camera_path_parse("t.views", text, sizeof text - 1, memory, r, &path);
    assert_true((done == RESULT_OK) == (path.cameras != NULL));
    char *written;
    size_t size;
    if (done == RESULT_OK) {
        done = camera_path_text(&path, memory, &written, &size); // says no words of its own
        if (done == RESULT_OK) memory_free(memory, written, size + 1, 1);
        else report_no_memory(r, "t.views");
    }
    camera_path_free(&path, memory);
    return done;
}

static result load_automatic(const char *what, const allocator *memory, report *r)
{
    scene *s = map_of(map_source(), &doors_open);
    camera_path path = {0};
    const result done = camera_path_load(what, s, 1.5, memory, r, &path);
    assert_true((done == RESULT_OK) == (path.cameras != NULL));
    camera_path_free(&path, memory);
    scene_free(s, allocator_heap());
    return done;
}

static result load_auto(const allocator *memory, report *r)
{
    return load_automatic("auto:5", memory, r);
}

static result load_walk(const allocator *memory, report *r)
{
    return load_automatic("auto:walk:400", memory, r);
}

static void fail_each(load what)
{
    for (uint64_t fail_at = 1;; ++fail_at) {
        shaky_memory shaky = {.fail_at = fail_at};
        const allocator memory = shaky_allocator(&shaky);
        heard h;
        report r = hear(&h);
        const result done = what(&memory, &r);
        assert_int_equal(shaky.live_bytes, 0);
        if (shaky.allocations < fail_at) {
            assert_int_equal(done, RESULT_OK);
            assert_true(fail_at > 2);
            return;
        }
        assert_int_equal(done, RESULT_NO_MEMORY);
        assert_int_equal(r.errors, 1);
        assert_non_null(strstr(h.text, "out of memory"));
    }
}

static void a_map_survives_each_failed_allocation(void **state)
{
    (void)state;
    fail_each(load_map);
}

static void boxes_survive_each_failed_allocation(void **state)
{
    (void)state;
    fail_each(load_boxes);
}

static void views_survive_each_failed_allocation(void **state)
{
    (void)state;
    fail_each(load_views);
    fail_each(load_auto);
    fail_each(load_walk);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_map_survives_each_failed_allocation),
        cmocka_unit_test(boxes_survive_each_failed_allocation),
        cmocka_unit_test(views_survive_each_failed_allocation),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
