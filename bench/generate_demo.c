// demo: the project's own scene and the walk through it: six rooms of a museum, out of the door, along the street, up.
// SPDX-License-Identifier: MIT
// Importers make a colour from a material's name: from a word like brick, else from its hash, and then a number in the
// name chooses one that suits.
#include "generate_demo.h"

#include "generate_kinds.h"

#include <math.h>

enum { DEMO_KEY = 0x64656d6f, FRAMES = 120 };

typedef struct key_frame { double frame; spot eye, target; } key_frame;

// Eyes 1.65 m above the floor but for the last ones, which rise over the street.
static const key_frame walk[] = {
    {0, {-13.6, 1.65, -20.8}, {-9.9, 1.5, -16.6}},
    {7, {-10.9, 1.65, -20.2}, {-9.4, 1.5, -14}},
    {13, {-8.6, 1.65, -16.2}, {-9.9, 1.3, -11}},
    {18, {-9.8, 1.65, -12.6}, {-9.8, 1.5, -5}},
    {24, {-9.2, 1.65, -8.6}, {-9.9, 1.5, -5.2}},
    {29, {-7.6, 1.65, -5.9}, {-2, 1.5, -5.8}},
    {34, {-4.2, 1.65, -5.8}, {1, 1.6, -9}},
    {39, {-0.6, 1.65, -7.4}, {0, 1.9, -15.4}},
    {44, {0, 1.65, -11}, {0, 2.2, -15.4}},
    {50, {2, 1.65, -14.2}, {0.4, 2.2, -16}},
    {56, {3.4, 1.65, -17.8}, {8, 1.4, -18.4}},
    {61, {6, 1.65, -18.2}, {10, 1.3, -16}},
    {66, {9.8, 1.65, -16}, {9.8, 1.4, -10}},
    {71, {9.8, 1.65, -11}, {10, 1.3, -6}},
    {76, {9, 1.65, -7}, {12.8, 1.3, -4}},
    {81, {6, 1.65, -5.8}, {0, 1.6, -5.6}},
    {86, {1.2, 1.65, -4.6}, {0, 1.6, 3}},
    {91, {0, 1.65, 0.2}, {3, 1.8, 10}},
    {96, {2, 1.65, 3.6}, {14, 2.5, 7.5}},
    {103, {10, 1.6, 5.8}, {40, 4, 6}},
    {108, {17, 1.6, 6}, {30, 12, 1}},
    {112, {22, 3.5, 6}, {20, 10, 14}},
    {116, {27, 10, 6}, {8, 7, 6}},
    {119, {30, 15, 7}, {-6, 2, 0}},
};
enum { KEYS = (int)(sizeof walk / sizeof *walk) };

void generate_demo(uint64_t seed, const allocator *memory, text_file *out)
{
    random_stream inside = random_make(seed, DEMO_KEY), outside = random_make(seed, DEMO_KEY + 1);
    obj_writer w = obj_open(out, memory);
    demo_museum(&w, &inside);
    demo_street(&w, &outside);
    obj_close(&w);
}

// Cubic Hermite between b and c, slopes from the neighbours (Catmull-Rom over uneven frames).
static double hermite(const double *value, const double *frame, double at)
{
    const double span = frame[2] - frame[1], t = (at - frame[1]) / span;
    const double slope_b = frame[2] > frame[0] ? (value[2] - value[0]) / (frame[2] - frame[0]) * span : 0;
    const double slope_c = frame[3] > frame[1] ? (value[3] - value[1]) / (frame[3] - frame[1]) * span : 0;
    const double square = t * t, cube = square * t;
    return (2 * cube - 3 * square + 1) * value[1] + (cube - 2 * square + t) * slope_b + (3 * square - 2 * cube) * value[2] +
           (cube - square) * slope_c;
}

static void walk_at(double frame, double out[6])
{
    int i = 0;
    while (i + 2 < KEYS && walk[i + 1].frame <= frame) i++;
    double frames[4], values[6][4];
    for (int k = 0; k < 4; ++k) {
        int from = i + k - 1;
        if (from < 0) from = 0;
        if (from > KEYS - 1) from = KEYS - 1;
        const key_frame *key = &walk[from];
        const double numbers[6] = {key->eye.x, key->eye.y, key->eye.z, key->target.x, key->target.y, key->target.z};
        frames[k] = key->frame;
        for (int n = 0; n < 6; ++n) values[n][k] = numbers[n];
    }
    for (int n = 0; n < 6; ++n) out[n] = hermite(values[n], frames, frame);
}

static void decimal_add(text_file *out, double value, uint32_t decimals)
{
    double power = 1;
    for (uint32_t i = 0; i < decimals; ++i) power *= 10;
    text_decimal(out, (int64_t)floor(value * power + 0.5), decimals);
    text_add(out, " ");
}

void generate_demo_path(text_file *out)
{
    enum { EYE_DECIMALS = 3, DIRECTION_DECIMALS = 6 };
    for (int i = 0; i < FRAMES; ++i) {
        double at[6], to[3], length = 0;
        walk_at(i, at);
        for (int n = 0; n < 3; ++n) {
            to[n] = at[n + 3] - at[n];
            length += to[n] * to[n];
        }
        length = sqrt(length);
        for (int n = 0; n < 3; ++n) decimal_add(out, at[n], EYE_DECIMALS);
        for (int n = 0; n < 3; ++n) decimal_add(out, to[n] / length, DIRECTION_DECIMALS);
        text_add(out, "0 1 0 60 1.777778 0.0625 1000\n"); // up, fovy, aspect, near, far
    }
}
