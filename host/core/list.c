// Output lists: see list.h.
// SPDX-License-Identifier: MIT
#define _GNU_SOURCE
#include "list.h"

#ifdef NDEBUG

#include <string.h>

list list_open(const allocator *memory, size_t count, size_t item_size)
{
    list l = {.size = count * item_size, .block_size = count * item_size};
    l.items = l.block = memory_alloc(memory, count, item_size);
    if (l.items && l.size) memset(l.items, 0, l.size); // touched now, so that no frame waits for the system to give the pages
    return l;
}

void list_close(list *l, const allocator *memory)
{
    memory_free(memory, l->block, l->block_size, 1);
    *l = (list){0};
}

#else

#include <sys/mman.h>
#include <unistd.h>

list list_open(const allocator *memory, size_t count, size_t item_size)
{
    void *permit = memory_alloc(memory, 1, 1); // mapping is not the allocator's: ask it first, so that fault tests reach here too
    if (!permit) return (list){0};
    memory_free(memory, permit, 1, 1);
    const size_t page = (size_t)sysconf(_SC_PAGESIZE), size = count * item_size;
    list l = {.size = size, .block_size = (size + page - 1) / page * page + page};
    l.block = mmap(NULL, l.block_size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (l.block == MAP_FAILED) return (list){0};
    char *guard = (char *)l.block + l.block_size - page;
    mprotect(guard, page, PROT_NONE);
    l.items = guard - size;
    return l;
}

void list_close(list *l, const allocator *memory)
{
    (void)memory;
    if (l->block) munmap(l->block, l->block_size);
    *l = (list){0};
}

#endif
