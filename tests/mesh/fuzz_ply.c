// Fuzz target: any bytes as a .ply file.
// SPDX-License-Identifier: MIT
#include "fuzz_mesh.h"

// Binary seeds hold no zero byte, as they are C strings.
const char *const fuzz_seeds[] = {
    "ply\nformat ascii 1.0\ncomment c\nelement vertex 4\nproperty float x\nproperty double y\nproperty int z\nproperty uchar red\nelement face 3\n"
    "property list uchar int vertex_indices\nproperty list int float w\nelement edge 1\nproperty int a\nend_header\n"
    "0 0 0 255\n1 0 0 0\n1 1 0 0\n0 1 7 0\n3 0 1 2 1 0.5\n4 0 1 2 3 0\n3 2 1 0 0\n7\n",
    "ply\nformat binary_little_endian 1.0\nelement vertex 5\nproperty uchar x\nproperty char y\nproperty short z\nelement face 3\n"
    "property list uchar uchar vertex_index\nend_header\n\x01\x01\x01\x01\x09\x01\x01\x01\x09\xff\x01\x01\x01\xf0\x01\x02\x05\x05\x01\x03\x03\x01\x02\x03\x04\x04\x03\x02\x01\x03\x02\x03\x04",
    "ply\nformat binary_big_endian 1.0\nelement face 1\nproperty list char ushort vertex_indices\nelement vertex 3\nproperty float x\nproperty double y\n"
    "property uint z\nend_header\n\x03\x01\x01\x01\x02\x01\x03" "aaaabbbbbbbbccccaaaabbbbbbbbccccaaaabbbbbbbbcccc",
    NULL,
};
const char *const fuzz_files[] = {NULL};

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    return fuzz_mesh(import_ply, data, size);
}
