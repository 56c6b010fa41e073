// The kernels of method=hiz for AVX2.
// SPDX-License-Identifier: MIT
#if defined(__x86_64__)
#define HIZ_AVX2
#include "hiz_raster_body.h"
#include "hiz_test_body.h"
#include "hiz_setup_body.h"
#include "hiz_walk_body.h"

const hiz_kernel hiz_kernel_avx2 = {"avx2", walk_run, walk_boxes_seen, polygon_cover, rectangle_hidden};
#else
typedef int hiz_avx2_is_empty;
#endif
