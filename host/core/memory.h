// Memory: the one allocator that everything takes as an argument, a growable buffer and an arena on top of it.
// SPDX-License-Identifier: MIT
// Invariant: every failure is a NULL or a result, never an abort; sizes that overflow fail like exhausted memory.
#ifndef PORTCULLIS_HOST_MEMORY_H
#define PORTCULLIS_HOST_MEMORY_H

#include <stddef.h>
#include <stdint.h>

// [any thread] alloc returns memory aligned to `align` (a power of two) or NULL; free takes the size asked for.
typedef struct allocator {
    void *(*alloc)(void *user, size_t size, size_t align);
    void (*free)(void *user, void *memory, size_t size);
    void *user;
} allocator;

// The C library's heap. Constant, shared by all.
const allocator *allocator_heap(void);

void *memory_alloc(const allocator *memory, size_t count, size_t item_size); // 64-byte aligned; NULL on failure; count 0 gives memory
void *memory_alloc_zeroed(const allocator *memory, size_t count, size_t item_size);
void memory_free(const allocator *memory, void *block, size_t count, size_t item_size); // NULL is fine

// A growable array of items of one size. `items` moves when it grows.
typedef struct buffer {
    void *items;
    size_t count, capacity, item_size;
    const allocator *memory;
} buffer;

buffer buffer_make(const allocator *memory, size_t item_size);
void *buffer_push(buffer *b, size_t count); // `count` new items of undefined content; never NULL but on failure (nothing changed)
void *buffer_append(buffer *b, const void *items, size_t count); // copies; NULL on failure
void buffer_free(buffer *b);

// Memory that goes all at once. Blocks of 1 KiB, doubling to 64 KiB; nothing in it moves.
typedef struct arena_block arena_block;
typedef struct arena {
    arena_block *blocks;
    const allocator *memory;
    size_t bytes; // handed out
} arena;

arena arena_make(const allocator *memory);
void *arena_push(arena *a, size_t count, size_t item_size); // 64-byte aligned; NULL on failure
char *arena_text(arena *a, const char *text, size_t length); // a copy with a closing zero; NULL on failure
void arena_free(arena *a);

#endif
