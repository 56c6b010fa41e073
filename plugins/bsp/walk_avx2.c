// The walk in AVX2's vectors.
// SPDX-License-Identifier: MIT
#if defined(__AVX2__)
#define WALK_KERNEL walk_avx2
#include "walk_body.h"
#else
typedef int walk_avx2_is_empty;
#endif
