// Runs a libFuzzer target without libFuzzer: its seeds, pieces of real files, and seeded mutations of both.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_FUZZ_DRIVER_H
#define PORTCULLIS_TESTS_FUZZ_DRIVER_H

#include <stddef.h>
#include <stdint.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

// Each target defines both; a list ends in NULL. Files are names below the folder PORTCULLIS_SCENES.
extern const char *const fuzz_seeds[];
extern const char *const fuzz_files[];

#endif
