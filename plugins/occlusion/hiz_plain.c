// The kernels of method=hiz in plain C: the oracle of the others.
// SPDX-License-Identifier: MIT
#include "hiz_raster_body.h"
#include "hiz_test_body.h"
#include "hiz_setup_body.h"
#include "hiz_walk_body.h"

const hiz_kernel hiz_kernel_plain = {"plain", walk_run, walk_boxes_seen, polygon_cover, rectangle_hidden};
