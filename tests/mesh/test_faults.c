// Exhausted memory: allocation 1, 2, 3, ... of the host and of OpenMesh fails; nothing crashes, leaks or is half made.
// SPDX-License-Identifier: MIT
#include "fixture.h"

#include "counting_new.h"
#include "tests/common/failing_allocator.h"

#include <stdio.h>
#include <string.h>

typedef struct sample { const char *path, *text; } sample;

static const sample SAMPLES[] = {
    {"a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 2 0 0\nv .5 .2 0\nvt 0 0\no first\nusemtl a\nf 1 2 3 4\nf 1/1 3/1 2/1\nusemtl b\nf 1 2 5\nf 2 1 6\n"
              "f 1 2 7 3 4\no second\nf 1 2 3\nf 1 3 2\nf 1 2 6\nf 1 2 4\nf 1 2 3 1 5\n"},
    {"a.off", "OFF\n4 3 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n4 0 1 2 3\n3 1 0 2\n"},
    {"a.ply", "ply\nformat ascii 1.0\nelement vertex 4\nproperty int x\nproperty int y\nproperty int z\nelement face 2\nproperty list uchar int vertex_index\n"
              "end_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n3 0 2 3\n"},
    {"faults.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n"},
};
enum { SAMPLE_COUNT = sizeof SAMPLES / sizeof *SAMPLES };

static result import_sample(const sample *s, failing_allocator *heap, captured *c, scene **out)
{
    captured_open(c);
    *out = NULL;
    return import_bytes(s->path, s->text, strlen(s->text), &heap->memory, &c->report, out);
}

static int can_read(const sample *s)
{
    failing_allocator heap;
    captured c;
    scene *out;
    failing_allocator_init(&heap, 0);
    new_fails_at(0);
    const result done = import_sample(s, &heap, &c, &out); // and what libraries keep for good is allocated from now on
    scene_free(out, &heap.memory);
    assert_true(failing_allocator_is_clean(&heap));
    return done == RESULT_OK || strstr(c.text, "built without OpenMesh") == NULL;
}

// Many clusters too: a field of triangles.
static void fill_field(char *text, size_t size)
{
    enum { SIDE = 14 };
    size_t used = 0;
    for (int i = 0; i < SIDE * SIDE; ++i) used += (size_t)snprintf(text + used, size - used, "v %d 0 %d\n", i % SIDE, i / SIDE);
    for (int i = 0; i + SIDE + 1 < SIDE * SIDE; ++i) used += (size_t)snprintf(text + used, size - used, "f %d %d %d\n", i + 1, i + 2, i + SIDE + 1);
    assert_true(used < size);
}

static void fail_each_host_allocation(const sample *s)
{
    if (!can_read(s)) return;
    const long live = new_live();
    for (long k = 1;; ++k) {
        failing_allocator heap;
        captured c;
        scene *out;
        failing_allocator_init(&heap, (uint64_t)k);
        const result done = import_sample(s, &heap, &c, &out);
        if (heap.failures == 0) {
            assert_int_equal(done, RESULT_OK);
            scene_free(out, &heap.memory);
            assert_true(failing_allocator_is_clean(&heap));
            assert_true(k > 20);
            return;
        }
        assert_int_equal(done, RESULT_NO_MEMORY);
        assert_null(out);
        assert_true(failing_allocator_is_clean(&heap));
        assert_int_equal(new_live(), live);
        assert_non_null(strstr(c.text, "out of memory"));
    }
}

static void fail_each_new(const sample *s)
{
    if (!can_read(s)) return;
    const long live = new_live();
    for (long k = 1;; ++k) {
        failing_allocator heap;
        captured c;
        scene *out;
        failing_allocator_init(&heap, 0);
        new_fails_at(k);
        const result done = import_sample(s, &heap, &c, &out);
        const int has_failed = new_calls() >= k;
        new_fails_at(0);
        scene_free(out, &heap.memory);
        assert_true(failing_allocator_is_clean(&heap));
        assert_int_equal(new_live(), live);
        if (!has_failed) {
            assert_int_equal(done, RESULT_OK);
            return;
        }
        assert_int_equal(done, RESULT_NO_MEMORY);
        assert_null(out);
    }
}

static void each_failed_allocation_of_the_host_is_told_and_leaves_nothing(void **state)
{
    static char field[16384];
    (void)state;
    for (int i = 0; i < SAMPLE_COUNT; ++i) fail_each_host_allocation(&SAMPLES[i]);
    fill_field(field, sizeof field);
    const sample s = {"field.obj", field};
    fail_each_host_allocation(&s);
}

static void each_failed_new_is_told_and_leaves_nothing(void **state)
{
    static char field[16384];
    (void)state;
    for (int i = 0; i < SAMPLE_COUNT; ++i) fail_each_new(&SAMPLES[i]);
    fill_field(field, sizeof field);
    const sample s = {"field.obj", field};
    fail_each_new(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_failed_allocation_of_the_host_is_told_and_leaves_nothing),
        cmocka_unit_test(each_failed_new_is_told_and_leaves_nothing),
    };
    return cmocka_run_group_tests_name("faults", tests, NULL, NULL);
}
