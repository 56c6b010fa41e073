// Exact planes about other origins: normal . (p + by) + offset = normal . p + (offset + normal . by).
// SPDX-License-Identifier: MIT
#include "exact_plane.h"

#include <math.h>

static const double STEPS_MOST = 0x1p53; // below it a product of whole numbers is exact in double

int exact_plane_move(const cull_exact_plane *from, const double by[3], double steps_per_metre, cull_exact_plane *out)
{
    int64_t offset = from->offset;
    if (floor(steps_per_metre) != steps_per_metre) return 0;
    for (int k = 0; k < 3; ++k) {
        const double steps = by[k] * steps_per_metre;
        int64_t part;
        if (!(fabs(steps) < STEPS_MOST)) return 0;
        if (__builtin_mul_overflow(from->normal[k], (int64_t)steps, &part) || __builtin_add_overflow(offset, part, &offset)) return 0;
    }
    if (offset == INT64_MIN) return 0; // whose negative, the plane seen from behind, has no place
    *out = (cull_exact_plane){{from->normal[0], from->normal[1], from->normal[2]}, offset};
    return 1;
}
