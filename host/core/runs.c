// Runs: the choice of the widest kernel.
// SPDX-License-Identifier: MIT
#include "runs.h"

const runs_kernel *runs_kernel_best(void)
{
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq")) return &runs_kernel_avx512;
    if (__builtin_cpu_supports("avx2")) return &runs_kernel_avx2;
#endif
    return &runs_kernel_plain;
}
