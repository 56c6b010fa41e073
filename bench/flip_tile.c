// FLIP: one tile of both pictures, filtered and compared. See flip.h.
// SPDX-License-Identifier: MIT
// Invariant: a pixel's sums run in one order, in vectors that the source says, so every compiler gives the same bits.
#include "flip_parts.h"

#include <math.h>
#include <string.h>

typedef float lanes __attribute__((vector_size(16)));
enum { LANES = 4 };

// As variables, not arrays of them: gcc keeps arrays in memory.
static inline lanes lanes_at(const float *in)
{
    lanes out;
    memcpy(&out, in, sizeof out);
    return out;
}

// One row of a tile: sum over k of weight[k] * (in[x + k * step] + in[x - k * step]); step 1: along the row, else down.
static void sum_even(const float *in, ptrdiff_t step, const flip_taps *t, float *out)
{
    for (ptrdiff_t x = 0; x < FLIP_TILE_PX; x += 2 * LANES) {
        const float *at = in + x;
        lanes sum = lanes_at(at) * t->weight[0], next = lanes_at(at + LANES) * t->weight[0];
        for (int32_t k = 1; k <= t->reach; ++k) {
            const float *before = at - k * step, *behind = at + k * step;
            sum += t->weight[k] * (lanes_at(behind) + lanes_at(before));
            next += t->weight[k] * (lanes_at(behind + LANES) + lanes_at(before + LANES));
        }
        memcpy(out + x, &sum, sizeof sum);
        memcpy(out + x + LANES, &next, sizeof next);
    }
}

static void sum_odd(const float *in, ptrdiff_t step, const flip_taps *t, float *out)
{
    for (ptrdiff_t x = 0; x < FLIP_TILE_PX; x += 2 * LANES) {
        const float *at = in + x;
        lanes sum = {0}, next = {0};
        for (int32_t k = 1; k <= t->reach; ++k) {
            const float *before = at - k * step, *behind = at + k * step;
            sum += t->weight[k] * (lanes_at(behind) - lanes_at(before));
            next += t->weight[k] * (lanes_at(behind + LANES) - lanes_at(before + LANES));
        }
        memcpy(out + x, &sum, sizeof sum);
        memcpy(out + x + LANES, &next, sizeof next);
    }
}

// The tile and what the filters reach around it, as luminance and two opponent colours, linear. Beyond the picture its border goes on.
static void load(flip *f, const uint8_t *rgba, const uint32_t corner[2])
{
    const int32_t side = FLIP_TILE_PX + 2 * f->reach, width = (int32_t)f->width_px, height = (int32_t)f->height_px;
    const float(*m)[3] = (const float(*)[3])f->colours.white_from_rgb, *linear = f->colours.linear;
    for (int32_t y = 0; y < side; ++y) {
        const int32_t at = (int32_t)corner[1] + y - f->reach, row = at < 0 ? 0 : at >= height ? height - 1 : at;
        const uint8_t *pixels = rgba + (size_t)row * f->width_px * 4;
        const size_t first = (size_t)y * FLIP_SIDE_MOST;
        for (int32_t x = 0; x < side; ++x) {
            const int32_t column = (int32_t)corner[0] + x - f->reach;
            const uint8_t *p = pixels + (size_t)(column < 0 ? 0 : column >= width ? width - 1 : column) * 4;
            const float r = linear[p[0]], g = linear[p[1]], b = linear[p[2]];
            const float luminance = m[1][0] * r + m[1][1] * g + m[1][2] * b;
            f->scratch.luminance[first + (size_t)x] = luminance;
            f->scratch.red_green[first + (size_t)x] = m[0][0] * r + m[0][1] * g + m[0][2] * b - luminance;
            f->scratch.blue_yellow[first + (size_t)x] = luminance - (m[2][0] * r + m[2][1] * g + m[2][2] * b);
        }
    }
}

static void filter_across(flip *f)
{
    flip_scratch *s = &f->scratch;
    const flip_filters *t = &f->filters;
    for (int32_t y = 0; y < FLIP_TILE_PX + 2 * f->reach; ++y) {
        const size_t in = (size_t)y * FLIP_SIDE_MOST + (size_t)f->reach, out = (size_t)y * FLIP_TILE_PX;
        sum_even(s->luminance + in, 1, &t->luminance, s->across[0] + out);
        sum_even(s->red_green + in, 1, &t->red_green, s->across[1] + out);
        sum_even(s->blue_yellow + in, 1, &t->blue_yellow[0][0], s->across[2] + out);
        sum_even(s->blue_yellow + in, 1, &t->blue_yellow[1][0], s->across[3] + out);
        sum_even(s->luminance + in, 1, &t->smooth, s->across[4] + out);
        sum_odd(s->luminance + in, 1, &t->edge, s->across[5] + out);
        sum_even(s->luminance + in, 1, &t->point, s->across[6] + out);
    }
}

static void filter_down(flip *f, flip_tile *tile)
{
    flip_scratch *s = &f->scratch;
    const flip_filters *t = &f->filters;
    for (int32_t y = 0; y < FLIP_TILE_PX; ++y) {
        const size_t in = (size_t)(y + f->reach) * FLIP_TILE_PX, out = (size_t)y * FLIP_TILE_PX;
        float along[FLIP_TILE_PX], down[FLIP_TILE_PX];
        sum_even(s->across[0] + in, FLIP_TILE_PX, &t->luminance, s->down[0] + out);
        sum_even(s->across[1] + in, FLIP_TILE_PX, &t->red_green, s->down[1] + out);
        sum_even(s->across[2] + in, FLIP_TILE_PX, &t->blue_yellow[0][1], s->down[2] + out);
        sum_even(s->across[3] + in, FLIP_TILE_PX, &t->blue_yellow[1][1], down);
        for (int x = 0; x < FLIP_TILE_PX; ++x) s->down[2][out + (size_t)x] += down[x];
        sum_even(s->across[5] + in, FLIP_TILE_PX, &t->smooth, along);
        sum_odd(s->across[4] + in, FLIP_TILE_PX, &t->edge, down);
        for (int x = 0; x < FLIP_TILE_PX; ++x) tile->edges[out + (size_t)x] = sqrtf(along[x] * along[x] + down[x] * down[x]);
        sum_even(s->across[6] + in, FLIP_TILE_PX, &t->smooth, along);
        sum_even(s->across[4] + in, FLIP_TILE_PX, &t->point, down);
        for (int x = 0; x < FLIP_TILE_PX; ++x) tile->points[out + (size_t)x] = sqrtf(along[x] * along[x] + down[x] * down[x]);
    }
}

// Of 2^-20 .. 2: a guess from the exponent, within 4%, and two steps of Halley's, each of which cubes that error.
static inline float cube_root(float t)
{
    int32_t bits;
    float root;
    memcpy(&bits, &t, sizeof bits);
    bits = (int32_t)((float)bits * (1.0f / 3)) + 709921077; // 2/3 of the exponent's offset, less what evens the guess out
    memcpy(&root, &bits, sizeof root);
    for (int i = 0; i < 2; ++i) {
        const float cube = root * root * root;
        root *= (cube + 2 * t) / (2 * cube + t);
    }
    return root;
}

// CIE 1976: the cube root, and below (6/29)^3 the line that meets it.
static inline float compressed(float t)
{
    const float line = t * (841.0f / 108) + 4.0f / 29, root = cube_root(t > 0x1p-20f ? t : 0x1p-20f);
    return t > 216.0f / 24389 ? root : line;
}

static inline float within(float v)
{
    return v < 0 ? 0 : v > 1 ? 1 : v;
}

// Hunt's adjustment: a dark colour is less of a colour.
static void finish_colours(const flip *f, flip_tile *tile)
{
    const float(*m)[3] = (const float(*)[3])f->colours.rgb_from_white, (*w)[3] = (const float(*)[3])f->colours.white_from_rgb;
    const float *in_y = f->scratch.down[0], *in_x = f->scratch.down[1], *in_z = f->scratch.down[2];
    for (int i = 0; i < FLIP_TILE_PIXELS; ++i) {
        const float y = in_y[i], x = in_x[i] + y, z = y - in_z[i];
        const float r = within(m[0][0] * x + m[0][1] * y + m[0][2] * z), g = within(m[1][0] * x + m[1][1] * y + m[1][2] * z);
        const float b = within(m[2][0] * x + m[2][1] * y + m[2][2] * z);
        const float fx = compressed(w[0][0] * r + w[0][1] * g + w[0][2] * b), fy = compressed(w[1][0] * r + w[1][1] * g + w[1][2] * b);
        const float fz = compressed(w[2][0] * r + w[2][1] * g + w[2][2] * b), lightness = 116 * fy - 16;
        tile->lightness[i] = lightness;
        tile->a[i] = 0.01f * lightness * (500 * (fx - fy));
        tile->b[i] = 0.01f * lightness * (200 * (fy - fz));
    }
}

// HyAB: lightness by its difference, the two colours by their distance.
void flip_compare_tile(flip_scratch *s, const flip_tile *reference)
{
    const flip_tile *p = reference, *q = &s->tile;
    for (int i = 0; i < FLIP_TILE_PIXELS; ++i) {
        const float a = p->a[i] - q->a[i], b = p->b[i] - q->b[i];
        const float edges = fabsf(p->edges[i] - q->edges[i]), points = fabsf(p->points[i] - q->points[i]);
        s->colour[i] = fabsf(p->lightness[i] - q->lightness[i]) + sqrtf(a * a + b * b);
        s->feature[i] = edges > points ? edges : points;
    }
}

void flip_filter_tile(flip *f, const uint8_t *rgba, const uint32_t corner[2], flip_tile *out)
{
    load(f, rgba, corner);
    filter_across(f);
    filter_down(f, out);
    finish_colours(f, out);
}
