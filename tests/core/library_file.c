// Tests of the look at a library before it is opened: a stranger's wrong file is told in one line, and never opened.
// SPDX-License-Identifier: MIT
#define _XOPEN_SOURCE 700
#include "host/core/library_file.h"
#include "tests/common/scratch_folder.h"
#include "tests/common/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { TYPE_AT = 16, MACHINE_AT = 18, CUTS = 400 }; // places of an ELF header

typedef struct bytes { uint8_t *at; size_t size; } bytes;

static bytes library_of(const char *path)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    assert_int_equal(fseek(file, 0, SEEK_END), 0);
    bytes b = {NULL, (size_t)ftell(file)};
    rewind(file);
    b.at = malloc(b.size);
    assert_non_null(b.at);
    assert_int_equal(fread(b.at, 1, b.size, file), b.size);
    fclose(file);
    return b;
}

static void expect_fault(const uint8_t *at, size_t size, const char *words)
{
    library_fault_text text;
    const char *fault = library_bytes_fault(at, size, &text);
    if (!fault || !strstr(fault, words)) fail_msg("'%s' does not say '%s'", fault ? fault : "(no fault)", words);
}

static void a_sound_library_has_no_fault(void **state)
{
    (void)state;
    library_fault_text text;
    assert_null(library_path_fault(TEST_PLUGINS "/testmore.culler.so", &text));
    assert_null(library_path_fault(TEST_PLUGINS "/testpicture.culler.so", &text));
    assert_null(library_path_fault(REFUSED_PLUGINS "/no-verb.culler.so", &text)); // what only its memory tells is the loader's
}

static void a_cut_library_is_refused_wherever_it_is_cut(void **state)
{
    (void)state;
    bytes b = library_of(TEST_PLUGINS "/testmore.culler.so");
    for (size_t i = 0; i < CUTS; ++i) {
        const size_t length = i * (b.size - 1) / (CUTS - 1);
        uint8_t *cut = malloc(length ? length : 1); // of its own size: reading past the end is seen
        assert_non_null(cut);
        memcpy(cut, b.at, length);
        expect_fault(cut, length, length < 16 ? "no shared library" : "cut short");
        free(cut);
    }
    free(b.at);
}

static void another_machine_s_library_is_told_as_such(void **state)
{
    (void)state;
    bytes b = library_of(TEST_PLUGINS "/testmore.culler.so");
    b.at[MACHINE_AT] ^= 0x55;
#if defined(__x86_64__) || defined(__aarch64__)
    expect_fault(b.at, b.size, "another machine");
#endif
    b.at[MACHINE_AT] ^= 0x55;
    b.at[4] ^= 3; // 64 bits to 32, or back
    expect_fault(b.at, b.size, "word size");
    b.at[4] ^= 3;
    b.at[5] ^= 3;
    expect_fault(b.at, b.size, "byte order");
    free(b.at);
}

static void what_is_not_linked_as_a_library_is_told_as_such(void **state)
{
    (void)state;
    bytes b = library_of(TEST_PLUGINS "/testmore.culler.so");
    b.at[TYPE_AT] = 1;
    expect_fault(b.at, b.size, "object file");
    b.at[TYPE_AT] = 2;
    expect_fault(b.at, b.size, "a program");
    free(b.at);
    library_fault_text text;
    const char *fault = library_path_fault("/proc/self/exe", &text); // a program that can be loaded anywhere calls itself a library
    assert_non_null(fault);
    assert_true(strstr(fault, "a program") || strstr(fault, "no symbol"));
    expect_fault((const uint8_t *)"#!/bin/sh\necho a text\n", 22, "no shared library");
}

static void the_entry_and_its_number_are_read_from_the_file(void **state)
{
    (void)state;
    library_fault_text text;
    assert_non_null(strstr(library_path_fault(REFUSED_PLUGINS "/no-symbol.culler.so", &text), "no symbol cull_entry"));
    assert_non_null(strstr(library_path_fault(REFUSED_PLUGINS "/abi-most.culler.so", &text), "ABI number 4294967295,"));
}

static void what_is_no_file_is_not_waited_for(void **state)
{
    (void)state;
    scratch_folder folder;
    char path[512];
    library_fault_text text;
    scratch_folder_make(&folder);
    scratch_folder_name(&folder, "pipe.culler.so", path, sizeof path);
    assert_int_equal(mkfifo(path, 0600), 0);
    assert_non_null(strstr(library_path_fault(path, &text), "no file"));
    assert_non_null(strstr(library_path_fault(folder.path, &text), "no file"));
    scratch_folder_write(&folder, "empty.culler.so", "", 0);
    scratch_folder_name(&folder, "empty.culler.so", path, sizeof path);
    assert_non_null(strstr(library_path_fault(path, &text), "empty"));
    scratch_folder_name(&folder, "missing.culler.so", path, sizeof path);
    assert_non_null(strstr(library_path_fault(path, &text), "cannot open it"));
    scratch_folder_remove(&folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_sound_library_has_no_fault),
        cmocka_unit_test(a_cut_library_is_refused_wherever_it_is_cut),
        cmocka_unit_test(another_machine_s_library_is_told_as_such),
        cmocka_unit_test(what_is_not_linked_as_a_library_is_told_as_such),
        cmocka_unit_test(the_entry_and_its_number_are_read_from_the_file),
        cmocka_unit_test(what_is_no_file_is_not_waited_for),
    };
    return cmocka_run_group_tests_name("core library file", tests, NULL, NULL);
}
