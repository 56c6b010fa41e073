// JSON scenes under attack: each byte of a good file dropped or changed, each allocation failing. Always a scene or one line.
// SPDX-License-Identifier: MIT
// jansson's own allocations are excepted from the fault loop: its allocator is one for the whole process, and not ours to set.
#include "json_support.h"

#include <stdio.h>
#include <string.h>

static const char good[] =
    "{\"portcullis\": 1, \"name\": \"n\", \"include\": [{\"file\": \"h.json\", \"name\": \"h\", \"at\": [20,0,0], \"turn\": [0,90,0], \"scale\": 2}, {\"file\": \"t.boxes\"}],\n"
    "\"meshes\": [{\"file\": \"t.obj\", \"at\": [0,5,0], \"repeat\": {\"count\": 2, \"step\": [0,1,0]}}],\n"
    "\"boxes\": [{\"name\": \"b\", \"min\": [0,0,0], \"max\": [4,3,5], \"material\": \"brick\", \"side\": \"in\", \"omit\": [\"+x\"]}],\n"
    "\"walls\": [{\"points\": [[4,0,0],[4,0,5],[4,3,5],[4,3,0]], \"material\": \"glass\"}],\n"
    "\"zones\": [{\"name\": \"out\"}, {\"name\": \"a\", \"box\": [[0,0,0],[4,3,5]], \"in\": \"out\", \"chain\": \"frustum[backface=1]\"},\n"
    " {\"name\": \"b\", \"hull\": [[4,0,0],[4,0,5],[4,3,5],[4,3,0],[8,0,0],[8,0,5],[8,3,0],[8,3,5]]}],\n"
    "\"portals\": [{\"zones\": [\"a\", \"b\"], \"points\": [[4,0,2],[4,0,3],[4,2,3],[4,2,2]], \"door\": \"d\"}],\n"
    "\"doors\": [{\"name\": \"d\", \"open\": true, \"mover\": \"m\"}],\n"
    "\"movers\": [{\"name\": \"m\", \"box\": {\"min\": [4,0,2], \"max\": [4,2,3]}, \"open\": [0,0,1], \"pivot\": [4,0,2]},\n"
    " {\"name\": \"c\", \"file\": \"t.obj\", \"path\": [{\"time\": 0}, {\"time\": 1, \"at\": [1,0,0], \"turn\": [0,90,0]}], \"loop\": true}],\n"
    "\"lights\": [{\"kind\": \"point\", \"at\": [1,2,3], \"reach\": 4, \"colour\": [1,1,0.5]}],\n"
    "\"paths\": [{\"name\": \"w\", \"views\": [{\"eye\": [1,1,1], \"forward\": [1,0,0], \"far\": \"inf\"}]}, {\"name\": \"f\", \"file\": \"t.views\"}]}\n";
static const memory_file files[] = {{"h.json", "{\"portcullis\": 1, \"boxes\": [{\"min\": [0,0,0], \"max\": [1,1,1]}], \"zones\": [{\"name\": \"r\", \"box\": [[0,0,0],[1,1,1]], \"in\": \"/out\"}],"
                                               "\"paths\": [{\"name\": \"w\", \"views\": [{\"eye\": [1,1,1], \"forward\": [1,0,0]}]}]}"},
                                    {"t.boxes", "boxes 1\n9 0 0 10 1 1\n"},
                                    {"t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"},
                                    {"t.views", "0 1.7 -120 0 0 1 0 1 0 60 1.5 0.1 10000\n"},
                                    {0}};

static result load(const char *text, size_t size, const allocator *memory, report *r)
{
    scene *s = NULL;
    const import_files from = memory_files(files);
    const result done = import_json("t.json", text, size, &doors_open, &from, memory, r, &s);
    assert_true((done == RESULT_OK) == (s != NULL));
    scene_free(s, memory);
    return done;
}

static unsigned scenes, refused;

static void try_text(const char *text, size_t size)
{
    heard h;
    report r = hear(&h);
    const result done = load(text, size, allocator_heap(), &r);
    assert_int_equal(r.errors, done == RESULT_OK ? 0 : 1);
    if (done == RESULT_OK) scenes++;
    else refused++;
}

static void the_good_file_is_good(void **state)
{
    (void)state;
    heard h;
    report r = hear(&h);
    const result done = load(good, sizeof good - 1, allocator_heap(), &r);
    if (done != RESULT_OK || r.warnings) fail_msg("%s", h.text);
}

static void each_byte_dropped_gives_a_scene_or_a_line(void **state)
{
    (void)state;
    char text[sizeof good];
    scenes = refused = 0;
    for (size_t i = 0; i + 1 < sizeof good; ++i) {
        memcpy(text, good, i);
        memcpy(text + i, good + i + 1, sizeof good - i - 1);
        try_text(text, sizeof good - 2);
    }
    assert_true(scenes > 100 && refused > 500);
}

static void each_byte_changed_gives_a_scene_or_a_line(void **state)
{
    (void)state;
    static const char with[] = {'0', '9', '-', 'e', '"', '[', '}', ',', 'x', '\0', '\xff'};
    char text[sizeof good];
    scenes = refused = 0;
    for (size_t i = 0; i + 1 < sizeof good; ++i) {
        memcpy(text, good, sizeof good);
        text[i] = with[i % sizeof with];
        try_text(text, sizeof good - 1);
    }
    assert_true(scenes > 50 && refused > 500);
}

static void each_length_cut_gives_a_line(void **state)
{
    (void)state;
    char text[sizeof good];
    for (size_t size = 1; size + 3 < sizeof good; ++size) {
        memcpy(text, good, size);
        text[size] = 0;
        heard h;
        report r = hear(&h);
        assert_int_equal(load(text, size, allocator_heap(), &r), RESULT_BAD_INPUT);
        assert_int_equal(r.errors, 1);
    }
}

static void deep_nesting_is_refused_without_a_deep_stack(void **state)
{
    (void)state;
    static char text[1 << 20];
    const int head = snprintf(text, sizeof text, "{\"portcullis\": 1, \"note\": ");
    memset(text + head, '[', sizeof text - (size_t)head - 1);
    try_text(text, sizeof text - 1);
    for (size_t i = (size_t)head; i + 6 < sizeof text; i += 5) memcpy(text + i, "{\"a\":", 5);
    try_text(text, sizeof text - 1);
}

static void it_survives_each_failed_allocation(void **state)
{
    (void)state;
    for (uint64_t fail_at = 1;; ++fail_at) {
        shaky_memory shaky = {.fail_at = fail_at};
        const allocator memory = shaky_allocator(&shaky);
        heard h;
        report r = hear(&h);
        const result done = load(good, sizeof good - 1, &memory, &r);
        assert_int_equal(shaky.live_bytes, 0);
        if (shaky.allocations < fail_at) {
            assert_int_equal(done, RESULT_OK);
            assert_true(fail_at > 100);
            return;
        }
        assert_int_equal(done, RESULT_NO_MEMORY);
        assert_int_equal(r.errors, 1);
        assert_non_null(strstr(h.text, "out of memory"));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_good_file_is_good),
        cmocka_unit_test(each_byte_dropped_gives_a_scene_or_a_line),
        cmocka_unit_test(each_byte_changed_gives_a_scene_or_a_line),
        cmocka_unit_test(each_length_cut_gives_a_line),
        cmocka_unit_test(deep_nesting_is_refused_without_a_deep_stack),
        cmocka_unit_test(it_survives_each_failed_allocation),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
