// Output lists: see list.h.
// SPDX-License-Identifier: MIT
#define _GNU_SOURCE
#include "list.h"

#include <string.h>

enum { NOTHING = 256 }; // the address of lists of nothing: aligned for any item, in the page that no system maps

static list list_of_nothing(void)
{
    return (list){.items = (void *)(uintptr_t)NOTHING};
}

static list list_plain(const allocator *memory, size_t size)
{
    list l = {.size = size, .block_size = size};
    l.items = l.block = memory_alloc(memory, size, 1);
    if (l.items) memset(l.items, 0, size); // touched now, so that no frame waits for the system to give the pages
    return l;
}

#ifdef NDEBUG

list list_open_as(list_kind kind, const allocator *memory, size_t count, size_t item_size)
{
    (void)kind;
    if (!count || !item_size) return list_of_nothing();
    if (count > SIZE_MAX / 2 / item_size) return (list){0};
    return list_plain(memory, count * item_size);
}

static int list_is_mapped(const list *l)
{
    (void)l;
    return 0;
}

static void list_unmap(list *l)
{
    (void)l;
}

#else

#include <sys/mman.h>
#include <unistd.h>

// NULL items: the system gives no mapping.
static list list_guarded(size_t size)
{
    const size_t page = (size_t)sysconf(_SC_PAGESIZE);
    list l = {.size = size, .block_size = (size + page - 1) / page * page + page};
    l.block = mmap(NULL, l.block_size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (l.block == MAP_FAILED) return (list){0};
    char *guard = (char *)l.block + l.block_size - page;
    if (mprotect(guard, page, PROT_NONE) != 0) {
        munmap(l.block, l.block_size);
        return (list){0};
    }
    l.items = guard - size;
    return l;
}

list list_open_as(list_kind kind, const allocator *memory, size_t count, size_t item_size)
{
    if (!count || !item_size) return list_of_nothing();
    if (count > SIZE_MAX / 2 / item_size) return (list){0};
    if (kind == LIST_PLAIN) return list_plain(memory, count * item_size);
    void *permit = memory_alloc(memory, 1, 1); // mapping is not the allocator's: ask it first, so that fault tests reach here too
    if (!permit) return (list){0};
    memory_free(memory, permit, 1, 1);
    const list l = list_guarded(count * item_size);
    return l.items ? l : list_plain(memory, count * item_size);
}

static int list_is_mapped(const list *l)
{
    return l->block && l->block_size != l->size; // a mapping has the guard page on top
}

static void list_unmap(list *l)
{
    munmap(l->block, l->block_size);
}

#endif

list list_open(const allocator *memory, size_t count, size_t item_size)
{
    return list_open_as(LIST_GUARDED, memory, count, item_size);
}

void list_close(list *l, const allocator *memory)
{
    if (list_is_mapped(l)) list_unmap(l);
    else memory_free(memory, l->block, l->block_size, 1);
    *l = (list){0};
}
