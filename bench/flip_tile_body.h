// FLIP: one tile of both pictures, filtered and compared. Included by a file for each instruction set, which defines FLIP_LANES. See flip.h.
// SPDX-License-Identifier: MIT
// Invariant: a pixel's sums run in one order, in vectors that the source says, so every compiler and every width gives the same bits.
#include "flip_parts.h"

#include <math.h>
#include <string.h>

typedef float lanes __attribute__((vector_size(4 * FLIP_LANES)));
typedef int32_t words __attribute__((vector_size(4 * FLIP_LANES)));
enum { LANES = FLIP_LANES };

// As variables, not arrays of them: gcc keeps arrays in memory.
static inline lanes lanes_at(const float *in)
{
    lanes out;
    memcpy(&out, in, sizeof out);
    return out;
}

static inline void put(lanes a, lanes b, lanes c, lanes d, float *out)
{
    memcpy(out, &a, sizeof a);
    memcpy(out + LANES, &b, sizeof b);
    memcpy(out + 2 * LANES, &c, sizeof c);
    memcpy(out + 3 * LANES, &d, sizeof d);
}

// One row of a tile: sum over k of weight[k] * (in[x + k * step] + in[x - k * step]); step 1: along the row, else down. Four sums at once: each
// waits for its last addition.
static void sum_even(const float *in, ptrdiff_t step, const flip_taps *t, float *out)
{
    for (ptrdiff_t x = 0; x < FLIP_TILE_PX; x += 4 * LANES) {
        const float *at = in + x;
        lanes a = lanes_at(at) * t->weight[0], b = lanes_at(at + LANES) * t->weight[0], c = lanes_at(at + 2 * LANES) * t->weight[0],
              d = lanes_at(at + 3 * LANES) * t->weight[0];
        for (int32_t k = 1; k <= t->reach; ++k) {
            const float *before = at - k * step, *behind = at + k * step;
            const float weight = t->weight[k];
            a += weight * (lanes_at(behind) + lanes_at(before));
            b += weight * (lanes_at(behind + LANES) + lanes_at(before + LANES));
            c += weight * (lanes_at(behind + 2 * LANES) + lanes_at(before + 2 * LANES));
            d += weight * (lanes_at(behind + 3 * LANES) + lanes_at(before + 3 * LANES));
        }
        put(a, b, c, d, out + x);
    }
}

static void sum_odd(const float *in, ptrdiff_t step, const flip_taps *t, float *out)
{
    for (ptrdiff_t x = 0; x < FLIP_TILE_PX; x += 4 * LANES) {
        const float *at = in + x;
        lanes a = {0}, b = {0}, c = {0}, d = {0};
        for (int32_t k = 1; k <= t->reach; ++k) {
            const float *before = at - k * step, *behind = at + k * step;
            const float weight = t->weight[k];
            a += weight * (lanes_at(behind) - lanes_at(before));
            b += weight * (lanes_at(behind + LANES) - lanes_at(before + LANES));
            c += weight * (lanes_at(behind + 2 * LANES) - lanes_at(before + 2 * LANES));
            d += weight * (lanes_at(behind + 3 * LANES) - lanes_at(before + 3 * LANES));
        }
        put(a, b, c, d, out + x);
    }
}

// A row of what the filters see, as linear red, green and blue: beyond the picture its border goes on.
typedef struct linear_row { float red[FLIP_SIDE_MOST], green[FLIP_SIDE_MOST], blue[FLIP_SIDE_MOST]; } linear_row;

static void load_row(const flip *f, const uint8_t *row, int32_t first, int32_t side, linear_row *out)
{
    const int32_t width = (int32_t)f->width_px, before = first < 0 ? -first : 0, behind = first + side > width ? width - first : side;
    const float *linear = f->colours.linear;
    uint8_t pixels[FLIP_SIDE_MOST * 4];
    for (int32_t x = 0; x < before; ++x) memcpy(pixels + 4 * x, row, 4);
    memcpy(pixels + 4 * before, row + 4 * (ptrdiff_t)(first + before), 4 * (size_t)(behind - before));
    for (int32_t x = behind; x < side; ++x) memcpy(pixels + 4 * x, row + 4 * (ptrdiff_t)(width - 1), 4);
    for (int32_t x = 0; x < side; ++x) {
        out->red[x] = linear[pixels[4 * x]];
        out->green[x] = linear[pixels[4 * x + 1]];
        out->blue[x] = linear[pixels[4 * x + 2]];
    }
}

// The tile and what the filters reach around it, as luminance and two opponent colours, linear.
static void load(const flip *f, flip_scratch *s, const uint8_t *rgba, const uint32_t corner[2])
{
    const int32_t side = FLIP_TILE_PX + 2 * f->reach, height = (int32_t)f->height_px;
    const flip_colours c = f->colours;
    const float(*m)[3] = (const float(*)[3])c.white_from_rgb;
    linear_row in;
    for (int32_t y = 0; y < side; ++y) {
        const int32_t at = (int32_t)corner[1] + y - f->reach, row = at < 0 ? 0 : at >= height ? height - 1 : at;
        float *luminances = s->luminance + (size_t)y * FLIP_SIDE_MOST, *reds = s->red_green + (size_t)y * FLIP_SIDE_MOST;
        float *blues = s->blue_yellow + (size_t)y * FLIP_SIDE_MOST;
        load_row(f, rgba + (size_t)row * f->width_px * 4, (int32_t)corner[0] - f->reach, side, &in);
        for (int32_t x = 0; x < side; ++x) {
            const float r = in.red[x], g = in.green[x], b = in.blue[x];
            const float luminance = m[1][0] * r + m[1][1] * g + m[1][2] * b;
            luminances[x] = luminance;
            reds[x] = m[0][0] * r + m[0][1] * g + m[0][2] * b - luminance;
            blues[x] = luminance - (m[2][0] * r + m[2][1] * g + m[2][2] * b);
        }
    }
}

static void filter_across(const flip *f, flip_scratch *s)
{
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

static void filter_down(const flip *f, flip_scratch *s, flip_tile *tile)
{
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

static inline lanes chosen(words where, lanes a, lanes b)
{
    return (lanes)((where & (words)a) | (~where & (words)b));
}

static inline lanes all_of(float v)
{
    return v - (lanes){0};
}

// Of 2^-20 .. 2: a guess from the exponent, within 4%, and two steps of Halley's, each of which cubes that error.
static inline lanes cube_root(lanes t)
{
    const lanes third = __builtin_convertvector((words)t, lanes) * (1.0f / 3);
    lanes root = (lanes)(__builtin_convertvector(third, words) + 709921077); // 2/3 of the exponent's offset, less what evens the guess out
    for (int i = 0; i < 2; ++i) {
        const lanes cube = root * root * root;
        root *= (cube + 2 * t) / (2 * cube + t);
    }
    return root;
}

// CIE 1976: the cube root, and below (6/29)^3 the line that meets it.
static inline lanes compressed(lanes t)
{
    const lanes line = t * (841.0f / 108) + 4.0f / 29, root = cube_root(chosen(t > 0x1p-20f, t, all_of(0x1p-20f)));
    return chosen(t > 216.0f / 24389, root, line);
}

static inline lanes within(lanes v)
{
    return chosen(v < 0, all_of(0), chosen(v > 1, all_of(1), v));
}

static inline lanes weighted(const float row[3], lanes x, lanes y, lanes z)
{
    return row[0] * x + row[1] * y + row[2] * z;
}

// Hunt's adjustment: a dark colour is less of a colour.
static void finish_colours(const flip *f, const flip_scratch *s, flip_tile *tile)
{
    const float(*m)[3] = (const float(*)[3])f->colours.rgb_from_white, (*w)[3] = (const float(*)[3])f->colours.white_from_rgb;
    for (int i = 0; i < FLIP_TILE_PIXELS; i += LANES) {
        const lanes y = lanes_at(s->down[0] + i), x = lanes_at(s->down[1] + i) + y, z = y - lanes_at(s->down[2] + i);
        const lanes r = within(weighted(m[0], x, y, z)), g = within(weighted(m[1], x, y, z)), b = within(weighted(m[2], x, y, z));
        const lanes fx = compressed(weighted(w[0], r, g, b)), fy = compressed(weighted(w[1], r, g, b)), fz = compressed(weighted(w[2], r, g, b));
        const lanes lightness = 116 * fy - 16, red = 0.01f * lightness * (500 * (fx - fy)), blue = 0.01f * lightness * (200 * (fy - fz));
        memcpy(tile->lightness + i, &lightness, sizeof lightness);
        memcpy(tile->a + i, &red, sizeof red);
        memcpy(tile->b + i, &blue, sizeof blue);
    }
}

// HyAB: lightness by its difference, the two colours by their distance.
static void compare_tile(flip_scratch *s, const flip_tile *reference)
{
    const flip_tile *p = reference, *q = &s->tile;
    for (int i = 0; i < FLIP_TILE_PIXELS; ++i) {
        const float a = p->a[i] - q->a[i], b = p->b[i] - q->b[i];
        const float edges = fabsf(p->edges[i] - q->edges[i]), points = fabsf(p->points[i] - q->points[i]);
        s->colour[i] = fabsf(p->lightness[i] - q->lightness[i]) + sqrtf(a * a + b * b);
        s->feature[i] = edges > points ? edges : points;
    }
}

static void filter_tile(const flip *f, flip_scratch *s, const uint8_t *rgba, const uint32_t corner[2], flip_tile *out)
{
    load(f, s, rgba, corner);
    filter_across(f, s);
    filter_down(f, s, out);
    finish_colours(f, s, out);
}
