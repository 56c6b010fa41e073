// Whole files in and out. Writing goes through a temporary name, so no partial output is left behind.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_FILE_H
#define PORTCULLIS_HOST_FILE_H

#include "memory.h"
#include "report.h"

// *out_bytes has a closing zero behind *out_size bytes; free with memory_free(memory, bytes, size + 1, 1).
result file_read(const char *path, const allocator *memory, report *r, char **out_bytes, size_t *out_size);
// The same, with another limit than 4 GiB.
result file_read_most(const char *path, uint64_t bytes_most, const allocator *memory, report *r, char **out_bytes, size_t *out_size);
// All of it under that name, or nothing. A link is followed, a file's mode kept, a device or pipe written to in place.
result file_write(const char *path, const void *bytes, size_t size, report *r);
// Whether file_write would find a place: asked before long work, so that its result is not lost.
result file_can_write(const char *path, report *r);

#endif
