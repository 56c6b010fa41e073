// The order of items: a k-d tree by medians (Bentley 1975), whose cuts fall on multiples of 16^k so that every leaf is full.
// SPDX-License-Identifier: MIT
// The items are sorted once along each axis; a cut then only divides two lists by a mark, keeping their order, so the
// time is O(n log n) on any input.
#include "index.h"

#include <string.h>

typedef struct keyed_item { uint32_t key, item; } keyed_item;

typedef struct splitter {
    const cull_boxes *boxes;
    uint32_t *lists[3]; // the items of a range, each time sorted along one axis
    uint32_t *spare;
    uint8_t *is_right; // by item
    uint32_t *order;
} splitter;

static float centre(const cull_boxes *boxes, int axis, uint32_t item)
{
    const float *low[3] = {boxes->min_x, boxes->min_y, boxes->min_z};
    const float *high[3] = {boxes->max_x, boxes->max_y, boxes->max_z};
    return low[axis][item] * 0.5f + high[axis][item] * 0.5f;
}

// Unsigned integers that sort as the floats do.
static uint32_t sortable(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits & 0x80000000u ? ~bits : bits | 0x80000000u;
}

// Least significant digit first, 3 digits of 11 bits; equal keys keep the order of their ids.
static void sort_axis(const cull_boxes *boxes, int axis, uint32_t count, keyed_item *a, keyed_item *b, uint32_t *list)
{
    enum { DIGITS = 3, DIGIT_BITS = 11, BUCKETS = 1 << DIGIT_BITS };
    uint32_t starts[DIGITS][BUCKETS];
    memset(starts, 0, sizeof starts);
    for (uint32_t i = 0; i < count; i++) {
        a[i] = (keyed_item){sortable(centre(boxes, axis, i)), i};
        for (int d = 0; d < DIGITS; d++) starts[d][a[i].key >> d * DIGIT_BITS & (BUCKETS - 1)]++;
    }
    for (int d = 0; d < DIGITS; d++) {
        uint32_t sum = 0;
        for (int k = 0; k < BUCKETS; k++) {
            const uint32_t size = starts[d][k];
            starts[d][k] = sum;
            sum += size;
        }
        for (uint32_t i = 0; i < count; i++) b[starts[d][a[i].key >> d * DIGIT_BITS & (BUCKETS - 1)]++] = a[i];
        keyed_item *swap = a;
        a = b;
        b = swap;
    }
    for (uint32_t i = 0; i < count; i++) list[i] = a[i].item;
}

static int widest_axis(const splitter *s, uint32_t first, uint32_t count)
{
    int widest = 0;
    float most = -1;
    for (int axis = 0; axis < 3; axis++) {
        const uint32_t *list = s->lists[axis] + first;
        const float width = centre(s->boxes, axis, list[count - 1]) - centre(s->boxes, axis, list[0]);
        if (width > most) {
            most = width;
            widest = axis;
        }
    }
    return widest;
}

// Items not marked first, then the marked, each in the order that they had. Without a branch: the marks look random.
static void divide(const splitter *s, uint32_t *list, uint32_t count)
{
    uint32_t left = 0, right = 0;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t item = list[i], is_right = s->is_right[item];
        list[left] = item;
        s->spare[right] = item;
        left += 1 - is_right;
        right += is_right;
    }
    memcpy(list + left, s->spare, right * sizeof *list);
}

// Items on the left of the cut: whole children of the node, as near to half as they come.
static uint32_t left_share(uint32_t count)
{
    uint64_t child = CULL_BLOCK_WIDTH;
    while (child * CULL_BLOCK_WIDTH < count) child *= CULL_BLOCK_WIDTH;
    const uint64_t children = (count + child - 1) / child;
    uint64_t left = (count / 2 + child / 2) / child;
    if (left < 1) left = 1;
    if (left > children - 1) left = children - 1;
    return (uint32_t)(left * child);
}

static void split(const splitter *s, uint32_t first, uint32_t count) // at most 4 deep for each level of the tree
{
    const int axis = widest_axis(s, first, count);
    uint32_t *list = s->lists[axis] + first;
    if (count <= CULL_BLOCK_WIDTH) {
        memcpy(s->order + first, list, count * sizeof *list); // sorted: fewer runs in a leaf that a plane cuts
        return;
    }
    const uint32_t left = left_share(count);
    for (uint32_t i = 0; i < count; i++) s->is_right[list[i]] = i >= left;
    for (int other = 0; other < 3; other++)
        if (other != axis) divide(s, s->lists[other] + first, count);
    split(s, first, left);
    split(s, first + left, count - left);
}

cull_result index_order(const cull_host *host, const cull_zone *zone, uint32_t *order)
{
    const uint32_t count = zone->item_count;
    const size_t ids = (size_t)count * sizeof *order, pairs = (size_t)count * sizeof(keyed_item);
    if (count == 0) return CULL_OK;
    keyed_item *work = host->alloc(host, 2 * pairs, _Alignof(keyed_item));
    uint32_t *lists = host->alloc(host, 4 * ids, sizeof *lists);
    uint8_t *is_right = host->alloc(host, count, 1);
    if (work && lists && is_right) {
        splitter s = {&zone->boxes, {lists, lists + count, lists + 2 * (size_t)count}, lists + 3 * (size_t)count, is_right, order};
        for (int axis = 0; axis < 3; axis++) sort_axis(&zone->boxes, axis, count, work, work + count, s.lists[axis]);
        split(&s, 0, count);
    }
    const cull_result result = work && lists && is_right ? CULL_OK : CULL_ERR_MEMORY;
    if (is_right) host->free(host, is_right, count);
    if (lists) host->free(host, lists, 4 * ids);
    if (work) host->free(host, work, 2 * pairs);
    return result;
}
