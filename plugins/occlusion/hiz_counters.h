// What a viewer's frames came to under method=hiz.
// SPDX-License-Identifier: MIT
#ifndef OCCLUSION_HIZ_COUNTERS_H
#define OCCLUSION_HIZ_COUNTERS_H

#include <stdint.h>

typedef struct hiz_counters { uint64_t rectangles, items, polygons; } hiz_counters; // rectangles tested; drawn into the pyramid

#endif
