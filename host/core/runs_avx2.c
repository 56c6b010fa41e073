// Runs: the avx2 form.
// SPDX-License-Identifier: MIT
#define RUNS_KERNEL runs_kernel_avx2
#include "runs_body.h"
