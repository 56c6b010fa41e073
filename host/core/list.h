// Output lists lent to plugins. In debug builds each ends at a page that no one may touch, so a write behind the end
// stops at the spot; in release builds they are plain memory.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_LIST_H
#define PORTCULLIS_HOST_LIST_H

#include "memory.h"

typedef struct list {
    void *items; // the list proper, `size` bytes, its end at the guard page; aligned to the largest power of two in item_size
    size_t size;
    void *block; // what was taken
    size_t block_size;
} list;

// NULL items on failure. Undefined content.
list list_open(const allocator *memory, size_t count, size_t item_size);
void list_close(list *l, const allocator *memory);

#endif
