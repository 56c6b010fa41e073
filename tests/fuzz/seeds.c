// Hands a libFuzzer target the seeds of its source: with PORTCULLIS_FUZZ_SEEDS=FOLDER they are written there before it starts.
// SPDX-License-Identifier: MIT
#include "tests/fuzz_driver.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerInitialize(int *argc, char ***argv);

int LLVMFuzzerInitialize(int *argc, char ***argv)
{
    const char *folder = getenv("PORTCULLIS_FUZZ_SEEDS");
    (void)argc, (void)argv;
    for (int i = 0; folder && fuzz_seeds[i]; ++i) {
        char path[4096];
        const int length = snprintf(path, sizeof path, "%s/seed%d", folder, i);
        FILE *file = length > 0 && (size_t)length < sizeof path ? fopen(path, "wb") : NULL;
        if (!file) continue; // fewer seeds: it starts all the same
        (void)fwrite(fuzz_seeds[i], 1, strlen(fuzz_seeds[i]), file);
        fclose(file);
    }
    return 0;
}
