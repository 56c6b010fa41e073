// Memory: see memory.h.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "memory.h"

#include <stdlib.h>
#include <string.h>

enum { MEMORY_ALIGN = 64, ARENA_LEAST_BYTES = 1024, ARENA_MOST_BYTES = 64 * 1024 };

struct arena_block {
    arena_block *next;
    size_t used, size; // of the whole block, header included
};

static void *heap_alloc(void *user, size_t size, size_t align)
{
    (void)user;
    void *memory = NULL;
    if (posix_memalign(&memory, align < sizeof(void *) ? sizeof(void *) : align, size ? size : 1) != 0) return NULL;
    return memory;
}

static void heap_free(void *user, void *memory, size_t size)
{
    (void)user;
    (void)size;
    free(memory);
}

const allocator *allocator_heap(void)
{
    static const allocator heap = {heap_alloc, heap_free, NULL};
    return &heap;
}

static size_t size_of(size_t count, size_t item_size)
{
    if (item_size && count > SIZE_MAX / 2 / item_size) return SIZE_MAX;
    return count * item_size;
}

void *memory_alloc(const allocator *memory, size_t count, size_t item_size)
{
    const size_t size = size_of(count, item_size);
    return size == SIZE_MAX ? NULL : memory->alloc(memory->user, size, MEMORY_ALIGN);
}

void *memory_alloc_zeroed(const allocator *memory, size_t count, size_t item_size)
{
    void *block = memory_alloc(memory, count, item_size);
    if (block && count > 0 && item_size > 0) memset(block, 0, count * item_size);
    return block;
}

void memory_free(const allocator *memory, void *block, size_t count, size_t item_size)
{
    if (block) memory->free(memory->user, block, count * item_size);
}

buffer buffer_make(const allocator *memory, size_t item_size)
{
    return (buffer){.item_size = item_size, .memory = memory};
}

static int buffer_reserve(buffer *b, size_t count)
{
    if (b->items && count <= b->capacity - b->count) return 1;
    if (count > SIZE_MAX / 4 - b->count) return 0;
    size_t capacity = b->capacity ? b->capacity * 2 : 64;
    if (capacity < b->count + count) capacity = b->count + count;
    void *items = memory_alloc(b->memory, capacity, b->item_size);
    if (!items) return 0;
    if (b->count) memcpy(items, b->items, b->count * b->item_size);
    memory_free(b->memory, b->items, b->capacity, b->item_size);
    b->items = items;
    b->capacity = capacity;
    return 1;
}

void *buffer_push(buffer *b, size_t count)
{
    if (!buffer_reserve(b, count)) return NULL;
    void *first = (char *)b->items + b->count * b->item_size;
    b->count += count;
    return first;
}

void *buffer_append(buffer *b, const void *items, size_t count)
{
    void *first = buffer_push(b, count);
    if (first && count) memcpy(first, items, count * b->item_size);
    return first;
}

void buffer_free(buffer *b)
{
    memory_free(b->memory, b->items, b->capacity, b->item_size);
    b->items = NULL;
    b->count = b->capacity = 0;
}

arena arena_make(const allocator *memory)
{
    return (arena){.memory = memory};
}

static size_t round_up(size_t size)
{
    return (size + MEMORY_ALIGN - 1) / MEMORY_ALIGN * MEMORY_ALIGN;
}

// Thousands of small arenas stay small, a large one takes few blocks.
static size_t next_block_bytes(const arena_block *last)
{
    if (!last) return ARENA_LEAST_BYTES;
    return last->size < ARENA_MOST_BYTES / 2 ? last->size * 2 : ARENA_MOST_BYTES;
}

void *arena_push(arena *a, size_t count, size_t item_size)
{
    const size_t size = size_of(count, item_size);
    if (size > SIZE_MAX / 2) return NULL;
    const size_t need = round_up(size ? size : 1);
    arena_block *block = a->blocks;
    if (!block || block->size - block->used < need) {
        const size_t head = round_up(sizeof(arena_block));
        const size_t wanted = next_block_bytes(block), whole = need + head > wanted ? need + head : wanted;
        block = a->memory->alloc(a->memory->user, whole, MEMORY_ALIGN);
        if (!block) return NULL;
        *block = (arena_block){.next = a->blocks, .used = head, .size = whole};
        a->blocks = block;
    }
    void *memory = (char *)block + block->used;
    block->used += need;
    a->bytes += need;
    return memory;
}

char *arena_text(arena *a, const char *text, size_t length)
{
    char *copy = arena_push(a, length + 1, 1);
    if (!copy) return NULL;
    if (length) memcpy(copy, text, length);
    copy[length] = 0;
    return copy;
}

void arena_free(arena *a)
{
    for (arena_block *block = a->blocks; block;) {
        arena_block *next = block->next;
        a->memory->free(a->memory->user, block, block->size);
        block = next;
    }
    a->blocks = NULL;
    a->bytes = 0;
}
