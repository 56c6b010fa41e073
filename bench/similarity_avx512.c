// SSIM's sums for AVX-512: the same bits.
// SPDX-License-Identifier: MIT
#if defined(__x86_64__)
#define SSIM_LANES 16
#include "similarity_body.h"

const similarity_kernel similarity_kernel_avx512 = {across, row};
#else
typedef int similarity_avx512_is_empty;
#endif
