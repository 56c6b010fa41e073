// The baked index: the order of items, with a head that says whose it is and a check of all of it.
// SPDX-License-Identifier: MIT
// Invariant: what is loaded is a permutation that this version saved; anything else is CULL_ERR_BLOB, never used.
#include "index.h"

#include <string.h>

typedef struct baked_head {
    char magic[8];
    uint32_t byte_order, item_count;
    uint64_t check; // of the order
} baked_head;

static const char MAGIC[8] = {'f', 'r', 'u', 's', 't', 'u', 'm', '1'};
enum { BYTE_ORDER_MARK = 0x01020304 };

// Fowler, Noll and Vo's hash 1a, a word at a time: each step can be undone, so no single wrong word goes unseen.
static uint64_t check_of(const uint32_t *order, uint32_t count)
{
    uint64_t hash = 0xcbf29ce484222325u;
    for (uint32_t i = 0; i < count; i++) hash = (hash ^ order[i]) * 0x100000001b3u;
    return hash;
}

uint64_t index_save(const frustum_index *index, void *blob, uint64_t size)
{
    const size_t bytes = index->item_count * sizeof *index->order;
    baked_head head = {.byte_order = BYTE_ORDER_MARK, .item_count = index->item_count, .check = check_of(index->order, index->item_count)};
    if (size < sizeof head + bytes) return sizeof head + bytes;
    memcpy(head.magic, MAGIC, sizeof head.magic);
    memcpy(blob, &head, sizeof head);
    if (bytes) memcpy((char *)blob + sizeof head, index->order, bytes);
    return sizeof head + bytes;
}

static int is_permutation(const uint32_t *order, uint32_t count, uint8_t *seen)
{
    memset(seen, 0, count);
    for (uint32_t i = 0; i < count; i++) {
        if (order[i] >= count || seen[order[i]]) return 0;
        seen[order[i]] = 1;
    }
    return 1;
}

cull_result index_load_order(const cull_host *host, const cull_blob *baked, uint32_t item_count, uint32_t *order)
{
    const size_t bytes = item_count * sizeof *order;
    baked_head head;
    if (!baked->bytes || baked->size != sizeof head + bytes) return CULL_ERR_BLOB;
    memcpy(&head, baked->bytes, sizeof head);
    if (memcmp(head.magic, MAGIC, sizeof head.magic) != 0 || head.byte_order != BYTE_ORDER_MARK || head.item_count != item_count) return CULL_ERR_BLOB;
    if (bytes) memcpy(order, (const char *)baked->bytes + sizeof head, bytes);
    if (check_of(order, item_count) != head.check) return CULL_ERR_BLOB;
    const size_t seen_bytes = item_count ? item_count : 1;
    uint8_t *seen = host->alloc(host, seen_bytes, 1);
    if (!seen) return CULL_ERR_MEMORY;
    const int good = is_permutation(order, item_count, seen);
    host->free(host, seen, seen_bytes);
    return good ? CULL_OK : CULL_ERR_BLOB;
}
