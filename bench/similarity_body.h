// SSIM's sums over windows. Included by a file for each instruction set, which defines SSIM_LANES. See similarity.h.
// SPDX-License-Identifier: MIT
// Invariant: a pixel's sums run in one order, in vectors that the source says, so every compiler and every width gives the same bits.
#include "similarity_parts.h"

#include <string.h>

typedef float lanes __attribute__((vector_size(4 * SSIM_LANES)));
enum { LANES = SSIM_LANES };
static const float C1 = (0.01f * 255) * (0.01f * 255), C2 = (0.03f * 255) * (0.03f * 255);

static inline lanes lanes_at(const float *in)
{
    lanes out;
    memcpy(&out, in, sizeof out);
    return out;
}

// One row of a tile: the sum over k of window[k] * in[x + k * step].
static void sum_window(const float *in, ptrdiff_t step, const float *window, float *out)
{
    for (ptrdiff_t x = 0; x < SSIM_TILE_PX; x += 2 * LANES) {
        const float *at = in + x;
        lanes a = window[0] * lanes_at(at), b = window[0] * lanes_at(at + LANES);
        for (ptrdiff_t k = 1; k < SSIM_WINDOW_PX; ++k) {
            a += window[k] * lanes_at(at + k * step);
            b += window[k] * lanes_at(at + k * step + LANES);
        }
        memcpy(out + x, &a, sizeof a);
        memcpy(out + x + LANES, &b, sizeof b);
    }
}

// Beyond the tile's own pixels stands what was there before: finite, and read by no window that counts.
static void across(similarity *s, uint32_t rows)
{
    for (uint32_t y = 0; y < rows; ++y) {
        float products[SSIM_SUMS][SSIM_SIDE_PX];
        for (int x = 0; x < SSIM_SIDE_PX; ++x) {
            const float a = s->of_picture[0][y][x], b = s->of_picture[1][y][x];
            products[0][x] = a;
            products[1][x] = b;
            products[2][x] = a * a;
            products[3][x] = b * b;
            products[4][x] = a * b;
        }
        for (int i = 0; i < SSIM_SUMS; ++i) sum_window(products[i], 1, s->window, s->across[i][y]);
    }
}

static double row(similarity *s, const similarity_row *q)
{
    float alike[SSIM_TILE_PX];
    for (int i = 0; i < SSIM_SUMS; ++i) sum_window(&s->across[i][q->y][0], SSIM_TILE_PX, s->window, s->down[i]);
    for (int x = 0; x < SSIM_TILE_PX; ++x) {
        const float a = s->down[0][x], b = s->down[1][x], mean_a = a + q->mean, mean_b = b + q->mean;
        const float variance_a = s->down[2][x] - a * a, variance_b = s->down[3][x] - b * b, covariance = s->down[4][x] - a * b;
        const float over = (2 * mean_a * mean_b + C1) * (2 * covariance + C2);
        alike[x] = over / ((mean_a * mean_a + mean_b * mean_b + C1) * (variance_a + variance_b + C2));
    }
    double sum = 0;
    for (uint32_t x = 0; x < q->wide; ++x) sum += (double)alike[x];
    return sum;
}
