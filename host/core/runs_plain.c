// Runs: the plain form.
// SPDX-License-Identifier: MIT
#define RUNS_KERNEL runs_kernel_plain
#include "runs_body.h"
