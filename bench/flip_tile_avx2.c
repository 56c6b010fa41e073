// FLIP's tiles for AVX2: the same bits.
// SPDX-License-Identifier: MIT
#if defined(__x86_64__)
#define FLIP_LANES 8
#include "flip_tile_body.h"

const flip_kernel flip_kernel_avx2 = {filter_tile, compare_tile};
#else
typedef int flip_tile_avx2_is_empty;
#endif
