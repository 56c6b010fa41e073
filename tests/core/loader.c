// Tests of the plugin loader: where it looks, what it opens, what it refuses and how it says so.
// SPDX-License-Identifier: MIT
#define _XOPEN_SOURCE 700
#include "host/core/loader.h"
#include "tests/common/failing_allocator.h"
#include "tests/common/report_lines.h"
#include "tests/common/scratch_folder.h"
#include "tests/common/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { BUILTIN = 3 }; // none, brute and flood

typedef struct fixture {
    failing_allocator memory;
    report_lines lines;
    scratch_folder folder;
    loader *plugins;
} fixture;

static int set_up(void **state)
{
    fixture *f = *state = calloc(1, sizeof(fixture));
    if (!f) return 1;
    failing_allocator_init(&f->memory, 0);
    report_lines_init(&f->lines);
    scratch_folder_make(&f->folder);
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    loader_close(f->plugins);
    scratch_folder_remove(&f->folder);
    const int clean = failing_allocator_is_clean(&f->memory);
    free(f);
    return clean ? 0 : 1;
}

typedef struct places { const char *file, *folders[3]; } places;

static void open_at(fixture *f, places p)
{
    loader_options o = {.files = &p.file, .folders = p.folders, .file_count = p.file != NULL};
    while (o.folder_count < 3 && p.folders[o.folder_count]) o.folder_count++;
    assert_int_equal(loader_open(&o, &f->memory.memory, &f->lines.report, &f->plugins), RESULT_OK);
}

static result find(fixture *f, const char *id)
{
    const cull_plugin *p = NULL;
    const result done = loader_find(f->plugins, id, &f->lines.report, &p);
    if (done == RESULT_OK) assert_string_equal(p->descriptor->id, id);
    else assert_null(p);
    return done;
}

static const loaded_plugin *loaded(const fixture *f, const char *id)
{
    uint32_t count;
    const loaded_plugin *all = loader_plugins(f->plugins, &count);
    for (uint32_t i = 0; i < count; ++i)
        if (strcmp(all[i].plugin->descriptor->id, id) == 0) return &all[i];
    return NULL;
}

static const char *reason_of(const fixture *f, const char *path)
{
    uint32_t count;
    const refused_plugin *all = loader_refusals(f->plugins, &count);
    for (uint32_t i = 0; i < count; ++i)
        if (strcmp(all[i].path, path) == 0) return all[i].reason;
    return "(not refused)";
}

static const char *more_of(const char *place, char *path, size_t size) // the path of testmore in the folders _first, _second
{
    snprintf(path, size, "%s%s/testmore.culler.so", TEST_PLUGINS, place);
    return path;
}

// ---- Where it looks ----

static void the_built_in_cullers_need_no_library(void **state)
{
    fixture *f = *state;
    open_at(f, (places){.folders = {TEST_PLUGINS}});
    assert_int_equal(find(f, "none"), RESULT_OK);
    assert_int_equal(find(f, "brute"), RESULT_OK);
    assert_null(loaded(f, "brute")->path);
    assert_int_equal(loader_libraries_open(f->plugins), 0);
}

static void only_the_named_library_is_opened(void **state)
{
    fixture *f = *state;
    uint32_t count;
    open_at(f, (places){.folders = {REFUSED_PLUGINS, TEST_PLUGINS}});
    for (int again = 0; again < 2; ++again) {
        assert_int_equal(find(f, "testmore"), RESULT_OK);
        assert_int_equal(loader_libraries_open(f->plugins), 1);
        (void)loader_refusals(f->plugins, &count);
        assert_int_equal(count, 0);
    }
    assert_int_equal(find(f, "testfilter"), RESULT_OK);
    assert_int_equal(loader_libraries_open(f->plugins), 2);
    assert_int_equal(f->lines.count, 0);
}

static void a_culler_in_a_library_of_another_name_is_found(void **state)
{
    fixture *f = *state;
    open_at(f, (places){.folders = {TEST_PLUGINS}});
    assert_int_equal(find(f, "testcross-too"), RESULT_OK);
    assert_string_equal(loaded(f, "testcross-too")->path, TEST_PLUGINS "/testcross.culler.so");
}

static void the_first_folder_wins(void **state)
{
    fixture *f = *state;
    char wanted[512];
    open_at(f, (places){.folders = {TEST_PLUGINS "_missing", TEST_PLUGINS "_first", TEST_PLUGINS "_second"}});
    assert_int_equal(find(f, "testmore"), RESULT_OK);
    assert_string_equal(loaded(f, "testmore")->path, more_of("_first", wanted, sizeof wanted));
    uint32_t count;
    (void)loader_refusals(f->plugins, &count);
    assert_int_equal(count, 0); // the second was not even looked at
}

static void one_file_by_two_paths_is_one(void **state)
{
    fixture *f = *state;
    char link[512], wanted[512], folder[512];
    uint32_t count;
    scratch_folder_name(&f->folder, "linked.culler.so", link, sizeof link);
    assert_int_equal(symlink(more_of("_first", wanted, sizeof wanted), link), 0);
    snprintf(folder, sizeof folder, "%s_first/../%s_first", TEST_PLUGINS, strrchr(TEST_PLUGINS, '/') + 1);
    open_at(f, (places){.folders = {TEST_PLUGINS "_first", folder, f->folder.path}});
    assert_int_equal(loader_scan(f->plugins, &f->lines.report), RESULT_OK);
    assert_string_equal(loaded(f, "testmore")->path, wanted);
    assert_int_equal(loader_libraries_open(f->plugins), 1);
    (void)loader_refusals(f->plugins, &count);
    assert_int_equal(count, 0);
    loader_close(f->plugins);
    open_at(f, (places){.folders = {REFUSED_PLUGINS, REFUSED_PLUGINS "/.", REFUSED_PLUGINS}});
    assert_int_equal(loader_scan(f->plugins, &f->lines.report), RESULT_OK);
    (void)loader_refusals(f->plugins, &count);
    loader_close(f->plugins);
    uint32_t once;
    open_at(f, (places){.folders = {REFUSED_PLUGINS}});
    assert_int_equal(loader_scan(f->plugins, &f->lines.report), RESULT_OK);
    (void)loader_refusals(f->plugins, &once);
    assert_int_equal(count, once);
}

static void an_explicit_file_wins_over_the_folders(void **state)
{
    fixture *f = *state;
    char wanted[512];
    open_at(f, (places){more_of("_second", wanted, sizeof wanted), {TEST_PLUGINS "_first", TEST_PLUGINS}});
    assert_int_equal(find(f, "testmore"), RESULT_OK);
    assert_string_equal(loaded(f, "testmore")->path, wanted);
    assert_int_equal(loader_libraries_open(f->plugins), 1);
}

static void a_bad_library_does_not_hide_a_good_one_behind_it(void **state)
{
    fixture *f = *state;
    char bad[512];
    scratch_folder_write(&f->folder, "testmore.culler.so", "not a library", 13);
    scratch_folder_name(&f->folder, "testmore.culler.so", bad, sizeof bad);
    open_at(f, (places){.folders = {f->folder.path, TEST_PLUGINS}});
    assert_int_equal(find(f, "testmore"), RESULT_OK);
    assert_string_equal(loaded(f, "testmore")->path, TEST_PLUGINS "/testmore.culler.so");
    assert_string_not_equal(reason_of(f, bad), "(not refused)");
}

static void the_current_folder_is_never_searched(void **state)
{
    fixture *f = *state;
    char before[4096];
    assert_non_null(getcwd(before, sizeof before));
    assert_int_equal(chdir(TEST_PLUGINS), 0);
    open_at(f, (places){.folders = {"", ""}}); // an empty name is not the current folder either
    assert_int_equal(find(f, "testmore"), RESULT_BAD_INPUT);
    assert_int_equal(loader_scan(f->plugins, &f->lines.report), RESULT_OK);
    assert_int_equal(loader_libraries_open(f->plugins), 0);
    assert_int_equal(chdir(before), 0);
}

static void an_explicit_file_without_a_slash_is_a_file_here(void **state)
{
    fixture *f = *state;
    char before[4096];
    assert_non_null(getcwd(before, sizeof before));
    assert_int_equal(chdir(TEST_PLUGINS), 0);
    open_at(f, (places){.file = "testmore.culler.so"});
    assert_int_equal(find(f, "testmore"), RESULT_OK);
    assert_int_equal(chdir(before), 0);
}

// ---- What it says ----

static void a_missing_culler_s_line_lists_those_found(void **state)
{
    fixture *f = *state;
    open_at(f, (places){.folders = {TEST_PLUGINS}});
    assert_int_equal(find(f, "missing"), RESULT_BAD_INPUT);
    assert_true(report_lines_is_one_with(&f->lines, "no culler 'missing'; found: none, brute, flood, testbad, testcross, testcross-too, testfilter, testmore, testorder, testpicture"));
}

static void a_refused_culler_s_line_gives_the_reason(void **state)
{
    fixture *f = *state;
    open_at(f, (places){.folders = {REFUSED_PLUGINS}});
    char line[512];
    snprintf(line, sizeof line, "%s/abi-next.culler.so: error: refused: it is of ABI number %u, this host of %u", REFUSED_PLUGINS, CULL_ABI + 1, CULL_ABI);
    assert_int_equal(find(f, "abi-next"), RESULT_BAD_INPUT);
    assert_true(report_lines_is_one_with(&f->lines, line));
}

static void a_missing_culler_s_line_names_what_was_refused(void **state)
{
    fixture *f = *state;
    scratch_folder_write(&f->folder, "x.culler.so", "text", 4);
    open_at(f, (places){.folders = {f->folder.path}});
    assert_int_equal(find(f, "missing"), RESULT_BAD_INPUT);
    assert_true(report_lines_is_one_with(&f->lines, "no culler 'missing'; found: none, brute, flood; refused, see `portcullis plugins`: x.culler.so."));
}

static void a_name_that_no_culler_can_have_is_refused_at_once(void **state)
{
    fixture *f = *state;
    static const char *const names[] = {"", "Octree", "../testmore", "oct ree", "a123456789b123456789c123456789d123456789e123456789f123456789g123"};
    open_at(f, (places){.folders = {TEST_PLUGINS}});
    for (size_t i = 0; i < sizeof names / sizeof *names; ++i) {
        report_lines_init(&f->lines);
        assert_int_equal(find(f, names[i]), RESULT_BAD_INPUT);
        assert_true(report_lines_is_one_with(&f->lines, "is no culler's name"));
    }
    assert_int_equal(loader_libraries_open(f->plugins), 0);
}

// ---- What it refuses ----

static void every_unsound_library_is_refused_with_its_reason(void **state)
{
    fixture *f = *state;
    static const char *const cases[][2] = {
        {"no-symbol", "no symbol cull_entry"}, {"abi-next", "ABI number"}, {"abi-most", "ABI number 4294967295,"},
        {"no-table", "lists no plugin"}, {"no-plugin", "lists no plugin"}, {"many-plugins", "over 64"}, {"null-plugin", "NULL plugin"},
        {"no-descriptor", "no descriptor"}, {"no-create", "is NULL"}, {"no-destroy", "is NULL"}, {"no-build", "is NULL"}, {"no-open", "is NULL"},
        {"no-close", "is NULL"}, {"no-extension", "is NULL"}, {"no-verb", "no verb"}, {"id-null", "an id is"}, {"id-empty", "an id is"},
        {"id-capital", "an id is"}, {"id-long", "an id is"}, {"id-taken", "taken by a culler found before"}, {"id-twice", "an id twice"},
        {"no-version", "no version or summary"}, {"no-summary", "no version or summary"}, {"option-twice", "an option stands twice"},
        {"option-no-key", "no key, fallback or help"}, {"option-no-fallback", "no key, fallback or help"},
        {"option-no-help", "no key, fallback or help"}, {"options-missing", "option table"}, {"options-many", "option table"},
    };
    enum { CASES = sizeof cases / sizeof *cases };
    uint32_t count;
    open_at(f, (places){.folders = {REFUSED_PLUGINS}});
    assert_int_equal(loader_scan(f->plugins, &f->lines.report), RESULT_OK);
    for (size_t i = 0; i < CASES; ++i) {
        char path[512];
        snprintf(path, sizeof path, "%s/%s.culler.so", REFUSED_PLUGINS, cases[i][0]);
        if (!strstr(reason_of(f, path), cases[i][1])) fail_msg("%s: '%s' does not say '%s'", cases[i][0], reason_of(f, path), cases[i][1]);
    }
    (void)loader_refusals(f->plugins, &count);
    assert_int_equal(count, CASES);
    (void)loader_plugins(f->plugins, &count);
    assert_int_equal(count, BUILTIN);
    assert_int_equal(loader_libraries_open(f->plugins), 0);
    assert_int_equal(f->lines.count, 0);
}

static void what_is_no_library_is_refused(void **state)
{
    fixture *f = *state;
    static const char noise[] = "\177ELF\2\1\1 and then nothing that makes sense, but long enough to look like a header of 64 bytes";
    static const char *const names[] = {"text.culler.so", "empty.culler.so", "noise.culler.so", "dangling.culler.so"};
    char path[512];
    uint32_t count;
    scratch_folder_write(&f->folder, names[0], "a text\n", 7);
    scratch_folder_write(&f->folder, names[1], "", 0);
    scratch_folder_write(&f->folder, names[2], noise, sizeof noise);
    scratch_folder_name(&f->folder, names[3], path, sizeof path);
    assert_int_equal(symlink("nowhere", path), 0);
    scratch_folder_write(&f->folder, "other.so", "not looked at", 13);
    scratch_folder_write(&f->folder, ".culler.so", "not looked at", 13);
    open_at(f, (places){.folders = {f->folder.path}});
    assert_int_equal(loader_scan(f->plugins, &f->lines.report), RESULT_OK);
    assert_int_equal(loader_scan(f->plugins, &f->lines.report), RESULT_OK); // looked at once
    (void)loader_refusals(f->plugins, &count);
    assert_int_equal(count, 4);
    for (int i = 0; i < 4; ++i) {
        scratch_folder_name(&f->folder, names[i], path, sizeof path);
        assert_string_not_equal(reason_of(f, path), "(not refused)");
        assert_true(strlen(reason_of(f, path)) > 0);
    }
}

static void a_missing_explicit_file_is_refused_with_its_reason(void **state)
{
    fixture *f = *state;
    open_at(f, (places){.file = "/nowhere/x.culler.so"});
    assert_int_equal(find(f, "x"), RESULT_BAD_INPUT);
    assert_true(report_lines_is_one_with(&f->lines, "/nowhere/x.culler.so: error: refused: "));
}

static void a_bad_explicit_file_is_told_whatever_culler_is_asked_for(void **state)
{
    fixture *f = *state;
    open_at(f, (places){REFUSED_PLUGINS "/abi-most.culler.so", {TEST_PLUGINS}});
    assert_int_equal(find(f, "testmore"), RESULT_BAD_INPUT);
    assert_true(report_lines_is_one_with(&f->lines, REFUSED_PLUGINS "/abi-most.culler.so: error: refused: it is of ABI number 4294967295"));
}

static void a_culler_s_second_library_is_refused_in_a_scan(void **state)
{
    fixture *f = *state;
    char first[512], second[512];
    open_at(f, (places){.folders = {TEST_PLUGINS "_first", TEST_PLUGINS "_second", TEST_PLUGINS "_first"}});
    assert_int_equal(loader_scan(f->plugins, &f->lines.report), RESULT_OK);
    assert_string_equal(loaded(f, "testmore")->path, more_of("_first", first, sizeof first));
    assert_non_null(strstr(reason_of(f, more_of("_second", second, sizeof second)), "taken by a culler found before"));
    assert_int_equal(loader_libraries_open(f->plugins), 1);
}

static void out_of_memory_in_a_search_is_one_line_and_no_refusal(void **state)
{
    fixture *f = *state;
    for (uint64_t k = 1;; ++k) {
        report_lines_init(&f->lines);
        open_at(f, (places){.folders = {REFUSED_PLUGINS, TEST_PLUGINS}});
        f->memory.fail_at = f->memory.calls + k;
        const result done = find(f, "testcross-too"); // through a scan of both folders
        const int failed = f->memory.calls >= f->memory.fail_at;
        f->memory.fail_at = 0;
        loader_close(f->plugins);
        f->plugins = NULL;
        assert_true(failing_allocator_is_clean(&f->memory));
        if (!failed) {
            assert_int_equal(done, RESULT_OK);
            assert_true(k >= 3); // two allocations at least did fail
            return;
        }
        assert_int_equal(done, RESULT_NO_MEMORY);
        assert_true(report_lines_is_one_with(&f->lines, "out of memory"));
    }
}

int main(void)
{
#define TEST(t) cmocka_unit_test_setup_teardown(t, set_up, tear_down)
    const struct CMUnitTest tests[] = {
        TEST(the_built_in_cullers_need_no_library),
        TEST(only_the_named_library_is_opened),
        TEST(a_culler_in_a_library_of_another_name_is_found),
        TEST(the_first_folder_wins),
        TEST(one_file_by_two_paths_is_one),
        TEST(an_explicit_file_wins_over_the_folders),
        TEST(a_bad_library_does_not_hide_a_good_one_behind_it),
        TEST(the_current_folder_is_never_searched),
        TEST(an_explicit_file_without_a_slash_is_a_file_here),
        TEST(a_missing_culler_s_line_lists_those_found),
        TEST(a_refused_culler_s_line_gives_the_reason),
        TEST(a_missing_culler_s_line_names_what_was_refused),
        TEST(a_name_that_no_culler_can_have_is_refused_at_once),
        TEST(every_unsound_library_is_refused_with_its_reason),
        TEST(what_is_no_library_is_refused),
        TEST(a_missing_explicit_file_is_refused_with_its_reason),
        TEST(a_bad_explicit_file_is_told_whatever_culler_is_asked_for),
        TEST(a_culler_s_second_library_is_refused_in_a_scan),
        TEST(out_of_memory_in_a_search_is_one_line_and_no_refusal),
    };
    return cmocka_run_group_tests_name("core loader", tests, NULL, NULL);
}
