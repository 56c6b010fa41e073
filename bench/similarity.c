// PSNR and SSIM: see similarity.h. SSIM by tiles: equal ones are 1 without a sum.
// SPDX-License-Identifier: MIT
// Invariant: a tile's own mean is taken off before squares are summed, so that variances keep their digits in float.
#include "similarity.h"

#include <math.h>
#include <string.h>

enum { TILE_PX = 64, SIDE_PX = TILE_PX + SSIM_WINDOW_PX - 1, SUMS = 5 };
static const float C1 = (0.01f * 255) * (0.01f * 255), C2 = (0.03f * 255) * (0.03f * 255);

struct similarity {
    const allocator *memory;
    uint32_t width_px, height_px;
    float window[SSIM_WINDOW_PX];
    float of_picture[2][SIDE_PX][SIDE_PX]; // luminance less the tile's mean
    float across[SUMS][SIDE_PX][TILE_PX];  // of a, b, a^2, b^2, ab
    float down[SUMS][TILE_PX];
};

double similarity_squared_error(const flip_pair *pair, size_t pixels)
{
    uint64_t sum = 0; // under 2^64 for any picture: 3 * 255^2 a pixel
    for (size_t i = 0; i < pixels; ++i)
        for (size_t k = 0; k < 3; ++k) {
            const int d = pair->reference[4 * i + k] - pair->test[4 * i + k];
            sum += (uint64_t)(d * d);
        }
    return (double)sum / (3.0 * (double)pixels);
}

double similarity_psnr_db(double mean_squared_error)
{
    if (!(mean_squared_error > 0)) return PSNR_MOST_DB;
    const double db = 10 * log10(255.0 * 255.0 / mean_squared_error);
    return db < PSNR_MOST_DB ? db : PSNR_MOST_DB;
}

similarity *similarity_open(const similarity_size *q, const allocator *memory)
{
    if (q->width_px < SSIM_WINDOW_PX || q->height_px < SSIM_WINDOW_PX) return NULL;
    similarity *s = memory_alloc_zeroed(memory, 1, sizeof *s);
    if (!s) return NULL;
    s->memory = memory;
    s->width_px = q->width_px;
    s->height_px = q->height_px;
    double weights[SSIM_WINDOW_PX], sum = 0;
    for (int k = 0; k < SSIM_WINDOW_PX; ++k) {
        const double x = k - SSIM_WINDOW_PX / 2;
        weights[k] = exp(-x * x / (2 * 1.5 * 1.5));
        sum += weights[k];
    }
    for (int k = 0; k < SSIM_WINDOW_PX; ++k) s->window[k] = (float)(weights[k] / sum);
    return s;
}

void similarity_close(similarity *s)
{
    if (s) memory_free(s->memory, s, 1, sizeof *s);
}

typedef struct tile { uint32_t x, y, wide, high; } tile; // of windows; pixels: SSIM_WINDOW_PX - 1 more

static int differs(const similarity *s, const flip_pair *pair, const tile *t)
{
    const size_t bytes = (size_t)(t->wide + SSIM_WINDOW_PX - 1) * 4;
    for (uint32_t y = 0; y < t->high + SSIM_WINDOW_PX - 1; ++y) {
        const size_t at = ((size_t)(t->y + y) * s->width_px + t->x) * 4;
        if (memcmp(pair->reference + at, pair->test + at, bytes) != 0) return 1;
    }
    return 0;
}

static float luminance(const uint8_t *p)
{
    return 0.299f * (float)p[0] + 0.587f * (float)p[1] + 0.114f * (float)p[2];
}

static float load(similarity *s, const flip_pair *pair, const tile *t)
{
    const uint8_t *const pictures[2] = {pair->reference, pair->test};
    const uint32_t wide = t->wide + SSIM_WINDOW_PX - 1, high = t->high + SSIM_WINDOW_PX - 1;
    double sum = 0;
    for (int i = 0; i < 2; ++i)
        for (uint32_t y = 0; y < high; ++y)
            for (uint32_t x = 0; x < wide; ++x) {
                s->of_picture[i][y][x] = luminance(pictures[i] + ((size_t)(t->y + y) * s->width_px + t->x + x) * 4);
                sum += (double)s->of_picture[i][y][x];
            }
    const float mean = (float)(sum / (2.0 * wide * high));
    for (int i = 0; i < 2; ++i)
        for (uint32_t y = 0; y < high; ++y)
            for (uint32_t x = 0; x < wide; ++x) s->of_picture[i][y][x] -= mean;
    return mean;
}

// Beyond the tile's own pixels stands what was there before: finite, and read by no window that counts.
static void sum_across(similarity *s, uint32_t rows)
{
    for (uint32_t y = 0; y < rows; ++y) {
        float products[SUMS][SIDE_PX];
        for (int x = 0; x < SIDE_PX; ++x) {
            const float a = s->of_picture[0][y][x], b = s->of_picture[1][y][x];
            products[0][x] = a;
            products[1][x] = b;
            products[2][x] = a * a;
            products[3][x] = b * b;
            products[4][x] = a * b;
        }
        for (int i = 0; i < SUMS; ++i) {
            float *out = s->across[i][y];
            for (int x = 0; x < TILE_PX; ++x) out[x] = s->window[0] * products[i][x];
            for (int k = 1; k < SSIM_WINDOW_PX; ++k)
                for (int x = 0; x < TILE_PX; ++x) out[x] += s->window[k] * products[i][x + k];
        }
    }
}

static double sum_row(similarity *s, uint32_t y, uint32_t wide, float mean)
{
    for (int i = 0; i < SUMS; ++i) {
        float *out = s->down[i];
        for (int x = 0; x < TILE_PX; ++x) out[x] = s->window[0] * s->across[i][y][x];
        for (uint32_t k = 1; k < SSIM_WINDOW_PX; ++k)
            for (int x = 0; x < TILE_PX; ++x) out[x] += s->window[k] * s->across[i][y + k][x];
    }
    double sum = 0;
    for (uint32_t x = 0; x < wide; ++x) {
        const float a = s->down[0][x], b = s->down[1][x], mean_a = a + mean, mean_b = b + mean;
        const float variance_a = s->down[2][x] - a * a, variance_b = s->down[3][x] - b * b, covariance = s->down[4][x] - a * b;
        const float over = (2 * mean_a * mean_b + C1) * (2 * covariance + C2);
        sum += (double)(over / ((mean_a * mean_a + mean_b * mean_b + C1) * (variance_a + variance_b + C2)));
    }
    return sum;
}

double similarity_ssim(similarity *s, const flip_pair *pair)
{
    const uint32_t wide = s->width_px - SSIM_WINDOW_PX + 1, high = s->height_px - SSIM_WINDOW_PX + 1;
    double sum = 0;
    for (uint32_t y = 0; y < high; y += TILE_PX)
        for (uint32_t x = 0; x < wide; x += TILE_PX) {
            const tile t = {x, y, wide - x < TILE_PX ? wide - x : TILE_PX, high - y < TILE_PX ? high - y : TILE_PX};
            if (!differs(s, pair, &t)) {
                sum += (double)t.wide * t.high;
                continue;
            }
            const float mean = load(s, pair, &t);
            sum_across(s, t.high + SSIM_WINDOW_PX - 1);
            for (uint32_t row = 0; row < t.high; ++row) sum += sum_row(s, row, t.wide, mean);
        }
    return sum / ((double)wide * high);
}
