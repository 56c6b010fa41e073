// FLIP: tiles that differ, the final power of each pixel, the mean. See flip.h.
// SPDX-License-Identifier: MIT
#include "flip_parts.h"

#include <math.h>
#include <string.h>

// The paper's sections 4.1.4 and 4.3: differences to this power; those under PART of the largest take up TO of the scale.
enum { SIDE_MOST_PX = 1 << 20 };
static const float COLOUR_POWER = 0.7f, PART = 0.4f, TO = 0.95f;

static float hunt_difference(const flip_colours *c, int p, int q) // of two pure primaries
{
    double lab[2][3];
    const int primary[2] = {p, q};
    for (int i = 0; i < 2; ++i) {
        double f[3];
        for (int k = 0; k < 3; ++k) f[k] = cbrt((double)c->white_from_rgb[k][primary[i]]); // all over (6/29)^3
        lab[i][0] = 116 * f[1] - 16;
        lab[i][1] = 0.01 * lab[i][0] * 500 * (f[0] - f[1]);
        lab[i][2] = 0.01 * lab[i][0] * 200 * (f[1] - f[2]);
    }
    return (float)(fabs(lab[0][0] - lab[1][0]) + hypot(lab[0][1] - lab[1][1], lab[0][2] - lab[1][2]));
}

static const flip_kernel *best_kernel(void)
{
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512f")) return &flip_kernel_avx512;
    if (__builtin_cpu_supports("avx2")) return &flip_kernel_avx2;
#endif
    return &flip_kernel_plain;
}

static uint32_t tiles_in(uint32_t side_px)
{
    return (side_px + FLIP_TILE_PX - 1) / FLIP_TILE_PX;
}

flip *flip_open(const flip_request *q, const allocator *memory)
{
    if (q->width_px == 0 || q->height_px == 0 || q->width_px > SIDE_MOST_PX || q->height_px > SIDE_MOST_PX) return NULL;
    if (!(q->pixels_per_degree >= 1 && q->pixels_per_degree <= 400)) return NULL;
    flip *f = memory_alloc_zeroed(memory, 1, sizeof *f);
    if (!f) return NULL;
    f->memory = memory;
    f->kernel = best_kernel();
    f->tile_count = tiles_in(q->width_px) * tiles_in(q->height_px);
    f->references = memory_alloc(memory, f->tile_count, sizeof *f->references);
    f->reference_numbers = memory_alloc_zeroed(memory, f->tile_count, sizeof *f->reference_numbers);
    if (!f->references || !f->reference_numbers) {
        flip_close(f);
        return NULL;
    }
    f->width_px = q->width_px;
    f->height_px = q->height_px;
    flip_make_filters(q->pixels_per_degree, &f->filters);
    flip_make_colours(&f->colours);
    f->reach = flip_reach(&f->filters);
    f->largest = powf(hunt_difference(&f->colours, 1, 2), COLOUR_POWER);
    return f;
}

void flip_close(flip *f)
{
    if (!f) return;
    memory_free(f->memory, f->references, f->tile_count, sizeof *f->references);
    memory_free(f->memory, f->reference_numbers, f->tile_count, sizeof *f->reference_numbers);
    memory_free(f->memory, f, 1, sizeof *f);
}

typedef struct extent { uint32_t first[2], size[2]; } extent;

// The tile's pixels, and all that its filters see.
static extent extent_of(const flip *f, const uint32_t corner[2], uint32_t margin)
{
    const uint32_t sides[2] = {f->width_px, f->height_px};
    extent e;
    for (int k = 0; k < 2; ++k) {
        const uint32_t end = corner[k] + FLIP_TILE_PX + margin;
        e.first[k] = corner[k] > margin ? corner[k] - margin : 0;
        e.size[k] = (end < sides[k] ? end : sides[k]) - e.first[k];
    }
    return e;
}

static int differs(const flip *f, const flip_pair *pair, const extent *e)
{
    for (uint32_t y = 0; y < e->size[1]; ++y) {
        const size_t at = ((size_t)(e->first[1] + y) * f->width_px + e->first[0]) * 4;
        if (memcmp(pair->reference + at, pair->test + at, (size_t)e->size[0] * 4) != 0) return 1;
    }
    return 0;
}

static float difference_of(const flip *f, float colour, float feature)
{
    if (!(colour > 0)) return 0;
    const float knee = PART * f->largest, c = powf(colour, COLOUR_POWER);
    const float scaled = c < knee ? c * (TO / knee) : TO + (c - knee) / (f->largest - knee) * (1 - TO);
    return powf(scaled < 1 ? scaled : 1, 1 - sqrtf(feature * 0.70710678f)); // a feature has at most sqrt(2)
}

static double add_tile(const flip *f, const extent *e, float *map)
{
    double sum = 0;
    for (uint32_t y = 0; y < e->size[1]; ++y)
        for (uint32_t x = 0; x < e->size[0]; ++x) {
            const size_t from = (size_t)y * FLIP_TILE_PX + x;
            const float d = difference_of(f, f->scratch.colour[from], f->scratch.feature[from]);
            sum += (double)d;
            if (map) map[(size_t)(e->first[1] + y) * f->width_px + e->first[0] + x] = d;
        }
    return sum;
}

void flip_keep_reference(flip *f, uint64_t number)
{
    f->number = number;
}

static const flip_tile *reference_tile(flip *f, const uint8_t *rgba, const uint32_t corner[2])
{
    const uint32_t at = corner[1] / FLIP_TILE_PX * tiles_in(f->width_px) + corner[0] / FLIP_TILE_PX;
    flip_tile *kept = f->number ? &f->references[at] : &f->scratch.other;
    if (f->number == 0 || f->reference_numbers[at] != f->number) f->kernel->filter(f, &f->scratch, rgba, corner, kept);
    if (f->number) f->reference_numbers[at] = f->number;
    return kept;
}

double flip_compare(flip *f, const flip_pair *pair, float *map)
{
    const size_t pixels = (size_t)f->width_px * f->height_px;
    double sum = 0;
    if (map) memset(map, 0, pixels * sizeof *map);
    for (uint32_t y = 0; y < f->height_px; y += FLIP_TILE_PX)
        for (uint32_t x = 0; x < f->width_px; x += FLIP_TILE_PX) {
            const uint32_t corner[2] = {x, y};
            const extent seen = extent_of(f, corner, (uint32_t)f->reach), own = extent_of(f, corner, 0);
            if (!differs(f, pair, &seen)) continue;
            const flip_tile *reference = reference_tile(f, pair->reference, corner);
            f->kernel->filter(f, &f->scratch, pair->test, corner, &f->scratch.tile);
            f->kernel->compare(&f->scratch, reference);
            sum += add_tile(f, &own, map);
        }
    return sum / (double)pixels;
}

void flip_heat(const float *map, size_t pixels, uint8_t *rgba)
{
    enum { STOPS = 5 };
    static const float stops[STOPS][3] = {{0, 0, 0}, {84, 20, 120}, {190, 50, 110}, {250, 140, 70}, {255, 250, 200}};
    for (size_t i = 0; i < pixels; ++i) {
        const float v = map[i] * (STOPS - 1);
        const int stop = v < STOPS - 2 ? (int)v : STOPS - 2;
        const float part = v - (float)stop;
        for (int k = 0; k < 3; ++k) rgba[4 * i + (size_t)k] = (uint8_t)(stops[stop][k] + part * (stops[stop + 1][k] - stops[stop][k]) + 0.5f);
        rgba[4 * i + 3] = 255;
    }
}
