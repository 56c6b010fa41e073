// Morton codes: see codes.h. Bits are dealt as in Raman and Wise, Converting to and from Dilated Integers, 2008.
// SPDX-License-Identifier: MIT
// Invariant: a cell is a cube whatever the box of the scene is, so a flat scene has cells as wide as high; a level is found by exact halving.
#include "codes.h"

#include <math.h>
#include <string.h>

typedef struct spot { double at[3]; } spot;

static spot centre(const cull_boxes *b, uint32_t item)
{
    const spot c = {{((double)b->min_x[item] + (double)b->max_x[item]) / 2, ((double)b->min_y[item] + (double)b->max_y[item]) / 2,
                     ((double)b->min_z[item] + (double)b->max_z[item]) / 2}};
    return c;
}

// Of the axes that are divided.
static double widest(const code_frame *f, uint32_t item)
{
    const cull_boxes *b = f->boxes;
    const double x = (double)b->max_x[item] - (double)b->min_x[item], y = (double)b->max_y[item] - (double)b->min_y[item];
    const double z = (double)b->max_z[item] - (double)b->min_z[item], flat = x > z ? x : z;
    return f->kind == OCTREE_QUAD || flat > y ? flat : y;
}

static uint64_t spread3(uint64_t x) // bit i to bit 3 i, 21 bits
{
    x = (x | x << 32) & 0x001f00000000ffffu;
    x = (x | x << 16) & 0x001f0000ff0000ffu;
    x = (x | x << 8) & 0x100f00f00f00f00fu;
    x = (x | x << 4) & 0x10c30c30c30c30c3u;
    return (x | x << 2) & 0x1249249249249249u;
}

static uint64_t spread2(uint64_t x) // bit i to bit 2 i, 32 bits
{
    x = (x | x << 16) & 0x0000ffff0000ffffu;
    x = (x | x << 8) & 0x00ff00ff00ff00ffu;
    x = (x | x << 4) & 0x0f0f0f0f0f0f0f0fu;
    x = (x | x << 2) & 0x3333333333333333u;
    return (x | x << 1) & 0x5555555555555555u;
}

static uint64_t step_along(double distance, double side)
{
    const double steps = distance / side * (double)(1u << CODE_LEVELS), most = (double)((1u << CODE_LEVELS) - 1);
    return (uint64_t)(steps < most ? steps : most);
}

static uint32_t level_for(double room, double size) // the room for one item in the frame as a whole
{
    int exponent;
    if (!(size > 0)) return CODE_LEVELS;
    frexp(room / size, &exponent); // room / size is at least 2^(exponent - 1)
    return exponent <= 1 ? 0 : exponent > CODE_LEVELS ? CODE_LEVELS : (uint32_t)exponent - 1;
}

// From the bottom up, without recursion.
static void sort(coded_item *items, coded_item *spare, uint32_t count)
{
    coded_item *from = items, *to = spare;
    for (uint64_t width = 1; width < count; width *= 2) {
        for (uint64_t first = 0; first < count; first += 2 * width) {
            const uint64_t middle = first + width < count ? first + width : count, end = first + 2 * width < count ? first + 2 * width : count;
            uint64_t a = first, b = middle;
            for (uint64_t i = first; i < end; i++) {
                const int take_a = b == end || (a < middle && from[a].code <= from[b].code);
                to[i] = take_a ? from[a] : from[b];
                a += take_a != 0;
                b += take_a == 0;
            }
        }
        coded_item *const swap = from;
        from = to;
        to = swap;
    }
    if (from != items) memcpy(items, from, count * sizeof *items);
}

int codes_make(const code_frame *f, coded_item *items, coded_item *spare, uint32_t count)
{
    spot low = {{INFINITY, INFINITY, INFINITY}}, high = {{-INFINITY, -INFINITY, -INFINITY}};
    for (uint32_t i = 0; i < count; i++) {
        const spot c = centre(f->boxes, items[i].item);
        for (int axis = 0; axis < 3; axis++) {
            low.at[axis] = fmin(low.at[axis], c.at[axis]);
            high.at[axis] = fmax(high.at[axis], c.at[axis]);
        }
    }
    const int is_quad = f->kind == OCTREE_QUAD;
    double side = fmax(high.at[0] - low.at[0], high.at[2] - low.at[2]);
    if (!is_quad) side = fmax(side, high.at[1] - low.at[1]);
    if (!(side > 0)) return 0;
    for (uint32_t i = 0; i < count; i++) {
        const spot c = centre(f->boxes, items[i].item);
        const uint64_t x = step_along(c.at[0] - low.at[0], side), y = step_along(c.at[1] - low.at[1], side), z = step_along(c.at[2] - low.at[2], side);
        items[i].code = is_quad ? spread2(x) | spread2(z) << 1 : spread3(x) | spread3(y) << 1 | spread3(z) << 2;
        items[i].level = level_for(side * (f->loose - 1), widest(f, items[i].item));
    }
    sort(items, spare, count);
    return 1;
}

void codes_sort_widest(const code_frame *f, coded_item *items, coded_item *spare, uint32_t count)
{
    spot low = {{INFINITY, INFINITY, INFINITY}}, high = {{-INFINITY, -INFINITY, -INFINITY}};
    for (uint32_t i = 0; i < count; i++) {
        const spot c = centre(f->boxes, items[i].item);
        for (int axis = 0; axis < 3; axis++) {
            low.at[axis] = fmin(low.at[axis], c.at[axis]);
            high.at[axis] = fmax(high.at[axis], c.at[axis]);
        }
    }
    int widest = 0;
    for (int axis = 1; axis < 3; axis++)
        if (high.at[axis] - low.at[axis] > high.at[widest] - low.at[widest]) widest = axis;
    for (uint32_t i = 0; i < count; i++) {
        const double from = centre(f->boxes, items[i].item).at[widest] - low.at[widest]; // not negative: its bits sort as it does
        memcpy(&items[i].code, &from, sizeof from);
    }
    sort(items, spare, count);
}
