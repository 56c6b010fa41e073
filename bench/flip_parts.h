// What the files of FLIP share among themselves: filters as taps, the planes of one tile.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_BENCH_FLIP_PARTS_H
#define PORTCULLIS_BENCH_FLIP_PARTS_H

#include "flip.h"

enum {
    FLIP_TILE_PX = 64,     // side of what is filtered at once: its planes stay in the second-level cache
    FLIP_REACH_MOST = 56,  // pixels, of the widest filter at 400 pixels per degree
    FLIP_SIDE_MOST = FLIP_TILE_PX + 2 * FLIP_REACH_MOST,
    FLIP_TILE_PIXELS = FLIP_TILE_PX * FLIP_TILE_PX
};

// One dimension of a filter, even or odd: weights of distances 0 .. reach. Odd ones have weight[0] = 0.
typedef struct flip_taps {
    float weight[FLIP_REACH_MOST + 1];
    int32_t reach;
} flip_taps;

typedef struct flip_filters {
    flip_taps luminance, red_green, blue_yellow[2][2]; // contrast sensitivity; the last: first across, second down
    flip_taps smooth, edge, point;                     // of features: Gaussian, its first (odd) and second derivative
} flip_filters;

typedef struct flip_colours {
    float linear[256];    // of an sRGB byte
    float white_from_rgb[3][3]; // X, Y, Z by the white's, from linear R, G, B
    float rgb_from_white[3][3];
} flip_colours;

// What one tile of one picture comes to: L, a, b after filters and Hunt's adjustment, and how strong edges and points are.
typedef struct flip_tile {
    float lightness[FLIP_TILE_PIXELS], a[FLIP_TILE_PIXELS], b[FLIP_TILE_PIXELS];
    float edges[FLIP_TILE_PIXELS], points[FLIP_TILE_PIXELS];
} flip_tile;

typedef struct flip_scratch {
    float luminance[FLIP_SIDE_MOST * FLIP_SIDE_MOST], red_green[FLIP_SIDE_MOST * FLIP_SIDE_MOST], blue_yellow[FLIP_SIDE_MOST * FLIP_SIDE_MOST];
    float across[7][FLIP_SIDE_MOST * FLIP_TILE_PX]; // filtered along rows
    float down[7][FLIP_TILE_PIXELS];                // and columns
    flip_tile tile, other;                          // of the test picture; of a reference that is not kept
    float colour[FLIP_TILE_PIXELS], feature[FLIP_TILE_PIXELS]; // differences between the two
} flip_scratch;

// One body, compiled for each instruction set, chosen at run time; all give the same bits.
typedef struct flip_kernel {
    // The tile whose first pixel is `corner`.
    void (*filter)(const flip *f, flip_scratch *s, const uint8_t *rgba, const uint32_t corner[2], flip_tile *out);
    // scratch.tile with the reference, into scratch.colour and scratch.feature.
    void (*compare)(flip_scratch *s, const flip_tile *reference);
} flip_kernel;

extern const flip_kernel flip_kernel_plain;
#if defined(__x86_64__)
extern const flip_kernel flip_kernel_avx2, flip_kernel_avx512; // only for a CPU that has them
#endif

struct flip {
    const allocator *memory;
    const flip_kernel *kernel;
    uint32_t width_px, height_px;
    int32_t reach; // of the widest filter
    flip_filters filters;
    flip_colours colours;
    float largest; // colour difference of pure green and blue, to the power of FLIP_COLOUR_POWER
    flip_tile *references;    // by tile of the picture
    uint64_t *reference_numbers; // by tile: of what stands there; 0: nothing that a further call may use
    uint64_t number;          // of the reference of the calls now
    uint32_t tile_count;
    flip_scratch scratch;
};

void flip_make_filters(double pixels_per_degree, flip_filters *out);
int32_t flip_reach(const flip_filters *filters);
void flip_make_colours(flip_colours *out);

#endif
