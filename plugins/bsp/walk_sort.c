// Halving of items: see walk_sort.h.
// SPDX-License-Identifier: MIT
// Invariant: the order depends on boxes and places alone; heapsort, so n log n for any input and no memory.
#include "walk_sort.h"

#include <portcullis/box.h>

typedef struct sorting {
    const walk_range *range; // NULL: by place
    int axis;
} sorting;

static float middle(const walk_range *range, uint32_t place, int axis)
{
    const cull_boxes *b = &range->zone->boxes;
    const float *low[3] = {b->min_x, b->min_y, b->min_z}, *high[3] = {b->max_x, b->max_y, b->max_z};
    const uint32_t item = range->order[place];
    return 0.5f * low[axis][item] + 0.5f * high[axis][item];
}

// In front of is before: descending along the axis.
static int comes_before(const sorting *s, uint32_t a, uint32_t b)
{
    if (s->range) {
        const float at_a = middle(s->range, a, s->axis), at_b = middle(s->range, b, s->axis);
        if (at_a != at_b) return at_a > at_b;
    }
    return a < b;
}

static void sink(const sorting *s, uint32_t *places, uint32_t at, uint32_t count)
{
    for (;;) {
        uint32_t last = at;
        for (uint32_t child = 2 * at + 1; child <= 2 * at + 2 && child < count; child++)
            if (comes_before(s, places[last], places[child])) last = child;
        if (last == at) return;
        const uint32_t spare = places[at];
        places[at] = places[last];
        places[last] = spare;
        at = last;
    }
}

static void heapsort(const sorting *s, uint32_t *places, uint32_t count)
{
    for (uint32_t i = count / 2; i-- > 0;) sink(s, places, i, count);
    for (uint32_t end = count; end > 1;) {
        const uint32_t spare = places[--end];
        places[end] = places[0];
        places[0] = spare;
        sink(s, places, 0, end);
    }
}

static int longest_axis(const walk_range *range, float *out_length)
{
    int longest = 0;
    *out_length = 0;
    for (int axis = 0; axis < 3; axis++) {
        float low = FLT_MAX, high = -FLT_MAX;
        for (uint32_t i = 0; i < range->count; i++) {
            const float at = middle(range, range->places[i], axis);
            low = at < low ? at : low;
            high = at > high ? at : high;
        }
        if (high - low > *out_length) {
            *out_length = high - low;
            longest = axis;
        }
    }
    return longest;
}

uint32_t walk_halve(const walk_range *range, uint32_t width, float plane[4])
{
    float length;
    const sorting s = {range, longest_axis(range, &length)};
    const uint32_t front = (range->count / 2 + width - 1) / width * width;
    if (!(length > 0) || front >= range->count) return 0;
    heapsort(&s, range->places, range->count);
    for (int i = 0; i < 3; i++) plane[i] = i == s.axis ? 1 : 0;
    plane[3] = -middle(range, range->places[front], s.axis);
    return front;
}

void walk_sort(uint32_t *places, uint32_t count)
{
    const sorting s = {0};
    heapsort(&s, places, count);
}
