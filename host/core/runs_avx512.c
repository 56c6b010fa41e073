// Runs: the avx512 form.
// SPDX-License-Identifier: MIT
#if defined(__x86_64__)
#define RUNS_KERNEL runs_kernel_avx512
#include "runs_body.h"
#else
typedef int runs_avx512_is_empty;
#endif
