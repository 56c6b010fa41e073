// SSIM's sums for any CPU.
// SPDX-License-Identifier: MIT
#define SSIM_LANES 4
#include "similarity_body.h"

const similarity_kernel similarity_kernel_plain = {across, row};
