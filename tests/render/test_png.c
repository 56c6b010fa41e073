// PNG files: whole, readable, or not there at all. Needs no GL.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "fixture.h"

#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct folder { char path[64], file[80]; } folder;

static folder make_folder(void)
{
    folder f = {.path = "portcullis-png-XXXXXX"};
    assert_non_null(mkdtemp(f.path));
    snprintf(f.file, sizeof f.file, "%s/a.png", f.path);
    return f;
}

static void drop_folder(const folder *f)
{
    unlink(f->file);
    assert_int_equal(rmdir(f->path), 0); // fails if anything else was left in it
}

static void a_written_picture_reads_back_pixel_for_pixel(void **state)
{
    (void)state;
    enum { WIDE = 37, HIGH = 21 };
    static uint8_t rgba[WIDE * HIGH * 4], back[WIDE * HIGH * 4];
    report r = report_to_stderr();
    uint32_t seed = 3;
    const folder f = make_folder();
    for (size_t i = 0; i < sizeof rgba; ++i) rgba[i] = (uint8_t)random_next(&seed);
    for (int twice = 0; twice < 2; ++twice) // over itself, too
        assert_int_equal(png_write(f.file, rgba, WIDE, HIGH, &r), RESULT_OK);
    png_image image = {.version = PNG_IMAGE_VERSION};
    assert_true(png_image_begin_read_from_file(&image, f.file));
    assert_int_equal(image.width, WIDE);
    assert_int_equal(image.height, HIGH);
    image.format = PNG_FORMAT_RGBA;
    assert_true(png_image_finish_read(&image, NULL, back, 0, NULL));
    assert_memory_equal(rgba, back, sizeof rgba);
    drop_folder(&f);
}

static void what_cannot_be_written_leaves_nothing_and_one_line(void **state)
{
    (void)state;
    const uint8_t rgba[4] = {0};
    report r = {0};
    const folder f = make_folder();
    char missing[128];
    snprintf(missing, sizeof missing, "%s/no/such/folder.png", f.path);
    assert_int_equal(png_write(missing, rgba, 1, 1, &r), RESULT_BAD_INPUT);
    assert_int_equal(r.errors, 1);
    assert_int_equal(png_write(f.file, rgba, 0, 1, &r), RESULT_BAD_INPUT);
    assert_int_equal(png_write(f.file, rgba, 1, 1u << 31, &r), RESULT_BAD_INPUT);
    assert_int_equal(r.errors, 3);
    assert_int_equal(access(f.file, F_OK), -1);
    drop_folder(&f);
}

int main(void)
{
    const struct CMUnitTest png[] = {
        cmocka_unit_test(a_written_picture_reads_back_pixel_for_pixel),
        cmocka_unit_test(what_cannot_be_written_leaves_nothing_and_one_line),
    };
    return cmocka_run_group_tests(png, NULL, NULL);
}
