// Runs: the avx512 form.
// SPDX-License-Identifier: MIT
#define RUNS_KERNEL runs_kernel_avx512
#include "runs_body.h"
