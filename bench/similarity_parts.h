// What the files of SSIM share among themselves: the sums of one tile.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_BENCH_SIMILARITY_PARTS_H
#define PORTCULLIS_BENCH_SIMILARITY_PARTS_H

#include "similarity.h"

enum { SSIM_TILE_PX = 64, SSIM_SIDE_PX = SSIM_TILE_PX + SSIM_WINDOW_PX - 1, SSIM_SUMS = 5 };

typedef struct similarity_row { uint32_t y, wide; float mean; } similarity_row; // of windows; mean: what was taken off the tile

// One body, compiled for each instruction set, chosen at run time; all give the same bits.
typedef struct similarity_kernel {
    void (*across)(similarity *s, uint32_t rows);
    double (*row)(similarity *s, const similarity_row *q); // the sum of its windows' likeness
} similarity_kernel;

extern const similarity_kernel similarity_kernel_plain;
#if defined(__x86_64__)
extern const similarity_kernel similarity_kernel_avx2, similarity_kernel_avx512; // only for a CPU that has them
#endif

struct similarity {
    const allocator *memory;
    const similarity_kernel *kernel;
    uint32_t width_px, height_px;
    float window[SSIM_WINDOW_PX];
    float of_picture[2][SSIM_SIDE_PX][SSIM_SIDE_PX];    // luminance less the tile's mean
    float across[SSIM_SUMS][SSIM_SIDE_PX][SSIM_TILE_PX]; // of a, b, a^2, b^2, ab
    float down[SSIM_SUMS][SSIM_TILE_PX];
};

#endif
