// The choice of an instruction set, made once when a culler is created.
// SPDX-License-Identifier: MIT
#include "walk.h"

#include <string.h>

static const walk_kernel *kernel_avx2(void)
{
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("popcnt")) return &walk_avx2;
#endif
    return NULL;
}

static const walk_kernel *kernel_avx512(void)
{
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("popcnt")) return &walk_avx512;
#endif
    return NULL;
}

const walk_kernel *walk_kernel_of(const char *isa)
{
    if (strcmp(isa, "plain") == 0) return &walk_plain;
    if (strcmp(isa, "avx2") == 0) return kernel_avx2();
    if (strcmp(isa, "avx512") == 0) return kernel_avx512();
    if (strcmp(isa, "auto") != 0) return NULL;
    if (kernel_avx512()) return kernel_avx512();
    return kernel_avx2() ? kernel_avx2() : &walk_plain;
}
