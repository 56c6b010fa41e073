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

static int shows_mover(const float *depths, const mover_pictures *q, size_t at)
{
    return q->movers[at] > 0 && depths[at] == q->movers[at];
}

// Did what stands at a pixel around stand at (x, y), the mover there would be shown, or lost, as it is. Depths are larger where nearer.
static int is_explained_nearby(const mover_pictures *q, uint32_t x, uint32_t y)
{
    const float mover = q->movers[(size_t)y * q->width_px + x];
    const int is_shown = shows_mover(q->shown, q, (size_t)y * q->width_px + x);
    for (uint32_t row = y ? y - 1 : 0; row <= y + 1 && row < q->height_px; ++row)
        for (uint32_t column = x ? x - 1 : 0; column <= x + 1 && column < q->width_px; ++column) {
            const size_t at = (size_t)row * q->width_px + column;
            const int is_mover = shows_mover(q->geometry, q, at);
            if (is_shown ? is_mover || q->geometry[at] < mover : !is_mover && q->geometry[at] > mover) return 1;
        }
    return 0;
}

mover_order movers_count(const mover_pictures *q)
{
    mover_order sum = {0};
    for (uint32_t y = 0; y < q->height_px; ++y)
        for (uint32_t x = 0; x < q->width_px; ++x) {
            const size_t at = (size_t)y * q->width_px + x;
            const int is_true = shows_mover(q->geometry, q, at), is_shown = shows_mover(q->shown, q, at);
            sum.pixels += (uint64_t)(is_true || is_shown);
            sum.wrong += (uint64_t)(is_true != is_shown);
            sum.wrong_far += (uint64_t)(is_true != is_shown && !is_explained_nearby(q, x, y));
        }
    return sum;
}
