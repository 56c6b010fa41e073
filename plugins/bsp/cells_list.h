// A growing array on the host's memory, for builds. No step uses it.
// SPDX-License-Identifier: MIT
// Invariant: count <= room; items moves when it grows, so references are places, not pointers.
#ifndef PORTCULLIS_BSP_CELLS_LIST_H
#define PORTCULLIS_BSP_CELLS_LIST_H

#include <portcullis/culler.h>

#include <string.h>

typedef struct cells_list {
    const cull_host *host;
    void *items;
    size_t size; // of an item, bytes
    uint32_t count, room;
} cells_list;

static inline cells_list cells_list_make(const cull_host *host, size_t item_size)
{
    const cells_list list = {host, 0, item_size, 0, 0};
    return list;
}

static inline void cells_list_free(cells_list *list)
{
    if (list->items) list->host->free(list->host, list->items, list->size * list->room);
    list->items = 0;
    list->count = list->room = 0;
}

// Room for `more` items behind the last, not counted yet; NULL: out of memory, the list as it was, or nothing at all was asked for.
static inline void *cells_list_reserve(cells_list *list, uint32_t more)
{
    const uint64_t wanted = (uint64_t)list->count + more;
    if (wanted > list->room) {
        uint64_t room = list->room ? 2 * (uint64_t)list->room : 16;
        if (room < wanted) room = wanted;
        if (room > UINT32_MAX || room > SIZE_MAX / list->size) return 0;
        void *items = list->host->alloc(list->host, (size_t)room * list->size, 16);
        if (!items) return 0;
        if (list->count) memcpy(items, list->items, list->size * list->count);
        if (list->items) list->host->free(list->host, list->items, list->size * list->room);
        list->items = items;
        list->room = (uint32_t)room;
    }
    return list->items ? (char *)list->items + list->size * list->count : 0;
}

static inline void *cells_list_push(cells_list *list, uint32_t more)
{
    void *to = cells_list_reserve(list, more);
    if (to) list->count += more;
    return to;
}

static inline int cells_list_add(cells_list *list, const void *item)
{
    void *to = cells_list_push(list, 1);
    if (to) memcpy(to, item, list->size);
    return to != 0;
}

// The items alone, in a block of exactly their size; the list is empty afterwards. NULL with *out_count 0 where there are none.
static inline int cells_list_take(cells_list *list, void *out_items, uint32_t *out_count)
{
    void *items = 0;
    if (list->count) {
        items = list->host->alloc(list->host, list->size * list->count, 16);
        if (!items) return 0;
        memcpy(items, list->items, list->size * list->count);
    }
    memcpy(out_items, &items, sizeof items);
    *out_count = list->count;
    cells_list_free(list);
    return 1;
}

#endif
