// FLIP's tiles for any CPU.
// SPDX-License-Identifier: MIT
#define FLIP_LANES 4
#include "flip_tile_body.h"

const flip_kernel flip_kernel_plain = {filter_tile, compare_tile};
