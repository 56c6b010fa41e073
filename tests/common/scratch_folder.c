// A folder for a test's own files: see scratch_folder.h.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "scratch_folder.h"

#include "test.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

void scratch_folder_make(scratch_folder *f)
{
    const char *base = getenv("TMPDIR");
    const int length = snprintf(f->path, sizeof f->path, "%s/portcullis-test-XXXXXX", base && *base ? base : "/tmp");
    assert_true(length > 0 && (size_t)length < sizeof f->path);
    assert_non_null(mkdtemp(f->path));
}

void scratch_folder_name(const scratch_folder *f, const char *name, char *path, size_t size)
{
    const int length = snprintf(path, size, "%s/%s", f->path, name);
    assert_true(length > 0 && (size_t)length < size);
}

void scratch_folder_write(const scratch_folder *f, const char *name, const void *bytes, size_t size)
{
    char path[512];
    scratch_folder_name(f, name, path, sizeof path);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

static size_t walk(const scratch_folder *f, int remove_them)
{
    size_t count = 0;
    DIR *d = opendir(f->path);
    assert_non_null(d);
    for (const struct dirent *e; (e = readdir(d)) != NULL;) {
        if (strcmp(e->d_name, ".") == 0 || strcmp(e->d_name, "..") == 0) continue;
        char path[512];
        scratch_folder_name(f, e->d_name, path, sizeof path);
        if (remove_them) (void)remove(path);
        count++;
    }
    closedir(d);
    return count;
}

size_t scratch_folder_count(const scratch_folder *f)
{
    return walk(f, 0);
}

void scratch_folder_remove(const scratch_folder *f)
{
    (void)walk(f, 1);
    assert_int_equal(rmdir(f->path), 0);
}
