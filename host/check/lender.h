// The host that a culler under check is lent: memory with a page behind each block that no one may touch, counted, failed
// on wish and sealed against writing; a log that is kept; tasks in any order; a baked index on wish.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_CHECK_LENDER_H
#define PORTCULLIS_HOST_CHECK_LENDER_H

#include <portcullis/culler.h>

#include <pthread.h>

typedef enum lender_tasks { TASKS_FORWARD, TASKS_BACKWARD } lender_tasks;

// Memory that ends at a page that no one may touch.
typedef struct fence {
    char *map;
    size_t map_size;
    void *memory;
    size_t size;
} fence;
// slack: bytes that may be written behind it. NULL memory on failure.
fence fence_open(size_t size, size_t align, size_t slack, const char *name);
void fence_close(fence *f);

typedef struct lender_block { fence fence; size_t align; int is_live; } lender_block;

typedef struct lender {
    cull_host host;     // the struct must not move
    cull_costs costs;
    cull_blob blob;     // bytes NULL: none is lent
    const cull_zone *zone; // that the blob belongs to
    lender_block *blocks;
    uint32_t block_count, block_capacity;
    uint64_t calls, fail_at, failures; // fail_at 0: no allocation fails
    uint64_t live_blocks, live_bytes, wrong_frees, calls_in_step;
    unsigned char fill; // of new memory: what is read before it is written shows
    lender_tasks tasks;
    int is_in_step;
    pthread_mutex_t lock;
    uint32_t lines; // logged
    char last_line[256];
} lender;

void lender_open(lender *l);
void lender_close(lender *l); // gives back what is left
// What is live now may not be written until it is released. Sealed blocks may be freed.
void lender_seal(lender *l);
void lender_release(lender *l);

#endif
