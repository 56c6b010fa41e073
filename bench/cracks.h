// What depths tell of two pictures. Movers: where they stand behind or before other things. Cracks: pixels where a strategy's picture shows the background though geometry has a hit, or something though it has none.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_BENCH_CRACKS_H
#define PORTCULLIS_BENCH_CRACKS_H

#include <stddef.h>
#include <stdint.h>

// Depths of the three pictures, rows in the same order; over 0: covered.
typedef struct crack_pictures {
    const float *geometry;  // all of it
    const float *must_show; // what of it may not be left out; geometry itself, but for a strategy of front walls
    const float *shown;
    uint32_t width_px, height_px;
} crack_pictures;

typedef struct crack_counts {
    uint64_t holes;  // geometry has a hit, the background shows
    uint64_t inner;  // of those: with hits all around, so no silhouette is near
    uint64_t spills; // covered, and geometry has no hit there nor in the 8 pixels around. None is told at the picture's border
} crack_counts;

// marks: width * height bytes that become 1 at a crack and 0 elsewhere; NULL: not wanted.
crack_counts cracks_count(const crack_pictures *q, uint8_t *marks);

// Depths of movers alone, of all geometry with movers, and of what a strategy shows: the nearest mover shows where the depth is its own,
// to the bit, since it is drawn by the same program in all three.
typedef struct mover_pictures {
    const float *movers, *geometry, *shown;
    uint32_t width_px, height_px;
} mover_pictures;
typedef struct mover_order {
    uint64_t pixels, wrong; // where a mover shows in geometry or in the strategy's picture; where in one alone
    uint64_t wrong_far;     // of those: more than a pixel's displacement explains. None of the 8 pixels around has, in geometry, what would explain it:
                            // where the mover is lost something nearer than it, where it shows wrongly the mover or something farther
} mover_order;
mover_order movers_count(const mover_pictures *q);

#endif
