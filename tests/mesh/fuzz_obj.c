// Fuzz target: any bytes as an .obj file.
// SPDX-License-Identifier: MIT
#include "fuzz_mesh.h"

const char *const fuzz_seeds[] = {
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\nf 1 2 3 4\nf 1/1 2/1 3/1\nf 4//1 3//1 2//1\nf -1/-1/-1 -2/1/1 -3/1/1\n",
    "o a\ng b\nusemtl c\nv 0 0 0 1\nv 1e1 0 .5 \\\n 1 1 1\nv 0 -1 0#x\r\nf 1 \\\n2 3\no d\nv 2 2 2\nf 1 2 4\nf 2 1 4\nf 1 2 3 4\nf 1 1 2 3\ns off\nl 1 2\n",
    "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 2 1 0\nv 0 4 0\nv 1 1 0\nv 3 3 1\nf 1 2 3 4 5\nf 5 4 3 2 1 6 7\nf 1 6 5 7 2 3 6 4\n",
    NULL,
};
const char *const fuzz_files[] = {"city/delft.obj", "models/suzanne.obj", NULL};

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    return fuzz_mesh(import_obj, data, size);
}
