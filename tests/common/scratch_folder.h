// A folder for a test's own files, removed with all that is in it.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_SCRATCH_FOLDER_H
#define PORTCULLIS_TESTS_SCRATCH_FOLDER_H

#include <stddef.h>

typedef struct scratch_folder { char path[256]; } scratch_folder;

void scratch_folder_make(scratch_folder *f); // under TMPDIR or /tmp; asserts that it works
void scratch_folder_remove(const scratch_folder *f); // files in it too, folders in it only when empty
void scratch_folder_name(const scratch_folder *f, const char *name, char *path, size_t size); // f/name
void scratch_folder_write(const scratch_folder *f, const char *name, const void *bytes, size_t size);
size_t scratch_folder_count(const scratch_folder *f); // entries in it

#endif
