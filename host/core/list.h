// Output lists lent to plugins. In debug builds each that is guarded ends at a page that no one may touch, so a write
// behind the end stops at the spot; in release builds, and where the system gives no more mappings, they are plain memory.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_LIST_H
#define PORTCULLIS_HOST_LIST_H

#include "memory.h"

typedef struct list {
    void *items; // the list proper, `size` bytes, its end at the guard page; aligned to the largest power of two in item_size
    size_t size;
    void *block; // what was taken; NULL: a list of nothing takes nothing
    size_t block_size;
} list;

typedef enum list_kind {
    LIST_GUARDED, // debug builds: three system calls and a page or more each
    LIST_PLAIN,   // for worlds of so many zones that the system would run out of mappings
} list_kind;

// NULL items on failure. Zeroed. A list of nothing has items too, in the first page, which no one may touch.
list list_open(const allocator *memory, size_t count, size_t item_size);
list list_open_as(list_kind kind, const allocator *memory, size_t count, size_t item_size);
void list_close(list *l, const allocator *memory);

// The last `bytes` of a list that several share one after the other: whoever writes behind them is stopped as well.
static inline void *list_tail(const list *l, size_t bytes)
{
    return (char *)l->items + (l->size - bytes);
}

#endif
