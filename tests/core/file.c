// Tests of host/core/file: whole files in and out, or one line and nothing left behind.
// SPDX-License-Identifier: MIT
#define _XOPEN_SOURCE 700
#include "host/core/file.h"
#include "tests/common/failing_allocator.h"
#include "tests/common/report_lines.h"
#include "tests/common/scratch_folder.h"
#include "tests/common/test.h"

#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
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
    assert_true(report_lines_is_one_with(&f->lines, "taken: error: is a folder; name a file in it"));
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

// The size limit of a process stands for the full disk: the write fails part of the way.
static void a_write_that_runs_out_of_room_leaves_nothing(void **state)
{
    fixture *f = *state;
    struct rlimit before, small;
    static const char bytes[8192] = "";
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    small = before;
    small.rlim_cur = 4096;
    void (*const handler)(int) = signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
    const result done = write_name(f, "x", bytes, sizeof bytes);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
    signal(SIGXFSZ, handler);
    assert_int_equal(done, RESULT_BAD_INPUT);
    assert_true(report_lines_is_one_with(&f->lines, "x: error: cannot write it whole"));
    assert_int_equal(scratch_folder_count(&f->folder), 0);
}

static void a_device_is_written_to_and_stays_a_device(void **state)
{
    fixture *f = *state;
    struct stat status;
    char path[512];
    scratch_folder_name(&f->folder, "pipe", path, sizeof path);
    assert_int_equal(mkfifo(path, 0600), 0);
    const int reader = open(path, O_RDONLY | O_NONBLOCK);
    assert_true(reader >= 0);
    assert_int_equal(write_name(f, "pipe", "abc", 3), RESULT_OK);
    char got[8];
    assert_int_equal(read(reader, got, sizeof got), 3);
    close(reader);
    assert_int_equal(stat(path, &status), 0);
    assert_true(S_ISFIFO(status.st_mode));
}

static void a_link_is_followed_and_the_mode_kept(void **state)
{
    fixture *f = *state;
    struct stat status;
    char link_path[512], file_path[512];
    scratch_folder_name(&f->folder, "link", link_path, sizeof link_path);
    scratch_folder_name(&f->folder, "file", file_path, sizeof file_path);
    assert_int_equal(write_name(f, "file", "old", 3), RESULT_OK);
    assert_int_equal(chmod(file_path, 0600), 0);
    assert_int_equal(symlink(file_path, link_path), 0);
    assert_int_equal(write_name(f, "link", "new!", 4), RESULT_OK);
    assert_int_equal(lstat(link_path, &status), 0);
    assert_true(S_ISLNK(status.st_mode));
    assert_int_equal(stat(file_path, &status), 0);
    assert_int_equal(status.st_size, 4);
    assert_int_equal(status.st_mode & 0777, 0600);
    assert_int_equal(scratch_folder_count(&f->folder), 2);
}

static void what_cannot_be_written_is_known_before(void **state)
{
    fixture *f = *state;
    char path[512];
    scratch_folder_name(&f->folder, "new", path, sizeof path);
    assert_int_equal(file_can_write(path, &f->lines.report), RESULT_OK);
    assert_int_equal(scratch_folder_count(&f->folder), 0);
    scratch_folder_name(&f->folder, "missing/new", path, sizeof path);
    assert_int_equal(file_can_write(path, &f->lines.report), RESULT_BAD_INPUT);
    assert_true(report_lines_is_one_with(&f->lines, "missing/new: error: cannot be written: "));
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
        TEST(a_write_that_runs_out_of_room_leaves_nothing),
        TEST(a_device_is_written_to_and_stays_a_device),
        TEST(a_link_is_followed_and_the_mode_kept),
        TEST(what_cannot_be_written_is_known_before),
    };
    return cmocka_run_group_tests_name("core file", tests, NULL, NULL);
}
