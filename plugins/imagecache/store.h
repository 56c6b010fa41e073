// What pictures take together, and which one goes when there is no room: the one that was shown longest ago, never one of this frame.
// SPDX-License-Identifier: MIT
//
// Invariant: the pictures of a query never take more than `most` bytes, as the host counts them. A slot that was emptied counts on: a change empties it,
// or a filter drops the capture, and the host keeps the memory until the slot is taken anew.
#ifndef PORTCULLIS_IMAGECACHE_STORE_H
#define PORTCULLIS_IMAGECACHE_STORE_H

#include <portcullis/culler.h>

typedef struct store {
    uint32_t *bytes; // by slot: the most that the host may hold
    uint32_t *asked; // by slot: of a capture given in the frame before, which may have been dropped; 0: none
    uint32_t *used;  // by slot: the frame that it was shown in last
    uint32_t slot_count, frame;
    uint64_t held, most; // held: of all slots
    uint32_t evicted;    // this frame
    size_t size;
} store;

int store_open(const cull_host *host, uint32_t slot_count, store *out); // 0: no memory
void store_close(const cull_host *host, store *s);
void store_begin(store *s, const cull_visit *visit, uint32_t frame, uint64_t most);
// It is shown in this frame: it stays.
void store_keep(store *s, uint32_t slot);

typedef struct store_request {
    const cull_visit *visit;
    uint32_t slot, bytes; // that it is to take
    uint32_t captures_most;
} store_request;

// Makes room for a capture into a slot of this frame: others are emptied by captures of nothing, a texel wide. 0: there is none.
int store_take(store *s, const store_request *q, cull_batch *batch);

#endif
