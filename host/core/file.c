// Whole files in and out: see file.h.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "file.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const size_t FILE_BYTES_MOST = (size_t)1 << 32; // importers count in 32 bits

result file_read(const char *path, const allocator *memory, report *r, char **out_bytes, size_t *out_size)
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
    if (size > FILE_BYTES_MOST) {
        fclose(file);
        return report_error(r, path, 0, "larger than 4 GiB; split it");
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

result file_write(const char *path, const void *bytes, size_t size, report *r)
{
    char temporary[4096];
    const int length = snprintf(temporary, sizeof temporary, "%s.part", path);
    if (length < 0 || (size_t)length >= sizeof temporary) return report_error(r, path, 0, "the name is too long");
    FILE *file = fopen(temporary, "wb");
    if (!file) return report_error(r, path, 0, "cannot write it: %s; check the folder", strerror(errno));
    const size_t put = fwrite(bytes, 1, size, file);
    const int closed = fclose(file);
    if (put != size || closed != 0 || rename(temporary, path) != 0) {
        const int reason = errno;
        unlink(temporary);
        return report_error(r, path, 0, "cannot write it whole: %s; free some space", strerror(reason));
    }
    return RESULT_OK;
}
