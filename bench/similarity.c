// PSNR and SSIM: see similarity.h. SSIM by tiles: equal ones are 1 without a sum.
// SPDX-License-Identifier: MIT
// Invariant: a tile's own mean is taken off before squares are summed, so that variances keep their digits in float.
#include "similarity_parts.h"

#include <math.h>
#include <string.h>

static const similarity_kernel *best_kernel(void)
{
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512f")) return &similarity_kernel_avx512;
    if (__builtin_cpu_supports("avx2")) return &similarity_kernel_avx2;
#endif
    return &similarity_kernel_plain;
}

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
    s->kernel = best_kernel();
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

double similarity_ssim(similarity *s, const flip_pair *pair)
{
    const uint32_t wide = s->width_px - SSIM_WINDOW_PX + 1, high = s->height_px - SSIM_WINDOW_PX + 1;
    double sum = 0;
    for (uint32_t y = 0; y < high; y += SSIM_TILE_PX)
        for (uint32_t x = 0; x < wide; x += SSIM_TILE_PX) {
            const tile t = {x, y, wide - x < SSIM_TILE_PX ? wide - x : SSIM_TILE_PX, high - y < SSIM_TILE_PX ? high - y : SSIM_TILE_PX};
            if (!differs(s, pair, &t)) {
                sum += (double)t.wide * t.high;
                continue;
            }
            const float mean = load(s, pair, &t);
            s->kernel->across(s, t.high + SSIM_WINDOW_PX - 1);
            for (uint32_t row = 0; row < t.high; ++row) sum += s->kernel->row(s, &(similarity_row){row, t.wide, mean});
        }
    return sum / ((double)wide * high);
}
