// Which air a shell bounds: a shell round air is the outer one of a region, a shell round solid is an island in the region
// that encloses it, or hangs in the void round the map. The thesis's A5, for any nesting.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_ISLANDS_H
#define PORTCULLIS_HOST_ISLANDS_H

#include "rays.h"

#define REGION_VOID UINT32_MAX        // the void round the map
#define REGION_SOLID (UINT32_MAX - 1) // of places only

typedef struct region_set {
    const allocator *memory;
    uint32_t *region_of; // by shell: a region or REGION_VOID
    uint8_t *is_outer;   // by shell: it encloses air
    uint32_t shell_count, region_count;
    uint32_t unclear;    // shells that no ray could tell: 0 but for a surface that isn't closed
} region_set;

result region_set_make(ray_space *rays, const allocator *memory, region_set *out);
void region_set_free(region_set *r); // zeroed is fine
// The region of a grid point: REGION_VOID, REGION_SOLID (walls too) or a region.
result region_of_point(const region_set *r, ray_space *rays, const int32_t point[3], uint32_t *out);
// Of the air before a face, liquids' too.
result region_of_face(const region_set *r, ray_space *rays, uint32_t face, uint32_t *out);

#endif
