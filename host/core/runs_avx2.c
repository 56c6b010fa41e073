// Runs: the avx2 form.
// SPDX-License-Identifier: MIT
#if defined(__x86_64__)
#define RUNS_KERNEL runs_kernel_avx2
#include "runs_body.h"
#else
typedef int runs_avx2_is_empty;
#endif
