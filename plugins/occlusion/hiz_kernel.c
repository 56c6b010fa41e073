// The choice of an instruction set for method=hiz, made once when a culler is created.
// SPDX-License-Identifier: MIT
#include "hiz_walk.h"

#include <string.h>

static const hiz_kernel *kernel_avx2(void)
{
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2")) return &hiz_kernel_avx2;
#endif
    return NULL;
}

static const hiz_kernel *kernel_avx512(void)
{
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw")) return &hiz_kernel_avx512;
#endif
    return NULL;
}

const hiz_kernel *hiz_kernel_of(const char *isa)
{
    if (strcmp(isa, "plain") == 0) return &hiz_kernel_plain;
    if (strcmp(isa, "avx2") == 0) return kernel_avx2();
    if (strcmp(isa, "avx512") == 0) return kernel_avx512();
    if (strcmp(isa, "auto") != 0) return NULL;
    if (kernel_avx512()) return kernel_avx512();
    return kernel_avx2() ? kernel_avx2() : &hiz_kernel_plain;
}
