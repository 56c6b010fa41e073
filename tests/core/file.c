// Tests of host/core/file: whole files in and out, or one line and nothing left behind.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "host/core/file.h"
#include "tests/common/failing_allocator.h"
#include "tests/common/report_lines.h"
#include "tests/common/scratch_folder.h"
#include "tests/common/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

typedef struct fixture {
    scratch_folder folder;
    failing_allocator memory;
    report_lines lines;
    char *bytes;
    size_t size;
} fixture;

static int set_up(void **state)
{
    fixture *f = *state = calloc(1, sizeof(fixture));
    if (!f) return 1;
    scratch_folder_make(&f->folder);
    failing_allocator_init(&f->memory, 0);
    report_lines_init(&f->lines);
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    const int clean = failing_allocator_is_clean(&f->memory);
    scratch_folder_remove(&f->folder);
    free(f);
    return clean ? 0 : 1;
}

static result read_name(fixture *f, const char *name)
{
    char path[512];
    scratch_folder_name(&f->folder, name, path, sizeof path);
    return file_read(path, &f->memory.memory, &f->lines.report, &f->bytes, &f->size);
}

static result write_name(fixture *f, const char *name, const void *bytes, size_t size)
{
    char path[512];
    scratch_folder_name(&f->folder, name, path, sizeof path);
    return file_write(path, bytes, size, &f->lines.report);
}

static void what_is_written_is_read_back_with_a_zero_behind_it(void **state)
{
    fixture *f = *state;
    static const char bytes[] = "a\0b\nc";
    const size_t sizes[] = {5, 0}; // the second goes over the first
    for (size_t i = 0; i < 2; ++i) {
        assert_int_equal(write_name(f, "x", bytes, sizes[i]), RESULT_OK);
        assert_int_equal(read_name(f, "x"), RESULT_OK);
        assert_int_equal(f->size, sizes[i]);
        assert_memory_equal(f->bytes, bytes, sizes[i]);
        assert_int_equal(f->bytes[f->size], 0);
        memory_free(&f->memory.memory, f->bytes, f->size + 1, 1);
        assert_int_equal(scratch_folder_count(&f->folder), 1); // no temporary file
    }
    assert_int_equal(f->lines.count, 0);
}

static void a_missing_file_is_one_line_with_its_name(void **state)
{
    fixture *f = *state;
    assert_int_equal(read_name(f, "nothing"), RESULT_BAD_INPUT);
    assert_true(report_lines_is_one_with(&f->lines, "nothing: error: cannot open it: "));
}

static void a_folder_is_not_read(void **state)
{
    fixture *f = *state;
    assert_int_equal(read_name(f, "."), RESULT_BAD_INPUT);
    assert_true(report_lines_is_one_with(&f->lines, "not a regular file"));
}

static void a_pipe_without_a_writer_does_not_block(void **state)
{
    fixture *f = *state;
    char path[512];
    scratch_folder_name(&f->folder, "pipe", path, sizeof path);
    assert_int_equal(mkfifo(path, 0600), 0);
    alarm(20); // ends the test if it does
    assert_int_equal(read_name(f, "pipe"), RESULT_BAD_INPUT);
    alarm(0);
    assert_true(report_lines_is_one_with(&f->lines, "not a regular file"));
}

static void reading_without_memory_is_one_line(void **state)
{
    fixture *f = *state;
    assert_int_equal(write_name(f, "x", "abc", 3), RESULT_OK);
    f->memory.fail_at = 1;
    assert_int_equal(read_name(f, "x"), RESULT_NO_MEMORY);
    assert_true(report_lines_is_one_with(&f->lines, "out of memory"));
}

static void writing_into_a_missing_folder_leaves_nothing(void **state)
{
    fixture *f = *state;
    assert_int_equal(write_name(f, "missing/x", "abc", 3), RESULT_BAD_INPUT);
    assert_true(report_lines_is_one_with(&f->lines, "missing/x: error: cannot write it: "));
    assert_int_equal(scratch_folder_count(&f->folder), 0);
}

static void writing_over_a_folder_leaves_only_the_folder(void **state)
{
    fixture *f = *state;
    char path[512];
    scratch_folder_name(&f->folder, "taken", path, sizeof path);
    assert_int_equal(mkdir(path, 0700), 0);
    assert_int_equal(write_name(f, "taken", "abc", 3), RESULT_BAD_INPUT);
    assert_true(report_lines_is_one_with(&f->lines, "taken: error: cannot write it whole"));
    assert_int_equal(scratch_folder_count(&f->folder), 1);
}

static void a_name_of_any_length_is_refused_or_written(void **state)
{
    fixture *f = *state;
    static char name[8000];
    memset(name, 'n', sizeof name - 1);
    assert_int_equal(file_write(name, "abc", 3, &f->lines.report), RESULT_BAD_INPUT);
    assert_true(report_lines_is_one_with(&f->lines, "nnn: error: the name is too long"));
}

static void a_full_disk_leaves_nothing(void **state)
{
    fixture *f = *state;
    if (access("/dev/full", W_OK) != 0) {
        fprintf(stderr, "core file: no /dev/full here, the full disk is not tested\n");
        skip();
    }
    char path[512];
    scratch_folder_name(&f->folder, "x.part", path, sizeof path); // what file_write opens first
    assert_int_equal(symlink("/dev/full", path), 0);
    assert_int_equal(write_name(f, "x", "abc", 3), RESULT_BAD_INPUT);
    assert_true(report_lines_is_one_with(&f->lines, "x: error: cannot write it whole"));
    assert_int_equal(scratch_folder_count(&f->folder), 0);
}

int main(void)
{
#define TEST(t) cmocka_unit_test_setup_teardown(t, set_up, tear_down)
    const struct CMUnitTest tests[] = {
        TEST(what_is_written_is_read_back_with_a_zero_behind_it),
        TEST(a_missing_file_is_one_line_with_its_name),
        TEST(a_folder_is_not_read),
        TEST(a_pipe_without_a_writer_does_not_block),
        TEST(reading_without_memory_is_one_line),
        TEST(writing_into_a_missing_folder_leaves_nothing),
        TEST(writing_over_a_folder_leaves_only_the_folder),
        TEST(a_name_of_any_length_is_refused_or_written),
        TEST(a_full_disk_leaves_nothing),
    };
    return cmocka_run_group_tests_name("core file", tests, NULL, NULL);
}
