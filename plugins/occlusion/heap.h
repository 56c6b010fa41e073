// A heap of entries, the nearest on top; of equal keys the smaller entry, so that the order is one.
// SPDX-License-Identifier: MIT
#ifndef OCCLUSION_HEAP_H
#define OCCLUSION_HEAP_H

#include <stdint.h>

typedef struct heap_entry { float key; uint32_t entry; } heap_entry; // no key is NaN

static inline int heap_before(heap_entry a, heap_entry b)
{
    return a.key < b.key || (a.key == b.key && a.entry < b.entry);
}

// There is room for one more.
static inline void heap_push(heap_entry *heap, uint32_t *count, heap_entry e)
{
    uint32_t at = (*count)++;
    while (at > 0) {
        const uint32_t above = (at - 1) / 2;
        if (!heap_before(e, heap[above])) break;
        heap[at] = heap[above];
        at = above;
    }
    heap[at] = e;
}

// The heap is not empty.
static inline heap_entry heap_pop(heap_entry *heap, uint32_t *count)
{
    const heap_entry top = heap[0], last = heap[--*count];
    uint32_t at = 0;
    for (uint32_t child = 1; child < *count; child = 2 * at + 1) {
        if (child + 1 < *count && heap_before(heap[child + 1], heap[child])) child++;
        if (!heap_before(heap[child], last)) break;
        heap[at] = heap[child];
        at = child;
    }
    heap[at] = last;
    return top;
}

#endif
