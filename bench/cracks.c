// Cracks: see cracks.h.
// SPDX-License-Identifier: MIT
#include "cracks.h"

#include <string.h>

typedef struct hits { uint32_t count, seen; } hits; // of the up to nine pixels around and at one

static hits hits_around(const crack_pictures *q, uint32_t x, uint32_t y)
{
    hits h = {0};
    for (uint32_t row = y ? y - 1 : 0; row <= y + 1 && row < q->height_px; ++row)
        for (uint32_t column = x ? x - 1 : 0; column <= x + 1 && column < q->width_px; ++column) {
            h.count += q->geometry[(size_t)row * q->width_px + column] > 0;
            h.seen++;
        }
    return h;
}

static int count_pixel(const crack_pictures *q, uint32_t x, uint32_t y, crack_counts *sum)
{
    enum { ALL_AROUND = 9 };
    const size_t at = (size_t)y * q->width_px + x;
    const int is_hole = q->must_show[at] > 0 && !(q->shown[at] > 0), is_over = q->shown[at] > 0 && !(q->geometry[at] > 0);
    if (!is_hole && !is_over) return 0;
    const hits h = hits_around(q, x, y);
    const int is_spill = is_over && h.count == 0 && h.seen == ALL_AROUND;
    sum->holes += (uint64_t)is_hole;
    sum->inner += (uint64_t)(is_hole && h.count == h.seen);
    sum->spills += (uint64_t)is_spill;
    return is_hole || is_spill;
}

crack_counts cracks_count(const crack_pictures *q, uint8_t *marks)
{
    crack_counts sum = {0};
    for (uint32_t y = 0; y < q->height_px; ++y)
        for (uint32_t x = 0; x < q->width_px; ++x) {
            const int is_crack = count_pixel(q, x, y, &sum);
            if (marks) marks[(size_t)y * q->width_px + x] = (uint8_t)is_crack;
        }
    return sum;
}

mover_order movers_count(const mover_pictures *q)
{
    mover_order sum = {0};
    for (size_t i = 0; i < q->pixels; ++i) {
        if (!(q->movers[i] > 0)) continue;
        const int is_true = q->geometry[i] == q->movers[i], is_shown = q->shown[i] == q->movers[i];
        sum.pixels += (uint64_t)(is_true || is_shown);
        sum.wrong += (uint64_t)(is_true != is_shown);
    }
    return sum;
}
