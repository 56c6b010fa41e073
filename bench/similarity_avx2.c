// SSIM's sums for AVX2: the same bits.
// SPDX-License-Identifier: MIT
#if defined(__x86_64__)
#define SSIM_LANES 8
#include "similarity_body.h"

const similarity_kernel similarity_kernel_avx2 = {across, row};
#else
typedef int similarity_avx2_is_empty;
#endif
