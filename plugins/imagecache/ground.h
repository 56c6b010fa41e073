// The ground of a zone: its box seen from above, parted into square cells (1998, uniform-cell image cache: 2^l x 2^l columns over x-z).
// SPDX-License-Identifier: MIT
//
// Invariant: every cell border x + i * size, z + j * size is exact in double, and a cell is closed: a point of a border is in both cells.
#ifndef PORTCULLIS_IMAGECACHE_GROUND_H
#define PORTCULLIS_IMAGECACHE_GROUND_H

#include <portcullis/culler.h>

enum { GROUND_LEVELS_MOST = 10 }; // 2^10 cells a side, what the integers of footprint.h and rings.h have room for

typedef struct ground {
    double x, z, size;   // corner of cell (0, 0) and the side of a cell, metres
    double low, high;    // of the zone, along y
    uint32_t level;      // at most 2^level cells a side
    uint32_t columns, rows; // cells there are: a narrow zone has fewer one way; at least 1
} ground;

typedef struct ground_cell { int32_t i, j; } ground_cell; // column (along x) and row (along z); may lie outside the ground

// Cells of a level over a box; level at most GROUND_LEVELS_MOST.
ground ground_of(cull_box box, uint32_t level);

static inline uint32_t ground_cell_count(const ground *g)
{
    return g->columns * g->rows;
}

static inline uint32_t ground_number(const ground *g, ground_cell c)
{
    return (uint32_t)c.j * g->columns + (uint32_t)c.i;
}

// The index along an axis of the half-open cell [start + i * size, start + (i + 1) * size) that holds `at`: exact, clamped to -1 .. count.
int32_t ground_index(double start, double size, int32_t count, double at);

// The closed cells that [low, high] touches, clamped to 0 .. count - 1; it must reach the ground.
typedef struct ground_range { int32_t first, last; } ground_range;
ground_range ground_touched(double start, double size, int32_t count, double low, double high);

// The eye's cell. It is clamped to one cell beyond the ground, which changes no order: beyond the ground |i - ie| differs by a constant.
// w 0: a viewer infinitely far off in a direction; along an axis where it has no part any index serves.
ground_cell ground_eye(const ground *g, const double eye[4]);

// Bits of i and j in turns (Morton, 1966): all cells of a quadtree node follow one another.
uint32_t ground_morton(ground_cell c);
ground_cell ground_of_morton(uint32_t code);

#endif
