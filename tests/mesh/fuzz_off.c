// Fuzz target: any bytes as an .off file.
// SPDX-License-Identifier: MIT
#include "fuzz_mesh.h"

const char *const fuzz_seeds[] = {
    "OFF\n# c\n4 3 0\n0 0 0\n1 0 0\n1 1 0 \n0 1 .5\n3 0 1 2 255 0 0\n4 0 1 2 3\n3 2 1 0\n",
    "STCNOFF 5 2\r\n0 0 0 1 1 1 1 0 0 1 0 0\r\n3 0 0\n3 3 0\n0 3 0\n1 1 0\n5 0 1 2 3 4\n3 4 3 2 # end",
    NULL,
};
const char *const fuzz_files[] = {NULL};

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    return fuzz_mesh(import_off, data, size);
}
