// What is still to be looked at, nearest first: lists by the leading bits of the depth under a bit set (a bucket queue, Dial 1969), the nearest
// list as a heap. The order is one, whatever the order of pushes: of equal depths the smaller number first.
// SPDX-License-Identifier: MIT
#ifndef OCCLUSION_HIZ_QUEUE_H
#define OCCLUSION_HIZ_QUEUE_H

#include "hiz_buffer.h"

#include <stdint.h>
#include <string.h>

enum {
    QUEUE_SHIFT = 17,            // 64 lists an octave
    QUEUE_LOW = (127 - 24) << 6, // of depths down to 2^-24 a metre ...
    QUEUE_LISTS = 36 << 6,       // ... and up to 2^12; the lists at both ends take the rest
    QUEUE_WORDS = QUEUE_LISTS / 64,
    QUEUE_NONE = -1,
};

typedef struct queue_entry {
    float depth;
    uint32_t code;   // the entry of the tree: level in the upper 4 bits
    uint32_t planes; // of the one volume, those that cut it
    uint32_t polygon_count; // drawn when it was tested last
    int32_t next;
    int16_t x0, y0, x1, y1;
    hiz_place open; // of the rectangle
} queue_entry;

typedef struct queue_key { uint64_t rank; int32_t entry, reserved; } queue_key; // rank: depth's bits over the number's complement

typedef struct hiz_queue {
    queue_entry *entries; // room for each entry of the tree
    queue_key *heap;      // of the list `front` and nearer ones; as much room
    int32_t *heads;       // QUEUE_LISTS, of meaning where a bit is set
    uint64_t words[QUEUE_WORDS];
    int32_t entry_count, free, top_word, front, heap_count;
} hiz_queue;

static inline void queue_begin(hiz_queue *q)
{
    memset(q->words, 0, sizeof q->words);
    q->entry_count = q->heap_count = 0;
    q->free = QUEUE_NONE;
    q->top_word = QUEUE_WORDS - 1;
    q->front = QUEUE_LISTS; // none yet
}

static inline uint32_t queue_bits(float depth) // not negative, no NaN
{
    uint32_t bits;
    memcpy(&bits, &depth, sizeof bits);
    return bits;
}

static inline int32_t queue_list_of(float depth)
{
    const int32_t list = (int32_t)(queue_bits(depth) >> QUEUE_SHIFT) - QUEUE_LOW;
    return list < 0 ? 0 : list >= QUEUE_LISTS ? QUEUE_LISTS - 1 : list;
}

static inline void queue_sift_up(hiz_queue *q, int32_t entry)
{
    const queue_key key = {(uint64_t)queue_bits(q->entries[entry].depth) << 32 | (uint32_t)~q->entries[entry].code, entry, 0};
    int32_t at = q->heap_count++;
    for (int32_t above = (at - 1) / 2; at > 0 && q->heap[above].rank < key.rank; at = above, above = (at - 1) / 2) q->heap[at] = q->heap[above];
    q->heap[at] = key;
}

static inline int32_t queue_take_first(hiz_queue *q)
{
    const int32_t first = q->heap[0].entry;
    const queue_key last = q->heap[--q->heap_count];
    int32_t at = 0;
    for (int32_t child = 1; child < q->heap_count; child = 2 * at + 1) {
        if (child + 1 < q->heap_count && q->heap[child].rank < q->heap[child + 1].rank) child++;
        if (q->heap[child].rank <= last.rank) break;
        q->heap[at] = q->heap[child];
        at = child;
    }
    q->heap[at] = last;
    return first;
}

// `with` is copied; next is of no meaning.
static inline void queue_push(hiz_queue *q, const queue_entry *with)
{
    const int32_t list = queue_list_of(with->depth), word = list >> 6;
    const uint64_t bit = UINT64_C(1) << (list & 63);
    int32_t at = q->free;
    if (at == QUEUE_NONE) at = q->entry_count++;
    else q->free = q->entries[at].next;
    q->entries[at] = *with;
    if (list >= q->front) {
        queue_sift_up(q, at);
        return;
    }
    q->entries[at].next = q->words[word] & bit ? q->heads[list] : QUEUE_NONE;
    q->words[word] |= bit;
    q->heads[list] = at;
}

// The nearest list becomes the heap. 0: there is none.
static inline int queue_advance(hiz_queue *q)
{
    while (q->top_word >= 0 && !q->words[q->top_word]) q->top_word--;
    if (q->top_word < 0) return 0;
    const int32_t bit = 63 - __builtin_clzll(q->words[q->top_word]);
    q->front = q->top_word * 64 + bit;
    q->words[q->top_word] &= ~(UINT64_C(1) << bit);
    for (int32_t at = q->heads[q->front]; at != QUEUE_NONE; at = q->entries[at].next) queue_sift_up(q, at);
    return 1;
}

// 0: it is empty.
static inline int queue_pop(hiz_queue *q, queue_entry *out)
{
    if (!q->heap_count && !queue_advance(q)) return 0;
    const int32_t first = queue_take_first(q);
    *out = q->entries[first];
    q->entries[first].next = q->free;
    q->free = first;
    return 1;
}

#endif
