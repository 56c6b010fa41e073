// Whole files in and out: see file.h.
// SPDX-License-Identifier: MIT
#define _XOPEN_SOURCE 700
#include "file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const uint64_t TEXT_BYTES_MOST = UINT64_C(1) << 32; // importers count in 32 bits

result file_read(const char *path, const allocator *memory, report *r, char **out_bytes, size_t *out_size)
{
    return file_read_most(path, TEXT_BYTES_MOST, memory, r, out_bytes, out_size);
}

result file_read_most(const char *path, uint64_t bytes_most, const allocator *memory, report *r, char **out_bytes, size_t *out_size)
{
    struct stat status;
    if (stat(path, &status) == 0 && !S_ISREG(status.st_mode)) // before opening: a pipe without a writer would block there
        return report_error(r, path, 0, "not a regular file; name a scene or views file");
    FILE *file = fopen(path, "rb");
    if (!file) return report_error(r, path, 0, "cannot open it: %s; check the name", strerror(errno));
    if (fstat(fileno(file), &status) != 0) {
        fclose(file);
        return report_error(r, path, 0, "cannot read it: %s; check the disk", strerror(errno));
    }
    const size_t size = (size_t)status.st_size;
    if ((uint64_t)status.st_size > bytes_most || size >= SIZE_MAX) {
        fclose(file);
        return report_error(r, path, 0, "larger than %llu GiB; split it", (unsigned long long)(bytes_most >> 30));
    }
    char *bytes = memory_alloc(memory, size + 1, 1);
    if (!bytes) {
        fclose(file);
        return report_no_memory(r, path);
    }
    const size_t got = fread(bytes, 1, size, file);
    fclose(file);
    if (got != size) {
        memory_free(memory, bytes, size + 1, 1);
        return report_error(r, path, 0, "cannot read it whole; it changed while it was read");
    }
    bytes[size] = 0;
    *out_bytes = bytes;
    *out_size = size;
    return RESULT_OK;
}

// ---- Writing ----

enum { PATH_BYTES = 4096, NAMES_TRIED = 100 };

// Where a write goes: behind a link, the file that it names.
typedef struct target {
    char path[PATH_BYTES];
    struct stat status;
    int exists;
} target;

static result find_target(const char *path, report *r, target *out)
{
    char *resolved = realpath(path, NULL);
    const int length = snprintf(out->path, sizeof out->path, "%s", resolved ? resolved : path);
    free(resolved);
    if (*path == 0) return report_error(r, NULL, 0, "an empty file name; name a file to write");
    if (length < 0 || (size_t)length + 32 > sizeof out->path) return report_error(r, path, 0, "the name is too long; shorten it");
    out->exists = stat(out->path, &out->status) == 0;
    if (out->exists && S_ISDIR(out->status.st_mode)) return report_error(r, path, 0, "is a folder; name a file in it");
    return RESULT_OK;
}

static result write_all(int file, const char *path, const void *bytes, size_t size, report *r)
{
    const char *at = bytes;
    while (size) {
        const ssize_t put = write(file, at, size);
        if (put < 0 && errno == EINTR) continue;
        if (put <= 0) return report_error(r, path, 0, "cannot write it whole: %s; nothing is left of it", strerror(errno));
        at += put;
        size -= (size_t)put;
    }
    return RESULT_OK;
}

// A device or a pipe is written to, never replaced.
static result write_into(const target *t, const char *path, const void *bytes, size_t size, report *r)
{
    const int file = open(t->path, O_WRONLY);
    if (file < 0) return report_error(r, path, 0, "cannot write it: %s; choose another name", strerror(errno));
    const result done = write_all(file, path, bytes, size, r);
    if (close(file) != 0 && done == RESULT_OK) return report_error(r, path, 0, "cannot write it whole: %s; choose another place", strerror(errno));
    return done;
}

// A name beside the target that nobody has.
static int open_beside(const target *t, char name[PATH_BYTES])
{
    for (int i = 0; i < NAMES_TRIED; ++i) {
        snprintf(name, PATH_BYTES, "%.4060s.%ld-%d.part", t->path, (long)getpid(), i);
        const int file = open(name, O_WRONLY | O_CREAT | O_EXCL, 0666);
        if (file >= 0 || errno != EEXIST) return file;
    }
    return -1;
}

static result write_beside(const target *t, const char *path, const void *bytes, size_t size, report *r)
{
    char name[PATH_BYTES];
    const int file = open_beside(t, name);
    if (file < 0) return report_error(r, path, 0, "cannot write it: %s; check the folder", strerror(errno));
    if (t->exists) (void)fchmod(file, t->status.st_mode & 0777); // keeps what the user allowed
    result done = write_all(file, path, bytes, size, r);
    if (close(file) != 0 && done == RESULT_OK) done = report_error(r, path, 0, "cannot write it whole: %s; free some space", strerror(errno));
    if (done == RESULT_OK && rename(name, t->path) != 0) done = report_error(r, path, 0, "cannot write it: %s; check the folder", strerror(errno));
    if (done != RESULT_OK) unlink(name);
    return done;
}

result file_write(const char *path, const void *bytes, size_t size, report *r)
{
    target t;
    const result found = find_target(path, r, &t);
    if (found != RESULT_OK) return found;
    return t.exists && !S_ISREG(t.status.st_mode) ? write_into(&t, path, bytes, size, r) : write_beside(&t, path, bytes, size, r);
}

result file_can_write(const char *path, report *r)
{
    target t;
    const result found = find_target(path, r, &t);
    if (found != RESULT_OK) return found;
    if (t.exists) return access(t.path, W_OK) == 0 ? RESULT_OK : report_error(r, path, 0, "cannot be written: %s; choose another name", strerror(errno));
    char *slash = strrchr(t.path, '/');
    if (slash == t.path) slash[1] = 0;
    else if (slash) *slash = 0;
    if (access(slash ? t.path : ".", W_OK | X_OK) == 0) return RESULT_OK;
    return report_error(r, path, 0, "cannot be written: %s; make its folder, or choose another", strerror(errno));
}
